-- A digest of each result and of each final state, with the key of its job, so that a changed bit is noticed when it is
-- read. What earlier versions stored has none.
ALTER TABLE results ADD COLUMN digest TEXT;
ALTER TABLE final_states ADD COLUMN digest TEXT;

-- Counting jobs by state must not read all rows of the table. (The second migration built the table again without it.)
CREATE INDEX jobs_state ON jobs (state);
