//! The axes of tables and figures: any parameter along the axis, over the columns and in panels, in units that people use.

use crate::charts::{data, only, points, texts};
use crate::synthetic::{partial_study, periodic, record, report, row, with};
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::Axis;
use tribosweep_output::report::figure::{Plot, figures};
use tribosweep_output::report::tables::{self, Quantity};
use tribosweep_output::report::{JobRow, RowState, SCALARS, Scalar, View, write};

/// Two speeds, two μ and three stiffnesses of the pin.
fn study() -> Vec<JobRow> {
    let mut rows = Vec::new();
    for young in [5e8, 1e9, 2e9] {
        for mu in [0.3, 0.4] {
            for omega in [2.0, 7.0] {
                let job = row(omega, mu, periodic(mu * (0.5 + young / 1e10 + omega / 100.0)));
                rows.push(with(job, "young_modulus_pa", young));
            }
        }
    }
    rows
}

fn view(x: Option<&str>, by: Option<&str>) -> View {
    View { x: x.map(str::to_owned), by: by.map(str::to_owned), ..View::default() }
}

fn heads(rows: &[JobRow], view: &View) -> Vec<String> {
    let page = tables::page(rows, view, Quantity::MuStar, "t");
    page.lines().filter(|line| line.starts_with('#') || line.starts_with("| ")).map(str::to_owned).collect()
}

/// Protects: a view puts any parameter along the axis and over the columns; the others make the groups, and no job is lost.
#[test]
fn any_parameter_can_be_an_axis() {
    let rows = study();
    let found = heads(&rows, &view(Some("young_modulus_pa"), Some("omega_rpm")));
    assert_eq!(found[1], "### μ = 0.3");
    assert_eq!(found[2], "| young_modulus [GPa] | ω = 2 rpm | ω = 7 rpm |");
    assert!(found[4].starts_with("|                 0.5 |     0.171 |     0.186 |"), "{found:?}");
    let found = heads(&rows, &view(Some("mu"), Some("young_modulus_pa")));
    assert_eq!(
        found[2],
        "|    μ | young_modulus = 0.5 GPa | young_modulus = 1 GPa | young_modulus = 2 GPa |"
    );
    // A name that no job has is ignored.
    assert_eq!(heads(&rows, &view(Some("load_n"), Some("omega_rpm"))), heads(&rows, &View::default()));
    for (x, by) in [("mu", "omega_rpm"), ("young_modulus_pa", "mu"), ("omega_rpm", "young_modulus_pa")] {
        let all = figures(&rows, &view(Some(x), Some(by)), Plot::RegimeMap);
        let cells: usize = all.iter().map(|figure| figure.svg.matches("data-job").count()).sum();
        assert_eq!(cells, rows.len(), "{x} {by}");
    }
}

/// Protects: the title of an axis has the description and the unit, ticks have that unit, and panels say their values.
#[test]
fn figures_have_the_units_that_people_use() {
    let mut view = view(Some("young_modulus_pa"), None);
    view.descriptions.insert("young_modulus_pa".to_owned(), "Young's modulus of the pin".to_owned());
    let figures = figures(&study(), &view, Plot::MuStar);
    let panels = &figures[0].chart.panels;
    assert_eq!(panels[0].x.label, "Young's modulus of the pin [GPa]");
    let ticks: Vec<String> = panels[0].x.labelled_ticks().into_iter().map(|tick| tick.1).collect();
    assert_eq!(ticks, ["0.5", "1", "2"]);
    let titles: Vec<&str> = panels.iter().map(|panel| panel.title.as_str()).collect();
    assert_eq!(titles, ["ω = 2 rpm", "ω = 7 rpm"]);
}

