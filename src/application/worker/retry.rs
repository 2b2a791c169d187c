//! Waiting for a database that cannot be reached, with growing pauses between attempts.

use super::interrupt::Interrupt;
use super::progress::Progress;
use crate::queue::QueueError;
use std::time::{Duration, Instant};

/// Longest time to wait in all.
const LIMIT: Duration = Duration::from_hours(1);

/// Shortest pause between two attempts.
const SHORTEST_PAUSE: Duration = Duration::from_secs(1);

/// Longest pause. It is not shorter because hundreds of waiting workers must not keep a server from starting.
const LONGEST_PAUSE: Duration = Duration::from_secs(15);

/// In between, the pause is the time waited so far divided by this.
const PAUSE_DIVISOR: u32 = 8;

/// How often the interrupt is polled during a pause.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// The pauses between attempts at one operation, counted from its first attempt.
#[derive(Debug, Clone, Copy)]
pub struct RetryBackoff(Instant);

impl RetryBackoff {
    /// The operation is attempted now for the first time.
    pub fn new() -> Self {
        Self(Instant::now())
    }

    /// Waits before the next attempt; returns early if `interrupt` is raised meanwhile.
    ///
    /// # Errors
    /// `error` itself, if waiting does not help or has lasted for an hour.
    pub async fn wait(
        &self,
        error: QueueError,
        interrupt: &Interrupt,
        progress: &mut dyn Progress,
    ) -> Result<(), QueueError> {
        let waited = self.0.elapsed();
        if !error.is_transient() || waited >= LIMIT {
            return Err(error);
        }
        progress.waiting(&error.to_string());
        let was_raised = interrupt.is_raised();
        let pause = if was_raised { SHORTEST_PAUSE } else { pause(waited, std::process::id()) };
        let begun = Instant::now();
        while begun.elapsed() < pause && interrupt.is_raised() == was_raised {
            tokio::time::sleep(POLL_INTERVAL).await;
        }
        Ok(())
    }
}

/// The pause after waiting for `waited`. It differs from process to process: when a server goes down, all its workers
/// begin to wait together, and must not try again together.
fn pause(waited: Duration, process: u32) -> Duration {
    (waited / PAUSE_DIVISOR)
        .clamp(SHORTEST_PAUSE, LONGEST_PAUSE)
        .mul_f64(1.0 - 0.5 * f64::from(process % 64) / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the first attempts follow quickly, after an hour there are a few per minute, and workers that begin to
    /// wait together do not try again together.
    #[test]
    fn attempts_become_rarer_and_spread() {
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
            assert!(tries[0] <= SHORTEST_PAUSE, "{tries:?}");
            let late = tries.windows(2).filter(|pair| pair[0] >= LONGEST_PAUSE * PAUSE_DIVISOR);
            assert!(late.map(|pair| pair[1] - pair[0]).all(|pause| pause >= LONGEST_PAUSE / 2), "{tries:?}");
        }
        let late = |tries: &[Duration]| tries[200].as_secs();
        assert!(late(&all[0]) > late(&all[1]) && late(&all[1]) > late(&all[2]), "{all:?}");
    }
}
