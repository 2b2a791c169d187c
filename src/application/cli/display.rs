//! Progress on standard error: a bar on a terminal, plain lines elsewhere.

use super::outlook::time_left;
use super::output::{log, wrapped};
use crate::publish::value::{count, multiple, significant};
use crate::queue::Planned;
use crate::worker::{Progress, RunningJob, Snapshot};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

/// Number of characters of a job's key that the display shows.
const KEY_LENGTH: usize = 8;

/// The largest and the smallest length of the bar, in characters.
const BAR: (usize, usize) = (30, 10);

/// Characters per line if the width of the terminal is not known.
const USUAL_WIDTH: usize = 80;

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
        let form = if stderr().is_terminal() {
            let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(4));
            if let Ok(style) = ProgressStyle::with_template("{msg}") {
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

/// The state of the jobs in lines of at most `width` characters: a bar with the numbers of jobs and the time left, and below
/// it how far the running jobs are.
fn lines(snapshot: &Snapshot, width: usize) -> Vec<String> {
    let counts = &snapshot.counts;
    let (ended, total) = (counts.done + counts.failed, counts.total());
    let failed = if counts.failed > 0 { format!(", {} failed", counts.failed) } else { String::new() };
    let state = format!("{ended}/{total} jobs{failed}, {}", time_left(snapshot.eta));
    let room = width.saturating_sub(state.chars().count() + 1);
    let mut lines = if room >= BAR.1 {
        vec![format!("{} {state}", bar(ended, total, room.min(BAR.0)))]
    } else {
        let mut lines = vec![bar(ended, total, width.min(BAR.0))];
        lines.extend(wrapped(&state, width));
        lines
    };
    if let Some(running) = running(&snapshot.running) {
        lines.extend(wrapped(&running, width));
    }
    lines
}

fn bar(ended: u64, total: u64, length: usize) -> String {
    // Rounded down: the bar is full only when nothing is left.
    let full = (ended * length as u64 / total.max(1)) as usize;
    format!("{}{}", "█".repeat(full), "░".repeat(length - full))
}

/// How far the running jobs are, in simulated time: `16 running: 3.1 to 11.0 of at most 40 ms`. `None` if none has begun.
fn running(jobs: &[RunningJob]) -> Option<String> {
    let begun: Vec<(f64, f64)> =
        jobs.iter().filter_map(|job| Some((job.simulated_s, job.limit_s?))).collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let limit_s = largest(&mut begun.iter().map(|(_, limit_s)| *limit_s));
    if limit_s == 0.0 {
        return None;
    }
    let what = match jobs {
        [only] => only.key.chars().take(KEY_LENGTH).collect(),
        several => format!("{} jobs", several.len()),
    };
    let range = |values: &[f64], decimals: usize| {
        let texts: Vec<String> = values.iter().map(|value| format!("{value:.decimals$}")).collect();
        let order = |a: &&String, b: &&String| a.len().cmp(&b.len()).then(a.cmp(b));
        match (texts.iter().min_by(order), texts.iter().max_by(order)) {
            (Some(least), Some(most)) if least != most => format!("{least} to {most}"),
            (least, _) => least.cloned().unwrap_or_default(),
        }
    };
    if begun.iter().all(|(_, limit)| *limit == limit_s) {
        let (factor, unit) = multiple("s", limit_s);
        let simulated: Vec<f64> = begun.iter().map(|(simulated_s, _)| simulated_s / factor).collect();
        let limit = significant(limit_s / factor, 4);
        return Some(format!("running: {what}, at {} of at most {limit} {unit}", range(&simulated, 1)));
    }
    let percent: Vec<f64> =
        begun.iter().map(|(simulated_s, limit_s)| 100.0 * simulated_s / limit_s).collect();
    Some(format!("running: {what}, at {} % of their time limits", range(&percent, 0)))
}

fn width() -> usize {
    terminal_size::terminal_size_of(stderr()).map_or(USUAL_WIDTH, |(width, _)| usize::from(width.0))
}

impl Progress for Display {
    fn update(&mut self, snapshot: &Snapshot) {
        match &mut self.form {
            Form::Bar(bar) => {
                bar.set_message(lines(snapshot, width()).join("\n"));
            }
            Form::Lines { last } => {
                if last.elapsed() >= LINE_INTERVAL {
                    *last = Instant::now();
                    let running =
                        running(&snapshot.running).map_or_else(String::new, |text| format!("; {text}"));
                    log(format_args!("{}, {}{running}", counters(snapshot), time_left(snapshot.eta)));
                }
            }
        }
    }

    fn failed(&mut self, key: &str, error: &str) {
        self.note(&format!("job {key} failed: {error}"));
    }

    fn planned(&mut self, study: &str, wave: u64, planned: &Planned) {
        self.note(&match planned {
            Planned::Wave { jobs, note } => {
                format!("{study}: wave {wave} adds {} ({note})", count(jobs.len() as u64, "job"))
            }
            Planned::Complete { note } => format!("{study}: the plan has ended: {note}"),
            Planned::Failed { error } => format!("{study}: wave {wave} cannot be planned: {error}"),
        });
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queue::Counts;
    use crate::worker::Eta;

    fn snapshot(jobs: u64, limits_ms: &[f64]) -> Snapshot {
        let job = |(i, limit_ms): (usize, &f64)| RunningJob {
            key: format!("{i:02}3456789abcdef"),
            simulated_s: 1e-3 * (11.0 - i as f64),
            limit_s: Some(1e-3 * limit_ms),
        };
        Snapshot {
            counts: Counts {
                done: jobs / 3,
                failed: jobs / 5,
                running: limits_ms.len() as u64,
                pending: jobs / 2,
                cancelled: 0,
            },
            running: limits_ms.iter().enumerate().map(job).collect(),
            eta: Some(Eta { low: Duration::from_hours(83), high: Duration::from_hours(833) }),
        }
    }

    /// Protects: at 80 columns and below no line is cut off, whatever the numbers, and the lines say the same as wide ones: how
    /// many jobs, the time left, and how far the running jobs are.
    #[test]
    fn nothing_is_cut_off() {
        for jobs in [1, 102, 100_000, 123_456_789] {
            for limits_ms in [vec![40.0], vec![40.0; 8], vec![40.0, 12.0, 5.0]] {
                let snapshot = snapshot(jobs, &limits_ms);
                let words = |lines: &[String]| {
                    lines.join(" ").replace(['█', '░'], "").split_whitespace().collect::<Vec<_>>().join(" ")
                };
                let wide = words(&lines(&snapshot, 200));
                assert!(
                    wide.contains("jobs") && wide.contains("34.7 days left") && wide.contains("running: "),
                    "{wide}"
                );
                for width in [20, 40, 80] {
                    let lines = lines(&snapshot, width);
                    assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
                    assert_eq!(words(&lines), wide);
                    assert!(width < 80 || lines.len() <= 3, "{lines:?}");
                }
            }
        }
    }

    /// Protects: the running jobs are shown with their time limit, many of them by the least and the most advanced, and
    /// nothing is said of jobs that have not begun.
    #[test]
    fn running_jobs_are_shown_with_their_limit() {
        let text = |limits_ms: &[f64]| running(&snapshot(9, limits_ms).running);
        assert_eq!(text(&[40.0]).unwrap(), "running: 00345678, at 11.0 of at most 40 ms");
        assert_eq!(text(&[40.0; 8]).unwrap(), "running: 8 jobs, at 4.0 to 11.0 of at most 40 ms");
        assert_eq!(text(&[40.0, 12.5, 40.0]).unwrap(), "running: 3 jobs, at 23 to 80 % of their time limits");
        assert_eq!(text(&[]), None);
        let mut waiting = snapshot(9, &[40.0]).running;
        waiting[0].limit_s = None;
        assert_eq!(running(&waiting), None);
    }
}
