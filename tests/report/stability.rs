//! The linear stability of steady sliding: its zero line, the jobs that it does not explain, its files.

use crate::maps;
use crate::report_files::{REPORT, STABILITY};
use crate::synthetic::{done, parameters, periodic, record, report, row, with};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use tribosweep_mechanics::analysis::{
    AboveBand, ComplexMode, Outcome, Regime, SlidingStability, UnknownError,
};
use tribosweep_output::publish::chart::palette::DARK;
use tribosweep_output::publish::chart::{At, Axis, Chart, Layer, Panel, Pen, Point, Sample, Shape};
use tribosweep_output::report::figure::{Plot, StabilityPlot, figures, figures_with, stability_figures};
use tribosweep_output::report::{
    Along, JobRow, Report, RowState, ShownModes, StabilityPoint, View, thresholds_table, unknown_errors,
    write, write_stability,
};

const SPEEDS: [f64; 4] = [1.0, 5.0, 20.0, 100.0];
const FRICTION: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];

/// The threshold of the leading mode.
fn mu_c(omega_rpm: f64) -> f64 {
    0.22 + 0.07 * omega_rpm.log10()
}

fn mode(frequency_hz: f64, growth_rate_per_s: f64) -> ComplexMode {
    ComplexMode::of(frequency_hz, growth_rate_per_s)
}

/// A point with a mode that grows above its threshold, and one that always decays.
fn point(omega_rpm: f64, mu: f64) -> StabilityPoint {
    let modes = vec![mode(15_000.0, 1000.0 * (mu - mu_c(omega_rpm))), mode(21_000.0, -800.0)];
    let above_band = AboveBand::Nothing;
    let stability = SlidingStability { mu_star: mu, above_band, modes, ..SlidingStability::example() };
    StabilityPoint {
        parameters: parameters(omega_rpm, mu),
        on_grid: true,
        stands_alone: Some(UnknownError::NoCoarserMesh),
        stability,
    }
}

fn points() -> Vec<StabilityPoint> {
    SPEEDS.into_iter().flat_map(|omega| FRICTION.map(|mu| point(omega, mu))).collect()
}

/// Protects: a threshold has the error of the growth rates beside it over their slope, in the file and in words, and none where one of
/// them is unknown. Growth rates that are wrong by 20 1/s with a slope of 1000 1/s move it by 0.02.
#[test]
fn a_threshold_has_the_error_of_its_growth_rates() {
    let with_error = |errors: [Option<f64>; 2]| {
        let mut points: Vec<StabilityPoint> = FRICTION.map(|mu| point(1.0, mu)).into();
        for (error, point) in errors.into_iter().zip(&mut points[1..3]) {
            point.stability.modes[0].growth_rate_mesh_error_per_s = error;
        }
        let (table, _) = thresholds_table(&points, &Along::mu());
        table.lines[0][1].clone()
    };
    assert_eq!(with_error([Some(20.0), Some(10.0)]), "0.22 ± 0.02");
    assert_eq!(with_error([Some(20.0), None]), "0.22");
}

/// Protects: who reads modes without an error learns why, of the modes that the table shows: their point has no run on a coarser
/// mesh, or one with another clamp, or the mode has no partner there.
#[test]
fn modes_without_an_error_have_a_reason() {
    let mut points = [point(1.0, 0.1), point(1.0, 0.2)];
    let of = |points: &[StabilityPoint], count| unknown_errors(points, ShownModes { count, near_hz: None });
    let alone = "No mesh error is known. Of 4 modes, 4 have no run on a coarser mesh.";
    assert_eq!(of(&points, 2).as_deref(), Some(alone));
    points[0].stands_alone = None;
    points[0].stability.modes[0].growth_rate_mesh_error_per_s = Some(10.0);
    points[1].stands_alone = Some(UnknownError::OtherClamp);
    let both = "Not every mesh error is known. Of 4 modes, 1 has no mode on the coarser mesh that is clearly the same, and 2 have another width of \
                the clamp on the coarser mesh.";
    assert_eq!(of(&points, 2).as_deref(), Some(both));
    // The leading mode has its error, and the other one is not shown.
    assert_eq!((of(&points[..1], 1), of(&[], 2)), (None, None));
}

fn with_points<'a>(rows: &'a [JobRow], points: &'a [StabilityPoint]) -> Report<'a> {
    Report { stability: points, ..report(rows) }
}

