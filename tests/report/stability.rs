//! The linear stability of steady sliding: its zero line, the jobs that it does not explain, its files.

use crate::report_files::{REPORT, STABILITY};
use crate::svg::{self, Element};
use crate::synthetic::{done, periodic, record, report, row, with};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tribosweep::analysis::{AboveBand, ComplexMode, Outcome, Regime, SlidingStability};
use tribosweep::report::{JobRow, Report, RowState, StabilityPoint, write, write_stability};

const SPEEDS: [f64; 4] = [1.0, 5.0, 20.0, 100.0];
const FRICTION: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];

/// The threshold of the leading mode.
fn mu_c(omega_rpm: f64) -> f64 {
    0.22 + 0.07 * omega_rpm.log10()
}

fn mode(frequency_hz: f64, growth_rate_per_s: f64) -> ComplexMode {
    let damping_ratio = -growth_rate_per_s / (std::f64::consts::TAU * frequency_hz);
    ComplexMode { frequency_hz, growth_rate_per_s, damping_ratio, residual: 1e-9, is_converged: true }
}

/// A point with a mode that grows above its threshold, and one that always decays.
fn point(omega_rpm: f64, mu: f64) -> StabilityPoint {
    let modes = vec![mode(15_000.0, 1000.0 * (mu - mu_c(omega_rpm))), mode(21_000.0, -800.0)];
    let stability = SlidingStability {
        decided: false,
        contact_nodes: 30,
        lifted_nodes: 2,
        mu_star: mu,
        band_hz: 5e4,
        above_band: AboveBand::Nothing,
        damped_above_hz: None,
        modes,
    };
    let parameters = vec![("omega_rpm".to_owned(), omega_rpm.into()), ("mu".to_owned(), mu.into())];
    StabilityPoint { omega_rpm, mu, parameters, on_grid: true, stability }
}

fn points() -> Vec<StabilityPoint> {
    SPEEDS.into_iter().flat_map(|omega| FRICTION.map(|mu| point(omega, mu))).collect()
}

fn with_points<'a>(rows: &'a [JobRow], points: &'a [StabilityPoint]) -> Report<'a> {
    Report { stability: points, ..report(rows) }
}

fn drawing(folder: &Path, name: &str) -> Vec<Element> {
    svg::parse(&fs::read_to_string(folder.join(name)).unwrap_or_else(|_| panic!("no {name}")))
}

fn number(element: &Element, name: &str) -> f64 {
    element.attribute(name).expect(name).parse().expect("a number")
}

fn texts(elements: &[Element]) -> Vec<&str> {
    elements.iter().filter(|element| element.name == "text").map(|element| element.text.as_str()).collect()
}

/// The zero lines: black, and of their own width. The one in the legend has two points at the same height.
fn zero_lines(elements: &[Element]) -> Vec<Vec<(f64, f64)>> {
    let own = elements.iter().filter(|element| {
        element.name == "polyline" && element.is("stroke", "#000000") && element.is("stroke-width", "6")
    });
    let vertices = |element: &Element| {
        let pairs = element.attribute("points").expect("points").split_whitespace();
        let pair = |text: &str| {
            let (x, y) = text.split_once(',').expect("a pair");
            (x.parse().expect("x"), y.parse().expect("y"))
        };
        pairs.map(pair).collect()
    };
    own.map(vertices).collect()
}

/// The pixel of each point in a map on true axes: the dot inside of its cell.
fn places(elements: &[Element]) -> Vec<(&Element, f64, f64)> {
    let dots = || elements.iter().filter(|element| element.name == "circle" && element.is("r", "4"));
    let cells =
        elements.iter().filter(|element| element.name == "rect" && element.attribute("data-y").is_some());
    let place = |cell| {
        let [left, top, width, height] = ["x", "y", "width", "height"].map(|name| number(cell, name));
        let inside = |dot: &&Element| {
            let (x, y) = (number(dot, "cx"), number(dot, "cy"));
            (left..left + width).contains(&x) && (top..top + height).contains(&y)
        };
        let dot = dots().find(inside).expect("a dot in the cell");
        (cell, number(dot, "cx"), number(dot, "cy"))
    };
    cells.map(place).collect()
}

