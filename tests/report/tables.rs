//! The tables: every job is in its cell, and missing results are marked.

use crate::synthetic::{done, failed, partial_study, periodic, row, with};
use serde_json::{Value, json};
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::report::tables::{self, Quantity};
use tribosweep_output::report::{JobRow, RowState, View};

/// The lines of the Markdown tables as cells without padding, rules left out.
fn cells(rows: &[JobRow], quantity: Quantity) -> Vec<Vec<String>> {
    tables::markdown(rows, quantity)
        .lines()
        .filter(|line| line.starts_with('|') && !line.contains("---"))
        .map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect())
        .collect()
}

/// The names and the cells of the table.
fn table(rows: &[JobRow], quantity: Quantity) -> (Vec<String>, Vec<Vec<Value>>) {
    let table = tables::table(rows, quantity);
    (table.names().map(str::to_owned).collect(), table.lines)
}

/// Protects: in a study with every kind of job, each cell has the right position and format.
#[test]
fn mu_star_of_a_partial_study() {
    let table = cells(&partial_study(), Quantity::MuStar);
    let expected = [
        ["ω [rpm]", "μ = 0.2", "μ = 0.3", "μ = 0.4"],
        ["1", "0.2000", "0.246", "–"],
        ["2", "0.2000", "0.252", "0.336"],
        ["5", "0.2000", "0.270", "0.360"],
        ["10", "0.2000", "0.270", "0.350~"],
        ["50", "0.2000", "failed", "–"],
        ["100", "0.2000", "0.285", "–"],
    ];
    assert_eq!(table, expected);
}

/// Protects: the table for programs has the same cells, and missing results are empty.
#[test]
fn the_table_for_programs_has_the_same_cells() {
    let (names, lines) = table(&partial_study(), Quantity::MuStar);
    assert_eq!(names, ["omega_rpm", "mu=0.2", "mu=0.3", "mu=0.4"]);
    assert_eq!(lines[0], [json!(1.0), json!("0.2000"), json!("0.2460"), Value::Null]);
    assert_eq!(lines[3], [json!(10.0), json!("0.2000"), json!("0.2700"), json!("0.3500~")]);
    assert_eq!(lines[4], [json!(50.0), json!("0.2000"), json!("failed"), Value::Null]);
    assert_eq!(lines.len(), 6);
}

/// Protects: frequencies are in whole hertz, `stable` if nothing oscillates, and regimes are names.
#[test]
fn frequency_and_regime_cells() {
    let frequency = cells(&partial_study(), Quantity::Frequency);
    assert_eq!(frequency[4], ["10", "stable", "14510", "14510~"]);
    assert_eq!(frequency[5], ["50", "stable", "failed", "–"]);
    let regime = cells(&partial_study(), Quantity::Regime);
    assert_eq!(regime[4], ["10", "stable", "stick_slip_separation", "stick_slip_separation~"]);
    assert_eq!(regime[5], ["50", "stable", "failed", "–"]);
}

/// Protects: what a run prints ends with what is known of the errors by the mesh, and has no table of frequencies if there are none.
#[test]
fn a_run_prints_what_is_known_of_its_errors() {
    let text = tables::of_results(&partial_study(), &View::default(), "t");
    let heads: Vec<&str> = text.lines().filter(|line| line.starts_with("# ")).collect();
    assert_eq!(heads, ["# t: macroscopic friction coefficient μ\\*", "# t: frequency [Hz]"]);
    let last = text.lines().last().expect("a line");
    assert!(last.starts_with("- Mesh: the error of 8 of 14 jobs") && last.contains("is unknown"), "{text}");
    let stable: Vec<JobRow> =
        partial_study().into_iter().filter(|row| row.parameter("mu").as_f64() == Some(0.2)).collect();
    assert!(!tables::of_results(&stable, &View::default(), "t").contains("frequency"), "{text}");
}

/// Protects: the legend below a table explains the marks that are in it, and no others.
#[test]
fn the_marks_that_occur_are_explained() {
    let legend = |rows: &[JobRow], quantity| {
        let text = tables::markdown(rows, quantity);
        text.rsplit_once("|\n").expect("a table").1.to_owned()
    };
    for quantity in [Quantity::MuStar, Quantity::Frequency, Quantity::Regime] {
        let legend = legend(&partial_study(), quantity);
        for mark in ["`~`", "`failed`", "`–`"] {
            assert!(legend.contains(mark), "{mark} of {quantity:?}");
        }
        assert!(!legend.contains("`a / b`"), "{legend}");
    }
    let complete = [row(7.0, 0.4, periodic(0.35)), row(9.0, 0.4, periodic(0.36))];
    assert_eq!(legend(&complete, Quantity::MuStar).trim(), "");
    let twice = [row(7.0, 0.4, periodic(0.35)), row(7.0, 0.4, periodic(0.36))];
    assert!(legend(&twice, Quantity::MuStar).contains("`a / b` several jobs"));
}

/// Protects: all lines of a table have the same width, so that it is readable in a terminal.
#[test]
fn columns_are_aligned() {
    for quantity in [Quantity::MuStar, Quantity::Regime] {
        let text = tables::markdown(&partial_study(), quantity);
        let widths: Vec<usize> =
            text.lines().filter(|line| line.starts_with('|')).map(|line| line.chars().count()).collect();
        assert_eq!(widths.len(), 8);
        assert!(widths.iter().all(|width| *width == widths[0]), "{text}");
    }
}

