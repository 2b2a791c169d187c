//! An observer interrupts a job.

use crate::analysis::signals::coarse;
use std::ops::ControlFlow;
use tribosweep_mechanics::analysis::{JobError, JobObserver, Moment, solve};

/// Interrupts the job at a simulated time. It counts the steps and checks that their times increase.
struct StopsAt {
    stop_s: f64,
    steps: u64,
    steps_after_break: u64,
    broken: bool,
    last_s: f64,
}

impl JobObserver for StopsAt {
    fn step(&mut self, moment: &Moment<'_>) {
        let sample = moment.sample;
        assert!(self.steps == 0 || sample.time_s > self.last_s, "time runs forwards");
        self.last_s = sample.time_s;
        self.steps += 1;
        self.steps_after_break += u64::from(self.broken);
    }

    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        let steps = simulated_s / self.last_s * (self.steps - 1) as f64;
        assert!((steps - self.steps as f64).abs() < 1e-6, "all steps so far, and no other, have been shown");
        if simulated_s >= self.stop_s {
            self.broken = true;
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

fn interrupted_at(stop_s: f64) -> StopsAt {
    let mut observer = StopsAt { stop_s, steps: 0, steps_after_break: 0, broken: false, last_s: 0.0 };
    let found = solve(&coarse(), &mut observer);
    assert!(matches!(found, Err(JobError::Interrupted)), "{found:?}");
    observer
}

/// Protects: an interrupted job ends with the error `Interrupted` and does no step after the request. A
/// request is possible at least every 100 steps.
#[test]
fn interruption_is_prompt() {
    let first = interrupted_at(0.0);
    assert!(first.steps <= 100 && first.steps_after_break == 0, "{} steps", first.steps);
    let later = interrupted_at(0.001);
    assert_eq!(later.steps_after_break, 0);
    let step_s = later.last_s / (later.steps - 1) as f64;
    assert!(later.last_s - 0.001 < 100.0 * step_s, "noticed {} s late", later.last_s - 0.001);
}
