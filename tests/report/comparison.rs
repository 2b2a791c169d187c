//! Several sources side by side: studies, and measured points.

use crate::charts::{self, only, texts};
use crate::synthetic::{measured, parameters, periodic, record, report, row};
use std::fs;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::publish::chart::Rgb;
use tribosweep_output::publish::chart::palette::{BLUE, VERMILLION};
use tribosweep_output::report::figure::Plot;
use tribosweep_output::report::tables::{self, Quantity};
use tribosweep_output::report::{
    JobRow, MeasuredValue, Measurement, Parameters, Report, RowState, View, write, write_compared,
};

/// A study called `name` at 1, 10 and 100 rpm, with μ* = `offset` + 0.01 log₁₀ ω and an error of 0.0005.
fn study(name: &str, offset: f64) -> Vec<JobRow> {
    let at = |omega: f64| {
        let job = row(omega, 0.4, periodic(offset + 0.01 * omega.log10()));
        JobRow { study: name.to_owned(), job: format!("{name}-{omega}"), ..job }
    };
    [1.0, 10.0, 100.0].map(at).into()
}

fn differences(rows: &[JobRow], view: &View) -> (Vec<csv::StringRecord>, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&Report { view, ..report(rows) }, folder.path()).expect("the report is written");
    let mut reader =
        csv::Reader::from_path(folder.path().join("differences.csv")).expect("a file of differences");
    let lines = reader.records().map(|line| line.expect("a line")).collect();
    (lines, fs::read_to_string(folder.path().join("report.md")).expect("a page"))
}

/// Protects: measured points are compared at equal speeds, and between neighbours with the value on the line that the figure
/// draws, with the error of both. A point outside is not compared, and this is said.
#[test]
fn measured_points_are_compared_with_the_study() {
    let mut rows = study("simulated", 0.3);
    let between = 10f64.sqrt();
    rows.extend([
        measured(10.0, 0.4, 0.33, Some(0.0012)),
        measured(between, 0.4, 0.3, None),
        measured(500.0, 0.4, 0.3, None),
    ]);
    let (lines, page) = differences(&rows, &View::default());
    let number = |line: &csv::StringRecord, column: usize| line[column].parse::<f64>().expect("a number");
    let mu_star: Vec<_> = lines.iter().filter(|line| &line[2] == "mu_star").collect();
    // source, reference, quantity, omega_rpm or mu …: the study has one μ, so only ω varies.
    let [first, second] = mu_star.as_slice() else { panic!("{lines:?}") };
    assert_eq!((&first[0], &first[1]), ("rig", "simulated"));
    let x = 3;
    assert_eq!(number(first, x), 10.0);
    // How far the simulation is above the measured value, as in the sentence.
    assert!((number(first, x + 5) + 0.02).abs() < 1e-12, "{first:?}");
    assert!((number(first, x + 7) + 0.02 / 0.33).abs() < 1e-12, "{first:?}");
    assert!((number(first, x + 6) - 0.0012f64.hypot(0.0005)).abs() < 1e-12, "{first:?}");
    assert_eq!(&first[x + 8], "no");
    // Half-way between 1 and 10 rpm on the logarithmic axis.
    assert!((number(second, x + 3) - 0.305).abs() < 1e-12, "{second:?}");
    assert!((number(second, x + 4) - 0.0005 * 0.5f64.sqrt()).abs() < 1e-12, "{second:?}");
    assert_eq!(&second[x + 8], "yes");
    assert!(
        page.contains(
            "1 of the 3 points of rig is at the parameters of a job of simulated; 1 is between two jobs"
        ),
        "{page}"
    );
    assert!(page.contains("## Comparison"), "{page}");
    // Who sees the verdict alone hears of it, too.
    let unmatched = |rows: &[JobRow]| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        write_compared(&report(rows), folder.path()).expect("the report is written").unmatched
    };
    let one = "1 of the 3 points of rig is compared with nothing: no finished job of simulated is at their parameters, or on both sides of them";
    assert_eq!(unmatched(&rows), [one]);
    rows.pop();
    assert_eq!(unmatched(&rows), Vec::<String>::new());
    // The points say nothing of a second study.
    let mut second = rows[0].clone();
    second.study = "second".to_owned();
    rows.push(second);
    assert_eq!(
        unmatched(&rows),
        [
            "measured points are compared with simulated alone; name another study first to compare them with that one"
        ]
    );
}