/// The figures of the stability of one kind.
fn charts(points: &[StabilityPoint], plot: StabilityPlot) -> Vec<Chart> {
    let all = stability_figures(points, &Along::mu(), <&View>::default(), plot);
    all.into_iter().map(|figure| figure.chart).collect()
}

/// The map of regimes on true axes.
fn plane(rows: &[JobRow], points: &[StabilityPoint]) -> Chart {
    let all = figures_with(rows, <&View>::default(), Plot::RegimePlane, points);
    assert_eq!(all.len(), 1);
    all.into_iter().next().expect("a map").chart
}

/// The lines of a panel with their pens.
fn lines(panel: &Panel) -> Vec<(&[At], Pen)> {
    fn line(layer: &Layer) -> Option<(&[At], Pen)> {
        if let Layer::Line { points, pen, .. } = layer { Some((points, *pen)) } else { None }
    }
    panel.layers.iter().filter_map(line).collect()
}

/// The zero lines: black, and not dashed.
fn zero_lines(chart: &Chart) -> Vec<&[At]> {
    let is_black = |(points, pen): (_, Pen)| (pen.colour == DARK && pen.dash.0 == 0.0).then_some(points);
    lines(&chart.panels[0]).into_iter().filter_map(is_black).collect()
}

/// The points of a panel.
fn dots(panel: &Panel) -> Vec<&Point> {
    fn of_layer(layer: &Layer) -> &[Point] {
        if let Layer::Points(points) = layer { points } else { &[] }
    }
    panel.layers.iter().flat_map(of_layer).collect()
}

/// Protects: at every speed the zero line lies between the points of opposite sign next to each other, in the stability map and
/// in the map of regimes, and it is at the interpolated place. A wider, light line is below it.
#[test]
fn the_zero_line_lies_between_points_of_opposite_sign() {
    let rows: Vec<JobRow> =
        SPEEDS.into_iter().flat_map(|omega| FRICTION.map(|mu| row(omega, mu, periodic(0.9 * mu)))).collect();
    let points = points();
    for chart in [charts(&points, StabilityPlot::Map).remove(0), plane(&rows, &points)] {
        assert_eq!(maps::cells(&chart).len(), points.len());
        let found = zero_lines(&chart);
        assert_eq!(found.len(), 1);
        for omega in SPEEDS {
            let at = found[0].iter().find(|at| at.0 == omega).expect("the line crosses the column");
            // The growth rate of the points is linear in μ, so that interpolation has rounding errors only.
            assert!((at.1 - mu_c(omega)).abs() < 1e-12, "{omega}: {} {}", at.1, mu_c(omega));
        }
        let wider =
            lines(&chart.panels[0]).into_iter().find(|(points, _)| *points == found[0]).expect("a line");
        assert!(wider.1.colour != DARK && wider.1.width > 3.0, "{:?}", wider.1);
        assert!(maps::legend(&chart).contains(&"threshold: the leading growth rate is zero"));
    }
}

/// A job with its own stability: the growth rate of its leading mode, and μ* of steady sliding.
fn job(omega_rpm: f64, outcome: Outcome, mu_star: f64, growth_rate_per_s: f64, sliding: f64) -> JobRow {
    let mut own = record(outcome, Regime::StickSlip, mu_star);
    let stability = SlidingStability { mu_star: sliding, ..point(omega_rpm, 0.4).stability };
    own.stability = Some(SlidingStability { modes: vec![mode(15_000.0, growth_rate_per_s)], ..stability });
    row(omega_rpm, 0.4, RowState::Done(Box::new(own)))
}

