//! The workers of a database as text and JSON, for `status`.

use super::output::wrapped;
use crate::publish::value::count;
use crate::queue::{WorkerPresence, WorkerStatus};
use std::time::Duration;

/// If more workers were lost, only their number is shown.
const MOST_LOST_LISTED: usize = 5;

/// The workers in lines of at most `width` characters; empty without workers.
pub(crate) fn as_text(workers: &[WorkerStatus], width: usize) -> String {
    let (lost, present): (Vec<_>, Vec<_>) =
        workers.iter().partition(|worker| worker.presence == WorkerPresence::Gone);
    let mut lines: Vec<String> = present.iter().map(|worker| present_line(worker)).collect();
    lines.extend(present.iter().filter_map(|worker| worker.advice()));
    if present.len() > 1 {
        let per_s: f64 = present.iter().filter_map(|worker| worker.jobs_per_s).sum();
        let threads: u64 = present.iter().map(|worker| worker.threads).sum();
        lines.insert(
            0,
            format!("{} workers with {}, {}", present.len(), count(threads, "thread"), rate(per_s)),
        );
    }
    let taken_back: u64 = lost.iter().map(|worker| worker.taken_back).sum();
    if lost.len() > MOST_LOST_LISTED {
        let jobs = count(taken_back, "job");
        lines.push(format!("{} workers were lost, and {jobs} taken back from them", lost.len()));
    } else {
        lines.extend(
            lost.iter()
                .filter(|worker| worker.taken_back + worker.running > 0)
                .map(|worker| lost_line(worker)),
        );
    }
    lines.iter().flat_map(|line| wrapped(line, width)).fold(String::new(), |text, line| text + &line + "\n")
}

fn present_line(worker: &WorkerStatus) -> String {
    let WorkerStatus { host, pid, threads, running, finished, taken_back, silent_ms, .. } = worker;
    let doing = match (worker.presence, running) {
        (WorkerPresence::Stopping, _) => "stopping".to_owned(),
        (WorkerPresence::Stopped, running) => format!("stopped, {running} in its hands"),
        (_, 0) => "idle".to_owned(),
        (_, running) => format!("{running} running"),
    };
    let pace = worker.jobs_per_s.map_or_else(String::new, |per_s| format!(", {}", rate(per_s)));
    let lost = if *taken_back > 0 { format!(", {taken_back} taken back from it") } else { String::new() };
    let threads = count(*threads, "thread");
    format!(
        "worker {pid} on {host}: {threads}, {doing}, {finished} done{pace}{lost}, seen {} ago",
        ago(*silent_ms)
    )
}

fn lost_line(worker: &WorkerStatus) -> String {
    let WorkerStatus { host, pid, running, taken_back, silent_ms, .. } = worker;
    let waiting = if *running > 0 { format!(", {running} still to be taken back") } else { String::new() };
    format!(
        "worker {pid} on {host}: lost {} ago, {} taken back from it{waiting}",
        ago(*silent_ms),
        count(*taken_back, "job")
    )
}

/// Jobs per second, minute or hour: the shortest of these in which at least one job ends.
fn rate(per_s: f64) -> String {
    match per_s {
        0.0 => "none lately".to_owned(),
        1.0.. => format!("{per_s:.1} jobs/s"),
        _ if per_s * 60.0 >= 1.0 => format!("{:.1} jobs/min", 60.0 * per_s),
        _ => format!("{:.1} jobs/h", 3600.0 * per_s),
    }
}

/// A duration to the second, from ten minutes on to the minute.
fn ago(milliseconds: i64) -> String {
    let seconds = milliseconds.unsigned_abs() / 1000;
    let seconds = if seconds < 600 { seconds } else { seconds / 60 * 60 };
    humantime::format_duration(Duration::from_secs(seconds)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worker(presence: WorkerPresence, taken_back: u64) -> WorkerStatus {
        WorkerStatus {
            host: "node7".into(),
            pid: 4242,
            threads: 8,
            presence,
            running: if presence == WorkerPresence::Gone { 0 } else { 12 },
            finished: 340,
            jobs_per_s: Some(0.25),
            taken_back,
            started_ms: 0,
            silent_ms: 3_200,
        }
    }

    /// Protects: each worker has a line with its host and its rate; several workers have a line with their sum first.
    #[test]
    fn workers_are_listed_with_host_and_rate() {
        let one = worker(WorkerPresence::Working, 0);
        let line = "worker 4242 on node7: 8 threads, 12 running, 340 done, 15.0 jobs/min, seen 3s ago\n";
        assert_eq!(as_text(std::slice::from_ref(&one), 100), line);
        let two = as_text(&[one.clone(), one], 100);
        assert_eq!(two, format!("2 workers with 16 threads, 30.0 jobs/min\n{line}{line}"));
        assert_eq!(as_text(&[], 100), "");
    }

    /// Protects: the line of a lost worker has the number of jobs taken back from it; many lost workers do not fill the
    /// screen.
    #[test]
    fn lost_workers_are_listed() {
        let lost = worker(WorkerPresence::Gone, 5);
        let text = as_text(std::slice::from_ref(&lost), 100);
        assert_eq!(text, "worker 4242 on node7: lost 3s ago, 5 jobs taken back from it\n");
        let many = as_text(&vec![lost; 40], 100);
        assert_eq!(many, "40 workers were lost, and 200 jobs taken back from them\n");
    }

    /// Protects: no line is wider than the terminal.
    #[test]
    fn lines_fit_narrow_terminals() {
        for width in [20, 40, 80] {
            let text = as_text(&[worker(WorkerPresence::Stopping, 2)], width);
            assert!(text.lines().all(|line| line.chars().count() <= width), "{text}");
        }
    }
}
