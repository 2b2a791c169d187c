-- Studies that grow: when all jobs of such a study have ended, a worker plans its next wave of jobs from their results.
-- Who plans has a lease, like who runs a job; `wave` counts the waves that were stored, and it is the fence that keeps the
-- second one of two equal plans out.
CREATE TABLE plans (
    study_id       INTEGER PRIMARY KEY REFERENCES studies (id),
    wave           INTEGER NOT NULL DEFAULT 0,
    state          TEXT    NOT NULL DEFAULT 'open' CHECK (state IN ('open', 'complete', 'failed')),
    owner          INTEGER,
    lease_until_ms INTEGER,
    note           TEXT
) STRICT;

-- A job that continues another one begins with the state in which that one ended. `parent` is the key of that one.
ALTER TABLE jobs ADD COLUMN parent TEXT;

CREATE TABLE final_states (
    job_id INTEGER PRIMARY KEY REFERENCES jobs (id),
    bytes  BLOB    NOT NULL
) STRICT;