/// Protects: exactly two kinds of jobs are marked, and the legend explains the kinds that occur: limit cycles where every mode
/// decays, and growing modes that leave μ* as it is in steady sliding. A leading mode that is not converged marks nothing.
#[test]
fn exactly_the_unexplained_jobs_are_marked() {
    let mut unclear = job(50.0, Outcome::Periodic, 0.3, -10.0, 0.4);
    if let RowState::Done(record) = &mut unclear.state {
        record.stability.as_mut().expect("modes").modes[0].is_converged = false;
    }
    let rows = [
        (job(1.0, Outcome::Periodic, 0.3, -10.0, 0.4), Some("cycle-below-threshold")),
        (job(2.0, Outcome::NotPeriodic, 0.3, -10.0, 0.4), None),
        (job(3.0, Outcome::Decayed, 0.4, -10.0, 0.4), None),
        (job(4.0, Outcome::Periodic, 0.3, 10.0, 0.4), None),
        (job(6.0, Outcome::Periodic, 0.4003, 10.0, 0.4), Some("no-effect")),
        (job(8.0, Outcome::NotPeriodic, 0.3997, 10.0, 0.4), Some("no-effect")),
        (job(10.0, Outcome::Periodic, 0.4005, 10.0, 0.4), None),
        (unclear, None),
        // Without stability of their own, jobs have that of the point at their parameters: −80 and 40 1/s.
        (row(100.0, 0.3, periodic(0.2)), Some("cycle-below-threshold")),
        (row(100.0, 0.4, periodic(0.4)), Some("no-effect")),
        // No point is here.
        (row(101.0, 0.3, periodic(0.2)), None),
        (row(101.0, 0.4, RowState::Pending), None),
    ];
    let jobs: Vec<JobRow> = rows.iter().map(|(row, _)| row.clone()).collect();
    let points = points();
    let chart = plane(&jobs, &points);
    for (row, mark) in &rows {
        let (cell, tip) = maps::cell(&chart, &row.job);
        assert_eq!(maps::data(tip, "mark"), mark.unwrap_or_default(), "{}", row.job);
        assert_eq!(cell.mark.is_some(), mark.is_some(), "{}", row.job);
    }
    let kinds = ["limit cycle, although every mode decays", "a mode grows, but μ* is that of steady sliding"];
    let explained = |chart: &Chart| kinds.map(|words| maps::legend(chart).contains(&words));
    assert_eq!(explained(&chart), [true, true]);
    let two = [&rows[4], &rows[10]].map(|(row, _)| row.clone());
    assert_eq!(explained(&plane(&two, &points)), [false, true]);
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    entries.map(|name| name.to_string_lossy().into_owned()).collect()
}

/// Protects: a report without points has no file, no section, no line and no mark of the stability, and says the same to the
/// last byte as before, even if its records have modes. With points it has exactly their files, and both pages show them.
#[test]
fn without_points_there_is_nothing() {
    let rows = [
        job(1.0, Outcome::Periodic, 0.3, -10.0, 0.4),
        row(5.0, 0.3, done(Outcome::Decayed, Regime::Stable, 0.3)),
    ];
    let (points, folder) = (points(), tempfile::tempdir().expect("a temporary folder"));
    let path = folder.path();
    let read = |name: &str| fs::read_to_string(path.join(name)).expect("a file");
    write(&report(&rows), path).expect("the report is written");
    let expected: BTreeSet<String> = REPORT.map(str::to_owned).into();
    assert_eq!(names(path), expected);
    let before = read("regime_plane.svg");
    let chart = maps::only(&rows, Plot::RegimePlane);
    assert!(zero_lines(&chart).is_empty());
    assert!(maps::cells(&chart).iter().all(|cell| cell.mark.is_none()));
    assert!(
        !read("report.html").contains("Linear stability") && !read("report.md").contains("Linear stability")
    );

    write(&with_points(&rows, &points), path).expect("the report is written");
    assert_eq!(names(path), REPORT.iter().chain(&STABILITY).map(|name| (*name).to_owned()).collect());
    let (page, markdown) = (read("report.html"), read("report.md"));
    assert!(page.contains("<h2>Linear stability</h2>") && page.contains("download=\"modes.csv\""));
    for name in STABILITY {
        assert!(markdown.contains(&format!("]({name})")), "{name}");
    }

    write(&report(&rows), path).expect("the report is written");
    assert_eq!(names(path), expected);
    assert_eq!(read("regime_plane.svg"), before);
}

