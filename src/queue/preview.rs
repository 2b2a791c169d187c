use std::collections::HashSet;

use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::plan_rows;
use super::replace::{OLD, OldColumns, Replaced};
use super::state::JobState;

/// The jobs of a study: key, state, and 1 if no other study has the job.
const OLD_JOBS: &str = "
    SELECT j.key, j.state,
           CAST(CASE WHEN EXISTS (SELECT 1 FROM study_jobs AS o WHERE o.job_id = j.id AND o.study_id <> $1)
                THEN 0 ELSE 1 END AS BIGINT)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id";

impl Queue {
    /// What a submission of a study with this name, these jobs and this document would replace; `None` if no study has the name. Nothing
    /// is changed.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn preview_replacement(
        &mut self,
        name: &str,
        keys: &HashSet<&str>,
        document: &str,
    ) -> Result<Option<Replaced>, QueueError> {
        let old: Option<OldColumns> = query(OLD).bind(name).optional(&mut self.connection).await?;
        let Some((study_id, old_document, _, parameters)) = old else { return Ok(None) };
        let jobs: Vec<(String, String, i64)> =
            query(OLD_JOBS).bind(study_id).all(&mut self.connection).await?;
        let mut replaced = Replaced {
            document: old_document,
            parameters,
            kept: 0,
            new: 0,
            dropped: 0,
            dropped_done: 0,
            cancelled: 0,
        };
        // A study that grows keeps its waves if it is submitted as it is. Another version of the solver gives its jobs other keys.
        let known: HashSet<&str> = jobs.iter().map(|(key, ..)| key.as_str()).collect();
        let keeps_waves = replaced.document == document
            && keys.is_subset(&known)
            && plan_rows::read(&mut self.connection, study_id).await?.is_some();
        let mut stay = 0;
        for (key, state, is_only_here) in &jobs {
            let is_wanted = keys.contains(key.as_str());
            stay += u64::from(is_wanted);
            if is_wanted || keeps_waves {
                replaced.kept += 1;
                continue;
            }
            let state = JobState::from_column(state)?;
            replaced.dropped += 1;
            replaced.dropped_done += u64::from(state == JobState::Done);
            replaced.cancelled += u64::from(state == JobState::Pending && *is_only_here == 1);
        }
        replaced.new = keys.len() as u64 - stay;
        Ok(Some(replaced))
    }
}
