-- The same as in SQLite (migrations/sqlite/0005_digests.sql), where more is said.
ALTER TABLE results ADD COLUMN digest TEXT COLLATE "C";
ALTER TABLE final_states ADD COLUMN digest TEXT COLLATE "C";

-- As for the other columns (0001_queue.sql).
ALTER TABLE results ALTER COLUMN digest SET STATISTICS 0;
ALTER TABLE final_states ALTER COLUMN digest SET STATISTICS 0;
