//! Protects: the criteria of `evidence` themselves can fail.

use crate::verification::evidence::{Evidence, MADE_UP};

fn series(errors: [f64; 3]) -> Evidence {
    let mut evidence = Evidence::new(MADE_UP, "a made-up series", "made up");
    for error in errors {
        evidence.found("", 1.0 + error, 1.0, 1.0);
    }
    evidence
}

#[test]
fn second_order_with_a_fourth_order_rest_passes() {
    series([0.01 + 0.001, 0.0025 + 0.001 / 16.0, 0.000_625 + 0.001 / 256.0]).judge_order(2.0, 2.0, 0.0);
}

#[test]
#[should_panic(expected = "observed orders")]
fn first_order_is_not_second() {
    series([0.01, 0.005, 0.0025]).judge_order(2.0, 2.0, 0.0);
}

#[test]
#[should_panic(expected = "extrapolated limit")]
fn a_wrong_limit_is_noticed() {
    // The errors converge towards 0.9999 with second order. The order still looks right, but the limit is
    // wrong.
    series([0.04 - 1e-4, 0.01 - 1e-4, 0.0025 - 1e-4]).judge_order(2.0, 2.0, 0.0);
}

#[test]
#[should_panic(expected = "above")]
fn rounding_is_counted() {
    series([0.0, 0.0, 1e-13]).judge_exact(100.0);
}
