-- Marks the file as tribosweep's ("trib" in ASCII), so that a database of another program is refused
-- instead of being filled with our tables. In the migration, so that it is set with the tables or not at all.
PRAGMA application_id = 1953655138;

CREATE TABLE studies (
    id           INTEGER PRIMARY KEY,
    name         TEXT    NOT NULL UNIQUE,
    document     TEXT    NOT NULL,
    submitted_ms INTEGER NOT NULL
) STRICT;

-- What claiming and finishing touch. `attempt` counts starts and never falls: it is the fence that keeps a
-- late finish of an earlier attempt out. `note` says why a job went back to pending.
CREATE TABLE jobs (
    id         INTEGER PRIMARY KEY,
    key        TEXT    NOT NULL UNIQUE,
    cost       REAL    NOT NULL,
    state      TEXT    NOT NULL DEFAULT 'pending' CHECK (state IN ('pending', 'running', 'done', 'failed')),
    attempt    INTEGER NOT NULL DEFAULT 0,
    created_ms INTEGER NOT NULL,
    started_ms INTEGER,
    note       TEXT,
    payload    TEXT    NOT NULL
) STRICT;

-- The order of claims. Partial, so that it shrinks with the work left and a claim costs the same at any size.
CREATE INDEX jobs_pending ON jobs (cost DESC, id) WHERE state = 'pending';

-- Counting states and finding what an interrupted process left must not read the payloads.
CREATE INDEX jobs_state ON jobs (state);

-- The rows of a study. Two rows may point to one job: two grid points can describe the same simulation.
CREATE TABLE study_jobs (
    study_id   INTEGER NOT NULL REFERENCES studies (id),
    ordinal    INTEGER NOT NULL,
    job_id     INTEGER NOT NULL REFERENCES jobs (id),
    parameters TEXT    NOT NULL,
    PRIMARY KEY (study_id, ordinal)
) STRICT, WITHOUT ROWID;

-- "Does this job belong to that study", asked for every candidate of a claim.
CREATE INDEX study_jobs_job ON study_jobs (job_id, study_id);

-- One row an attempt that ran to its end, written once and never changed.
CREATE TABLE results (
    job_id      INTEGER NOT NULL REFERENCES jobs (id),
    attempt     INTEGER NOT NULL,
    record      TEXT,
    error       TEXT,
    wall_s      REAL    NOT NULL,
    finished_ms INTEGER NOT NULL,
    PRIMARY KEY (job_id, attempt),
    CHECK ((record IS NULL) <> (error IS NULL))
) STRICT, WITHOUT ROWID;
