//! The evidence of a case. It is judged by one of four criteria and written down for `docs/evidence/verification.md`.
//!
//! * **Exact**: the scheme reproduces the answer. The error may only be rounding, and its bound counts
//!   operations.
//! * **Convergent**: there are at least three resolutions, each `ratio` times finer than the last. The finest
//!   observed order lies within [`ORDER_SLACK`] of the order that the scheme's analysis gives. The limit is
//!   extrapolated with that order. It differs from the exact answer by no more than the last two
//!   extrapolations differ from each other (plus rounding).
//! * **Convergent overall**: fronts and impacts make single orders irregular. The slope of the error from the
//!   coarsest to the finest of at least three resolutions reaches the analysed order (less [`ORDER_SLACK`]).
//!   The limit is not judged.
//! * **Bounded**: each error is below a bound that follows from an analysis of the scheme at that resolution.
//!
//! Every case is written as one JSON file to the folder that `TRIBOSWEEP_VERIFICATION` names. It is written
//! before it is judged, so that a failing case is in the document, too.

use serde_json::json;
use std::cell::Cell;
use std::fs;
use std::path::PathBuf;

/// The benchmark of the tests of the criteria. They write no evidence.
pub const MADE_UP: &str = "made up";

/// An observed order may differ by this from the expected one: 0.75 to 1.25 is first order, 1.75 to 2.25
/// second.
pub const ORDER_SLACK: f64 = 0.25;

/// One case: a quantity with an exact answer, and the values found at one or more resolutions.
#[derive(Debug)]
#[must_use]
pub struct Evidence {
    benchmark: &'static str,
    quantity: String,
    source: &'static str,
    rows: Vec<Row>,
    judged: Cell<bool>,
}

/// A case that is not judged is a test that cannot fail.
impl Drop for Evidence {
    fn drop(&mut self) {
        assert!(self.judged.get() || std::thread::panicking(), "{}: found, but not judged", self.quantity);
    }
}

#[derive(Debug)]
struct Row {
    resolution: String,
    found: f64,
    exact: f64,
    /// Relative to `scale` where one is set.
    error: f64,
    bound: Option<f64>,
}

impl Evidence {
    /// A case of `benchmark` ("B1" …). `quantity` includes the unit, and `source` is that of the exact
    /// answer.
    pub fn new(benchmark: &'static str, quantity: impl Into<String>, source: &'static str) -> Self {
        Self { benchmark, quantity: quantity.into(), source, rows: Vec::new(), judged: Cell::new(false) }
    }

    /// Adds the value found at a resolution. `scale` makes the error relative. It is the exact value itself,
    /// or the size of the terms that cancel in it.
    pub fn found(&mut self, resolution: impl Into<String>, found: f64, exact: f64, scale: f64) -> &mut Self {
        let error = (found - exact).abs() / scale.abs();
        self.rows.push(Row { resolution: resolution.into(), found, exact, error, bound: None });
        self
    }

    /// As [`Self::found`], but with a bound of the error at this resolution.
    pub fn bounded(
        &mut self,
        resolution: impl Into<String>,
        found: f64,
        exact: f64,
        scale: f64,
        bound: f64,
    ) -> &mut Self {
        self.found(resolution, found, exact, scale);
        self.rows.last_mut().expect("just pushed").bound = Some(bound);
        self
    }

    /// Judges: every error is rounding, at most `operations` roundings of the scale.
    pub fn judge_exact(mut self, operations: f64) {
        let bound = operations * f64::EPSILON;
        for row in &mut self.rows {
            row.bound = Some(bound);
        }
        self.judge(&format!("exact: at most {operations:.0} roundings"), &json!({}));
    }

    /// Judges: every error is below its bound. `why` names the origin of the bounds.
    pub fn judge_bounded(self, why: &str) {
        assert!(
            self.rows.iter().all(|row| row.bound.is_some()),
            "{}: every row needs a bound",
            self.quantity
        );
        self.judge(&format!("bounded: {why}"), &json!({}));
    }