/// Protects: a comparison begins with how far the simulation is from the measured values, in which direction, and where it agrees.
#[test]
fn the_verdict_comes_first() {
    let verdicts = |points: &[JobRow]| {
        let mut rows = study("simulated", 0.3);
        rows.extend(points.iter().cloned());
        let folder = tempfile::tempdir().expect("a temporary folder");
        let written = write_compared(&report(&rows), folder.path()).expect("the report is written");
        let page = fs::read_to_string(folder.path().join("report.md")).expect("a page");
        let page = page.replace("\\*", "*");
        assert!(written.verdicts.iter().all(|verdict| page.contains(verdict)), "{page}");
        let chart = fs::read_to_string(folder.path().join("differences.svg")).expect("a figure");
        assert!(chart.contains("difference of μ* [%]"), "{chart}");
        written.verdicts
    };
    let at = |omega, mu_star, error| measured(omega, 0.4, mu_star, error);
    // The study has 0.30, 0.31 and 0.32 with an error of 0.0005.
    assert_eq!(
        verdicts(&[at(1.0, 0.4, Some(0.01)), at(10.0, 0.4, Some(0.01))])[0],
        "μ*: simulated is 24 % below rig at all 2 points (−25 % to −23 %); within two standard errors at 0 of 2."
    );
    assert_eq!(
        verdicts(&[at(1.0, 0.302, Some(0.01)), at(10.0, 0.305, Some(0.01))])[0],
        "μ*: simulated agrees with rig within two standard errors at all 2 points (−0.7 % to +1.6 %)."
    );
    assert_eq!(
        verdicts(&[at(1.0, 0.33, Some(0.001)), at(10.0, 0.311, Some(0.001)), at(100.0, 0.3, Some(0.001))])[0],
        "μ*: simulated differs from rig by −9.1 % to +6.7 %; within two standard errors at 1 of 3."
    );
    assert_eq!(
        verdicts(&[at(10.0, 0.2, Some(0.001))])[0],
        "μ*: simulated is 55 % above rig at the one point that is compared; not within two standard errors."
    );
}

/// Protects: the verdict says which parameters of another study could move the quantity the right way, from which value to which and by how
/// much. What moves it by less than a tenth of the difference is named as such, and the speed along the axis explains nothing. Where that study
/// says nothing, the verdict says why: it has no jobs, varies the axis alone, or has values that follow no plane.
#[test]
fn a_verdict_names_what_could_move_it() {
    let mut rows = study("simulated", 0.3);
    rows.extend([measured(1.0, 0.4, 0.25, Some(0.001)), measured(10.0, 0.4, 0.26, Some(0.001))]);
    // Its mean is 0.84. It falls by 0.04 with E, rises by 0.02 with the load, and hardly depends on the width of the clamp.
    let plane = |omega: f64, modulus: f64, load: f64, width: f64| {
        0.3 + 0.1 * omega - 0.04e-9 * modulus + 0.002 * load + 0.5 * width
    };
    let variation = |mu_star: &dyn Fn(f64, f64, f64, f64) -> f64| -> Vec<JobRow> {
        let job = |i: usize| {
            let (omega, modulus) = ([1.0, 10.0][i % 2], [1e9, 2e9][i / 2 % 2]);
            let (load, width) = ([20.0, 30.0][i / 4 % 2], [0.001, 0.002][i / 8]);
            let mut job = row(omega, 0.4, periodic(mu_star(omega, modulus, load, width)));
            let grid = [
                ("omega_rpm", omega),
                ("young_modulus_pa", modulus),
                ("load_n", load),
                ("clamp_width_m", width),
            ];
            let grid = grid.map(|(name, x)| (name.to_owned(), x.into())).into();
            job.parameters = Parameters::new(f64::NAN, 0.4, grid);
            job
        };
        (0..16).map(job).collect()
    };
    let verdict = |variation: &[JobRow]| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let report = Report { sensitivity: Some(("scan", variation)), ..report(&rows) };
        write_compared(&report, folder.path()).expect("the report is written").verdicts.remove(0)
    };
    let all = variation(&plane);
    assert_eq!(
        verdict(&all),
        "μ*: simulated is 20 % above rig at all 2 points (+19 % to +20 %); within two standard errors at 0 of 2. In scan, a larger \
         young_modulus_pa (1 GPa to 2 GPa: −4.8 %) lowers it, and so does a smaller load_n (30 N to 20 N: −2.4 %); clamp_width_m hardly \
         moves it."
    );
    // A sample that is no grid gives the same plane.
    let (some, _) = all.split_at(13);
    assert!(verdict(some).contains("a larger young_modulus_pa (1 GPa to 2 GPa: −"), "{}", verdict(some));
    let of =
        |name: &'static str, value: f64| move |job: &JobRow| job.parameters.get(name) == Some(&value.into());
    let mut of_width = all.clone();
    of_width.retain(|job| of("young_modulus_pa", 1e9)(job) && of("load_n", 20.0)(job));
    let mut of_axis = of_width.clone();
    of_axis.retain(of("clamp_width_m", 0.001));
    let bent = variation(&|_, modulus, load, _| 0.3 + 1e-10 * (modulus - 1.5e9) * (load - 25.0));
    let flat = variation(&|_, _, _, _| 0.3);
    let mut together = all.clone();
    together.retain(|job| of("young_modulus_pa", 1e9)(job) == of("load_n", 20.0)(job));
    for (jobs, expected) in [
        (&of_width, " Nothing that scan varies moves it by a tenth of that."),
        (&Vec::new(), " What could move it is not known: scan has no finished job with this quantity."),
        (&of_axis, " What could move it is not known: scan varies no parameter but that along the axis."),
        (
            &bent,
            " What could move it is not known: scan has values that follow no plane over its parameters.",
        ),
        (&flat, " Nothing that scan varies moves it by a tenth of that."),
        (
            &together,
            " What could move it is not known: scan varies parameters together, whose parts cannot be told apart.",
        ),
    ] {
        assert!(verdict(jobs).ends_with(expected), "{expected}: {}", verdict(jobs));
    }
}

