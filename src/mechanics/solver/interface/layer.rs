//! A compliant layer between the pin and a rigid target, in series with each slave node.
//!
//! The layer of a node carries `N = A p(δ)` at the depth δ ≥ 0, with the node's area A. The force at t_n belongs to the depth at t_{n+1}:
//!
//! ```text
//! g* + N/s + δ(N) = 0,   s = m/(cΔt²)
//! ```
//!
//! with the gap g* of the prediction. So a node on a layer has the gap −δ where it would have none on a rigid surface, and the
//! step stays stable with the pin's own Δt for any stiffness. An infinite stiffness is the rigid contact. To first order in Δt
//! the layer has a damper of Δt dN/dδ: what it dissipates is a part of the contact loss.

use super::{Contacts, SlaveNode};
use crate::solver::body::pin::Face;
use crate::solver::field::{FieldOf, LaneSlot};
use crate::solver::interface::solve::StepData;
use crate::solver::number::Number;

/// How a layer resists: `p = p₀ (k δ/(m p₀))^m`, whose stiffness dp/dδ is k at the pressure p₀. With m = 1 it is k at any pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// k \[Pa/m\], > 0.
    pub stiffness_pa_m: f64,
    /// m ≥ 1.
    pub exponent: f64,
    /// p₀ \[Pa\], > 0.
    pub pressure_pa: f64,
}

/// Newton's method for [`Layer::depth_m`] needs at most some ten steps. It also ends when rounding stops it.
const MOST_ITERATIONS: usize = 100;

impl Layer {
    /// The depth \[m\] under a force \[N\] on an area \[m²\].
    pub fn depth_under_m(&self, force_n: f64, area_m2: f64) -> f64 {
        let Self { stiffness_pa_m: k, exponent: m, pressure_pa } = *self;
        if m == 1.0 {
            return force_n / (k * area_m2);
        }
        libm::pow(force_n / (pressure_pa * area_m2), 1.0 / m) * (m * pressure_pa / k)
    }

    /// The energy \[J\] that is stored under a force \[N\]: ∫N dδ = N δ/(m + 1).
    pub fn stored_j(&self, force_n: f64, area_m2: f64) -> f64 {
        force_n * self.depth_under_m(force_n, area_m2) / (self.exponent + 1.0)
    }

    /// The depth \[m\] at which the layer and a spring s \[N/m\] share an overlap \[m\]: the root of `δ + N(δ)/s = overlap`.
    ///
    /// In x = δ/overlap it is `x + (x/x₁)^m = 1`, where the layer alone would be as strong as the spring under the whole overlap at
    /// x₁. The left side is convex and rises, and the root is below 1 and below x₁. So Newton's method from there falls to
    /// the root without overshooting.
    pub fn depth_m(&self, overlap_m: f64, spring_n_m: f64, area_m2: f64) -> f64 {
        let alone_m = self.depth_under_m(overlap_m * spring_n_m, area_m2);
        if self.exponent == 1.0 {
            return overlap_m * (alone_m / (alone_m + overlap_m));
        }
        let x1 = alone_m / overlap_m;
        let mut x = x1.min(1.0);
        for _ in 0..MOST_ITERATIONS {
            let power = libm::pow(x / x1, self.exponent);
            let next = x - (x + power - 1.0) / (1.0 + self.exponent * power / x);
            // NaN ends it too.
            if next > 0.0 && next < x {
                x = next;
            } else {
                break;
            }
        }
        overlap_m * x
    }
}

/// A layer under the slave nodes.
#[derive(Debug, Clone)]
pub(super) struct NodesOnLayer {
    layer: Layer,
    nodes: Vec<(LaneSlot, SlaveNode)>,
}

impl NodesOnLayer {
    /// The layer under these slave nodes.
    pub fn new(layer: Layer, slaves: &[SlaveNode], place: impl Fn(usize) -> LaneSlot) -> Self {
        let nodes = slaves.iter().enumerate().map(|(slave, node)| (place(slave), *node)).collect();
        Self { layer, nodes }
    }

