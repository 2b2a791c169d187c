//! Progress on standard error: a bar on a terminal, plain lines elsewhere.

use super::output::log;
use crate::worker::{Progress, Snapshot};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Number of characters of a job's key that the display shows.
const KEY_LENGTH: usize = 8;

/// The shortest time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// The shortest time between two lines with the same reason for waiting: waiting may last an hour.
const WAITING_INTERVAL: Duration = Duration::from_mins(1);

/// Shows the progress of a worker.
pub(crate) struct Display {
    form: Form,
    /// The last reason for waiting, and when it was shown.
    waiting: Option<(String, Instant)>,
}

enum Form {
    /// A bar that is redrawn.
    Bar(ProgressBar),
    /// A line every [`LINE_INTERVAL`].
    Lines {
        /// When the last line was written.
        last: Instant,
    },
}

impl Display {
    /// A bar if standard error is a terminal, otherwise lines.
    pub(crate) fn new() -> Self {
        let form = if std::io::stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(4));
            if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} jobs  {wide_msg}") {
                bar.set_style(style);
            }
            Form::Bar(bar)
        } else {
            Form::Lines { last: Instant::now() }
        };
        Self { form, waiting: None }
    }

    /// Writes a line above the bar.
    fn note(&self, line: &str) {
        match &self.form {
            Form::Bar(bar) => bar.suspend(|| log(line)),
            Form::Lines { .. } => log(line),
        }
    }
}

/// `12 done, 1 failed, 89 left`.
fn counters(snapshot: &Snapshot) -> String {
    let counts = &snapshot.counts;
    format!("{} done, {} failed, {} left", counts.done, counts.failed, counts.pending + counts.running)
}

fn remaining(snapshot: &Snapshot) -> String {
    snapshot.eta.map_or_else(|| "remaining time not known yet".to_owned(), |eta| format!("{eta} left"))
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
        match &mut self.form {
            Form::Bar(bar) => {
                bar.set_length(snapshot.counts.total());
                bar.set_position(snapshot.counts.done + snapshot.counts.failed);
                bar.set_message(format!(
                    "{} failed, {} · simulated: {}",
                    snapshot.counts.failed,
                    remaining(snapshot),
                    running(snapshot)
                ));
            }
            Form::Lines { last } => {
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    log(format_args!("{}, {}", counters(snapshot), remaining(snapshot)));
                }
            }
        }
    }

    fn failed(&mut self, key: &str, error: &str) {
        self.note(&format!("job {key} failed: {error}"));
    }

    fn waiting(&mut self, reason: &str) {
        let is_recent =
            |(last, when): &(String, Instant)| last == reason && when.elapsed() < WAITING_INTERVAL;
        if !self.waiting.as_ref().is_some_and(is_recent) {
            self.note(&format!("waiting: {reason}"));
            self.waiting = Some((reason.to_owned(), Instant::now()));
        }
    }

    fn stopped(&mut self, snapshot: &Snapshot) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
        log(counters(snapshot));
    }
}
