//! The limit of a figure under refinement, where the observed order is clean (Richardson 1911; Roache 1998).
//!
//! Three levels with sizes s₁ > s₂ > s₃ and figures q = q₀ + a sᵖ give the order p from
//! (q₁ − q₂)/(q₂ − q₃) = (s₁ᵖ − s₂ᵖ)/(s₂ᵖ − s₃ᵖ), and the limit q₀ = q₃ − (q₂ − q₃)/((s₂/s₃)ᵖ − 1).
//!
//! The order is **clean** when there are at least three levels; the differences between the finest three have
//! one sign and the last exceeds twice its standard error; the order is within 0.5 … 3; and, with a fourth level, the
//! order of the three coarser of the last four differs by at most 0.5. Then the uncertainty of the limit is the
//! size of the correction. Otherwise the figure of the finest level is taken, and its uncertainty is
//! * if the figures are monotone but their order is not stable: the remaining error at first order,
//!   |q₂ − q₃|/(s₂/s₃ − 1), or the last difference if that is larger;
//! * if the figures have no order: the spread of the last three levels, because a small last difference of figures that
//!   are not monotone says nothing;
//! * otherwise the last difference.

/// A figure at one level of refinement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Element size or time step, in any unit.
    pub size: f64,
    /// The figure.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// The limit of a figure under refinement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The extrapolated figure, or that of the finest level.
    pub value: f64,
    /// Its uncertainty.
    pub uncertainty: f64,
    /// The order, or the reason why it is not clean.
    pub order: Result<f64, Unclean>,
}

/// The reason why a sequence is not extrapolated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unclean {
    /// Fewer than three levels.
    TooFewLevels,
    /// The last difference is at most twice its standard error: the figures have converged within their noise.
    WithinNoise,
    /// The figures are not monotone.
    NotMonotone,
    /// The differences do not shrink, or shrink at an order outside of 0.5 … 3.
    OrderOutOfRange(Option<f64>),
    /// The orders from two sets of three levels differ by more than 0.5.
    OrderNotStable(f64, f64),
}

impl Unclean {
    /// The name in CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::TooFewLevels => "too_few_levels",
            Self::WithinNoise => "within_noise",
            Self::NotMonotone => "not_monotone",
            Self::OrderOutOfRange(_) => "order_out_of_range",
            Self::OrderNotStable(..) => "order_not_stable",
        }
    }
}

/// Orders that a scheme of second order with events of first order can have.
const ORDERS: std::ops::RangeInclusive<f64> = 0.5..=3.0;
/// Largest difference of two orders that count as equal.
const STABLE: f64 = 0.5;

/// The limit of `levels`, coarsest first; `None` for fewer than two.
pub fn limit(levels: &[Level]) -> Option<Limit> {
    let [.., before, finest] = levels else { return None };
    let last = before.value - finest.value;
    let unclean = |reason| Some(Limit { value: finest.value, uncertainty: last.abs(), order: Err(reason) });
    let [.., coarse, middle, fine] = levels else { return unclean(Unclean::TooFewLevels) };
    if last.abs() <= 2.0 * before.standard_error.hypot(finest.standard_error) {
        return unclean(Unclean::WithinNoise);
    }
    let values = [coarse.value, middle.value, fine.value];
    let spread = values.into_iter().fold(f64::MIN, f64::max) - values.into_iter().fold(f64::MAX, f64::min);
    let without_order = |reason| Some(Limit { value: finest.value, uncertainty: spread, order: Err(reason) });
    if (coarse.value - middle.value) * last <= 0.0 {
        return without_order(Unclean::NotMonotone);
    }
    let order = match observed_order([coarse, middle, fine]) {
        Some(order) if ORDERS.contains(&order) => order,
        other => return without_order(Unclean::OrderOutOfRange(other)),
    };
    if let [.., first, second, third, _] = levels {
        match observed_order([first, second, third]) {
            Some(earlier) if (earlier - order).abs() <= STABLE => {}
            Some(earlier) => {
                let first_order = last.abs() / (middle.size / fine.size - 1.0);
                let reason = Unclean::OrderNotStable(earlier, order);
                let uncertainty = first_order.max(last.abs());
                return Some(Limit { value: finest.value, uncertainty, order: Err(reason) });
            }
            None => return without_order(Unclean::NotMonotone),
        }
    }
    let correction = last / ((middle.size / fine.size).powf(order) - 1.0);
    Some(Limit { value: fine.value - correction, uncertainty: correction.abs(), order: Ok(order) })
}

/// The order p > 0 of three levels, coarsest first; `None` if the differences have two signs or do not shrink.
pub fn observed_order([coarse, middle, fine]: [&Level; 3]) -> Option<f64> {
    let ratio = (coarse.value - middle.value) / (middle.value - fine.value);
    let (a, b) = (coarse.size / fine.size, middle.size / fine.size);
    // This increases with p, from ln(a/b)/ln b at p = 0.
    let expected = |p: f64| (a.powf(p) - b.powf(p)) / (b.powf(p) - 1.0);
    let (mut low, mut high) = (1.0e-3, 20.0);
    if !(ratio > expected(low) && ratio < expected(high)) {
        return None;
    }
    // After 60 halvings the interval is a unit in the last place.
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        if expected(p) < ratio { low = p } else { high = p }
    }
    Some(0.5 * (low + high))
}
