//! Whole texts for readers. `UPDATE_EXPECT=1 cargo test --test report texts` writes them again: read what changed.

#![allow(clippy::needless_raw_string_hashes, reason = "the macro writes them")]

use crate::synthetic::{after, done, partial_study, periodic, report, row};
use expect_test::{expect, expect_file};
use std::fs;
use tribosweep_mechanics::analysis::{Outcome, Regime};
use tribosweep_output::report::overview::overview;
use tribosweep_output::report::sensitivity::{markdown, sensitivities};
use tribosweep_output::report::{JobRow, RowState, Scalar, write};

/// Protects: the words of a report, in their order, for a study in progress that has every kind of job.
#[test]
fn a_report_reads_well() {
    let folder = tempfile::tempdir().unwrap();
    let after_coarser = |row: JobRow| match row.record() {
        Some(record) => {
            let coarser_mu_star = 0.98 * record.mu_star;
            after(row, coarser_mu_star, 14_500.0)
        }
        None => row,
    };
    let rows: Vec<JobRow> = partial_study().into_iter().map(after_coarser).collect();
    write(&report(&rows), folder.path()).unwrap();
    let page = fs::read_to_string(folder.path().join("report.md")).unwrap();
    expect_file!["partial_study.md"].assert_eq(&page);
}

/// Protects: the letters of a study on a terminal, with what they mean.
#[test]
fn an_overview_reads_well() {
    let text = anstream::adapter::strip_str(&overview(&partial_study(), 80)).to_string();
    expect![[r#"
        μ \ ω [rpm]   1   2   5  10  50 100
                0.4   >   K   K   x   .   .
                0.3   K   K   K   X   !   P
                0.2   S   S   S   S   S   S
        S stable  K stick–slip  X stick–slip–separation  ! failed  P slip–separation
        > running  x stick–slip–separation, not periodic  . pending
    "#]]
    .assert_eq(&text);
}

/// Protects: the words and the numbers of sensitivity indices on a full grid, where they are exact: μ\* is μ − ω/100 here.
#[test]
fn indices_read_well() {
    let point = |omega: i32, mu: i32| {
        let mu = f64::from(mu) / 10.0;
        row(f64::from(omega), mu, periodic(mu - 0.01 * f64::from(omega)))
    };
    let rows: Vec<JobRow> = (1..5).flat_map(|omega| (2..6).map(move |mu| point(omega, mu))).collect();
    let found = sensitivities(&rows, &[Scalar::find("mu_star").unwrap()], false);
    expect![[r#"
        ## macroscopic friction coefficient μ\*: 16 points

        | parameter | first order | total | PAWN  |
        | :-------- | :---------- | :---- | :---- |
        | mu        | 0.990       | 0.990 | 0.625 |
        | omega_rpm | 0.010       | 0.010 | 0.156 |

        - On this grid of 4 × 4 points, each of which counts the same, the indices have no sampling error.

        ## regime: 16 points

        | parameter | shares |
        | :-------- | :----- |
        | mu        | 0.000  |
        | omega_rpm | 0.000  |

        - On this grid of 4 × 4 points, each of which counts the same, the indices have no sampling error.
    "#]]
    .assert_eq(&markdown(&found));

    // A mean over no whole number of cycles counts, and this is said.
    let mut doubtful = rows;
    let RowState::Done(record) = &mut doubtful[0].state else { panic!("a result") };
    record.outcome = Outcome::NotPeriodic;
    let found = sensitivities(&doubtful, &[Scalar::find("mu_star").unwrap()], false);
    let words = markdown(&found);
    let said = "Doubt the results of 1 of 16 jobs: the motion is not periodic (1). They count here.";
    assert_eq!(words.matches(said).count(), 2, "{words}");
    // A run that is not periodic has no frequency.
    let found = sensitivities(&doubtful, &[Scalar::find("frequency_hz").unwrap()], false);
    let words = markdown(&found);
    assert!(words.contains("15 points") && words.contains("1 job without a value here"), "{words}");
    // Without a value there are no indices, and of one value there are none, too.
    let none: Vec<JobRow> = doubtful
        .iter()
        .cloned()
        .map(|row| JobRow { state: done(Outcome::NotPeriodic, Regime::StickSlip, 0.3), ..row })
        .collect();
    for (quantity, why) in
        [("frequency_hz", "no job has a value."), ("mu_star", "it is the same at all points.")]
    {
        let words = markdown(&sensitivities(&none, &[Scalar::find(quantity).unwrap()], false));
        assert!(words.contains(&format!("No PAWN and no first-order index: {why}")), "{words}");
    }
    // One parameter has all shares, and none is given.
    let alone: Vec<JobRow> = doubtful.into_iter().take(4).collect();
    let words = markdown(&sensitivities(&alone, &[Scalar::find("mu_star").unwrap()], false));
    assert!(
        words.matches("only mu varies, so everything depends on it alone").count() == 2
            && !words.contains("0."),
        "{words}"
    );
}
