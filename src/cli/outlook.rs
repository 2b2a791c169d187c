//! How far a study is, and when it will be finished.

use super::error::CliError;
use super::work::all_cores;
use crate::queue::{ActiveWorkers, Counts, Queue, Scope};
use crate::worker::Eta;
use anstyle::{AnsiColor, Style};
use serde_json::{Value, json};

/// The bar has so many characters at most, and where the line has no room for it at least.
const BAR: (usize, usize) = (40, 10);

/// What is left of a study that is not finished.
pub struct Outlook {
    counts: Counts,
    alive: ActiveWorkers,
    /// This machine's threads.
    cores: usize,
    /// The time that is left with the workers that are there, or on this machine if there are none.
    eta: Option<Eta>,
}

/// Looks ahead; nothing if no job of the study is left.
pub async fn read(queue: &mut Queue, study: &str, counts: Counts) -> Result<Option<Outlook>, CliError> {
    let left = counts.pending + counts.running;
    if left == 0 {
        return Ok(None);
    }
    let alive = queue.active_workers().await?;
    let cores = all_cores();
    let threads = if alive.threads > 0 { alive.threads } else { cores as u64 };
    let cost = queue.remaining_cost(&Scope::Study(study.to_owned())).await?;
    let finished = queue.timings(study).await?;
    // A job is not made faster by a second thread.
    let eta = Eta::estimate(&finished, cost, left, threads.min(left) as usize);
    Ok(Some(Outlook { counts, alive, cores, eta }))
}

impl Outlook {
    /// The share of jobs that have ended.
    fn share(&self) -> f64 {
        let Counts { done, failed, pending, running, .. } = self.counts;
        let ended = done + failed;
        ended as f64 / (ended + pending + running) as f64
    }

    /// A bar and the time left, in lines of at most `width` characters; with colours.
    pub fn in_words(&self, width: usize) -> String {
        let percent = format!(" {:.0} %", (100.0 * self.share()).floor());
        let time = self.time();
        let room = width.saturating_sub(percent.chars().count());
        let beside = room.saturating_sub(time.chars().count() + 2);
        if beside >= BAR.1 {
            return format!("{}{percent}, {time}\n", self.bar(beside.min(BAR.0)));
        }
        let mut text = format!("{}{percent}\n", self.bar(room.min(BAR.0)));
        for line in wrapped(&time, width) {
            text.push_str(&line);
            text.push('\n');
        }
        text
    }

    fn bar(&self, length: usize) -> String {
        // Full only when nothing is left.
        let full = (self.share() * length as f64) as usize;
        let style = Style::new().fg_color(Some(AnsiColor::Green.into()));
        format!("{style}{}{style:#}{}", "█".repeat(full), "░".repeat(length - full))
    }

    fn time(&self) -> String {
        let ActiveWorkers { workers, threads } = self.alive;
        let with =
            |threads: u64| if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") };
        match (workers, &self.eta) {
            (0, Some(eta)) => {
                format!("no worker is running; it would take {eta} with {} here", with(self.cores as u64))
            }
            (0, None) => "no worker is running".to_owned(),
            (_, Some(eta)) => format!("{eta} left with {}", with(threads)),
            (_, None) => format!("time left unknown yet, {} at work", with(threads)),
        }
    }

    /// The same for programs.
    pub fn json(&self) -> Value {
        let seconds =
            self.eta.map(|eta| json!({ "low": eta.low.as_secs_f64(), "high": eta.high.as_secs_f64() }));
        json!({
            "ended_share": self.share(),
            "workers": self.alive.workers,
            "worker_threads": self.alive.threads,
            "threads_here": self.cores,
            "remaining_s": seconds,
        })
    }
}

/// Words in lines of at most `width` characters, where they are no longer themselves.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn outlook(workers: u64, eta_s: Option<u64>) -> Outlook {
        let counts = Counts { done: 30, failed: 3, running: 2, pending: 65, cancelled: 7 };
        let eta = eta_s.map(Duration::from_secs).map(|time| Eta { low: time, high: 2 * time });
        Outlook { counts, alive: ActiveWorkers { workers, threads: 2 * workers }, cores: 4, eta }
    }

    fn plain(outlook: &Outlook, width: usize) -> Vec<String> {
        let text = anstream::adapter::strip_str(&outlook.in_words(width)).to_string();
        text.lines().map(str::to_owned).collect()
    }

    /// Protects: one line where there is room, several that are no longer than the terminal where there is not; what is
    /// told does not depend on it.
    #[test]
    fn every_width_is_told_the_same() {
        let wide = plain(&outlook(1, Some(60)), 100);
        let bar = format!("{}{}", "█".repeat(13), "░".repeat(27));
        assert_eq!(wide, [format!("{bar} 33 %, 60 s to 2 min left with 2 threads")]);
        for width in [16, 24, 40, 60] {
            let lines = plain(&outlook(1, Some(60)), width);
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
            let words = lines.join(" ");
            assert!(
                words.contains("33 %") && words.ends_with("60 s to 2 min left with 2 threads"),
                "{lines:?}"
            );
        }
    }

    /// Protects: nobody waits for a worker that is not there, and nothing is claimed without evidence.
    #[test]
    fn what_is_not_known_is_said() {
        let told = |workers, eta_s| plain(&outlook(workers, eta_s), 100).join(" ");
        let alone = told(0, Some(10));
        assert!(
            alone.ends_with("no worker is running; it would take 10 s to 20 s with 4 threads here"),
            "{alone}"
        );
        assert!(told(0, None).ends_with("33 %, no worker is running"));
        assert!(told(1, None).ends_with("33 %, time left unknown yet, 2 threads at work"));
    }
}
