//! Waves of studies that grow: the dispatcher plans those that are due.

use super::dispatcher::{Dispatcher, TICK};
use super::planner::Planner;
use super::progress::Progress;
use crate::queue::{PlanClaim, Planned, QueueError, StudyRow};
use std::time::{Duration, Instant};

/// Shortest time between two looks for waves that are due, while jobs run here: most studies have none.
const PLAN_PAUSE: Duration = Duration::from_secs(1);

impl Dispatcher<'_> {
    /// Plans the waves that are due, if it has not looked for them within [`PLAN_PAUSE`]. Returns whether there are new jobs.
    pub(super) async fn plan_waves(&mut self, progress: &mut dyn Progress) -> Result<bool, QueueError> {
        let Some(planner) = self.planner else { return Ok(false) };
        if self.interrupt.is_raised() || self.last_plan.is_some_and(|last| last.elapsed() < PLAN_PAUSE) {
            return Ok(false);
        }
        self.last_plan = Some(Instant::now());
        let mut has_planned = false;
        match self.plan_due(planner, &mut has_planned, progress).await {
            // It is tried again at the next turn.
            Err(error) if error.is_transient() => {}
            planned => planned?,
        }
        if has_planned {
            self.tally.invalidate();
        }
        Ok(has_planned)
    }

    async fn plan_due(
        &mut self,
        planner: &'static dyn Planner,
        has_planned: &mut bool,
        progress: &mut dyn Progress,
    ) -> Result<(), QueueError> {
        while !self.interrupt.is_raised()
            && let Some(claim) = self.queue.claim_plan(self.scope).await?
        {
            let rows = self.queue.rows(&claim.study).await?;
            let planned = self.plan_aside(planner, claim.clone(), rows).await?;
            if self.queue.store_plan(&claim, &planned).await? {
                *has_planned |= matches!(planned, Planned::Wave { .. });
                progress.planned(&claim.study, claim.wave, &planned);
            }
        }
        Ok(())
    }

    /// Plans a wave on a thread of its own. Heartbeats go on meanwhile.
    async fn plan_aside(
        &mut self,
        planner: &'static dyn Planner,
        claim: PlanClaim,
        rows: Vec<StudyRow>,
    ) -> Result<Planned, QueueError> {
        let mut plan = tokio::task::spawn_blocking(move || planner.plan(&claim, &rows));
        loop {
            match tokio::time::timeout(TICK, &mut plan).await {
                Ok(Ok(planned)) => return Ok(planned),
                // A panic is a bug, but it must not end the worker, which has other studies.
                Ok(Err(error)) => {
                    return Ok(Planned::Failed {
                        error: format!("internal error (please report it): {error}"),
                    });
                }
                Err(_) => match self.keep_alive().await {
                    Err(error) if error.is_transient() => {}
                    kept_alive => kept_alive?,
                },
            }
        }
    }
}
