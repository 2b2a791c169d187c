//! Error against run time, with synthetic jobs whose errors are known.

use crate::charts::{points, texts};
use crate::random::Random;
use crate::synthetic::{failed, numerics, parameters, record, row, with};
use std::fs;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::report::pareto::refinement::{Level, Unclean, limit, observed_order};
use tribosweep_output::report::pareto::{
    self, Comparison, Direction, ParetoError, chart, markdown, on_front, write,
};
use tribosweep_output::report::{JobNumerics, JobRow, RowState};

/// The parameters of these tests that are numerics.
fn is_numerics(name: &str) -> bool {
    !matches!(name, "omega_rpm" | "mu" | "young_modulus_pa" | "load_n" | "beta_r_s" | "clamp_width_m")
}

fn compare(rows: &[JobRow]) -> Result<Comparison<'_>, ParetoError> {
    pareto::compare(rows, is_numerics)
}

/// A finished job; its time step follows from mesh and safety factor.
fn job(numerics: JobNumerics, mu_star: f64, wall_s: f64) -> JobRow {
    let mut record = record(Outcome::Periodic, Regime::StickSlip, mu_star);
    record.mu_star_se = 1.0e-6;
    record.time_step_s = 1.0e-6 * numerics.safety_factor.unwrap_or(1.0) / numerics.elements[0] as f64;
    record.steps = (numerics.limit_s / record.time_step_s).round() as u64;
    let mut row = row(7.0, 0.4, RowState::Done(Box::new(record)));
    row.job = format!("{numerics:?}");
    row.wall_s = Some(wall_s);
    row.numerics = Some(numerics);
    row
}

/// μ* = 0.3 + 0.02 h² + 0.004 s with h = 4/n: second order in the mesh at a given step, first in the step.
fn manufactured(n: usize, safety_factor: f64) -> f64 {
    0.3 + 0.02 * (4.0 / n as f64).powi(2) + 0.004 * safety_factor
}

/// Meshes 4, 8, 16 at three steps each; the run time increases with both.
fn product() -> Vec<JobRow> {
    let mut rows = Vec::new();
    for n in [4, 8, 16] {
        for safety in [0.8, 0.4, 0.2] {
            let wall_s = 1.0e-3 * (n as f64).powi(4) / safety;
            rows.push(job(numerics(n, safety), manufactured(n, safety), wall_s));
        }
    }
    rows
}

fn levels(values: &[(f64, f64)]) -> Vec<Level> {
    values.iter().map(|&(size, value)| Level { size, value, standard_error: 1.0e-9 }).collect()
}

/// Protects: order and limit of q = q₀ + a hᵖ are recovered, for any ratios of the sizes and any sign.
#[test]
fn richardson_recovers_a_manufactured_limit() {
    for p in [0.6, 1.0, 1.43, 2.0, 2.9] {
        for sizes in [vec![4.0, 2.0, 1.0], vec![2.0, 1.0, 2.0 / 3.0, 0.5], vec![1.9, 1.7, 1.0, 0.9, 0.3]] {
            for a in [0.05, -0.02] {
                let values: Vec<_> = sizes.iter().map(|&h: &f64| (h, 0.3 + a * h.powf(p))).collect();
                let found = limit(&levels(&values)).unwrap();
                let order = found.order.unwrap_or_else(|why| panic!("p = {p}, {sizes:?}: {why:?}"));
                // The order is found to rounding of the differences, the limit follows.
                assert!((order - p).abs() < 1.0e-9, "p = {p}, {sizes:?}: {order}");
                assert!((found.value - 0.3).abs() < 1.0e-11, "p = {p}, {sizes:?}: {}", found.value);
                let finest = values.last().unwrap().1;
                assert!((found.uncertainty - (finest - found.value).abs()).abs() < 1.0e-15);
            }
        }
    }
}