/// Protects: a folder of its own has the page, the figures and the data, the same each time. Thresholds are those of the modes,
/// and what is not converged is said in the table and drawn hollow.
#[test]
fn the_stability_has_a_report_of_its_own() {
    let mut points = points();
    // At 5 rpm one mode beside the threshold is not converged; at 20 rpm sliding is unstable at every μ, at 100 rpm stable.
    for point in &mut points {
        let growing = &mut point.stability.modes[0];
        match (point.parameters.omega_rpm(), point.parameters.mu()) {
            (5.0, 0.3) => growing.is_converged = false,
            (20.0, _) => growing.growth_rate_per_s = 5.0,
            (100.0, _) => growing.growth_rate_per_s = -5.0,
            _ => {}
        }
    }
    // A point that refines the threshold at 1 rpm.
    points.push(StabilityPoint { on_grid: false, ..point(1.0, 0.225) });
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path();
    let read = |name: &str| fs::read_to_string(path.join(name)).expect("a file");
    let written = write_stability(&with_points(&[], &points), path).expect("the report is written");
    let expected: BTreeSet<String> = STABILITY
        .iter()
        .chain(&["stability.html", ".tribosweep-stability"])
        .map(|name| (*name).to_owned())
        .collect();
    assert_eq!(names(path), expected);
    assert_eq!(written.len(), expected.len() - 1);

    let modes = read("modes.csv");
    let header = "omega_rpm,mu,mode,frequency_hz,frequency_mesh_error_hz,growth_rate_per_s,growth_rate_mesh_error_per_s,damping_ratio,residual,converged,contact_nodes,lifted_nodes,band_hz,above_band";
    assert_eq!(modes.lines().next(), Some(header));
    assert_eq!(modes.lines().count(), 1 + 2 * points.len());
    assert_eq!(modes.matches(",false,30,2,").count(), 1);
    let thresholds = read("thresholds.csv");
    let lines: Vec<Vec<&str>> = thresholds.lines().map(|line| line.split(',').collect()).collect();
    let columns = [
        "omega_rpm",
        "mu_c",
        "mu_c_mesh_error",
        "mu_below",
        "mu_above",
        "mu_end",
        "mu_end_below",
        "mu_end_above",
        "frequency_hz",
        "converged",
        "band_hz",
        "above_band",
    ];
    assert_eq!(lines[0], columns);
    let near = |text: &str, expected: f64| (text.parse::<f64>().expect("a number") - expected).abs() < 1e-9;
    assert!(
        near(lines[1][1], mu_c(1.0)) && lines[1][2..10] == ["", "0.2", "0.225", "", "", "", "15000", "true"],
        "{thresholds}"
    );
    assert!(near(lines[2][1], mu_c(5.0)) && lines[2][9] == "false", "{thresholds}");
    assert_eq!(lines[3][..10], ["20", "", "", "", "0.1", "", "", "", "15000", "true"]);
    assert_eq!(lines[4][..10], ["100", "", "", "0.5", "", "", "", "", "", ""]);

    let page = read("stability.html");
    for text in [
        "Linear stability",
        "not converged",
        "≤ 0.1",
        "&gt; 0.5",
        "stable up to μ = 0.5",
        "Of 42 modes, 1 is not",
    ] {
        assert!(page.contains(text), "{text}");
    }
    // A drawing has inner ones, which begin with their place.
    let drawings = page.matches("<svg ").count() - page.matches("<svg x=").count();
    assert!(!page.contains("src=") && drawings == 3 + 2, "{drawings}");
    for (plot, text) in [
        (StabilityPlot::Map, "not converged"),
        (StabilityPlot::Map, "point outside the grid"),
        (StabilityPlot::LockIn, "not converged"),
        (StabilityPlot::LockIn, "15 kHz"),
        (StabilityPlot::LockIn, "decays at every point"),
        (StabilityPlot::Thresholds, "not converged"),
        (StabilityPlot::Thresholds, "no mode grows at any point"),
        (StabilityPlot::Thresholds, "unstable at the first point already"),
    ] {
        let charts = charts(&points, plot);
        assert!(maps::legend(&charts[0]).contains(&text), "{text} in {plot:?}");
    }
    let thresholds = charts(&points, StabilityPlot::Thresholds).remove(0);
    let dots = dots(&thresholds.panels[0]);
    let shapes: Vec<(f64, Shape, bool)> =
        dots.iter().map(|dot| (dot.at.0, dot.marker.shape, dot.marker.is_hollow)).collect();
    let expected = [
        (1.0, Shape::Circle, false),
        (5.0, Shape::Circle, true),
        (20.0, Shape::Down, false),
        (100.0, Shape::Up, false),
    ];
    assert_eq!(shapes, expected);
    assert!(near(&dots[0].at.1.to_string(), mu_c(1.0)) && dots[2].at.1 == 0.1 && dots[3].at.1 == 0.5);
    let before: Vec<String> = STABILITY.map(read).into();
    write_stability(&with_points(&[], &points), path).expect("the report is written");
    assert_eq!(before, STABILITY.map(read), "the same points make the same files");
    write_stability(&with_points(&[], &[]), path).expect("a report without points");
    assert_eq!(names(path).len(), 2);
}

