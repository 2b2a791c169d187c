//! Axes with ticks at round numbers.

use crate::publish::value;
use serde_json::Value;
use std::ops::Range;

/// An axis of a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Logarithmic, for positive numbers.
    Log(Range<f64>),
    /// Linear.
    Linear(Range<f64>),
    /// Linear around zero, and logarithmic beyond `linear` on both sides: a change of sign is seen although other values are
    /// many times as large.
    Signed {
        /// The ends of the axis.
        range: Range<f64>,
        /// Where the logarithm begins.
        linear: f64,
    },
    /// Names, equally spaced at 0, 1, 2 …
    Names(Vec<String>),
}

/// Up to so many decades, ticks are at 1, 2 and 5 of each; beyond, they are at whole decades.
const FINE_DECADES: f64 = 5.0;
/// Number of ticks that a linear axis should have.
const LINEAR_TICKS: f64 = 6.0;

impl Axis {
    /// The axis for these values: names if some are not numbers. It is logarithmic if that is asked for, or if nothing is asked
    /// for and the values span a factor of 20, but only if all of them are positive.
    pub fn for_values(values: &[Value], logarithmic: Option<bool>) -> Self {
        let numbers: Option<Vec<f64>> =
            values.iter().map(|value| value.as_f64().filter(|x| x.is_finite())).collect();
        let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) else {
            return Self::Names(values.iter().map(value::text).collect());
        };
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if low > 0.0 && logarithmic.unwrap_or(high / low >= 20.0) {
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

    /// The axis for values of both signs around zero: [`Axis::Signed`] if the sizes of the values span more than a factor of
    /// 50, and linear otherwise.
    pub fn around_zero(values: impl Iterator<Item = f64>, least: f64) -> Self {
        let [mut low, mut high, mut smallest] = [0.0_f64, 0.0_f64, f64::INFINITY];
        for x in values.filter(|x| x.is_finite()) {
            (low, high) = (low.min(x), high.max(x));
            if x != 0.0 {
                smallest = smallest.min(x.abs());
            }
        }
        let largest = high.max(-low);
        if !(low < 0.0 && high > 0.0 && largest > 50.0 * smallest) {
            return Self::spanning(low, high, least);
        }
        // Six decades on each side are enough.
        let linear = 10f64.powf(smallest.max(largest * 1e-6).log10().floor());
        let end = |x: f64| 10f64.powf((x.abs() + linear).log10() + 0.3) * x.signum();
        Self::Signed { range: end(low)..end(high), linear }
    }

    /// The ends; names reach from −½ to half behind the last one.
    pub fn range(&self) -> Range<f64> {
        match self {
            Self::Log(range) | Self::Linear(range) | Self::Signed { range, .. } => range.clone(),
            Self::Names(names) => -0.5..(names.len().max(1) as f64 - 0.5),
        }
    }

    /// The place of a value: 0 at the beginning of the axis and 1 at its end.
    pub fn place(&self, value: f64) -> f64 {
        let to = |x: f64| match self {
            Self::Log(_) => x.ln(),
            Self::Signed { linear, .. } => x.signum() * (x.abs() / linear).ln_1p(),
            Self::Linear(_) | Self::Names(_) => x,
        };
        let Range { start, end } = self.range();
        (to(value) - to(start)) / (to(end) - to(start))
    }

    /// The value at a place; the inverse of [`Axis::place`].
    pub fn value_at(&self, place: f64) -> f64 {
        let Range { start, end } = self.range();
        let between = |start: f64, end: f64| start + place * (end - start);
        match self {
            Self::Log(_) => between(start.ln(), end.ln()).exp(),
            Self::Signed { linear, .. } => {
                let to = |x: f64| x.signum() * (x.abs() / linear).ln_1p();
                let t = between(to(start), to(end));
                t.signum() * linear * t.abs().exp_m1()
            }
            Self::Linear(_) | Self::Names(_) => between(start, end),
        }
    }

    fn ticks(&self) -> Vec<f64> {
        match self {
            Self::Log(range) => log_ticks(range),
            Self::Signed { range, linear } => signed_ticks(range, *linear),
            Self::Linear(range) => linear_ticks(range),
            Self::Names(names) => (0..names.len()).map(|i| i as f64).collect(),
        }
    }

    fn label(&self, tick: f64) -> String {
        match self {
            Self::Log(_) | Self::Signed { .. } => with_power(tick),
            Self::Names(names) => names.get(tick as usize).cloned().unwrap_or_default(),
            Self::Linear(range) => {
                let step = nice_step(range);
                let text = if (1e-4..1e7).contains(&step) {
                    let decimals = (-step.log10().floor()).max(0.0) as usize;
                    format!("{tick:.decimals$}")
                } else {
                    // Four digits, because the multiplication in `linear_ticks` rounds.
                    format!("{tick:.3e}").parse().map_or_else(|_| format!("{tick:e}"), value::number)
                };
                // Not `-0`.
                if text.trim_matches(['-', '0', '.']).is_empty() {
                    text.replace('-', "")
                } else {
                    text.replace('-', "−")
                }
            }
        }
    }

    /// The positions of the ticks with their labels.
    pub fn labelled_ticks(&self) -> Vec<(f64, String)> {
        self.ticks().into_iter().map(|tick| (tick, self.label(tick))).collect()
    }
}

/// A number with a power of ten where plain digits are hard to read: `2·10⁻⁷`, `10⁵`.
fn with_power(x: f64) -> String {
    let plain = value::number(x).replace('-', "−");
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        return plain;
    }
    let scientific = format!("{x:e}");
    let Some((factor, exponent)) = scientific.split_once('e') else { return plain };
    let raised: String =
        exponent.chars().filter_map(|c| "-0123456789".find(c)).map(|at| RAISED[at]).collect();
    match factor {
        "1" => format!("10{raised}"),
        "-1" => format!("−10{raised}"),
        _ => format!("{}·10{raised}", factor.replace('-', "−")),
    }
}