/// Protects: the export beside a comparison has what was measured, with its error, under the names of what was computed.
#[test]
fn measured_values_are_in_the_export() {
    let mut rows = study("simulated", 0.3);
    rows.push(measured(10.0, 0.4, 0.33, Some(0.0012)));
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    for file in ["jobs.csv", "mu_star_points.csv"] {
        let mut lines = csv::Reader::from_path(folder.path().join(file)).expect("a table");
        let heads = lines.headers().expect("a head").clone();
        let own = lines.records().map(Result::unwrap).find(|line| line.iter().any(|cell| cell == "measured"));
        let own = own.expect("the measured point");
        let cell = |name: &str| &own[heads.iter().position(|head| head == name).expect("a column")];
        assert_eq!([cell("mu_star"), cell("mu_star_se")], ["0.33", "0.0012"], "{file}");
    }
}

/// Protects: two studies are compared at equal points, each with columns, curves and an entry in the legend of its own. Jobs
/// without a counterpart are said.
#[test]
fn studies_are_compared() {
    let mut rows = study("a", 0.3);
    rows.extend(study("b", 0.31).into_iter().take(2));
    let (lines, page) = differences(&rows, &View::default());
    let mu_star = lines.iter().filter(|line| &line[2] == "mu_star");
    let found: Vec<f64> = mu_star.map(|line| line[line.len() - 4].parse().expect("a number")).collect();
    assert!(
        found.len() == 2 && found.iter().all(|difference| (difference - 0.01).abs() < 1e-12),
        "{found:?}"
    );
    assert!(page.contains("1 of the 3 jobs of a have no counterpart in b"), "{page}");
    let table = tables::markdown(&rows, Quantity::MuStar);
    assert!(table.contains("|     a |     b |") && table.contains("|     100 | 0.320 |     – |"), "{table}");
    let chart = only(&rows, Plot::MuStar);
    let texts = texts(&chart.legend);
    assert!(texts.contains(&"source") && texts.contains(&"a") && texts.contains(&"b"), "{texts:?}");
    let colours: Vec<Rgb> = charts::lines(&chart.panels[0]).iter().map(|(_, pen)| pen.colour).collect();
    assert_eq!(colours, [BLUE, VERMILLION], "a colour for each study");
}

