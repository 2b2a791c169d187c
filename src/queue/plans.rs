//! Studies that grow: their next jobs depend on the results of those that have ended.
//!
//! ```text
//!              jobs of the study end            store_plan: a wave
//!  open plan ───────────────────────► claimed ─────────────────────► open plan, more jobs
//!                                        ├── nothing more to ask for ──► complete
//!                                        └── it cannot be planned ─────► failed ── submit, retry ──► open
//! ```
//!
//! The queue does not know how a wave is planned. It says when one is due, lets one worker at a time plan it, and stores
//! the jobs together with the number of the wave in one transaction. A plan of a worker that was too late changes nothing,
//! so a wrong decision about who is gone costs some time and nothing else.

use super::engine::{Connection, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::plan_rows;
use super::scope::Scope;
use super::submit::{self, CHUNK, NewJob};

/// A wave that this worker plans.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanClaim {
    /// The study.
    pub study: String,
    /// The study's document.
    pub document: String,
    /// The number of the wave to be planned, from 1.
    pub wave: u64,
}

/// What became of a plan.
#[derive(Debug, Clone, PartialEq)]
pub enum Planned {
    /// More jobs, at the end of the study.
    Wave {
        /// The jobs; at least one.
        jobs: Vec<NewJob>,
        /// Why they are needed, in words.
        note: String,
    },
    /// The study needs no more jobs.
    Complete {
        /// How it ended, in words.
        note: String,
    },
    /// The wave cannot be planned, and another attempt would fail in the same way.
    Failed {
        /// Why.
        error: String,
    },
}

/// The plan of a study that grows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanStatus {
    /// How many waves were added.
    pub waves: u64,
    /// Whether more may come.
    pub state: PlanState,
    /// What the last planner said.
    pub note: Option<String>,
}

/// Whether a study still grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanState {
    /// It may grow further.
    Open,
    /// It needs no more jobs.
    Complete,
    /// Its next wave could not be planned.
    Failed,
}

impl PlanState {
    fn of(name: &str) -> Self {
        [Self::Complete, Self::Failed].into_iter().find(|state| state.name() == name).unwrap_or(Self::Open)
    }

    /// The word in the database, which programs read too.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Complete => "complete",
            Self::Failed => "failed",
        }
    }
}

/// A study whose next wave is due: all its jobs have ended, and nobody plans it. $1 is a study or null, $2 the worker that
/// asks and $3 the time.
const DUE: &str = "
    SELECT s.id, s.name, s.document, p.wave
    FROM plans AS p
    JOIN studies AS s ON s.id = p.study_id
    LEFT JOIN workers AS w ON w.id = p.owner
    WHERE p.state = 'open' AND s.cancelled_ms IS NULL AND ($1 IS NULL OR s.id = $1)
      AND (p.owner IS NULL OR p.owner = $2 OR w.id IS NULL OR w.ended_ms IS NOT NULL OR p.lease_until_ms <= $3)
      AND NOT EXISTS (SELECT 1 FROM study_pending AS q WHERE q.study_id = s.id)
      AND NOT EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id
          WHERE m.study_id = s.id AND j.state = 'running')
    ORDER BY s.id LIMIT 1";

const TAKE: &str = "UPDATE plans SET owner = $2, lease_until_ms = $3 WHERE study_id = $1";

/// The fence: the plan is still the one that the worker claimed, and the study has the document from which it was made.
const ADVANCE: &str = "
    UPDATE plans SET wave = $3, state = $4, note = $5, owner = NULL, lease_until_ms = NULL
    WHERE study_id = $1 AND owner = $2 AND state = 'open' AND wave = $6
      AND EXISTS (SELECT 1 FROM studies AS s WHERE s.id = $1 AND s.document = $7 AND s.cancelled_ms IS NULL)";

/// The priority of the jobs that the study has.
const PRIORITY: &str = "
    SELECT COALESCE(MAX(j.priority), 0) FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id WHERE m.study_id = $1";

const LAST_ORDINAL: &str = "SELECT COALESCE(MAX(ordinal), -1) FROM study_jobs WHERE study_id = $1";

