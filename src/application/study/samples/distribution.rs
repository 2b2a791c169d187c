//! How the values of a parameter are distributed.

use crate::study::parameter::Kind;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::f64::consts::SQRT_2;

/// Number of significant digits of a drawn value. So it is the same number in every text.
const DIGITS: usize = 9;

/// The distribution of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(in crate::study) enum Distribution {
    /// Equally likely between the two ends.
    Uniform([f64; 2]),
    /// Equally likely logarithms between those of the two ends, both > 0.
    LogUniform([f64; 2]),
    /// A normal distribution: mean and standard deviation.
    Normal([f64; 2]),
    /// A normal distribution that is cut off: mean, standard deviation, lower and upper limit.
    TruncatedNormal([f64; 4]),
    /// One of these values, all equally likely.
    Discrete(Vec<Value>),
}

impl JsonSchema for Distribution {
    fn schema_name() -> Cow<'static, str> {
        "Distribution".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let numbers = |what: &str, count: usize| json!({ "description": what, "type": "array", "items": { "type": "number" }, "minItems": count, "maxItems": count });
        let properties = json!({
            "uniform": numbers("Equally likely between the two ends.", 2),
            "log_uniform": numbers("Equally likely logarithms between those of the two ends, both > 0.", 2),
            "normal": numbers("A normal distribution: mean and standard deviation.", 2),
            "truncated_normal":
                numbers("A normal distribution that is cut off: mean, standard deviation, lower and upper limit.", 4),
            "discrete": { "description": "One of these values, all equally likely.", "type": "array", "minItems": 1 },
        });
        let names = properties.as_object().into_iter().flat_map(|fields| fields.keys());
        let one_of: Vec<Value> = names.map(|name| json!({ "required": [name] })).collect();
        json_schema!({
            "description": "The distribution of a parameter.",
            "type": "object",
            "properties": properties,
            "additionalProperties": false,
            "oneOf": one_of,
        })
    }
}

impl Distribution {
    /// What is wrong with it for a parameter of this kind.
    pub fn problem(&self, kind: &Kind) -> Option<String> {
        let is_number = matches!(kind, Kind::Number | Kind::Count);
        if !is_number && !matches!(self, Self::Discrete(_)) {
            return Some(
                "expected `discrete` with a list of values, because this parameter is no number".to_owned(),
            );
        }
        let (holds, right) = match self {
            Self::Uniform([low, high]) => (low < high, "two numbers, the smaller one first"),
            Self::LogUniform([low, high]) => {
                (*low > 0.0 && low < high, "two numbers > 0, the smaller one first")
            }
            Self::Normal([_, deviation]) => (*deviation > 0.0, "a mean and a standard deviation > 0"),
            Self::TruncatedNormal([mean, deviation, low, high]) => (
                *deviation > 0.0
                    && low < high
                    && (high - mean) / deviation > -MOST_DEVIATIONS
                    && (low - mean) / deviation < MOST_DEVIATIONS,
                "mean, standard deviation > 0, lower and upper limit, within 8 standard deviations of the mean",
            ),
            Self::Discrete(values) => (!values.is_empty(), "at least one value"),
        };
        (!holds).then(|| format!("expected {right}"))
    }

    /// The share of the distribution below a value: the inverse of [`Distribution::value`]. That of a value of a list is 0.
    pub fn share(&self, value: f64) -> f64 {
        let share = match self {
            Self::Uniform([low, high]) => (value - low) / (high - low),
            Self::LogUniform([low, high]) => libm::log(value / low) / libm::log(high / low),
            Self::Normal([mean, deviation]) => normal_share((value - mean) / deviation),
            Self::TruncatedNormal([mean, deviation, low, high]) => {
                let [at, from, to] = [&value, low, high].map(|x| normal_share((x - mean) / deviation));
                (at - from) / (to - from)
            }
            Self::Discrete(_) => 0.0,
        };
        share.clamp(0.0, 1.0)
    }

    /// Whether it has two ends, which a design with levels needs.
    pub fn is_bounded(&self) -> bool {
        !matches!(self, Self::Normal(_))
    }

    /// The value below which a share `u` of the distribution lies, 0 ≤ u ≤ 1 (0 < u < 1 for a normal distribution).
    pub fn value(&self, u: f64, kind: &Kind) -> Value {
        let number = match self {
            Self::Uniform([low, high]) => low * (1.0 - u) + high * u,
            Self::LogUniform([low, high]) => libm::exp(libm::log(*low) * (1.0 - u) + libm::log(*high) * u),
            Self::Normal([mean, deviation]) => mean + deviation * normal_quantile(u),
            Self::TruncatedNormal([mean, deviation, low, high]) => {
                let [from, to] = [low, high].map(|limit| normal_share((limit - mean) / deviation));
                (mean + deviation * normal_quantile(from * (1.0 - u) + to * u)).clamp(*low, *high)
            }
            Self::Discrete(values) => {
                let place = (u * values.len() as f64) as usize;
                return values[place.min(values.len() - 1)].clone();
            }
        };
        if matches!(kind, Kind::Count) {
            return Value::from(number.round().max(0.0) as u64);
        }
        Value::from(format!("{number:.0$e}", DIGITS - 1).parse().unwrap_or(number))
    }
}

/// A normal distribution has no values beyond so many standard deviations here.
const MOST_DEVIATIONS: f64 = 8.0;

/// The share of a standard normal distribution below x.
fn normal_share(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// The inverse of [`normal_share`], by bisection and Newton's method: exact to rounding, and the same on every machine.
fn normal_quantile(share: f64) -> f64 {
    let (mut low, mut high) = (-MOST_DEVIATIONS, MOST_DEVIATIONS);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if normal_share(middle) < share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: quantiles are those of tables of the normal distribution, and shares of the others are linear.
    #[test]
    fn values_are_quantiles() {
        let number = |distribution: &Distribution, u| distribution.value(u, &Kind::Number).as_f64().unwrap();
        let normal = Distribution::Normal([10.0, 2.0]);
        // Abramowitz and Stegun, table 26.5: 0.975 ↔ 1.959964, 0.9 ↔ 1.281552.
        for (u, deviations) in [(0.5, 0.0), (0.975, 1.959_964), (0.1, -1.281_552)] {
            assert!((number(&normal, u) - (10.0 + 2.0 * deviations)).abs() < 2e-6, "{u}");
        }
        let truncated = Distribution::TruncatedNormal([10.0, 2.0, 8.0, 12.0]);
        assert_eq!([0.0, 0.5, 1.0].map(|u| number(&truncated, u)), [8.0, 10.0, 12.0]);
        assert_eq!(number(&Distribution::Uniform([1.0, 3.0]), 0.25), 1.5);
        assert_eq!(number(&Distribution::LogUniform([1.0, 100.0]), 0.5), 10.0);
        let discrete = Distribution::Discrete(vec![1.into(), 2.into(), 4.into()]);
        assert_eq!([0.0, 0.32, 0.34, 0.99, 1.0].map(|u| number(&discrete, u)), [1.0, 1.0, 2.0, 4.0, 4.0]);
        assert_eq!(Distribution::Uniform([4.0, 9.0]).value(0.5, &Kind::Count), Value::from(7));
        // Shares are the inverse, to the digits that a value has.
        let others = [Distribution::Uniform([-1.0, 3.0]), Distribution::LogUniform([1.0e9, 4.0e9])];
        for own in [normal, truncated].iter().chain(&others) {
            for u in [0.01, 0.3, 0.5, 0.99] {
                assert!((own.share(number(own, u)) - u).abs() < 1e-7, "{own:?} {u}");
            }
        }
    }
}
