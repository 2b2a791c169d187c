-- Several processes on one database: who runs a job and until when, which jobs can be run together and which
-- first, where a long job can go on, and what a result was made with.
--
-- Foreign keys are off while migrations run (a table cannot be rebuilt under those that refer to it) and on ever
-- after.

-- A process that runs jobs. Numbers are never used twice: a late finish of an old one must not pass for a new one's.
-- `process_start` is in the kernel's ticks since the boot: with it, a process number that was given again is told
-- from the old one. A process number means something only to the same boot and namespace. A process that had been asked
-- to stop (`stopping_ms`) and is gone did not crash.
CREATE TABLE workers (
    id            INTEGER PRIMARY KEY AUTOINCREMENT,
    host          TEXT    NOT NULL,
    boot_id       TEXT,
    pid_namespace TEXT,
    pid           INTEGER NOT NULL,
    process_start INTEGER,
    threads       INTEGER NOT NULL,
    version       TEXT    NOT NULL,
    started_ms    INTEGER NOT NULL,
    heartbeat_ms  INTEGER NOT NULL,
    stopping_ms   INTEGER,
    ended_ms      INTEGER
) STRICT;

-- When the study was cancelled: it asks for its jobs no more.
ALTER TABLE studies ADD COLUMN cancelled_ms INTEGER;

-- What the executor needs, apart from the jobs: claiming and finishing rewrite a job's row, and with it all that lies
-- on the same page.
CREATE TABLE payloads (
    job_id  INTEGER PRIMARY KEY,
    payload TEXT    NOT NULL,
    FOREIGN KEY (job_id) REFERENCES jobs (id)
) STRICT;

INSERT INTO payloads (job_id, payload) SELECT id, payload FROM jobs;

-- Jobs that can be run together have the same `batch`, an opaque name. `crashes` counts attempts whose process died,
-- in a row and without a checkpoint in between. `label` is what the worker calls the end of a job that is done, in a
-- word, so that those that ended alike are found without reading their records. `attempt` is, with the owner, the fence
-- that keeps a late finish out.
CREATE TABLE jobs_2 (
    id             INTEGER PRIMARY KEY,
    key            TEXT    NOT NULL UNIQUE,
    batch          TEXT    NOT NULL DEFAULT '',
    priority       INTEGER NOT NULL DEFAULT 0,
    cost           REAL    NOT NULL,
    state          TEXT    NOT NULL DEFAULT 'pending'
                   CHECK (state IN ('pending', 'running', 'done', 'failed', 'cancelled')),
    attempt        INTEGER NOT NULL DEFAULT 0,
    crashes        INTEGER NOT NULL DEFAULT 0,
    owner          INTEGER REFERENCES workers (id),
    lease_until_ms INTEGER,
    created_ms     INTEGER NOT NULL,
    started_ms     INTEGER,
    note           TEXT,
    label          TEXT,
    CHECK ((state = 'running') = (owner IS NOT NULL)),
    CHECK ((state = 'running') = (lease_until_ms IS NOT NULL))
) STRICT;

-- Whoever ran a job under the first schema held a lock that is ours now, so nothing is running.
INSERT INTO jobs_2 (id, key, cost, state, attempt, created_ms, started_ms, note)
SELECT id, key, cost, CASE state WHEN 'running' THEN 'pending' ELSE state END, attempt, created_ms, started_ms,
       CASE state WHEN 'running' THEN 'taken back: the process that ran the job ended without finishing it' ELSE note END
FROM jobs;

DROP TABLE jobs;
ALTER TABLE jobs_2 RENAME TO jobs;

-- The order of claims, over all jobs and within a batch. Partial, so that they shrink with the work left and a claim
-- costs the same at any size.
CREATE INDEX jobs_pending ON jobs (priority DESC, cost DESC, id) WHERE state = 'pending';
CREATE INDEX jobs_pending_batch ON jobs (batch, priority DESC, cost DESC, id) WHERE state = 'pending';

-- What a worker runs: its heartbeat and its end.
CREATE INDEX jobs_owner ON jobs (owner) WHERE state = 'running';

-- The pending jobs of each study in the order of claims, kept by the triggers below: looking for a study's next job
-- among all pending ones takes as long as other studies have jobs before it. No foreign keys: what they would check is
-- what the triggers do.
CREATE TABLE study_pending (
    study_id INTEGER NOT NULL,
    priority INTEGER NOT NULL,
    cost     REAL    NOT NULL,
    job_id   INTEGER NOT NULL,
    batch    TEXT    NOT NULL,
    PRIMARY KEY (study_id, priority DESC, cost DESC, job_id)
) STRICT, WITHOUT ROWID;