    /// Adds the depths \[m\] at t_{n+1} to the gaps of the undeformed slave nodes in the first component of `gap_m`, which are those
    /// of the target if it moves, and the initial ones otherwise.
    pub fn compress<const L: usize, R: Number>(
        &self,
        given: &StepData<'_, L, R>,
        face: &Face<'_, L, R>,
        gap_m: &mut FieldOf<L, R>,
        target_moves: bool,
    ) {
        let factors = given.factors;
        for (place, node) in &self.nodes {
            let [u, p] = [&*face.u, &*face.p].map(|field| field.at(*place, 2).map(R::to_f64));
            let residual = face.residual.at(*place, 2).map(R::to_f64);
            let gaps_m = gap_m.at_mut(*place, 0);
            for lane in 0..L {
                let base_m = if target_moves { gaps_m[lane].to_f64() } else { node.initial_gap_m };
                let u_scale = factors.u_scale[lane].to_f64();
                let acceleration = residual[lane] / node.mass_kg;
                let predicted_m = u[lane] + (p[lane] * factors.time_step_s - acceleration * u_scale);
                let overlap_m = -(predicted_m + base_m);
                let depth_m = if overlap_m > 0.0 && node.mobile[2] {
                    self.layer.depth_m(overlap_m, node.mass_kg / u_scale, node.area_m2)
                } else {
                    0.0
                };
                gaps_m[lane] = R::from_f64(base_m + depth_m);
            }
        }
    }

    /// The energy \[J\] stored under the contact forces.
    pub fn stored_j<const L: usize, R: Number>(&self, contacts: &Contacts<L, R>) -> [f64; L] {
        let mut stored_j = [0.0; L];
        for (place, node) in &self.nodes {
            let normal_n = contacts.force_n.at(*place, 2).map(R::to_f64);
            for (stored_j, force_n) in stored_j.iter_mut().zip(normal_n) {
                *stored_j += self.layer.stored_j(force_n, node.area_m2);
            }
        }
        stored_j
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the depth satisfies its equation from a layer that is much softer than the node to one that is much stiffer, and the
    /// energy is the integral of the force.
    #[test]
    fn layer_and_spring_share_the_overlap() {
        let (area_m2, spring_n_m) = (1.0e-6, 3.0e8);
        for exponent in [1.0, 1.5, 2.0, 3.7, 10.0] {
            for stiffness_pa_m in [1.0e6, 1.0e10, 3.0e14, 1.0e20] {
                let layer = Layer { stiffness_pa_m, exponent, pressure_pa: 2.0e5 };
                for overlap_m in [1.0e-14, 1.0e-8, 1.0e-4] {
                    let depth_m = layer.depth_m(overlap_m, spring_n_m, area_m2);
                    let share = stiffness_pa_m * depth_m / (exponent * layer.pressure_pa);
                    let force_n = if exponent == 1.0 {
                        area_m2 * stiffness_pa_m * depth_m
                    } else {
                        area_m2 * layer.pressure_pa * libm::pow(share, exponent)
                    };
                    let error = (depth_m + force_n / spring_n_m) / overlap_m - 1.0;
                    // The force has the m-fold relative error of the depth, and pow a few roundings more.
                    let bound = 64.0 * exponent * f64::EPSILON;
                    assert!(error.abs() < bound, "{exponent}, {stiffness_pa_m:e}, {overlap_m:e}: {error:e}");
                    let same = layer.depth_under_m(force_n, area_m2) / depth_m - 1.0;
                    assert!(same.abs() < bound, "{exponent}, {stiffness_pa_m:e}, {overlap_m:e}: {same:e}");
                    // The midpoint rule with so many points has an error of m(m − 1)(m + 1)/(24 n²), below 10⁻⁶.
                    let points = 8000;
                    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(points);
                    let integral: f64 =
                        (0..points).map(|i| libm::pow(at(i), exponent)).sum::<f64>() / f64::from(points);
                    let ratio = layer.stored_j(force_n, area_m2) / (force_n * depth_m * integral);
                    assert!((ratio - 1.0).abs() < 1.0e-6, "{exponent}: {ratio}");
                }
            }
        }
    }
}