/// Protects: with several μ the colour is μ, and each source has a line or mark of its own. A measured point of unknown μ is
/// compared with every curve. Maps show the jobs alone.
#[test]
fn a_point_of_unknown_friction_is_compared_with_every_curve() {
    let mut rows = study("simulated", 0.3);
    rows.extend(study("simulated", 0.2).into_iter().map(|job| JobRow {
        parameters: parameters(job.parameters.omega_rpm(), 0.3),
        job: format!("{}-low", job.job),
        ..job
    }));
    rows.push(measured(10.0, f64::NAN, 0.25, Some(0.01)));
    let (lines, _) = differences(&rows, &View::default());
    let mus: Vec<&str> = lines.iter().filter(|line| &line[2] == "mu_star").map(|line| &line[3]).collect();
    assert_eq!(mus, ["0.3", "0.4"]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&rows), folder.path()).expect("the report is written");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    assert_eq!(read("mu_star.svg").matches("data-job").count(), 7);
    assert_eq!(read("regime_map.svg").matches("data-job").count(), 6);
    assert!(read("report.md").contains("0.250 ± 0.010"), "{}", read("report.md"));
    // 0.21 is 16 % below 0.25, and 0.31 is 24 % above it.
    let nearest = "Of 2 curves, μ = 0.3, simulated is the nearest by the mean square: −16 %.";
    assert!(read("report.md").contains(nearest), "{}", read("report.md"));
    assert!(read("report.md").contains("jobs done: 6 of 6"), "a measured point is no job");
}

/// Protects: a report of one source has no comparison.
#[test]
fn one_study_has_no_comparison() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&[row(7.0, 0.4, RowState::Pending)]), folder.path()).expect("the report is written");
    assert!(!folder.path().join("differences.csv").exists());
}

/// Protects: a measured frequency beside a job that is not periodic is not compared with its mean rate, and this is said; its μ\* is
/// compared.
#[test]
fn a_frequency_beside_a_job_that_is_not_periodic_is_not_compared() {
    let value = |name: &str, value| MeasuredValue { name: name.to_owned(), value, error: None };
    let values = vec![value("mu_star", 0.3), value("frequency_hz", 14_000.0)];
    let state = RowState::Measured(Measurement { values, squeals: Some(true) });
    let mut rows = study("simulated", 0.3);
    let RowState::Done(record) = &mut rows[1].state else { panic!("a result") };
    record.outcome = Outcome::NotPeriodic;
    rows.push(JobRow { state, ..measured(10.0, 0.4, 0.3, None) });
    let folder = tempfile::tempdir().expect("a temporary folder");
    let found = write_compared(&report(&rows), folder.path()).expect("the report is written");
    let said = "1 value of frequency_hz in rig is compared with nothing: a job of simulated at its place, or on one side, has no such \
                value, because it slides steadily, is not periodic, or has modes alone";
    let squeal = "whether rig squeals is compared at none of its points: they lie beyond the jobs of simulated, between one that squeals and \
                  one that does not, or at one that is not periodic";
    assert_eq!(found.unmatched, [said, squeal]);
    let [mu_star] = &*found.verdicts else { panic!("{:?}", found.verdicts) };
    assert_eq!(
        mu_star,
        "μ*: simulated is 3.3 % above rig at the one point that is compared; the errors of the measured values are not given. The motion is not periodic there."
    );
    // Another job, beside no measured point, does not count.
    for (at, outcome) in [(0, Outcome::NotPeriodic), (1, Outcome::Periodic)] {
        let RowState::Done(record) = &mut rows[at].state else { panic!("a result") };
        record.outcome = outcome;
    }
    let found = write_compared(&report(&rows), folder.path()).expect("the report is written");
    assert!(!found.verdicts.iter().any(|words| words.contains("not periodic")), "{:?}", found.verdicts);
    // An instrument does not measure μ* of sliding that is unstable.
    let RowState::Done(record) = &mut rows[1].state else { panic!("a result") };
    record.outcome = Outcome::Unstable;
    let found = write_compared(&report(&rows), folder.path()).expect("the report is written");
    let of = |name: &str| {
        found.unmatched.iter().any(|words| words.starts_with(&format!("1 value of {name} in rig")))
    };
    assert!(of("mu_star") && !found.verdicts.iter().any(|words| words.starts_with("μ*")), "{found:?}");
}

