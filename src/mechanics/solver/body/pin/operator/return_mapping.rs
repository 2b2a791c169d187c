//! Plastic flow at a point: what yields comes back to the yield surface.

use crate::spec::Plasticity;
use nalgebra::Matrix3;

pub type Matrix = Matrix3<f64>;

/// √⅔.
pub(super) const ROOT: f64 = 0.816_496_580_927_726;

/// What a point keeps of its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// C_p⁻¹ − 1.
    pub plastic: Matrix,
    /// Plastic strain ε̄.
    pub strain: f64,
    /// Rise \[Pa\] of the yield stress by isotropic hardening.
    pub rise_pa: f64,
    /// B \[Pa\] of the back stress.
    pub back: Matrix,
}

/// The yield stress of a material.
#[derive(Debug, Clone)]
pub(super) struct YieldLaw {
    pub yield_stress_pa: f64,
    hardening_pa: f64,
    /// Stress \[Pa\] and strain of a hardening that saturates.
    saturation: [f64; 2],
    curve: Vec<[f64; 2]>,
    pub kinematic_pa: f64,
    /// D \[1/s\] and q; none if the yield stress does not depend on the rate.
    rate: Option<[f64; 2]>,
}

/// Error of the stress over the yield stress at which the search for Δγ ends, and its most steps. A step halves the interval at least every
/// third time.
const TOLERANCE: f64 = 1.0e-13;
const MAX_STEPS: usize = 200;

impl YieldLaw {
    pub fn of(plasticity: &Plasticity) -> Self {
        Self {
            yield_stress_pa: plasticity.yield_stress_pa.unwrap_or(f64::INFINITY),
            hardening_pa: plasticity.hardening_modulus_pa.unwrap_or(0.0),
            saturation: [
                plasticity.saturation_stress_pa.unwrap_or(0.0),
                plasticity.saturation_strain.unwrap_or(1.0),
            ],
            curve: plasticity.hardening_curve.clone(),
            kinematic_pa: plasticity.kinematic_modulus_pa.unwrap_or(0.0),
            rate: plasticity.rate_reference_per_s.zip(plasticity.rate_exponent).map(|(d, q)| [d, q]),
        }
    }

    /// Rise \[Pa\] of the yield stress of slow flow at a plastic strain.
    fn rise_pa(&self, strain: f64) -> f64 {
        if self.curve.is_empty() {
            let [stress_pa, scale] = self.saturation;
            return self.hardening_pa * strain - stress_pa * libm::expm1(-strain / scale);
        }
        let after = self.curve.partition_point(|[at, _]| *at <= strain);
        let [from, from_pa] = self.curve[after.max(1) - 1];
        let at_pa = self
            .curve
            .get(after)
            .map_or(from_pa, |[to, to_pa]| from_pa + (to_pa - from_pa) * (strain - from) / (to - from));
        at_pa - self.yield_stress_pa
    }

