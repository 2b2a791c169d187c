//! The figures of curves, shares and residuals: every result has a marker, and every μ has a curve and an entry in the legend.

use crate::charts::{all, coloured, data, lines, only, points, texts};
use crate::synthetic::{after, done, measured, partial_study, periodic, record, report, row, with};
use std::collections::HashSet;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::palette::{BLUE, GREEN, GREY, VERMILLION};
use tribosweep_output::publish::chart::{Axis, Chart, Guide, Layer, Panel, Rgb, Sample, Shape};
use tribosweep_output::report::figure::{Plot, figures};
use tribosweep_output::report::{JobRow, RowState, Scalar, View, write};

/// The first colours of the palette, in the order of ascending μ.
const COLOURS: [Rgb; 3] = [BLUE, VERMILLION, GREEN];

/// The only panel of the only figure.
fn panel(rows: &[JobRow], plot: Plot) -> Panel {
    let mut chart = only(rows, plot);
    assert_eq!(chart.panels.len(), 1);
    chart.panels.remove(0)
}

fn guides(panel: &Panel) -> Vec<Guide> {
    let guide = |layer: &Layer| match layer {
        Layer::Guide(guide) => Some(guide.clone()),
        _ => None,
    };
    panel.layers.iter().filter_map(guide).collect()
}

/// Corners and cover of the areas in a colour.
fn areas(panel: &Panel, colour: Rgb) -> Vec<(Vec<(f64, f64)>, f64)> {
    let area = |layer: &Layer| match layer {
        Layer::Area(corners, own, cover) if *own == colour => Some((corners.clone(), *cover)),
        _ => None,
    };
    panel.layers.iter().filter_map(area).collect()
}

/// Protects the figure's completeness: one curve, one legend entry and one guide per μ, one marker with the job's values per
/// result.
#[test]
fn each_mu_has_a_curve_and_each_result_a_marker() {
    let rows = partial_study();
    let chart = only(&rows, Plot::MuStar);
    let panel = &chart.panels[0];
    for ((colour, results), mu) in COLOURS.into_iter().zip([6, 5, 3]).zip([0.2, 0.3, 0.4]) {
        let own: Vec<_> = lines(panel).into_iter().filter(|(_, pen)| pen.colour == colour).collect();
        assert_eq!((own.len(), own[0].0.len()), (1, results), "the curve of {colour}");
        assert_eq!(coloured(panel, colour).len(), results, "markers of {colour}");
        let guide = guides(panel).into_iter().find(|guide| guide.pen.colour == colour).expect("a guide");
        assert!(guide.at == mu && guide.pen.dash.0 > 0.0 && !guide.is_vertical);
    }
    let texts = texts(&chart.legend);
    for label in ["0.2", "0.3", "0.4", "μ* = μ", "stable", "stick–slip", "stick–slip–separation"] {
        assert!(texts.contains(&label), "{label} in {texts:?}");
    }
    assert!(!texts.contains(&"undecided"), "a regime that does not occur is not in the legend");
    for point in points(panel) {
        let tip = point.tip.as_ref().expect("a tooltip");
        let row = rows.iter().find(|row| row.job == data(tip, "job")).expect("its job");
        assert_eq!(point.at, (row.parameters.omega_rpm(), row.record().expect("a result").mu_star));
        assert_eq!(data(tip, "mu").parse(), Ok(row.parameters.mu()));
    }
}

