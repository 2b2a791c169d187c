//! Progress on stderr: bars on a terminal, plain lines elsewhere.

use super::output::tell;
use crate::worker::{Progress, Snapshot};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// So many characters of a job's key tell it apart in a display.
const KEY_LENGTH: usize = 8;

/// How often a plain line is written at most.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// The display that suits stderr.
pub enum Display {
    /// A bar that is redrawn.
    Bar(ProgressBar),
    /// A line now and then.
    Lines {
        /// When the last line was written.
        last: Instant,
    },
}

impl Display {
    /// The display that suits stderr.
    pub fn new() -> Self {
        if std::io::stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(4));
            if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} jobs  {wide_msg}") {
                bar.set_style(style);
            }
            Self::Bar(bar)
        } else {
            Self::Lines { last: Instant::now() }
        }
    }

    fn note(&self, line: &str) {
        match self {
            Self::Bar(bar) => bar.suspend(|| tell(line)),
            Self::Lines { .. } => tell(line),
        }
    }
}

/// `12 done, 1 failed, 89 left`.
fn counters(snapshot: &Snapshot) -> String {
    let counts = &snapshot.counts;
    format!("{} done, {} failed, {} left", counts.done, counts.failed, counts.pending + counts.running)
}

fn remaining(snapshot: &Snapshot) -> String {
    snapshot.eta.map_or_else(|| "time left unknown yet".to_owned(), |eta| format!("{eta} left"))
}

fn running(snapshot: &Snapshot) -> String {
    let jobs: Vec<String> = snapshot
        .running
        .iter()
        .map(|job| {
            let key: String = job.key.chars().take(KEY_LENGTH).collect();
            format!("{key} {:.1} ms", job.simulated_s * 1e3)
        })
        .collect();
    jobs.join(", ")
}

impl Progress for Display {
    fn update(&mut self, snapshot: &Snapshot) {
        match self {
            Self::Bar(bar) => {
                bar.set_length(snapshot.counts.total());
                bar.set_position(snapshot.counts.done + snapshot.counts.failed);
                bar.set_message(format!(
                    "{} failed, {} · simulated: {}",
                    snapshot.counts.failed,
                    remaining(snapshot),
                    running(snapshot)
                ));
            }
            Self::Lines { last } => {
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    tell(format_args!("{}, {}", counters(snapshot), remaining(snapshot)));
                }
            }
        }
    }

    fn failed(&mut self, key: &str, error: &str) {
        self.note(&format!("job {key} failed: {error}"));
    }

    fn waiting(&mut self, reason: &str) {
        self.note(&format!("waiting: {reason}"));
    }

    fn stopped(&mut self, snapshot: &Snapshot) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
        tell(counters(snapshot));
    }
}