/// Protects: the axis is that of the frequencies of periodic jobs, and the others are at its edge. Colours and curves without
/// a frequency are not in the legend.
#[test]
fn only_periodic_jobs_set_the_axis_of_frequencies() {
    let at = |omega: f64, mu: f64, outcome, frequency: Option<f64>| {
        let regime = if frequency.is_some() { Regime::StickSlip } else { Regime::Stable };
        let mut own = record(outcome, regime, 0.3);
        own.frequency_hz = frequency;
        row(omega, mu, RowState::Done(Box::new(own)))
    };
    let rows = [
        at(1.0, 0.4, Outcome::Periodic, Some(15_000.0)),
        at(2.0, 0.4, Outcome::Periodic, Some(15_400.0)),
        at(5.0, 0.4, Outcome::NotPeriodic, Some(113_000.0)),
        at(1.0, 0.1, Outcome::Decayed, None),
        at(2.0, 0.1, Outcome::Decayed, None),
    ];
    let chart = only(&rows, Plot::Frequency);
    let Axis::Linear(range) = &chart.panels[0].y.axis else { panic!("{:?}", chart.panels[0].y.axis) };
    assert!(range.start > 14.0 && range.end < 16.5, "{range:?}");
    let beyond: Vec<f64> = points(&chart.panels[0]).iter().map(|point| point.at.1).collect();
    assert_eq!(beyond, [15.0, 15.4, 113.0], "also the one that is beyond the axis");
    let legend = texts(&chart.legend);
    assert!(legend.contains(&"0.4") && !legend.contains(&"0.1"), "{legend:?}");
}

/// Protects: every number of the record can be drawn and tabulated, and its title has the unit.
#[test]
fn every_scalar_has_a_figure_and_a_table() {
    for scalar in SCALARS.iter() {
        let rows = partial_study();
        let chart = only(&rows, Plot::Of(scalar));
        let points = points(&chart.panels[0]);
        for point in &points {
            let tip = point.tip.as_ref().expect("a tooltip");
            let row = rows.iter().find(|row| row.job == data(tip, "job")).expect("its job");
            assert_eq!(data(tip, "y").parse().ok(), scalar.value(row), "{}", scalar.name);
        }
        let points = points.len();
        // These are not in every record.
        let is_optional = [
            "frequency",
            "growth_rate",
            "hysteresis",
            "holder",
            "mode",
            "contact_nodes",
            "lifted_nodes",
            "start",
            "mesh",
            "mu_star_mesh_error",
            "mu_star_extrapolated",
            "disk",
            "front",
            "rear",
        ]
        .iter()
        .any(|beginning| scalar.name.starts_with(beginning));
        assert!(points == 14 || is_optional, "{}: {points}", scalar.name);
        let table = tables::page(&rows, &View::default(), Quantity::Of(scalar), "t");
        let title = scalar.title().replace('*', "\\*");
        assert!(table.starts_with(&format!("# t: {title}\n")), "{table}");
    }
    assert_eq!(
        Scalar::find("sigma_n_max_pa").expect("a stress").title(),
        "largest normal contact stress [Pa]"
    );
}

/// Protects: the values of a logarithmic range have short and different heads.
#[test]
fn computed_ranges_have_short_heads() {
    let rows: Vec<JobRow> =
        (0..5).map(|k| row(1.425_102_670_3 * 1.37f64.powi(k), 0.4, periodic(0.3))).collect();
    let speeds: Vec<String> = heads(&rows, &View::default())[3..]
        .iter()
        .map(|line| line.split('|').nth(1).expect("a cell").trim().to_owned())
        .collect();
    assert_eq!(speeds, ["1.43", "1.95", "2.67", "3.66", "5.02"]);
}

/// Protects: jobs that are points and no grid are shown in one figure for each of their parameters, without lines, and in tables with a
/// row for each point. A grid of the same number of jobs has curves.
#[test]
fn points_have_figures_over_each_parameter() {
    let point = |n: usize| {
        let (omega, mu) = (1.0 + 0.7 * n as f64, 0.2 + 0.01 * ((n * 7) % 12) as f64);
        with(row(omega, mu, periodic(mu)), "load_n", 20.0 + ((n * 5) % 12) as f64)
    };
    let points: Vec<JobRow> = (0..12).map(point).collect();
    let folder = tempfile::tempdir().unwrap();
    let files = write(&report(&points), folder.path()).unwrap();
    let files: Vec<_> = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
    for name in ["mu_star.svg", "mu_star-over-mu.svg", "mu_star-over-load_n.svg", "frequency-over-mu.svg"] {
        assert!(files.contains(&name), "{name} in {files:?}");
    }
    assert!(!files.contains(&"mu_star-2.svg"), "{files:?}");
    let table = std::fs::read_to_string(folder.path().join("mu_star.csv")).unwrap();
    assert_eq!(table.lines().count(), 13, "{table}");
}