/// Protects: at every speed the zero line lies between the points of opposite sign next to each other, in the stability map and
/// in the map of regimes, and it is at the interpolated place.
#[test]
fn the_zero_line_lies_between_points_of_opposite_sign() {
    let rows: Vec<JobRow> =
        SPEEDS.into_iter().flat_map(|omega| FRICTION.map(|mu| row(omega, mu, periodic(0.9 * mu)))).collect();
    let (points, folder) = (points(), tempfile::tempdir().expect("a temporary folder"));
    write(&with_points(&rows, &points), folder.path()).expect("the report is written");
    for file in ["stability_map.svg", "regime_plane.svg"] {
        let elements = drawing(folder.path(), file);
        let line = zero_lines(&elements).into_iter().max_by_key(Vec::len).expect("a line");
        let places = places(&elements);
        assert_eq!(places.len(), points.len(), "{file}");
        for omega in SPEEDS {
            let column: Vec<_> = places.iter().filter(|(cell, ..)| number(cell, "data-x") == omega).collect();
            let x = column[0].1;
            let (_, y) =
                *line.iter().find(|(own, _)| (own - x).abs() <= 1.0).expect("the line crosses the column");
            let height =
                |mu: f64| column.iter().find(|(cell, ..)| number(cell, "data-y") == mu).expect("a cell").2;
            let below = FRICTION.into_iter().rfind(|mu| *mu < mu_c(omega)).expect("a stable point");
            let above = FRICTION.into_iter().find(|mu| *mu > mu_c(omega)).expect("an unstable point");
            let (low, high) = (height(below), height(above));
            assert!(high < y && y < low, "{file} {omega}: {high} {y} {low}");
            let expected = low + (high - low) * (mu_c(omega) - below) / (above - below);
            assert!((y - expected).abs() <= 2.0, "{file} {omega}: {y} {expected}");
        }
        assert!(texts(&elements).contains(&"threshold: the leading"), "{file}");
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
    let (points, folder) = (points(), tempfile::tempdir().expect("a temporary folder"));
    write(&with_points(&jobs, &points), folder.path()).expect("the report is written");
    let elements = drawing(folder.path(), "regime_plane.svg");
    for (row, mark) in &rows {
        let target = elements.iter().find(|element| element.is("data-job", &row.job)).expect("a cell");
        assert_eq!(target.attribute("data-mark"), *mark, "{}", row.job);
    }
    let legend = texts(&elements);
    assert!(
        legend.contains(&"limit cycle, although") && legend.contains(&"a mode grows, but μ* is"),
        "{legend:?}"
    );

    let one = [rows[4].0.clone()];
    write(&with_points(&one, &points), folder.path()).expect("the report is written");
    let elements = drawing(folder.path(), "regime_plane.svg");
    let legend = texts(&elements);
    assert!(
        !legend.contains(&"limit cycle, although") && legend.contains(&"a mode grows, but μ* is"),
        "{legend:?}"
    );
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
    let elements = svg::parse(&before);
    assert!(zero_lines(&elements).is_empty());
    assert!(elements.iter().all(|element| element.attribute("data-mark").is_none()));
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
        match (point.omega_rpm, point.mu) {
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
    let header = "omega_rpm,mu,mode,frequency_hz,growth_rate_1_s,damping_ratio,residual,converged,contact_nodes,lifted_nodes,band_hz,above_band";
    assert_eq!(modes.lines().next(), Some(header));
    assert_eq!(modes.lines().count(), 1 + 2 * points.len());
    assert_eq!(modes.matches(",false,30,2,").count(), 1);
    let thresholds = read("thresholds.csv");
    let lines: Vec<Vec<&str>> = thresholds.lines().map(|line| line.split(',').collect()).collect();
    let columns = [
        "omega_rpm",
        "mu_c",
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
        near(lines[1][1], mu_c(1.0)) && lines[1][2..9] == ["0.2", "0.225", "", "", "", "15000", "true"],
        "{thresholds}"
    );
    assert!(near(lines[2][1], mu_c(5.0)) && lines[2][8] == "false", "{thresholds}");
    assert_eq!(lines[3][..9], ["20", "", "", "0.1", "", "", "", "15000", "true"]);
    assert_eq!(lines[4][..9], ["100", "", "0.5", "", "", "", "", "", ""]);

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
    assert!(!page.contains("src=") && page.matches("<svg ").count() == 3 + 2);
    let legend =
        |name: &str| drawing(path, name).into_iter().filter(|own| own.name == "text").map(|own| own.text);
    for (file, text) in [
        ("stability_map.svg", "not converged"),
        ("stability_map.svg", "point that refines"),
        ("lock_in.svg", "not converged"),
        ("lock_in.svg", "15 kHz"),
        ("lock_in.svg", "decays at every point"),
        ("thresholds.svg", "not converged"),
        ("thresholds.svg", "no mode grows"),
        ("thresholds.svg", "unstable at the"),
    ] {
        assert!(legend(file).any(|own| own == text), "{text} in {file}");
    }
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
                own.parameters.push(("load_n".to_owned(), load.into()));
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
    let elements = drawing(folder.path(), "lock_in.svg");
    let dots: Vec<&Element> =
        elements.iter().filter(|element| element.attribute("data-branch").is_some()).collect();
    let shown: BTreeSet<&str> = dots.iter().filter_map(|dot| dot.attribute("data-omega")).collect();
    assert_eq!(shown, ["1", "3", "5", "7", "9", "11"].into());
    // Frequencies and growth rates of two modes at five μ.
    assert_eq!(dots.len(), 6 * 2 * 2 * FRICTION.len());
    let growth: BTreeSet<String> = dots
        .iter()
        .filter(|dot| dot.is("data-omega", "11") && dot.is("data-x", "0.4"))
        .map(|dot| dot.attribute("data-growth").expect("a rate").to_owned())
        .collect();
    assert!(growth.len() == 2 && growth.contains("-800"), "{growth:?}");
    let lines = fs::read_to_string(folder.path().join("thresholds.csv")).expect("the thresholds");
    assert!(lines.starts_with("omega_rpm,load_n,mu_c,") && lines.lines().count() == 1 + 22, "{lines}");
    assert!(texts(&drawing(folder.path(), "stability_map-2.svg")).contains(&"load = 30 N"));
    for file in ["regime_plane.svg", "regime_plane-2.svg"] {
        // The other line is that of the legend.
        assert_eq!(zero_lines(&drawing(folder.path(), file)).len(), 2, "{file}");
    }
}
