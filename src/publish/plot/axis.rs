//! Axes with ticks at round numbers.

use crate::publish::value;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use serde_json::Value;
use std::ops::Range;

/// An axis of a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Logarithmic, for positive numbers.
    Log(Range<f64>),
    /// Linear.
    Linear(Range<f64>),
    /// Names, equally spaced at 0, 1, 2 …
    Names(Vec<String>),
}

/// Up to so many decades, ticks are at 1, 2 and 5 of each; beyond, they are at whole decades.
const FINE_DECADES: f64 = 5.0;
/// Number of ticks that a linear axis should have.
const LINEAR_TICKS: f64 = 6.0;

impl Axis {
    /// The axis for these values: names if some are not numbers. It is logarithmic if that is asked for or if the values
    /// span a factor of 20, but only if all of them are positive.
    pub fn for_values(values: &[Value], logarithmic: bool) -> Self {
        let numbers: Option<Vec<f64>> =
            values.iter().map(|value| value.as_f64().filter(|x| x.is_finite())).collect();
        let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) else {
            return Self::Names(values.iter().map(value::text).collect());
        };
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low > 0.0 && (logarithmic || high / low >= 20.0) {
            let margin = (high / low).powf(0.04).clamp(1.12, 10.0);
            // The search for ticks would not end at zero or infinity.
            Self::Log((low / margin).max(f64::MIN_POSITIVE)..(high * margin).min(f64::MAX))
        } else {
            Self::spanning(low, high, if low == 0.0 { 1.0 } else { low.abs() })
        }
    }

    /// A linear axis with a margin around the values. The range without the margin is at least `least` wide.
    pub fn spanning(low: f64, high: f64, least: f64) -> Self {
        let widen = ((least - (high - low)) / 2.0).max(0.0);
        let margin = 0.05 * (high - low).max(least);
        Self::Linear(low - widen - margin..high + widen + margin)
    }

    fn ticks(&self) -> Vec<f64> {
        match self {
            Self::Log(range) => log_ticks(range),
            Self::Linear(range) => linear_ticks(range),
            Self::Names(names) => (0..names.len()).map(|i| i as f64).collect(),
        }
    }

    fn label(&self, tick: f64) -> String {
        match self {
            Self::Log(_) => value::number(tick),
            Self::Names(names) => names.get(tick as usize).cloned().unwrap_or_default(),
            Self::Linear(range) => {
                let step = nice_step(range);
                if (1e-4..1e7).contains(&step) {
                    let decimals = (-step.log10().floor()).max(0.0) as usize;
                    format!("{tick:.decimals$}")
                } else {
                    // Four digits, because the multiplication in `linear_ticks` rounds.
                    format!("{tick:.3e}").parse().map_or_else(|_| format!("{tick:e}"), value::number)
                }
            }
        }
    }

    /// The positions of the ticks with their labels.
    pub fn labelled_ticks(&self) -> Vec<(f64, String)> {
        self.ticks().into_iter().map(|tick| (tick, self.label(tick))).collect()
    }

    /// Length of the longest tick label, in characters.
    pub fn longest_label(&self) -> usize {
        self.ticks().into_iter().map(|tick| self.label(tick).chars().count()).max().unwrap_or(0)
    }
}

fn log_ticks(range: &Range<f64>) -> Vec<f64> {
    let decades = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let multiples = |digits: &[u8]| -> Vec<f64> {
        decades
            .clone()
            // Parsing gives the number nearest to 2e-7; a product would be printed as 1.9999999999999998e-7.
            .flat_map(|exponent| digits.iter().filter_map(move |d| format!("{d}e{exponent}").parse().ok()))
            .filter(|tick| range.contains(tick))
            .collect()
    };
    let wide = (range.end / range.start).log10() > FINE_DECADES;
    let usual = if wide { multiples(&[1]) } else { multiples(&[1, 2, 5]) };
    if usual.len() >= 3 {
        return usual;
    }
    let all = multiples(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    if all.len() >= 3 { all } else { linear_ticks(range) }
}

fn linear_ticks(range: &Range<f64>) -> Vec<f64> {
    let step = nice_step(range);
    let first = (range.start / step).ceil() as i64;
    let last = (range.end / step).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The 1, 2 or 5 times a power of ten that gives about [`LINEAR_TICKS`] ticks.
fn nice_step(range: &Range<f64>) -> f64 {
    let raw = (range.end - range.start) / LINEAR_TICKS;
    let decade = 10f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0].map(|m| m * decade).into_iter().find(|step| *step >= raw).unwrap_or(10.0 * decade)
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let range = self.range();
        let share = match self {
            Self::Log(_) => (value / range.start).ln() / (range.end / range.start).ln(),
            _ => (value - range.start) / (range.end - range.start),
        };
        (f64::from(from) + share * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        match self {
            Self::Log(range) | Self::Linear(range) => range.clone(),
            Self::Names(names) => -0.5..(names.len().max(1) as f64 - 0.5),
        }
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, tick: &f64) -> String {
        self.label(*tick)
    }
}