/// Protects: the lock-in plot has six speeds at most, with every mode at its values, and each combination of further parameters
/// has figures and thresholds of its own.
#[test]
fn panels_are_speeds_and_sheets_are_combinations() {
    let speeds: Vec<f64> = (1..=11).map(f64::from).collect();
    let of = |load: i32| {
        let speeds = speeds.clone();
        speeds.into_iter().flat_map(move |omega| {
            FRICTION.map(|mu| {
                let mut own = point(omega, mu);
                own.parameters.extend([("load_n".to_owned(), load.into())]);
                own
            })
        })
    };
    let points: Vec<StabilityPoint> = of(10).chain(of(30)).collect();
    let jobs = |load: i32| {
        [(1.0, 0.1), (1.0, 0.5), (11.0, 0.1), (11.0, 0.5)]
            .map(|(omega, mu)| with(row(omega, mu, periodic(0.9 * mu)), "load_n", load))
    };
    let rows = [jobs(10), jobs(30)].concat();
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&with_points(&rows, &points), folder.path()).expect("the report is written");
    for file in
        ["stability_map.svg", "stability_map-2.svg", "lock_in-2.svg", "thresholds.svg", "regime_plane-2.svg"]
    {
        assert!(folder.path().join(file).is_file(), "{file} in {:?}", names(folder.path()));
    }
    assert!(!folder.path().join("thresholds-2.svg").exists(), "both combinations are panels");
    let lock_in = charts(&points, StabilityPlot::LockIn);
    assert_eq!(lock_in.len(), 2);
    let tips: Vec<_> = lock_in[0].tips().collect();
    let shown: BTreeSet<&str> = tips.iter().map(|tip| maps::data(tip, "omega")).collect();
    assert_eq!(shown, ["1", "3", "5", "7", "9", "11"].into());
    // Frequencies and growth rates of two modes at five μ.
    assert_eq!(tips.len(), 6 * 2 * 2 * FRICTION.len());
    let growth: BTreeSet<&str> = tips
        .iter()
        .filter(|tip| maps::data(tip, "omega") == "11" && maps::data(tip, "x") == "0.4")
        .map(|tip| maps::data(tip, "growth"))
        .collect();
    assert!(growth.len() == 2 && growth.contains("-800"), "{growth:?}");
    let titles: Vec<&str> = lock_in[0].panels.iter().map(|panel| panel.title.as_str()).collect();
    let above = |omegas: [i32; 3]| omegas.map(|omega| format!("ω = {omega} rpm"));
    assert_eq!(
        (&titles[..3], &titles[6..9]),
        (
            &above([1, 3, 5]).each_ref().map(String::as_str)[..],
            &above([7, 9, 11]).each_ref().map(String::as_str)[..]
        )
    );
    let lines = fs::read_to_string(folder.path().join("thresholds.csv")).expect("the thresholds");
    assert!(
        lines.starts_with("omega_rpm,load_n,mu_c,mu_c_mesh_error,") && lines.lines().count() == 1 + 22,
        "{lines}"
    );
    let maps = charts(&points, StabilityPlot::Map);
    assert_eq!(
        maps.iter().map(|chart| chart.title.as_str()).collect::<Vec<_>>(),
        ["load = 10 N", "load = 30 N"]
    );
    let planes = figures_with(&rows, <&View>::default(), Plot::RegimePlane, &points);
    assert_eq!(planes.iter().map(|figure| zero_lines(&figure.chart).len()).collect::<Vec<_>>(), [1, 1]);
    let alone = figures(&rows, <&View>::default(), Plot::RegimePlane);
    assert!(alone.iter().all(|figure| zero_lines(&figure.chart).is_empty()));
}

/// Two oscillators that friction couples, and a mode that decays. Up to the friction coefficient 0.2 at 1 rpm, and more at higher
/// speeds, the two have frequencies of their own; then they have a common one, and one of them grows.
fn coupled() -> Vec<StabilityPoint> {
    let mut points = Vec::new();
    for omega in SPEEDS {
        for step in 1..=12 {
            let mu = 0.04 * f64::from(step);
            let [low, high] = [14.0e3, 15.0e3].map(|hz: f64| (TAU * hz).powi(2));
            let coupling = (high - low) / 2.0 * mu / (mu_c(omega) - 0.02);
            let inside = ((high - low) / 2.0).powi(2) - coupling.powi(2);
            let root = inside.abs().sqrt();
            // Both squares λ² = −s of the eigenvalues.
            let mut modes: Vec<ComplexMode> = [1.0, -1.0]
                .map(|sign| {
                    let (re, im) = if inside > 0.0 {
                        ((low + high) / 2.0 + sign * root, 0.0)
                    } else {
                        ((low + high) / 2.0, sign * root)
                    };
                    let (size, angle) = (re.hypot(im).sqrt(), im.atan2(re) / 2.0);
                    mode(size * angle.cos() / TAU, -size * angle.sin() - 40.0 - 10.0 * sign)
                })
                .into();
            modes.push(mode(21_000.0, -9.0e4));
            let stability = SlidingStability { modes, ..point(omega, mu).stability };
            points.push(StabilityPoint { stability, ..point(omega, mu) });
        }
    }
    points
}