/// Protects: the span goes from the smallest to the largest result at each speed, over parameters and studies, its line is that of the
/// first study, and a speed at which a study is alone has no span.
#[test]
fn a_span_holds_all_jobs_of_its_speed() {
    let job = |study: &str, omega_rpm, mu_star| {
        let mut own = row(omega_rpm, 0.4, periodic(mu_star));
        study.clone_into(&mut own.study);
        own
    };
    let other =
        |study, omega_rpm, mu_star, side: &str| with(job(study, omega_rpm, mu_star), "clamp_side", side);
    let rows = [
        job("first", 2.0, 0.31),
        job("first", 4.0, 0.30),
        job("first", 7.0, 0.25),
        other("second", 2.0, 0.35, "outer_side"),
        other("second", 7.0, 0.24, "outer_side"),
        other("second", 2.0, 0.33, "both_ends"),
        other("second", 7.0, 0.29, "both_ends"),
        job("third", 7.0, 0.27),
        // Two jobs of the first study are no line, also if only one of them has settled.
        job("first", 9.0, 0.28),
        JobRow {
            state: done(Outcome::NotPeriodic, Regime::Undecided, 0.2),
            ..other("first", 9.0, 0.2, "both_sides")
        },
        // A run that is not periodic has no place in the span.
        JobRow {
            state: done(Outcome::NotPeriodic, Regime::Undecided, 0.1),
            ..other("third", 2.0, 0.1, "both_sides")
        },
    ];
    let view = View { by: Some("mu".to_owned()), ..View::default() };
    let [figure] = &figures(&rows, &view, Plot::Span)[..] else { panic!("one figure") };
    let [panel] = &figure.chart.panels[..] else { panic!("one panel") };
    let corners = vec![(2.0, 0.31), (7.0, 0.24), (7.0, 0.29), (2.0, 0.35)];
    let [(found, _)] = &areas(panel, GREY)[..] else { panic!("one band") };
    assert_eq!(*found, corners);
    let lines = lines(panel);
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0].0, [(2.0, 0.31), (4.0, 0.30), (7.0, 0.25)]);
    assert_eq!(points(panel).len(), rows.len());
    assert_eq!(guides(panel).iter().map(|guide| guide.at).collect::<Vec<_>>(), [0.4]);
}

/// Protects: there is no line μ\* = μ where the friction law has other coefficients too, or where nobody knows it.
#[test]
fn only_laws_with_one_coefficient_have_its_line() {
    let mut rows = partial_study();
    for row in rows.iter_mut().filter(|row| row.parameters.mu() == 0.3) {
        row.has_one_mu = row.parameters.omega_rpm() > 10.0;
    }
    let levels: Vec<f64> = guides(&panel(&rows, Plot::MuStar)).iter().map(|guide| guide.at).collect();
    assert_eq!(levels, [0.2, 0.4]);
    for row in &mut rows {
        row.has_one_mu = false;
    }
    let chart = only(&rows, Plot::MuStar);
    assert!(guides(&chart.panels[0]).is_empty() && !texts(&chart.legend).contains(&"μ* = μ"));
}

/// Protects: both axes of both figures have quantity, symbol and unit, and frequencies have the unit that fits them.
#[test]
fn axes_carry_quantity_and_unit() {
    let mu_star = panel(&partial_study(), Plot::MuStar);
    assert_eq!(mu_star.x.label, "disk speed ω [rpm]");
    assert_eq!(mu_star.y.label, "macroscopic friction coefficient μ*");
    let frequency = panel(&partial_study(), Plot::Frequency);
    assert_eq!((&*frequency.x.label, &*frequency.y.label), ("disk speed ω [rpm]", "frequency [kHz]"));
    let point = points(&frequency)[0];
    assert_eq!(point.at.1, 14.5124);
    assert_eq!(data(point.tip.as_ref().expect("a tooltip"), "y"), "14512.4", "as in the record");
}

