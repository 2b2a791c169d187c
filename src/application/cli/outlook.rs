//! The outlook of a study as text and JSON.

use super::output::wrapped;
use crate::publish::value::count;
use crate::queue::ActiveWorkers;
use crate::sweep::Outlook;
use crate::worker::Eta;
use anstyle::{AnsiColor, Style};
use serde_json::{Value, json};

/// The largest and the smallest length of the bar, in characters. Where the line has no room for the smallest one beside
/// the text, the bar has a line of its own.
const BAR: (usize, usize) = (40, 10);

/// A bar and the remaining time, with colours, in lines of at most `width` characters.
pub(crate) fn as_text(outlook: &Outlook, width: usize) -> String {
    let percent = format!(" {:.0} %", (100.0 * outlook.ended_share()).floor());
    let time = time(outlook);
    let room = width.saturating_sub(percent.chars().count());
    let beside = room.saturating_sub(time.chars().count() + 2);
    if beside >= BAR.1 {
        return format!("{}{percent}, {time}\n", bar(outlook, beside.min(BAR.0)));
    }
    let mut text = format!("{}{percent}\n", bar(outlook, room.min(BAR.0)));
    for line in wrapped(&time, width) {
        text.push_str(&line);
        text.push('\n');
    }
    text
}

fn bar(outlook: &Outlook, length: usize) -> String {
    // Rounded down: the bar is full only when nothing is left.
    let full = (outlook.ended_share() * length as f64) as usize;
    let style = Style::new().fg_color(Some(AnsiColor::Green.into()));
    format!("{style}{}{style:#}{}", "█".repeat(full), "░".repeat(length - full))
}

fn time(outlook: &Outlook) -> String {
    let ActiveWorkers { workers, threads } = outlook.alive;
    let with = |threads: u64| count(threads, "thread");
    if workers == 0 {
        let here = with(outlook.threads_here as u64);
        let eta = outlook.eta.map_or_else(|| "an unknown time".to_owned(), |eta| eta.to_string());
        return format!("no worker is running; it would take {eta} with {here} here");
    }
    match outlook.eta {
        Some(eta) => format!("{eta} left with {}", with(threads)),
        None => format!("the time left with {} is unknown", with(threads)),
    }
}

/// `40 s to 2 min left`.
pub(crate) fn time_left(eta: Option<Eta>) -> String {
    eta.map_or_else(|| "the time left is unknown".to_owned(), |eta| format!("{eta} left"))
}

/// The outlook for programs.
pub(crate) fn as_json(outlook: &Outlook) -> Value {
    json!({
        "ended_share": outlook.ended_share(),
        "workers": outlook.alive.workers,
        "worker_threads": outlook.alive.threads,
        "threads_here": outlook.threads_here,
        "remaining_s": outlook.eta,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::queue::Counts;
    use std::time::Duration;

    fn outlook(workers: u64, eta_s: u64) -> Outlook {
        let counts = Counts { done: 30, failed: 3, running: 2, pending: 65, cancelled: 7 };
        let time = Duration::from_secs(eta_s);
        let eta = Some(Eta { low: time, high: 2 * time });
        Outlook { counts, alive: ActiveWorkers { workers, threads: 2 * workers }, threads_here: 4, eta }
    }

    fn plain(outlook: &Outlook, width: usize) -> Vec<String> {
        let text = anstream::adapter::strip_str(&as_text(outlook, width)).to_string();
        text.lines().map(str::to_owned).collect()
    }

    /// Protects: the outlook takes one line if there is room, and otherwise several lines that fit the terminal. Its
    /// content does not depend on the width.
    #[test]
    fn the_content_does_not_depend_on_the_width() {
        let wide = plain(&outlook(1, 60), 100);
        let bar = format!("{}{}", "█".repeat(13), "░".repeat(27));
        assert_eq!(wide, [format!("{bar} 33 %, 60 s to 2 min left with 2 threads")]);
        for width in [16, 24, 40, 60] {
            let lines = plain(&outlook(1, 60), width);
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
            let words = lines.join(" ");
            assert!(
                words.contains("33 %") && words.ends_with("60 s to 2 min left with 2 threads"),
                "{lines:?}"
            );
        }
    }

    /// Protects: the outlook says when no worker is running.
    #[test]
    fn missing_workers_are_stated() {
        let alone = plain(&outlook(0, 10), 100).join(" ");
        assert!(
            alone.ends_with("no worker is running; it would take 10 s to 20 s with 4 threads here"),
            "{alone}"
        );
    }

    /// Protects: a time that nobody knows, such as that of modes of which none has finished, is no number.
    #[test]
    fn an_unknown_time_is_stated() {
        let unknown = |workers| Outlook { eta: None, ..outlook(workers, 0) };
        let running = plain(&unknown(1), 100).join(" ");
        assert!(running.ends_with("the time left with 2 threads is unknown"), "{running}");
        let alone = plain(&unknown(0), 100).join(" ");
        assert!(alone.ends_with("it would take an unknown time with 4 threads here"), "{alone}");
        assert_eq!(as_json(&unknown(1))["remaining_s"], Value::Null);
    }
}