/// Protects: both modes that lock in have the colour of the one that grows, the other mode is grey, and the growth rates cross
/// zero at a visible place although another mode decays much faster.
#[test]
fn both_modes_that_lock_in_have_a_colour() {
    let chart = charts(&coupled(), StabilityPlot::LockIn).remove(0);
    let across = chart.columns;
    assert_eq!((across, chart.panels.len()), (2, 8));
    for (number, panel) in
        chart.panels.iter().enumerate().filter(|(number, _)| (number / across).is_multiple_of(2))
    {
        let pens: Vec<Pen> = lines(panel).into_iter().map(|(_, pen)| pen).collect();
        let (dashed, others): (Vec<Pen>, Vec<Pen>) = pens.iter().partition(|pen| pen.dash.0 > 0.0);
        assert_eq!((pens.len(), dashed.len()), (3, 1), "panel {number}");
        let same = others.iter().filter(|pen| pen.colour == dashed[0].colour).count();
        assert_eq!(same, 1, "panel {number}: the mode that grows");
    }
    assert!(maps::legend(&chart).contains(&"locks in with the mode of this colour"));
    let growth = &chart.panels[across];
    let (line, _) =
        lines(growth).into_iter().find(|(line, _)| line.iter().any(|at| at.1 > 0.0)).expect("a line");
    let axis = &growth.y.axis;
    assert!(matches!(axis, Axis::Signed { .. }));
    let [lowest, highest] = [f64::min, f64::max].map(|of| line.iter().map(|at| axis.place(at.1)).reduce(of));
    let [above, below] =
        [highest.expect("a place") - axis.place(0.0), axis.place(0.0) - lowest.expect("a place")];
    assert!(above > 0.05 && below > 0.05, "{above} {below}");
    assert!(line.iter().any(|at| at.1 == 0.0), "the crossing is on the line");
}

/// Protects: thresholds of another parameter than μ are in the multiple of its unit that people write, in ticks, labels and
/// tooltips.
#[test]
fn thresholds_have_multiples_of_units() {
    let at = |omega: f64, modulus_pa: f64| {
        let mut own = point(omega, 0.3);
        own.parameters.extend([("young_modulus_pa".to_owned(), modulus_pa.into())]);
        own.stability.modes = vec![mode(15_000.0, 1e-7 * (modulus_pa - 2.5e8))];
        own
    };
    let points: Vec<StabilityPoint> = [1.0, 5.0]
        .into_iter()
        .flat_map(|omega| [1e8, 2e8, 3e8, 4e8].map(|modulus| at(omega, modulus)))
        .collect();
    let along = Along { parameter: "young_modulus_pa".to_owned(), with: Vec::new() };
    for plot in [StabilityPlot::Thresholds, StabilityPlot::LockIn, StabilityPlot::Map] {
        let figures = stability_figures(&points, &along, <&View>::default(), plot);
        let panel = figures[0].chart.panels.last().expect("a panel");
        let scale = if plot == StabilityPlot::LockIn { &panel.x } else { &panel.y };
        assert!(scale.label.ends_with("young_modulus [GPa]"), "{}", scale.label);
        let ticks = scale.labelled_ticks();
        assert!(
            ticks.len() > 2 && ticks.iter().all(|(at, label)| *at < 1.0 && label.len() <= 4),
            "{ticks:?}"
        );
    }
    let chart =
        stability_figures(&points, &along, <&View>::default(), StabilityPlot::Thresholds).remove(0).chart;
    let tip = chart.tips().next().expect("a threshold");
    assert!(tip.title.contains("young_modulus = 0.25 GPa"), "{}", tip.title);
    assert_eq!(maps::data(tip, "y"), "250000000");
    let pens: Vec<&Sample> = chart.legend.iter().map(|entry| &entry.sample).collect();
    assert!(pens.iter().any(|sample| matches!(sample, Sample::Line(_))));
}