CREATE INDEX study_pending_batch ON study_pending (study_id, batch, priority DESC, cost DESC, job_id);

INSERT INTO study_pending (study_id, priority, cost, job_id, batch)
SELECT DISTINCT m.study_id, j.priority, j.cost, j.id, j.batch
FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id
WHERE j.state = 'pending';

-- One trigger for each kind of change, since the order of triggers is not defined. What a claim does has one that does
-- nothing else: it runs for every job.
CREATE TRIGGER jobs_pending_no_more AFTER UPDATE OF state ON jobs
WHEN old.state = 'pending' AND new.state <> 'pending'
BEGIN
    DELETE FROM study_pending
    WHERE study_id IN (SELECT m.study_id FROM study_jobs AS m WHERE m.job_id = old.id)
      AND priority = old.priority AND cost = old.cost AND job_id = old.id;
END;

CREATE TRIGGER jobs_pending_changed AFTER UPDATE OF state, batch, priority, cost ON jobs
WHEN new.state = 'pending'
BEGIN
    DELETE FROM study_pending
    WHERE study_id IN (SELECT m.study_id FROM study_jobs AS m WHERE m.job_id = old.id)
      AND priority = old.priority AND cost = old.cost AND job_id = old.id;
    INSERT INTO study_pending (study_id, priority, cost, job_id, batch)
    SELECT DISTINCT m.study_id, new.priority, new.cost, new.id, new.batch
    FROM study_jobs AS m
    WHERE m.job_id = new.id;
END;

CREATE TRIGGER study_jobs_added AFTER INSERT ON study_jobs
BEGIN
    INSERT INTO study_pending (study_id, priority, cost, job_id, batch)
    SELECT new.study_id, j.priority, j.cost, j.id, j.batch
    FROM jobs AS j
    WHERE j.id = new.job_id AND j.state = 'pending'
    ON CONFLICT DO NOTHING;
END;

CREATE TRIGGER study_jobs_removed AFTER DELETE ON study_jobs
WHEN NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = old.job_id AND m.study_id = old.study_id)
BEGIN
    DELETE FROM study_pending
    WHERE study_id = old.study_id AND job_id = old.job_id
      AND (priority, cost) = (SELECT j.priority, j.cost FROM jobs AS j WHERE j.id = old.job_id);
END;

-- One row an attempt that ended, written once and never changed, one after the other as they come. The time it took is
-- unknown where its process died. `provenance` says what it was made with, as the worker tells it.
CREATE TABLE results_2 (
    job_id      INTEGER NOT NULL REFERENCES jobs (id),
    attempt     INTEGER NOT NULL,
    record      TEXT,
    error       TEXT,
    wall_s      REAL,
    started_ms  INTEGER,
    finished_ms INTEGER NOT NULL,
    provenance  TEXT,
    PRIMARY KEY (job_id, attempt),
    CHECK ((record IS NULL) <> (error IS NULL))
) STRICT;

INSERT INTO results_2 (job_id, attempt, record, error, wall_s, finished_ms)
SELECT job_id, attempt, record, error, wall_s, finished_ms FROM results;

DROP TABLE results;
ALTER TABLE results_2 RENAME TO results;

-- Records of the first schema's program say it themselves.
UPDATE jobs
SET label = (SELECT IIF(json_valid(r.record), r.record ->> '$.outcome', NULL)
             FROM results AS r WHERE r.job_id = jobs.id AND r.attempt = jobs.attempt)
WHERE state = 'done';

-- Where a job that was interrupted can go on: the last state that an attempt left, gone when the job is done or fails
-- by itself. One whose processes died, or that was cancelled, may be asked for again.
CREATE TABLE checkpoints (
    job_id   INTEGER PRIMARY KEY REFERENCES jobs (id),
    attempt  INTEGER NOT NULL,
    bytes    BLOB    NOT NULL,
    saved_ms INTEGER NOT NULL
) STRICT;

CREATE TRIGGER jobs_ended AFTER UPDATE OF state ON jobs
WHEN (new.state = 'done' OR new.state = 'failed' AND new.crashes = 0)
 AND EXISTS (SELECT 1 FROM checkpoints WHERE job_id = new.id)
BEGIN
    DELETE FROM checkpoints WHERE job_id = new.id;
END;
