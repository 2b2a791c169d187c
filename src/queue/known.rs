use std::collections::HashMap;

use super::bulk::json;
use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::state::JobState;

/// `SQLite`: CROSS JOIN fixes the order of the loops, so that a key is looked up for each row.
const KNOWN: Statement = Statement::each(
    "SELECT j.key, j.state FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value",
    "SELECT j.key, j.state FROM json_array_elements_text($1::json) AS e (value) JOIN jobs AS j ON j.key = e.value",
);

/// Keys per JSON parameter.
const CHUNK: usize = 10_000;

impl Queue {
    /// The states of those of the jobs that are in the database, by key, whatever their study.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn states(&mut self, keys: &[&str]) -> Result<HashMap<String, JobState>, QueueError> {
        let mut states = HashMap::new();
        for chunk in keys.chunks(CHUNK) {
            let known: Vec<(String, String)> =
                query(KNOWN).bind(json(&chunk)).all(&mut self.connection).await?;
            for (key, state) in known {
                states.insert(key, JobState::from_column(&state)?);
            }
        }
        Ok(states)
    }
}