/// Protects: if the order is not clean, nothing is extrapolated, and the reason is given.
#[test]
fn an_unclean_order_is_refused() {
    let of = |values: &[(f64, f64)]| limit(&levels(values)).unwrap();
    let reason = |values: &[(f64, f64)]| of(values).order.unwrap_err();
    assert_eq!(limit(&levels(&[(1.0, 0.3)])), None);
    assert_eq!(reason(&[(2.0, 0.31), (1.0, 0.30)]), Unclean::TooFewLevels);
    assert_eq!(reason(&[(4.0, 0.30), (2.0, 0.31), (1.0, 0.305)]), Unclean::NotMonotone);
    // Equal differences: order 0. A quarter of the order needed: 2^0.25 between the differences.
    assert!(matches!(reason(&[(4.0, 0.30), (2.0, 0.31), (1.0, 0.32)]), Unclean::OrderOutOfRange(None)));
    let slow = |h: f64| 0.3 + 0.01 * h.powf(0.25);
    assert!(matches!(
        reason(&[(4.0, slow(4.0)), (2.0, slow(2.0)), (1.0, slow(1.0))]),
        Unclean::OrderOutOfRange(Some(p)) if (p - 0.25).abs() < 1.0e-6
    ));
    // Order 2 from the last three levels, 1 from the three before.
    let unstable = of(&[(8.0, 0.42), (4.0, 0.38), (2.0, 0.36), (1.0, 0.355)]);
    assert!(
        matches!(unstable.order, Err(Unclean::OrderNotStable(a, b)) if a < 1.1 && b > 1.9),
        "{unstable:?}"
    );
    // The finest figure is taken, with the remaining error at first order: the last difference, at a ratio of 2.
    assert_eq!(unstable.value, 0.355);
    assert!((unstable.uncertainty - 0.005).abs() < 1.0e-12);
    // Not monotone: the uncertainty is the spread of the last three levels, however small the last difference is.
    let not_monotone = of(&[(4.0, 0.319), (2.0, 0.312), (1.0, 0.313)]);
    assert!((not_monotone.uncertainty - 0.007).abs() < 1.0e-12, "{not_monotone:?}");
    let noisy: Vec<Level> = [(4.0, 0.34), (2.0, 0.31), (1.0, 0.3099)]
        .map(|(size, value)| Level { size, value, standard_error: 1.0e-4 })
        .to_vec();
    assert_eq!(limit(&noisy).unwrap().order, Err(Unclean::WithinNoise));
    let [coarse, middle, fine] = noisy.as_slice() else { panic!() };
    assert!(observed_order([coarse, middle, fine]).is_some());
}

/// Protects: the front agrees with its definition, for points with equal costs, equal errors or both.
#[test]
fn the_front_agrees_with_a_brute_force_search() {
    let mut random = Random::new(12345);
    let mut next = |end: usize| random.below(end);
    for count in 1..60 {
        let points: Vec<(f64, f64)> = (0..count).map(|_| (next(12) as f64, next(12) as f64)).collect();
        let better = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
        let expected: Vec<bool> =
            points.iter().map(|&point| !points.iter().any(|&other| better(other, point))).collect();
        assert_eq!(on_front(&points), expected, "{points:?}");
    }
    assert_eq!(on_front(&[(f64::NAN, 0.0), (1.0, f64::NAN), (2.0, 3.0)]), [false, false, true]);
}

/// Protects: the finest job is the reference. It is extrapolated along mesh and step without counting the step twice, and
/// errors are the differences from it.
#[test]
fn errors_are_the_manufactured_ones() {
    let rows = product();
    let comparison = compare(&rows).unwrap();
    let [case] = comparison.cases.as_slice() else { panic!("one case") };
    let finest = &case.jobs[case.reference.job];
    assert_eq!((finest.numerics.elements, finest.numerics.safety_factor), ([16; 3], Some(0.2)));
    let directions: Vec<_> = case.reference.chains.iter().map(|chain| chain.direction).collect();
    assert_eq!(directions, [Direction::MeshAndStep, Direction::Step]);
    // At a constant fraction 0.2 of the stability limit, the chain of meshes has the limit 0.3008. The chain of steps is
    // not added to it.
    let target = case.reference.targets[0].unwrap();
    assert!((target.value - (0.3 + 0.004 * 0.2)).abs() < 1.0e-9, "{target:?}");
    for (job, score) in case.jobs.iter().zip(&case.scores) {
        let expected = job.record.mu_star / target.value - 1.0;
        assert!((score.mu_star_error - expected).abs() < 1.0e-12);
        assert_eq!(score.node_steps, job.numerics.nodes as f64 * job.record.steps as f64);
        assert_eq!(score.wall_s, job.row.wall_s);
        let claimed = score.claimed_error();
        assert!(claimed >= score.mu_star_resolution && claimed >= score.mu_star_error.abs());
    }
    // The uncertainty is the correction of the mesh, 0.02/16; the step adds none.
    let uncertainty = target.uncertainty.unwrap();
    assert!((uncertainty - 0.02 / 16.0).abs() < 1.0e-9, "{uncertainty}");
    // The error of the reference itself is its correction. It is not resolved, so the resolution is claimed.
    let own = &case.scores[case.reference.job];
    assert!(!own.is_resolved());
    let rounded_up = own.claimed_error() / own.mu_star_resolution;
    assert!((1.0..=1.1).contains(&rounded_up), "two digits, rounded up: {rounded_up}");
    // The front agrees with that of the claimed errors.
    let points: Vec<_> = case.scores.iter().map(|s| (s.wall_s.unwrap(), s.claimed_error())).collect();
    assert_eq!(case.scores.iter().map(|s| s.on_wall_front).collect::<Vec<_>>(), on_front(&points));
}