impl Queue {
    /// Claims the next wave that is due in `scope`, if there is one. The worker that was given it before may claim it again.
    /// Heartbeats extend the claim.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn claim_plan(&mut self, scope: &Scope) -> Result<Option<PlanClaim>, QueueError> {
        let owner = self.registration().id;
        let study_id = scope.study_id(&mut self.connection).await?;
        let now_ms = self.now_ms().await?;
        // Most of the time nothing is due, and the lock is not needed to see that.
        if due(&mut self.connection, study_id, owner, now_ms).await?.is_none() {
            return Ok(None);
        }
        let lease_ms = self.settings.lease_ms();
        self.write(async |connection, now_ms| {
            let Some((id, study, document, wave)) = due(connection, study_id, owner, now_ms).await? else {
                return Ok(None);
            };
            let until_ms = now_ms.saturating_add(lease_ms);
            query(TAKE).bind(id).bind(owner).bind(until_ms).run(connection).await?;
            Ok(Some(PlanClaim { study, document, wave: wave.unsigned_abs() + 1 }))
        })
        .await
    }

    /// Stores what became of a plan. Returns `false` if it came too late: another worker has planned the wave, or the study
    /// was replaced, cancelled, tried again or removed. Then nothing has changed.
    ///
    /// # Errors
    /// [`QueueError::BadCost`], or if the database cannot be written; then nothing has changed.
    ///
    /// # Panics
    /// If no worker is registered.
    pub async fn store_plan(&mut self, claim: &PlanClaim, planned: &Planned) -> Result<bool, QueueError> {
        let owner = self.registration().id;
        let before = claim.wave.cast_signed() - 1;
        let (jobs, wave, state, note): (&[NewJob], i64, &str, &str) = match planned {
            Planned::Wave { jobs, note } => (jobs, before + 1, "open", note),
            Planned::Complete { note } => (&[], before, "complete", note),
            Planned::Failed { error } => (&[], before, "failed", error),
        };
        submit::check_costs(jobs)?;
        self.write(async |connection, now_ms| {
            let Some(id) = lookup::find(connection, &claim.study).await? else { return Ok(false) };
            let advance = query(ADVANCE).bind(id).bind(owner).bind(wave).bind(state).bind(note);
            if advance.bind(before).bind(&claim.document).run(connection).await? == 0 {
                return Ok(false);
            }
            let last: i64 = query(LAST_ORDINAL).bind(id).scalar(connection).await?;
            if last.checked_add(jobs.len() as i64).is_none() {
                let study = &claim.study;
                return Err(QueueError::Inconsistent(format!(
                    "the last row of {study} has the number {last}"
                )));
            }
            let priority: i64 = query(PRIORITY).bind(id).scalar(connection).await?;
            let jobs: Vec<NewJob> =
                jobs.iter().map(|job| NewJob { priority: Some(priority), ..job.clone() }).collect();
            let rows: Vec<submit::Row<'_>> = (last + 1..).zip(&jobs).collect();
            for chunk in rows.chunks(CHUNK) {
                submit::insert(connection, id, chunk, now_ms).await?;
            }
            // A job that another study had and cancelled is asked for again.
            query(submit::UNDO_CANCELLATION).bind(id).run(connection).await?;
            Ok(true)
        })
        .await
    }

    /// The plan of a study; none if it does not grow.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn plan_status(&mut self, study: &str) -> Result<Option<PlanStatus>, QueueError> {
        let id = lookup::require(&mut self.connection, study).await?;
        let found = plan_rows::read(&mut self.connection, id).await?;
        Ok(found.map(|(waves, state, note)| PlanStatus {
            waves: waves.unsigned_abs(),
            state: PlanState::of(&state),
            note,
        }))
    }
}

async fn due(
    connection: &mut Connection,
    study_id: Option<i64>,
    owner: i64,
    now_ms: i64,
) -> Result<Option<(i64, String, String, i64)>, QueueError> {
    query(DUE).bind(study_id).bind(owner).bind(now_ms).optional(connection).await
}