    /// Lets a point flow in a time step, if its stress is beyond the yield surface. `h` is the displacement gradient whose stress yields, and
    /// `undamped` that of the displacements alone. Returns the plastic work per undeformed volume \[J/m³\], by the mean of the stresses at the ends
    /// of the step; `None` if the point does not yield.
    pub fn flow(
        &self,
        state: &mut PointState,
        h: &Matrix,
        undamped: &Matrix,
        shear_pa: f64,
        time_step_s: f64,
    ) -> Option<f64> {
        let identity = Matrix::identity();
        let f = h + identity;
        let volume = f.determinant();
        let inverse = f.try_inverse()?;
        let modulus = shear_pa * isochoric(volume);
        let elastic = h + h.transpose() + h * h.transpose() + f * state.plastic * f.transpose();
        let back = deviator(&(f * state.back * f.transpose())) * isochoric(volume);
        let trial = deviator(&elastic) * modulus - back;
        let (distance, limit) = (trial.norm(), ROOT * (self.yield_stress_pa + state.rise_pa));
        let excess = distance - limit;
        if excess.is_nan() || excess <= 0.0 {
            return None;
        }
        let n = trial / distance;
        let after = |gamma: f64| change(&elastic, &n, gamma);
        let kinematic_pa = 2.0 / 3.0 * self.kinematic_pa;
        // With a rate the search is for the overstress x over the yield stress, of which the yield stress is a smooth function, and else for Δγ.
        let rate =
            self.rate.map(|[reference_per_s, exponent]| [time_step_s * reference_per_s / ROOT, exponent]);
        let gamma_of = |x: f64| rate.map_or(x, |[unit, exponent]| unit * libm::pow(x, exponent));
        let remaining = |x: f64| {
            let gamma = gamma_of(x);
            let stress = deviator(&(elastic + after(gamma))) * modulus - back;
            let relative = stress - n * (kinematic_pa * gamma);
            let rise_pa = self.rise_pa(state.strain + ROOT * gamma);
            let yield_pa = (self.yield_stress_pa + rise_pa) * if rate.is_some() { 1.0 + x } else { 1.0 };
            // Beyond the end of the flow the stress turns round.
            relative.dot(&n).signum() * relative.norm() - ROOT * yield_pa
        };
        let most = excess / (2.0 * modulus);
        let guess =
            rate.map_or(most, |[unit, exponent]| libm::pow(most / unit, 1.0 / exponent).min(excess / limit));
        let found = root(&remaining, excess, guess, TOLERANCE * distance);
        let gamma = gamma_of(found);
        let change = after(gamma);
        // What the stress falls by in the step, and what it grew by since the step before.
        let fall_pa = -(deviator(&change) * modulus).dot(&n);
        let rise_before_pa = state.rise_pa;
        let before_j = (undamped + identity) * state.plastic * (undamped + identity).transpose();
        state.plastic += symmetric(&(inverse * change * inverse.transpose()));
        let after_j = (undamped + identity) * state.plastic * (undamped + identity).transpose();
        state.back +=
            symmetric(&(inverse * n * inverse.transpose() * (kinematic_pa * gamma / isochoric(volume))));
        state.strain += ROOT * gamma;
        state.rise_pa = self.rise_pa(state.strain);
        let of_undamped = shear_pa * isochoric((undamped + identity).determinant());
        let drop_j_m3 = 0.5 * of_undamped * (before_j - after_j).trace();
        // With a rate the overstress x changes in the step, too. Over a flow that begins and ends without overstress its part is this.
        let over = rate.map_or(1.0, |[_, exponent]| 1.0 + found * exponent / (exponent + 1.0));
        let growth_pa = ROOT * (state.rise_pa - rise_before_pa) * over + kinematic_pa * gamma;
        Some(drop_j_m3 - 0.5 * gamma * (fall_pa + growth_pa))
    }
}

/// The change of b_e = 1 + `elastic` when it becomes exp(−γ n) b_e exp(−γ n).
fn change(elastic: &Matrix, n: &Matrix, gamma: f64) -> Matrix {
    // exp(−γ n) − 1.
    let (step, mut power, mut exponential) = (n * -gamma, n * -gamma, n * -gamma);
    for order in 2..40 {
        power = power * step / f64::from(order);
        exponential += power;
        if power.norm() <= f64::EPSILON * 0.01 * exponential.norm() {
            break;
        }
    }
    let b = elastic + Matrix::identity();
    let once = exponential * b;
    once + once.transpose() + once * exponential
}

/// The root of a function that falls from `start` at 0, near `guess` or above, where its size is at most `tolerance` (Illinois).
fn root(function: &dyn Fn(f64) -> f64, start: f64, guess: f64, tolerance: f64) -> f64 {
    let (mut low, mut at_low, mut high) = (0.0, start, guess);
    let mut at_high = function(high);
    while at_high > 0.0 && high.is_finite() {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = function(high);
    }
    let nearest = if at_high.abs() < start { (at_high.abs(), high) } else { (start, 0.0) };
    let (mut last, mut best) = (0, nearest);
    for _ in 0..MAX_STEPS {
        if best.0 <= tolerance {
            break;
        }
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        if !(middle > low && middle < high) {
            break;
        }
        let at_middle = function(middle);
        if at_middle.abs() < best.0 {
            best = (at_middle.abs(), middle);
        }
        if at_middle > 0.0 {
            (low, at_low) = (middle, at_middle);
            if last == 1 {
                at_high *= 0.5;
            }
            last = 1;
        } else {
            (high, at_high) = (middle, at_middle);
            if last == -1 {
                at_low *= 0.5;
            }
            last = -1;
        }
    }
    best.1
}

/// J^(−2/3).
fn isochoric(volume: f64) -> f64 {
    libm::pow(volume, -2.0 / 3.0)
}

pub(super) fn deviator(a: &Matrix) -> Matrix {
    a - Matrix::identity() * (a.trace() / 3.0)
}

fn symmetric(a: &Matrix) -> Matrix {
    (a + a.transpose()) * 0.5
}

/// The tensor with the components xx, yy, zz, xy, yz and xz.
pub(super) fn matrix([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Matrix {
    Matrix::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// The components xx, yy, zz, xy, yz and xz.
pub(super) fn components(a: &Matrix) -> [f64; 6] {
    [a[(0, 0)], a[(1, 1)], a[(2, 2)], a[(0, 1)], a[(1, 2)], a[(0, 2)]]
}