/// A minus and the digits as superscripts.
const RAISED: [char; 11] = ['⁻', '⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

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

/// Zero, and powers of ten on both sides, at most five of them.
fn signed_ticks(range: &Range<f64>, linear: f64) -> Vec<f64> {
    let decades = |end: f64| (end.abs() / linear).log10().floor().max(0.0) as i32;
    let every = (decades(range.start).max(decades(range.end)) / 5 + 1).max(1) as usize;
    let side = |end: f64| {
        // Parsing gives the number nearest to 1e-7.
        let power = move |k: i32| format!("1e{}", linear.log10().round() as i32 + k).parse::<f64>();
        (0..=decades(end)).step_by(every).filter_map(move |k| power(k).ok()).map(move |x| x * end.signum())
    };
    let inside = side(range.start).chain([0.0]).chain(side(range.end)).filter(|x| range.contains(x));
    let mut ticks: Vec<f64> = inside.collect();
    ticks.sort_by(f64::total_cmp);
    ticks
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: on an axis of both signs a change of sign is seen although other values are 10⁵ times as large, places are in
    /// the order of the values, and zero has a tick.
    #[test]
    fn a_change_of_sign_is_seen() {
        let axis = Axis::around_zero([-1e5, -2.0, 1.0, 3e4].into_iter(), 1.0);
        let places: Vec<f64> = [-1e5, -2.0, 0.0, 1.0, 3e4].map(|x| axis.place(x)).into();
        assert!(places.is_sorted() && places[0] > 0.0 && places[4] < 1.0, "{places:?}");
        assert!(places[3] - places[1] > 0.05, "{places:?}");
        let ticks = axis.labelled_ticks();
        assert!(ticks.iter().any(|(at, label)| *at == 0.0 && label == "0"), "{ticks:?}");
        assert!(ticks.len() >= 5 && ticks.len() <= 13, "{ticks:?}");
        assert!(matches!(Axis::around_zero([-3.0, 4.0].into_iter(), 1.0), Axis::Linear(_)));
    }

    /// Protects: large and small numbers at ticks are powers of ten, and others are plain.
    #[test]
    fn ticks_have_powers_of_ten() {
        let texts = [1e-11, -1e5, 2e-4, 1e4, 0.002, 0.0].map(with_power);
        assert_eq!(texts, ["10⁻¹¹", "−10⁵", "2·10⁻⁴", "10000", "0.002", "0"]);
    }

    /// Protects: decades have equal lengths on a logarithmic axis, and names have equal distances.
    #[test]
    fn places_follow_the_scale() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        let log = Axis::Log(0.1..1000.0);
        near(log.place(1.0), 0.25);
        near(log.place(100.0), 0.75);
        let names = Axis::Names(vec!["a".to_owned(), "b".to_owned()]);
        near(names.place(0.0), 0.25);
        near(names.place(1.0), 0.75);
        near(Axis::Linear(-1.0..3.0).place(0.0), 0.25);
        let signed = Axis::around_zero([-1e5, 1.0].into_iter(), 1.0);
        for axis in [log, names, signed] {
            near(axis.place(axis.value_at(0.3)), 0.3);
        }
    }
}
