-- The same as in SQLite (migrations/sqlite/0004_plans.sql), where more is said.
CREATE TABLE plans (
    study_id       BIGINT PRIMARY KEY REFERENCES studies (id),
    wave           BIGINT NOT NULL DEFAULT 0,
    state          TEXT COLLATE "C" NOT NULL DEFAULT 'open' CHECK (state IN ('open', 'complete', 'failed')),
    owner          BIGINT,
    lease_until_ms BIGINT,
    note           TEXT
);

ALTER TABLE jobs ADD COLUMN parent TEXT COLLATE "C";

CREATE TABLE final_states (
    job_id BIGINT PRIMARY KEY REFERENCES jobs (id),
    bytes  BYTEA  NOT NULL
);
