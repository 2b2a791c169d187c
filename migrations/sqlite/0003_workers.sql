-- What a worker has done and how fast it lately was, as it says itself with its signs of life, and how many of its
-- jobs others took back.
ALTER TABLE workers ADD COLUMN finished INTEGER NOT NULL DEFAULT 0;
ALTER TABLE workers ADD COLUMN jobs_per_s REAL;
ALTER TABLE workers ADD COLUMN taken_back INTEGER NOT NULL DEFAULT 0;

-- How long it may be silent, as it says itself. Those of before had two minutes.
ALTER TABLE workers ADD COLUMN lease_ms INTEGER NOT NULL DEFAULT 120000;