/// Protects: values are in numerical order, 10 after 2, in any order of the jobs.
#[test]
fn speeds_and_coefficients_ascend() {
    let rows = [(10.0, 0.4), (2.0, 0.1), (0.5, 0.4)].map(|(omega, mu)| row(omega, mu, periodic(0.3)));
    let table = cells(&rows, Quantity::MuStar);
    assert_eq!(table[0], ["ω [rpm]", "μ = 0.1", "μ = 0.4"]);
    let speeds: Vec<&str> = table[1..].iter().map(|line| line[0].as_str()).collect();
    assert_eq!(speeds, ["0.5", "2", "10"]);
}

/// Protects: two jobs at the same point are both in the cell.
#[test]
fn duplicates_share_a_cell() {
    let rows =
        [row(7.0, 0.4, periodic(0.35)), row(7.0, 0.4, periodic(0.36)), row(7.0, 0.4, RowState::Pending)];
    assert_eq!(cells(&rows, Quantity::MuStar)[1], ["7", "0.350 / 0.360 / –"]);
    assert_eq!(table(&rows, Quantity::MuStar).1[0], [json!(7.0), json!("0.3500 / 0.3600 / –")]);
}

/// Protects: where μ is the same in all jobs, another parameter makes the columns, and every combination of the rest has
/// its own table. Values have the units that people use; the CSV has those of the names.
#[test]
fn one_table_per_combination() {
    let mut rows = Vec::new();
    for beta in [0.0, 1e-7] {
        for top in ["free_in_z", "tied_in_z"] {
            for (side, shift) in [("inner_side", 0.0), ("outer_side", 0.1)] {
                for omega in [5.0, 7.0] {
                    let job = row(omega, 0.4, periodic(0.2 + shift + beta * 1e5));
                    let job = with(with(job, "clamp_side", side), "beta_r_s", beta);
                    rows.push(with(with(job, "top", top), "force_n", 30.0));
                }
            }
        }
    }
    let text = tables::markdown(&rows, Quantity::MuStar);
    let headings: Vec<&str> = text.lines().filter(|line| line.starts_with('#')).collect();
    assert_eq!(
        headings,
        [
            "### beta_r = 0 µs, top = free_in_z",
            "### beta_r = 0 µs, top = tied_in_z",
            "### beta_r = 0.1 µs, top = free_in_z",
            "### beta_r = 0.1 µs, top = tied_in_z",
        ]
    );
    assert!(text.starts_with("In all jobs: μ = 0.4, force = 30 N.\n"), "{text}");
    assert_eq!(
        cells(&rows, Quantity::MuStar)[0],
        ["ω [rpm]", "clamp_side = inner_side", "clamp_side = outer_side"]
    );
    let (names, lines) = table(&rows, Quantity::MuStar);
    assert_eq!(names, ["beta_r_s", "top", "omega_rpm", "clamp_side=inner_side", "clamp_side=outer_side"]);
    assert_eq!(json!(lines[0]), json!([0.0, "free_in_z", 5.0, "0.2000", "0.3000"]));
    assert_eq!(json!(lines[7]), json!([1e-7, "tied_in_z", 7.0, "0.2100", "0.3100"]));
}

/// Protects: in a study at one speed, the first parameter that varies is along the rows.
#[test]
fn without_speeds_the_first_varying_parameter_makes_the_rows() {
    let rows = [json!([8, 10, 6]), json!([12, 15, 10])].map(|elements| {
        let job = with(row(7.0, 0.4, periodic(0.35)), "top", "tied_in_z");
        with(with(job, "elements", elements.clone()), "beta_r_s", elements[0].clone())
    });
    let table = cells(&rows, Quantity::MuStar);
    assert_eq!(table[0], ["elements", "beta_r = 8 s", "beta_r = 12 s"]);
    assert_eq!(table[1], ["8x10x6", "0.350", "–"]);
    let text = tables::markdown(&rows, Quantity::MuStar);
    assert!(text.starts_with("In all jobs: ω = 7 rpm, μ = 0.4, top = tied_in_z.\n"), "{text}");
}

/// Protects: studies with one job and with none have tables.
#[test]
fn one_job_and_none() {
    let one = cells(&[row(7.0, 0.4, failed("no"))], Quantity::MuStar);
    assert_eq!(one, [["ω [rpm]", "μ = 0.4"], ["7", "failed"]]);
    assert_eq!(cells(&[], Quantity::MuStar), [["ω [rpm]"]]);
}

/// Protects: rounding errors of a computed grid are not in the headings, and no cell is lost because of them.
#[test]
fn computed_coefficients_have_short_headings() {
    let rows = [row(7.0, 0.1 + 0.2, periodic(0.25)), row(8.0, 0.1 + 0.2, periodic(0.26))];
    assert_eq!(cells(&rows, Quantity::MuStar), [["ω [rpm]", "μ = 0.3"], ["7", "0.250"], ["8", "0.260"]]);
}

/// Protects: a result that is NaN is marked as missing.
#[test]
fn a_figure_that_is_not_finite_is_missing() {
    let rows = [row(7.0, 0.4, done(Outcome::NotPeriodic, Regime::Undecided, f64::NAN))];
    assert_eq!(cells(&rows, Quantity::MuStar)[1], ["7", "–"]);
}

/// Protects: a `|` in a value does not split its cell.
#[test]
fn a_bar_in_a_value_does_not_split_a_cell() {
    let rows = ["a|b", "c"].map(|name| with(row(7.0, 0.4, periodic(0.35)), "note", name));
    let text = tables::markdown(&rows, Quantity::MuStar);
    assert!(text.contains("| a\\|b |"), "{text}");
}