/// Protects: two vibrations at frequencies far apart are not called one squeal, and two that are near are.
#[test]
fn squeal_at_another_frequency_is_said() {
    let of_squeal = |frequency_hz: f64| {
        let value = |name: &str, value| MeasuredValue { name: name.to_owned(), value, error: None };
        let values = vec![value("mu_star", 0.3), value("frequency_hz", frequency_hz)];
        let state = RowState::Measured(Measurement { values, squeals: Some(true) });
        let rows =
            [study("simulated", 0.3), vec![JobRow { state, ..measured(10.0, 0.4, 0.3, None) }]].concat();
        let folder = tempfile::tempdir().expect("a temporary folder");
        write_compared(&report(&rows), folder.path()).expect("the report is written").verdicts.pop()
    };
    let agrees = "squeal: simulated and the others agree at the one point where both are known";
    let apart = ", but frequencies differ by more than 10 % at 1 of 1 point: it may be another squeal";
    // The study has 14.5 kHz.
    assert_eq!(of_squeal(6_200.0), Some(format!("{agrees}{apart}.")));
    assert_eq!(of_squeal(14_000.0), Some(format!("{agrees}.")));
}

/// Protects: what squeals in one source and not in the other comes first, in the file, on both pages and for the caller, at equal speeds
/// and between neighbours that agree; where one of the two does not say it, nothing is said.
#[test]
fn contradictions_about_squeal_come_first() {
    let mut rows = study("simulated", 0.3);
    rows.push(JobRow {
        study: "simulated".to_owned(),
        job: "stable".to_owned(),
        ..row(200.0, 0.4, RowState::Done(Box::new(record(Outcome::Decayed, Regime::Stable, 0.4))))
    });
    let at = |omega: f64, squeals: Option<bool>| {
        let RowState::Measured(measurement) = measured(omega, 0.4, 0.33, None).state else { unreachable!() };
        JobRow {
            state: RowState::Measured(Measurement { squeals, ..measurement }),
            ..measured(omega, 0.4, 0.33, None)
        }
    };
    rows.extend([
        at(1.0, Some(true)),
        at(5.0, Some(false)),
        at(150.0, Some(false)),
        at(200.0, Some(true)),
        at(100.0, None),
    ]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = write_compared(&report(&rows), folder.path()).expect("the report is written");
    assert_eq!(
        written.contradictions,
        [
            "Squeal is contradicted at 2 of 3 points where both say whether it squeals:",
            "omega_rpm = 5: rig (measured) does not squeal, and simulated squeals on both sides",
            "omega_rpm = 200: rig (measured) squeals, and simulated is stable",
        ]
    );
    let (lines, markdown) = differences(&rows, &View::default());
    let first: Vec<(&str, &str)> = lines.iter().take(3).map(|line| (&line[2], &line[4])).collect();
    assert_eq!(first[..2], [("squeals", "0"), ("squeals", "1")]);
    assert_eq!(first[2].0, "mu_star");
    let html = fs::read_to_string(folder.path().join("report.html")).expect("a page");
    for page in [markdown, html] {
        let place = |part: &str| page.find(part).unwrap_or_else(|| panic!("no {part}"));
        assert!(place("Squeal is contradicted at 2 of 3") < place("points of rig are at the parameters"));
        // Before the first section.
        let heading =
            if page.starts_with('<') { "<h2>Macroscopic friction</h2>" } else { "## Macroscopic friction\n" };
        assert!(place("Squeal is contradicted at 2 of 3") < place(heading));
    }
}

/// Protects: a file of many measured points is compared as a whole, and tables and figures show an even part of it and say so.
#[test]
fn many_measured_points_stay_readable() {
    let mut rows = study("simulated", 0.3);
    let count = 5000;
    rows.extend((0..count).map(|point| measured(1.0 + 0.01 * f64::from(point), 0.4, 0.33, None)));
    let (lines, page) = differences(&rows, &View::default());
    assert_eq!(lines.iter().filter(|line| &line[2] == "mu_star").count(), count as usize);
    assert!(page.contains("Tables and figures show 1667 of the 5000 measured points"), "{}", &page[..3000]);
    assert!(page.lines().count() < 6000, "{}", page.lines().count());
}