/// Protects: the ticks are the speeds that people chose, every doubling has the same length, and with many speeds, or with those
/// that the program adds, the ticks are round numbers.
#[test]
fn speed_is_on_a_logarithmic_axis() {
    let rows = [35.0, 0.5, 100.0, 6.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let scale = panel(&rows, Plot::MuStar).x;
    let labels: Vec<String> = scale.labelled_ticks().into_iter().map(|tick| tick.1).collect();
    assert_eq!(labels, ["0.5", "6", "35", "100"]);
    let doubling = |from: f64| scale.axis.place(2.0 * from) - scale.axis.place(from);
    assert!(doubling(0.5) > 0.05 && (doubling(0.5) - doubling(50.0)).abs() < 1e-12);

    let added: Vec<JobRow> =
        rows.iter().cloned().chain([JobRow { wave: 1, ..row(7.123, 0.4, periodic(0.3)) }]).collect();
    assert_eq!(panel(&added, Plot::MuStar).x.labelled_ticks(), scale.labelled_ticks());
    let many: Vec<JobRow> = (0..40).map(|k| row(1.3f64.powi(k), 0.4, periodic(0.3))).collect();
    let labels: Vec<String> =
        panel(&many, Plot::MuStar).x.labelled_ticks().into_iter().map(|tick| tick.1).collect();
    assert_eq!(labels[..4], ["1", "2", "5", "10"]);
}

/// Protects: a disk at rest is drawn too, because the axis is linear if there is ω = 0.
#[test]
fn zero_speed_makes_the_axis_linear() {
    let rows = [0.0, 5.0, 10.0, 20.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let panel = panel(&rows, Plot::MuStar);
    assert_eq!(points(&panel).len(), 4);
    assert!(matches!(panel.x.axis, Axis::Linear(_)));
}

/// Protects: the shape of a marker is the regime, and a hollow marker means that the state is not periodic.
#[test]
fn shape_is_the_regime_and_hollow_is_not_periodic() {
    let expected = [
        (Outcome::Decayed, Regime::Stable, Shape::Circle, false),
        (Outcome::Periodic, Regime::StickSlip, Shape::Up, false),
        (Outcome::Periodic, Regime::StickSlipSeparation, Shape::Square, false),
        (Outcome::Periodic, Regime::SlipSeparation, Shape::Diamond, false),
        (Outcome::NotPeriodic, Regime::StickSlip, Shape::Up, true),
        (Outcome::NotPeriodic, Regime::Undecided, Shape::Circle, true),
    ];
    for (outcome, regime, shape, is_hollow) in expected {
        let chart = only(&[row(7.0, 0.4, done(outcome, regime, 0.3))], Plot::MuStar);
        let marker = points(&chart.panels[0])[0].marker;
        assert_eq!((marker.shape, marker.is_hollow), (shape, is_hollow), "{outcome:?} {regime:?}");
        let in_legend = chart.legend.iter().any(|entry| {
            matches!(&entry.sample, Sample::Marker(own) if own.shape == shape && own.is_hollow == is_hollow)
        });
        assert!(in_legend, "{outcome:?} {regime:?}");
    }
}

/// Protects: a curve goes from left to right in any order of the jobs.
#[test]
fn a_curve_runs_from_left_to_right() {
    let rows = [50.0, 1.0, 20.0, 5.0].map(|omega| row(omega, 0.4, periodic(0.3)));
    let panel = panel(&rows, Plot::MuStar);
    assert_eq!(lines(&panel)[0].0, [1.0, 5.0, 20.0, 50.0].map(|omega| (omega, 0.3)));
}

/// Protects: of two jobs at one point both are drawn, and the curve goes through their mean.
#[test]
fn duplicates_are_both_drawn() {
    let rows = [
        row(5.0, 0.4, periodic(0.25)),
        row(7.0, 0.4, periodic(0.25)),
        row(7.0, 0.4, periodic(0.5)),
        row(9.0, 0.4, periodic(0.25)),
    ];
    let panel = panel(&rows, Plot::MuStar);
    assert_eq!(points(&panel).len(), 4);
    assert_eq!(lines(&panel)[0].0, [(5.0, 0.25), (7.0, 0.375), (9.0, 0.25)]);
}

/// Protects: the frequency curve is interrupted at a speed at which nothing oscillates.
#[test]
fn a_stable_job_interrupts_the_frequency_curve() {
    let state = |omega: f64| {
        if omega == 5.0 { done(Outcome::Decayed, Regime::Stable, 0.4) } else { periodic(0.3) }
    };
    let rows = [1.0, 2.0, 5.0, 10.0, 20.0].map(|omega| row(omega, 0.4, state(omega)));
    let panel = panel(&rows, Plot::Frequency);
    let curve = lines(&panel)[0].0;
    let lengths: Vec<usize> = curve.split(|(_, y)| !y.is_finite()).map(<[_]>::len).collect();
    assert_eq!(lengths, [2, 2]);
    assert_eq!(points(&panel).len(), 4);
}

/// Protects: a point has the standard error of its value, and none if that is no number. Measured points have their own and
/// crosses without lines.
#[test]
fn points_have_their_errors() {
    let errors = |error: f64| {
        let mut own = record(Outcome::Periodic, Regime::StickSlip, 0.35);
        own.mu_star_se = error;
        let rows = [row(7.0, 0.4, RowState::Done(Box::new(own))), measured(9.0, 0.4, 0.3, Some(0.01))];
        let panel = panel(&rows, Plot::MuStar);
        assert!(lines(&panel).is_empty() && points(&panel)[1].marker.shape == Shape::Cross);
        points(&panel).iter().map(|point| point.error).collect::<Vec<f64>>()
    };
    assert_eq!(errors(0.02), [0.02, 0.01]);
    assert_eq!(errors(f64::NAN), [0.0, 0.01]);
}

/// Protects: a result that is NaN has no marker, and the drawing has no NaN.
#[test]
fn a_result_that_is_not_finite_is_not_drawn() {
    let mut rows = partial_study();
    let count = |rows: &[JobRow]| coloured(&panel(rows, Plot::MuStar), COLOURS[1]).len();
    let before = count(&rows);
    rows[6].state = done(Outcome::NotPeriodic, Regime::Undecided, f64::NAN);
    assert_eq!(count(&rows), before - 1);
    let svg = &all(&rows, Plot::MuStar)[0].svg;
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

/// Protects: every combination has its panel with its own caption in one figure, and all panels have the same axes. With
/// more than twelve combinations there are more figures, each with a name of its own.
#[test]
fn each_combination_has_its_panel() {
    let named = |names: &[String]| -> Vec<JobRow> {
        let rows = names
            .iter()
            .map(|name| partial_study().into_iter().map(move |row| with(row, "note", name.as_str())));
        rows.flatten().collect()
    };
    let names = ["a/b", "a b", "<&\">"].map(str::to_owned);
    let chart = only(&named(&names), Plot::MuStar);
    let titles: Vec<&str> = chart.panels.iter().map(|panel| panel.title.as_str()).collect();
    assert_eq!(titles, ["note = a/b", "note = a b", "note = <&\">"]);
    for panel in &chart.panels {
        assert_eq!(coloured(panel, COLOURS[1]).len(), 5, "the results of every panel");
        assert_eq!((&panel.x, &panel.y), (&chart.panels[0].x, &chart.panels[0].y));
    }

    let many: Vec<String> = (0..25).map(|number| format!("n{number}")).collect();
    let all = all(&named(&many), Plot::MuStar);
    let parts: Vec<(&str, &str)> =
        all.iter().map(|figure| (figure.suffix.as_str(), figure.caption.as_str())).collect();
    let expected = [
        ("", "combinations 1 to 12 of 25"),
        ("-2", "combinations 13 to 24 of 25"),
        ("-3", "combinations 25 to 25 of 25"),
    ];
    assert_eq!(parts, expected);
}

/// Protects: a study without speeds has the names of another parameter on the axis, in the order of the study.
#[test]
fn a_named_parameter_makes_a_named_axis() {
    let names = ["whole_top", "inner_side", "both_ends"];
    let rows = names.map(|side| with(row(7.0, 0.4, periodic(0.35)), "clamp_side", side));
    let x = panel(&rows, Plot::MuStar).x;
    assert_eq!(x.axis, Axis::Names(names.map(str::to_owned).into()));
    assert_eq!(x.label, "clamp_side");
}

/// Protects: all curves have different colours, even if there are more of them than the palette has.
#[test]
fn many_coefficients_have_many_colours() {
    let rows: Vec<JobRow> = (1..=20)
        .flat_map(|k| [5.0, 7.0].map(|omega| row(omega, f64::from(k) * 0.05, periodic(f64::from(k) * 0.04))))
        .collect();
    let panel = panel(&rows, Plot::MuStar);
    let colours: HashSet<Rgb> = lines(&panel).iter().map(|(_, pen)| pen.colour).collect();
    assert_eq!(colours.len(), 20);
}

/// Protects: a figure without results says that there are none, and has no ticks that would suggest a scale.
#[test]
fn a_study_without_results_says_so() {
    for plot in [Plot::MuStar, Plot::Frequency, Plot::Shares, Plot::Bifurcation] {
        for rows in [vec![], vec![row(7.0, 0.4, RowState::Pending)]] {
            for panel in only(&rows, plot).panels {
                assert!(panel.layers.is_empty() && panel.note.contains("no results yet"), "{plot:?}");
                assert!(plot == Plot::Shares || panel.y.labelled_ticks().is_empty(), "{plot:?}");
            }
        }
    }
}

/// Protects: a curve has a band as wide as the mesh error, a single point has one too, and there is none where the error is unknown.
#[test]
fn the_error_of_the_mesh_is_a_band() {
    let error = after(row(2.0, 0.2, periodic(0.5)), 0.4, 14_500.0).mesh_error().unwrap().mu_star;
    assert!(error > 0.05, "{error}");
    let bands = |is_known: bool| {
        let rows = [(2.0, 0.2), (7.0, 0.2), (7.0, 0.4)].map(|(omega, mu)| {
            let row = row(omega, mu, periodic(0.5));
            if is_known { after(row, 0.4, 14_500.0) } else { row }
        });
        let chart = only(&rows, Plot::MuStar);
        let of = |colour| areas(&chart.panels[0], colour);
        (of(COLOURS[0]), of(COLOURS[1]), texts(&chart.legend).contains(&"mesh error"))
    };
    let (curve, point, legend) = bands(true);
    assert_eq!((curve.len(), point.len(), legend), (1, 1, true));
    let [low, high] = [0.5 - error, 0.5 + error];
    assert_eq!(curve[0].0, [(2.0, low), (7.0, low), (7.0, high), (2.0, high)]);
    assert_eq!(point[0].0.iter().map(|corner| corner.1).collect::<Vec<_>>(), [low, low, high, high]);
    let (curve, point, legend) = bands(false);
    assert_eq!((curve.len(), point.len(), legend), (0, 0, false));
}

/// Protects: a change of the sign of a growth rate is seen beside rates that are 10⁵ times as large.
#[test]
fn growth_rates_show_their_sign() {
    let rows = [(1.0, -1e5), (2.0, -1.0), (3.0, 1.0), (4.0, 1e5)].map(|(omega, rate)| {
        let mut own = record(Outcome::Decayed, Regime::Stable, 0.3);
        own.growth_rate_per_s = Some(rate);
        row(omega, 0.4, RowState::Done(Box::new(own)))
    });
    let axis = panel(&rows, Plot::Of(Scalar::find("growth_rate_per_s").expect("a scalar"))).y.axis;
    assert!(axis.place(1.0) - axis.place(-1.0) > 0.04, "{axis:?}");
    let frequencies = panel(&partial_study(), Plot::Frequency).y.axis;
    assert!(matches!(frequencies, Axis::Linear(_)), "{frequencies:?}");
}

/// Protects: the figure of shares has a panel for every friction coefficient. Areas connect neighbours in the grid, but
/// not across a job without a result, which has no tooltip either.
#[test]
fn shares_have_a_panel_for_each_mu() {
    let chart: Chart = only(&partial_study(), Plot::Shares);
    let titles: Vec<&str> = chart.panels.iter().map(|panel| panel.title.as_str()).collect();
    assert_eq!(titles, ["μ = 0.2", "μ = 0.3", "μ = 0.4"]);
    assert_eq!(chart.tips().count(), 14);
    // μ = 0.3 lacks 50 rpm: an area up to 10 rpm and a bar at 100. μ = 0.4 has 2 to 10 rpm.
    let stick: Vec<usize> = chart.panels.iter().map(|panel| areas(panel, BLUE).len()).collect();
    assert_eq!(stick, [1, 2, 1]);
    let tip = chart.tips().find(|tip| data(tip, "job") == "job-5-0.3").expect("a tooltip");
    assert_eq!(["stick", "slip", "separated"].map(|name| data(tip, name)), ["25", "50", "25"]);
    // Tooltips do not cover one another.
    let cells = chart.panels[0].layers.iter().find_map(|layer| match layer {
        Layer::Cells(cells) => Some(cells),
        _ => None,
    });
    assert!(cells.expect("cells").windows(2).all(|pair| pair[0].x[1] <= pair[1].x[0] * (1.0 + 1e-12)));
}

/// Protects: the shares of a study without speeds have bars at the names of its parameter.
#[test]
fn shares_of_names_are_bars() {
    let rows =
        ["whole_top", "inner_side"].map(|side| with(row(7.0, 0.4, periodic(0.35)), "clamp_side", side));
    let panel = panel(&rows, Plot::Shares);
    assert_eq!(areas(&panel, BLUE).len(), 2);
    assert!(matches!(panel.x.axis, Axis::Names(_)));
}

/// Protects: every job with a result has both residuals in the figure of the report, in the order of the study.
#[test]
fn residuals_are_those_of_all_jobs() {
    let rows = partial_study();
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    let svg = std::fs::read_to_string(folder.path().join("residuals.svg")).expect("the figure");
    for kind in ["energy_residual", "identity_residual"] {
        assert_eq!(svg.matches(&format!("data-kind=\"{kind}\"")).count(), 14);
    }
    assert!(svg.contains("data-job=\"job-100-0.3\" data-x=\"12\" data-y=\"1.5e-9\""));
}