/// Protects: at a given time step, the chain of meshes does not extrapolate the step, so both corrections are made.
#[test]
fn given_steps_are_extrapolated_in_both_directions() {
    let mut rows = Vec::new();
    for n in [4, 8, 16] {
        for step in [4.0e-7, 2.0e-7, 1.0e-7] {
            let mut row = job(JobNumerics { safety_factor: None, ..numerics(n, 1.0) }, 0.0, 1.0);
            let RowState::Done(record) = &mut row.state else { panic!() };
            record.time_step_s = step;
            record.mu_star = 0.3 + 0.02 * (4.0 / n as f64).powi(2) + 1.0e4 * step;
            row.job += &step.to_string();
            rows.push(row);
        }
    }
    let comparison = compare(&rows).unwrap();
    let reference = &comparison.cases[0].reference;
    let directions: Vec<_> = reference.chains.iter().map(|chain| chain.direction).collect();
    assert_eq!(directions, [Direction::Mesh, Direction::Step]);
    assert!((reference.targets[0].unwrap().value - 0.3).abs() < 1.0e-9, "{reference:?}");
}

/// Protects: only jobs with the same physics are compared. Damping belongs to the physics if the finest mesh has several
/// values of it, and to the numerics otherwise.
#[test]
fn physical_cases_are_kept_apart() {
    let mut rows = product();
    rows.extend(product().into_iter().map(|mut row| {
        row.parameters = parameters(35.0, row.parameters.mu());
        row.job += "-35";
        if let Some(numerics) = &mut row.numerics {
            numerics.case = "other".to_owned();
        }
        row
    }));
    let cases = |rows: &[JobRow]| {
        let comparison = compare(rows).unwrap();
        comparison.cases.iter().map(|case| (case.caption.clone(), case.jobs.len())).collect::<Vec<_>>()
    };
    assert_eq!(cases(&rows), [("ω = 7 rpm, μ = 0.4".to_owned(), 9), ("ω = 35 rpm, μ = 0.4".to_owned(), 9)]);

    let mut rows = product();
    let undamped = |n, safety| JobNumerics { beta_r_s: 0.0, ..numerics(n, safety) };
    rows.push(job(undamped(8, 0.4), 0.35, 1.0));
    assert_eq!(cases(&rows), [("ω = 7 rpm, μ = 0.4".to_owned(), 10)]);
    let comparison = compare(&rows).unwrap();
    assert_eq!(comparison.cases[0].jobs[comparison.cases[0].reference.job].numerics.beta_r_s, 5.0e-8);
    rows.push(job(undamped(16, 0.4), 0.34, 1.0));
    let split = cases(&rows);
    assert_eq!(split.iter().map(|(_, jobs)| *jobs).collect::<Vec<_>>(), [9, 2]);
    assert!(split[0].0.ends_with("β_R = 5e-8 s") && split[1].0.ends_with("β_R = 0 s"), "{split:?}");
}

/// Protects: a mesh that is refined in one direction only is no level of the chain.
#[test]
fn meshes_refined_in_one_direction_are_no_levels() {
    let mut rows = product();
    let one_direction = JobNumerics { elements: [8, 16, 16], element_size_m: 0.8e-4, ..numerics(8, 0.2) };
    rows.push(job(one_direction, 0.5, 1.0));
    let comparison = compare(&rows).unwrap();
    for chain in &comparison.cases[0].reference.chains {
        assert_eq!(chain.sizes.len(), 3, "{chain:?}");
    }
}

