//! Where jobs fail or do not become periodic.

use crate::synthetic::{failed, parameters, periodic, record, row, with};
use tribosweep_mechanics::analysis::{Obstacle, Outcome, Regime};
use tribosweep_output::report::trouble::{Grid, MAX_LISTED, Region, cause, regions, sentences};
use tribosweep_output::report::{JobRow, RowState};

fn unsteady(figure: &str, spread: f64) -> RowState {
    let mut record = record(Outcome::NotPeriodic, Regime::StickSlip, 0.3);
    record.obstacle = Some(Obstacle::Unsteady { figure: figure.to_owned(), spread, drift: 0.25 * spread });
    RowState::Done(Box::new(record))
}

/// A grid of 4 × 6 jobs, which are periodic except where `state` returns something else.
fn study(state: impl Fn(usize, usize) -> Option<RowState>) -> Vec<JobRow> {
    let (mus, omegas) = ([0.1, 0.2, 0.3, 0.4], [100.0, 1.0, 2.0, 5.0, 10.0, 50.0]);
    let at = |m: usize, o: usize| row(omegas[o], mus[m], state(m, o).unwrap_or_else(|| periodic(0.3)));
    (0..4).flat_map(|m| (0..6).map(move |o| (m, o))).map(|(m, o)| at(m, o)).collect()
}

fn in_short(region: &Region) -> (usize, usize, &str, &str) {
    (region.jobs, region.of, &region.place, region.cause.what)
}

/// Protects: neighbours in the grid form a region, also diagonally, and in the numerical order of the values, not in that of
/// the document. Jobs that are not connected or have another cause form another region. Messages that differ only in
/// their numbers are the same cause.
#[test]
fn regions_are_connected() {
    // Speeds in the document: 100, 1, 2, 5, 10, 50; by size 100 is a neighbour of 50 and not of 1.
    let rows = study(|m, o| match (m, o) {
        (3, 0) => Some(failed("diverged at step 17 (t = 3.2e-5 s)")),
        (3, 5) => Some(failed("diverged at step 4 (t = 1e-5 s)")),
        (2, 4) => Some(failed("diverged at step 5 (t = 1e-5 s)")),
        (0, 1) => Some(failed("diverged at step 9 (t = 1e-5 s)")),
        (3, 1) => Some(unsteady("mu_star", 0.034)),
        (3, 2) => Some(unsteady("mu_star", 0.05)),
        (2, 1) => Some(unsteady("period", 0.05)),
        _ => None,
    });
    let found = regions(&rows);
    let found: Vec<_> = found.largest.iter().map(in_short).collect();
    assert_eq!(
        found,
        [
            (3, 6, "ω = 10 … 100 rpm, μ = 0.3 … 0.4", "failed"),
            (2, 2, "ω = 1 … 2 rpm, μ = 0.4", "not periodic"),
            (1, 1, "ω = 1 rpm, μ = 0.1", "failed"),
            (1, 1, "ω = 1 rpm, μ = 0.3", "not periodic"),
        ]
    );
}

/// Protects: the sentence of a region has the status, the number of jobs, the ranges, the cause and a job.
#[test]
fn a_region_is_described_in_a_sentence() {
    let rows = study(|m, o| (m == 3 && o < 3 && o != 1).then(|| unsteady("mu_star", 0.034)));
    assert_eq!(
        sentences(&regions(&rows)),
        [
            "not periodic: 1 job at ω = 100 rpm, μ = 0.4: mu_star is not the same from cycle to cycle: it spreads by \
             0.034 and drifts by 0.0085 (job job-100-0.4)",
            "not periodic: 1 job at ω = 2 rpm, μ = 0.4: mu_star is not the same from cycle to cycle: it spreads by \
             0.034 and drifts by 0.0085 (job job-2-0.4)",
        ]
    );
    let everywhere = regions(&study(|_, _| Some(failed("no room"))));
    assert_eq!(sentences(&everywhere), ["failed: 24 jobs: no room (job job-100-0.1, for example)"]);
    assert!(sentences(&regions(&study(|_, _| None))).is_empty());
}

/// Protects: values that are not numbers have no neighbours, a missing parameter counts as a value, and parameters that are
/// equal in all jobs are not mentioned.
#[test]
fn names_have_no_neighbours() {
    let mut rows = Vec::new();
    for side in ["inner_side", "outer_side"] {
        for mu in [0.2, 0.4] {
            rows.push(with(row(7.0, mu, failed("no")), "clamp.side", side));
        }
    }
    rows.push(row(7.0, 0.4, failed("no")));
    let places: Vec<_> =
        regions(&rows).largest.into_iter().map(|region| (region.jobs, region.place)).collect();
    assert_eq!(
        places,
        [
            (2, "μ = 0.2 … 0.4, clamp.side = inner_side".to_owned()),
            (2, "μ = 0.2 … 0.4, clamp.side = outer_side".to_owned()),
            (1, "μ = 0.4, clamp.side not set".to_owned()),
        ]
    );
}

/// Protects: a study with many scattered failures is described in a bounded number of lines that count all of them.
#[test]
fn many_regions_are_counted() {
    let rows: Vec<JobRow> = (0..100)
        .map(|i| {
            let state = if i % 2 == 0 { failed("no") } else { periodic(0.3) };
            row(f64::from(i), 0.4, state)
        })
        .collect();
    let found = regions(&rows);
    assert_eq!(
        (found.largest.len(), found.omitted, found.jobs_in_omitted),
        (MAX_LISTED, 50 - MAX_LISTED, 50 - MAX_LISTED)
    );
    assert_eq!(sentences(&found)[MAX_LISTED], "and 38 more jobs in 38 smaller regions");
}

/// Protects: with many parameters, neighbours differ in one of them only, so that the search stays fast. A row that is not
/// in the grid, because the study was replaced in the meantime, is left out.
#[test]
fn many_parameters_are_fast() {
    let mut rows = Vec::new();
    for corner in 0..1 << 10 {
        let bits = (0..10).map(|bit| ((corner >> bit) & 1_i32, format!("p{bit}")));
        rows.push(bits.fold(row(7.0, 0.4, failed("no")), |row, (value, name)| with(row, &name, value)));
    }
    assert_eq!(sentences(&regions(&rows))[0].split(" (job").next(), Some("failed: 1024 jobs: no"));

    let mut grid = Grid::default();
    grid.add(&parameters(7.0, 0.4));
    let trouble = cause(&rows[0]).unwrap();
    let found =
        grid.regions([(0, "a".to_owned(), trouble.clone()), (1, "b".to_owned(), trouble)], MAX_LISTED);
    assert_eq!((found.largest.len(), found.largest[0].jobs, found.omitted), (1, 1, 0));
}
