//! Waiting for a database that cannot be reached.

use super::interrupt::Interrupt;
use super::progress::Progress;
use crate::queue::QueueError;
use std::time::{Duration, Instant};

/// How long it is waited for.
const LIMIT: Duration = Duration::from_hours(1);

/// Tried again after so long at first …
const SHORTEST: Duration = Duration::from_secs(1);

/// … and never later than after this: hundreds of workers that wait must not keep a server from getting up.
const LONGEST: Duration = Duration::from_secs(15);

/// The part of the time waited so far after which it is tried again.
const PART: u32 = 8;

/// How often it is looked whether to stop.
const LOOK: Duration = Duration::from_millis(100);

/// What is left of the time that something may take.
#[derive(Debug, Clone, Copy)]
pub struct Patience(Instant);

impl Patience {
    /// All of it.
    pub fn new() -> Self {
        Self(Instant::now())
    }

    /// Returns after a while, so that the same is tried again; sooner if `interrupt` is raised meanwhile.
    ///
    /// # Errors
    /// The error, if waiting does not help or has lasted for an hour.
    pub async fn wait(
        &self,
        error: QueueError,
        interrupt: &Interrupt,
        progress: &mut impl Progress,
    ) -> Result<(), QueueError> {
        let waited = self.0.elapsed();
        if !error.is_transient() || waited >= LIMIT {
            return Err(error);
        }
        progress.waiting(&error.to_string());
        let was_raised = interrupt.is_raised();
        let pause = if was_raised { SHORTEST } else { pause(waited, std::process::id()) };
        let begun = Instant::now();
        while begun.elapsed() < pause && interrupt.is_raised() == was_raised {
            tokio::time::sleep(LOOK).await;
        }
        Ok(())
    }
}

/// After the end of a server all its workers begin to wait at once: they are not to come back at once as well.
fn pause(waited: Duration, process: u32) -> Duration {
    (waited / PART).clamp(SHORTEST, LONGEST).mul_f64(1.0 - 0.5 * f64::from(process % 64) / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a server that is back in a moment is found in a moment, one that is away for an hour is asked a few
    /// times a minute, and workers that begin to wait together do not ask together.
    #[test]
    fn tries_become_rarer_and_spread() {
        let tries = |process| {
            let mut at = Duration::ZERO;
            std::iter::from_fn(|| {
                at += pause(at, process);
                Some(at)
            })
            .take_while(|at| *at < LIMIT)
            .collect::<Vec<_>>()
        };
        let all = [64, 65, 127].map(tries);
        for tries in &all {
            assert!(tries[0] <= SHORTEST, "{tries:?}");
            let late = tries.windows(2).filter(|pair| pair[0] >= LONGEST * PART);
            assert!(late.map(|pair| pair[1] - pair[0]).all(|pause| pause >= LONGEST / 2), "{tries:?}");
        }
        let late = |tries: &[Duration]| tries[200].as_secs();
        assert!(late(&all[0]) > late(&all[1]) && late(&all[1]) > late(&all[2]), "{all:?}");
    }
}