/// Protects: if nothing can be compared, the error says what is expected.
#[test]
fn nothing_to_compare_is_an_error() {
    let rows = product();
    assert_eq!(compare(&[]).unwrap_err(), ParetoError::TooFewDone { done: 0, jobs: 0 });
    assert_eq!(compare(&rows[..1]).unwrap_err(), ParetoError::TooFewDone { done: 1, jobs: 1 });
    let apart: Vec<JobRow> = rows
        .iter()
        .cloned()
        .map(|mut row| {
            let case = row.job.clone();
            row.numerics.as_mut().unwrap().case = case;
            row
        })
        .collect();
    assert_eq!(compare(&apart).unwrap_err(), ParetoError::OneJobACase { done: 9 });
    assert!(ParetoError::OneJobACase { done: 9 }.to_string().contains("safety_factor"));
    // A job that two studies share counts once.
    let twice = [rows[0].clone(), rows[0].clone()];
    assert_eq!(compare(&twice).unwrap_err(), ParetoError::TooFewDone { done: 1, jobs: 1 });
}

/// Protects: a study in progress is compared by its finished jobs, and the page says what is missing.
#[test]
fn a_partial_study_says_so() {
    let mut rows = product();
    rows[8].state = RowState::Pending;
    rows[7].state = failed("diverged");
    let text = markdown(&compare(&rows).unwrap());
    assert!(text.contains("**Incomplete: 1 job not done and 1 failed"), "{text}");
    let comparison = compare(&rows).unwrap();
    let case = &comparison.cases[0];
    assert_eq!(case.jobs[case.reference.job].numerics.safety_factor, Some(0.8));
    assert_eq!(case.reference.chains.len(), 1, "one step on the finest mesh is no chain");

    let lone = with(row(9.0, 0.4, RowState::Pending), "elements", "x");
    rows.push(JobRow { numerics: Some(JobNumerics { case: "lone".into(), ..numerics(4, 0.8) }), ..lone });
    let text = markdown(&compare(&rows).unwrap());
    assert!(
        text.contains("Left out") && text.contains("ω = 9 rpm") && text.contains("0 of 1 job done"),
        "{text}"
    );
}

/// Protects: the page has the same table as the command, the CSV has one line per job with the errors, and the figure has
/// one marker per job, rings on the front and readable labels.
#[test]
fn the_files_hold_the_comparison() {
    let rows = product();
    let comparison = compare(&rows).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let written = write(&comparison, folder.path(), "Study").unwrap();
    let names: Vec<_> = written.iter().map(|p| p.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["pareto.svg", "pareto.csv", "refinement.csv", "pareto.html", "pareto.md"]);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();

    let printed = markdown(&comparison);
    let table: Vec<&str> = printed.lines().filter(|line| line.starts_with('|')).collect();
    let page = read("pareto.md");
    assert!(table.len() >= 11 && table.iter().all(|line| page.contains(line)), "{printed}");
    assert!(page.contains("](pareto.svg)"));

    let text = read("pareto.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|field| field == name).unwrap();
    let lines: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(lines.len(), 9);
    let case = &comparison.cases[0];
    for (line, score) in lines.iter().zip(&case.scores) {
        assert_eq!(line[at("mu_star_error")].parse::<f64>().unwrap(), score.mu_star_error);
        assert_eq!(line[at("wall_s")].parse::<f64>().unwrap(), score.wall_s.unwrap());
        assert_eq!(line[at("node_steps")].parse::<f64>().unwrap(), score.node_steps);
        assert_eq!(&line[at("on_wall_front")], score.on_wall_front.to_string());
    }
    assert_eq!(lines.iter().filter(|line| &line[at("reference")] == "true").count(), 1);

    let chart = chart(case);
    let panel = &chart.panels[0];
    assert_eq!((&*panel.x.label, &*panel.y.label), ("solver time of the job [s]", "relative error of μ*"));
    let (rings, markers): (Vec<_>, Vec<_>) =
        points(panel).into_iter().partition(|point| point.marker.radius > 9.0);
    let expected = |is_ringed: bool| -> Vec<(f64, f64)> {
        let own = case.scores.iter().filter(|score| !is_ringed || score.on_wall_front);
        own.map(|score| (score.wall_s.unwrap(), score.claimed_error())).collect()
    };
    assert_eq!(rings.iter().map(|point| point.at).collect::<Vec<_>>(), expected(true));
    assert_eq!(markers.iter().map(|point| point.at).collect::<Vec<_>>(), expected(false));
    let hollow: Vec<bool> = markers.iter().map(|point| point.marker.is_hollow).collect();
    assert_eq!(hollow, case.scores.iter().map(|score| !score.is_resolved()).collect::<Vec<_>>());
    let legend = texts(&chart.legend);
    for label in ["4 × 4 × 4", "16 × 16 × 16", "on the Pareto front", "Pareto front"] {
        assert!(legend.contains(&label), "no {label:?} in {legend:?}");
    }
}
