//! A measured threshold of squeal: the value of a parameter below or above which the machine squeals, with its error.

use serde_json::Value;

/// Standard deviations from a threshold at which it is known whether the machine squeals.
const CERTAIN: f64 = 2.0;

/// Parameters of a point.
type Place = Vec<(String, Value)>;

/// What a line says about a threshold.
#[derive(Default)]
pub(super) struct Threshold {
    /// Whether the machine squeals below it, or else above it; none if the line has no threshold.
    pub squeals_below: Option<bool>,
    /// The errors of parameters.
    pub errors: Vec<(&'static str, f64)>,
}

impl Threshold {
    /// The points on both sides of the threshold, each with whether the machine squeals there. Returns `None` if the line has no
    /// threshold.
    ///
    /// # Errors
    /// What is wrong with the line.
    pub fn sides(&self, parameters: &Place, has_results: bool) -> Result<Option<[(Place, bool); 2]>, String> {
        let (Some(squeals_below), errors) = (self.squeals_below, self.errors.as_slice()) else {
            return match self.errors.first() {
                None => Ok(None),
                Some((name, _)) => Err(format!(
                    "the error of {name} is that of a threshold along it; expected squeals = below or above"
                )),
            };
        };
        if has_results {
            return Err("a threshold has no other result; expected a line of its own".to_owned());
        }
        let [(along, error)] = errors else {
            return Err(
                "a threshold needs its error in a column such as omega_error_rpm, of the one parameter along which it is"
                    .to_owned(),
            );
        };
        let value = parameters.iter().find(|(name, _)| name == along).and_then(|(_, value)| value.as_f64());
        let Some(value) = value else {
            return Err(format!("a threshold along {along} needs a value of {along}"));
        };
        let low = value - CERTAIN * error;
        if low <= 0.0 && value > 0.0 {
            return Err(format!(
                "{along} = {value} with an error of {error} says nothing; expected an error below half of the value"
            ));
        }
        let at = |x: f64, squeals| {
            let moved = |(name, own): &(String, Value)| {
                (name.clone(), if name == along { x.into() } else { own.clone() })
            };
            (parameters.iter().map(moved).collect(), squeals)
        };
        Ok(Some([at(low, squeals_below), at(value + CERTAIN * error, !squeals_below)]))
    }
}

#[cfg(test)]
mod tests {
    use crate::report::{JobRow, RowState};
    use crate::sweep::measured::parse;
    use serde_json::Value;

    /// Protects: a threshold is two points, two standard deviations away on both sides, of which one squeals; one without its error is
    /// refused.
    #[test]
    fn a_threshold_is_two_points() {
        for (side, squeals) in [("below", [Some(true), Some(false)]), ("above", [Some(false), Some(true)])] {
            let text = format!("omega_rpm,omega_error_rpm,mu,squeals\n80,4,0.3,{side}\n20,,0.3,yes\n");
            let found = parse(&text, "points.csv", "points").unwrap();
            let of = |row: &JobRow| match &row.state {
                RowState::Measured(own) => (row.parameters.get("omega_rpm").cloned(), own.squeals),
                _ => panic!("{row:?}"),
            };
            let [low, high] = [72.0, 88.0].map(|x| Some(Value::from(x)));
            let expected = [(low, squeals[0]), (high, squeals[1]), (Some(20.0.into()), Some(true))];
            assert_eq!(found.rows.iter().map(of).collect::<Vec<_>>(), expected, "{side}");
        }
        for (text, expected) in [
            (
                "omega_rpm,squeals\n80,below\n",
                "a threshold needs its error in a column such as omega_error_rpm",
            ),
            ("omega_rpm,omega_error_rpm,squeals\n80,50,below\n", "expected an error below half of the value"),
            ("omega_rpm,omega_error_rpm,squeals\n80,5,yes\n", "expected squeals = below or above"),
            ("omega_rpm,omega_error_rpm,squeals\n80,-5,below\n", "-5: expected an error > 0"),
            ("omega_rpm,omega_error_rpm,squeals\n,5,below\n", "needs a value of omega_rpm"),
            ("omega_rpm,omega_error_rpm,mu_star,squeals\n80,5,0.3,below\n", "has no other result"),
        ] {
            let message = parse(text, "points.csv", "points").unwrap_err().to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
