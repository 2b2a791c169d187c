//! The grid of letters for a terminal.

use crate::synthetic::{done, failed, periodic, row};
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::report::overview::overview;
use tribosweep_output::report::{JobRow, RowState};

/// Without colours.
fn plain(rows: &[JobRow], width: usize) -> String {
    anstream::adapter::strip_str(&overview(rows, width)).to_string()
}

fn study() -> Vec<JobRow> {
    vec![
        row(0.5, 0.2, done(Outcome::Decayed, Regime::Stable, 0.2)),
        row(0.5, 0.4, periodic(0.38)),
        row(7.0, 0.2, RowState::Running),
        row(7.0, 0.4, done(Outcome::NotPeriodic, Regime::StickSlipSeparation, 0.3)),
        row(100.0, 0.2, RowState::Pending),
        row(100.0, 0.4, failed("diverged")),
    ]
}

/// Protects: a narrow terminal gets the same letters in several parts, and no line is longer than its width.
#[test]
fn narrow_terminals_get_several_parts() {
    let text = plain(&study(), 20);
    assert!(text.lines().take(6).all(|line| line.chars().count() <= 20), "{text}");
    let lines = text.lines().take(6).filter(|line| line.starts_with("  "));
    let cells = lines.flat_map(|line| line.chars().skip("μ \\ ω [rpm]".chars().count()));
    let mut letters: Vec<char> = cells.filter(|c| *c != ' ').collect();
    letters.sort_unstable();
    assert_eq!(letters, ['!', '.', '>', 'K', 'S', 'x'], "{text}");
}

/// Protects: a study without jobs has no grid.
#[test]
fn without_jobs_there_is_nothing_to_show() {
    assert_eq!(overview(&[], 80), "");
}