    /// Judges: the rows, each `ratio` times finer than the last, converge with `order` to the exact
    /// answer. `rounding` is the relative error that rounding may leave in a row.
    pub fn judge_order(self, order: f64, ratio: f64, rounding: f64) {
        let errors: Vec<f64> = self.rows.iter().map(|row| row.error).collect();
        assert!(errors.len() >= 3, "{}: an order takes three resolutions", self.quantity);
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).ln() / ratio.ln()).collect();
        // The signed errors, relative to the scale, are extrapolated pair by pair. The result is the error of
        // the limit.
        let signed: Vec<f64> =
            self.rows.iter().map(|row| row.error.copysign(row.found - row.exact)).collect();
        let gain = ratio.powf(order);
        let limits: Vec<f64> = signed.windows(2).map(|e| (gain * e[1] - e[0]) / (gain - 1.0)).collect();
        let [.., before, last] = limits[..] else { unreachable!("three resolutions give two limits") };
        let allowed = (last - before).abs() + rounding;
        self.judge(
            &format!("order {order}"),
            &json!({ "orders": orders, "limit_error": last, "limit_allowed": allowed }),
        );
        let finest = orders[orders.len() - 1];
        assert!(
            (finest - order).abs() <= ORDER_SLACK,
            "{}: observed orders {orders:.3?} instead of {order}, errors {errors:?}",
            self.quantity
        );
        assert!(
            last.abs() <= allowed,
            "{}: the extrapolated limit is {last:e} off, {allowed:e} allowed",
            self.quantity
        );
    }

    /// Judges: from the coarsest to the finest of the rows, each `ratio` times finer than the last, the error
    /// falls at least with `order`. `why` says why no single order can be expected.
    pub fn judge_overall_order(self, order: f64, ratio: f64, why: &str) {
        let errors: Vec<f64> = self.rows.iter().map(|row| row.error).collect();
        assert!(errors.len() >= 3, "{}: an order takes three resolutions", self.quantity);
        let steps = (errors.len() - 1) as f64;
        let slope = (errors[0] / errors[errors.len() - 1]).ln() / (steps * ratio.ln());
        self.judge(&format!("order {order} overall: {why}"), &json!({ "overall_order": slope }));
        assert!(
            slope >= order - ORDER_SLACK,
            "{}: overall order {slope:.3} instead of {order}, errors {errors:?}",
            self.quantity
        );
    }

    fn judge(&self, criterion: &str, more: &serde_json::Value) {
        self.judged.set(true);
        self.write(criterion, more);
        assert!(!self.rows.is_empty(), "{}: nothing was found", self.quantity);
        for row in &self.rows {
            assert!(row.error.is_finite(), "{} at {}: {} found", self.quantity, row.resolution, row.found);
            if let Some(bound) = row.bound {
                assert!(
                    row.error <= bound,
                    "{} at {}: found {:e} instead of {:e}, error {:e} above {bound:e}",
                    self.quantity,
                    row.resolution,
                    row.found,
                    row.exact,
                    row.error
                );
            }
        }
    }

    fn write(&self, criterion: &str, more: &serde_json::Value) {
        let Some(folder) = std::env::var_os("TRIBOSWEEP_VERIFICATION").map(PathBuf::from) else { return };
        if self.benchmark == MADE_UP {
            return;
        }
        let rows: Vec<_> = self
            .rows
            .iter()
            .map(|row| {
                json!({
                    "resolution": row.resolution, "found": row.found, "exact": row.exact,
                    "error": row.error, "bound": row.bound,
                })
            })
            .collect();
        let case = json!({
            "benchmark": self.benchmark, "quantity": self.quantity, "source": self.source,
            "criterion": criterion, "rows": rows, "convergence": more,
        });
        let name: String = format!("{} {}", self.benchmark, self.quantity)
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
            .collect();
        fs::create_dir_all(&folder).expect("the folder for the evidence");
        fs::write(folder.join(format!("{name}.json")), format!("{case:#}\n"))
            .expect("the evidence is written");
    }
}
