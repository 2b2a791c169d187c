//! A range of values of a parameter.

use super::limits::MAX_JOBS;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

/// Evenly spaced values of a parameter: `count` of them, or one at each `step`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["count"] }, { "required": ["step"] }]))]
pub(super) struct Range {
    /// First value.
    pub from: f64,
    /// Last value. With `step` it is the last one only if a whole number of steps leads to it.
    pub to: f64,
    /// Number of values including both ends: at least 2, or 1 when `from` equals `to`.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "usize", range(min = 1))]
    pub count: Option<usize>,
    /// Distance from value to value, instead of `count`; it is negative where `to` is less than `from`.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub step: Option<f64>,
    /// Equal steps (the default) or equal ratios.
    #[serde(default)]
    pub spacing: Spacing,
    /// Number of significant digits to which the values between the ends are rounded.
    #[serde(default = "most_digits")]
    #[schemars(range(min = 1, max = 12))]
    pub digits: usize,
}

/// How the values of a range, or the ticks of an axis, are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios; all values must be > 0.
    Log,
}

/// Largest number of significant digits of computed values. So the range from 0.1 to 0.6 contains 0.3 and not
/// 0.30000000000000004, and its job is the same job as that of a listed 0.3.
const MOST_DIGITS: usize = 12;

fn most_digits() -> usize {
    MOST_DIGITS
}

/// `"step": null` is a mistake and not the absence of a step.
fn present<'de, T: Deserialize<'de>, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

/// By how many steps the end of a range may be missed and still count as hit. The rounding of decimal numbers misses it by
/// less, up to a million steps of a millionth of the end.
const MISSED_STEPS: f64 = 1.0e-6;

/// Why a range has no usable values: the field that is wrong, and what is expected.
pub(super) struct Unusable {
    pub field: &'static str,
    pub expected: String,
}

impl Range {
    /// The values. The ends are exactly as given, and the values between them are rounded to [`Range::digits`].
    pub(super) fn values(&self) -> Result<Vec<f64>, Unusable> {
        if !(1..=MOST_DIGITS).contains(&self.digits) {
            return unusable("digits", format!("expected a number of digits from 1 to {MOST_DIGITS}"));
        }
        let values = match (self.count, self.step) {
            (Some(count), None) => self.counted(count)?,
            (None, Some(step)) => self.stepped(step)?,
            (Some(_), Some(_)) => return unusable("step", "expected either count or step".to_owned()),
            (None, None) => return unusable("", "expected `count` or `step`".to_owned()),
        };
        let ascends = self.from < self.to;
        if self.digits < MOST_DIGITS
            && let Some(pair) =
                values.windows(2).find(|pair| (pair[0] < pair[1]) != ascends || pair[0] == pair[1])
        {
            let [one, next] = [pair[0], pair[1]];
            let message = format!("after {one} comes {next}; expected more digits or fewer values");
            return unusable("digits", message);
        }
        Ok(values)
    }

    /// `count` values with equal steps or ratios.
    fn counted(&self, count: usize) -> Result<Vec<f64>, Unusable> {
        if count > MAX_JOBS {
            return unusable("count", format!("expected at most {MAX_JOBS} values"));
        }
        if self.from == self.to && count != 1 {
            return unusable("count", "expected 1, because from equals to".to_owned());
        }
        if self.from != self.to && count < 2 {
            return unusable("count", "expected at least 2, one for each end".to_owned());
        }
        if self.spacing == Spacing::Log {
            for (field, end) in [("from", self.from), ("to", self.to)] {
                if end <= 0.0 {
                    let expected = "expected a number > 0, because the spacing is logarithmic";
                    return unusable(field, expected.to_owned());
                }
            }
        }
        let last = count - 1;
        let between = |step: usize| {
            let share = step as f64 / last as f64;
            self.rounded(match self.spacing {
                Spacing::Linear => self.from * (1.0 - share) + self.to * share,
                Spacing::Log => (self.from.ln() * (1.0 - share) + self.to.ln() * share).exp(),
            })
        };
        let value = |step| match step {
            0 => self.from,
            step if step == last => self.to,
            step => between(step),
        };
        Ok((0..count).map(value).collect())
    }

    /// `from`, `from` + `step` … up to `to`.
    fn stepped(&self, step: f64) -> Result<Vec<f64>, Unusable> {
        if self.spacing == Spacing::Log {
            return unusable("step", "expected count instead, because the spacing is logarithmic".to_owned());
        }
        let steps = (self.to - self.from) / step;
        if step == 0.0 || !steps.is_finite() || steps < 1.0 - MISSED_STEPS {
            let (low, high) = if self.from < self.to { ("> 0", "at most") } else { ("< 0", "at least") };
            let distance = self.rounded(self.to - self.from);
            let message = if distance == 0.0 {
                "expected count = 1 instead, because from equals to".to_owned()
            } else {
                format!("expected a step {low} and {high} {distance}, which leads from `from` to `to`")
            };
            return unusable("step", message);
        }
        if steps + 1.0 > MAX_JOBS as f64 {
            return unusable("step", format!("expected a larger step, for at most {MAX_JOBS} values"));
        }
        let hits_end = (steps - steps.round()).abs() <= MISSED_STEPS;
        let last = if hits_end { steps.round() } else { steps.floor() } as usize;
        let value = |index| match index {
            0 => self.from,
            index if index == last && hits_end => self.to,
            index => self.rounded(self.from + index as f64 * step),
        };
        Ok((0..=last).map(value).collect())
    }

    fn rounded(&self, value: f64) -> f64 {
        format!("{value:.0$e}", self.digits - 1).parse().unwrap_or(value)
    }
}

fn unusable<T>(field: &'static str, expected: String) -> Result<T, Unusable> {
    Err(Unusable { field, expected })
}

/// Number of values of an axis as written. It is 1 for anything that is not an axis, and for a range that is too long
/// by itself: reading the axis gives a better message.
pub(super) fn axis_length(given: &Value) -> usize {
    let number = |name| given.get(name).and_then(Value::as_f64);
    let length = match given {
        Value::Array(list) => list.len() as f64,
        _ => number("count").unwrap_or_else(|| {
            let [from, to, step] = ["from", "to", "step"].map(|name| number(name).unwrap_or(f64::NAN));
            ((to - from) / step + MISSED_STEPS).floor() + 1.0
        }),
    };
    if (1.0..=MAX_JOBS as f64).contains(&length) { length as usize } else { 1 }
}
