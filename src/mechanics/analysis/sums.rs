//! Sums and extremes of samples over a window, and the figures that follow from them.

use super::sample::{HolderSample, OBSERVED, Sample};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Sums and extremes over consecutive steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// Number of steps. The first and the last step of a cycle count with the fraction that belongs to the
    /// cycle.
    weight: f64,
    load: f64,
    normal: f64,
    /// Sums of N x/lx and N y/ly.
    moments: [f64; 2],
    contact_tangential: f64,
    clamp_tangential: f64,
    stick_deficit: f64,
    slip_deficit: f64,
    stick: f64,
    slip: f64,
    separated: f64,
    /// Smallest smoothed N \[N\].
    pub normal_min_n: f64,
    /// Largest smoothed N \[N\].
    pub normal_max_n: f64,
    /// Largest smoothed nodal normal stress \[Pa\].
    pub sigma_n_max_pa: f64,
    /// Largest slip speed \[m/s\].
    pub slip_speed_max_m_s: f64,
    /// Largest gap \[m\] of a node.
    pub lift_max_m: f64,
    holder: [HolderFigures; 3],
    /// Extremes of the observed nodes.
    pub nodes: [NodeFigures; OBSERVED],
}

/// The holder in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct HolderFigures {
    min_m: f64,
    max_m: f64,
    /// Sum of the squares of the acceleration.
    squares: f64,
}

impl HolderFigures {
    const EMPTY: Self = Self { min_m: f64::INFINITY, max_m: f64::NEG_INFINITY, squares: 0.0 };
}

/// Extremes of one observed node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NodeFigures {
    y_min_m: f64,
    y_max_m: f64,
    /// Largest gap \[m\].
    pub lift_max_m: f64,
    /// Largest smoothed normal stress \[Pa\].
    pub sigma_n_max_pa: f64,
    /// Largest slip speed \[m/s\].
    pub slip_speed_max_m_s: f64,
}

impl NodeFigures {
    const EMPTY: Self = Self {
        y_min_m: f64::INFINITY,
        y_max_m: f64::NEG_INFINITY,
        lift_max_m: 0.0,
        sigma_n_max_pa: 0.0,
        slip_speed_max_m_s: 0.0,
    };

    /// Peak-to-peak displacement in y \[m\].
    pub fn y_peak_to_peak_m(&self) -> f64 {
        self.y_max_m - self.y_min_m
    }
}

impl Sums {
    /// The figures of no step.
    pub const EMPTY: Self = Self {
        weight: 0.0,
        load: 0.0,
        normal: 0.0,
        moments: [0.0; 2],
        contact_tangential: 0.0,
        clamp_tangential: 0.0,
        stick_deficit: 0.0,
        slip_deficit: 0.0,
        stick: 0.0,
        slip: 0.0,
        separated: 0.0,
        normal_min_n: f64::INFINITY,
        normal_max_n: f64::NEG_INFINITY,
        sigma_n_max_pa: 0.0,
        slip_speed_max_m_s: 0.0,
        lift_max_m: 0.0,
        holder: [HolderFigures::EMPTY; 3],
        nodes: [NodeFigures::EMPTY; OBSERVED],
    };

    /// Adds one step, or the fraction `weight` of it that belongs to the window.
    pub fn add(&mut self, sample: &Sample, weight: f64) {
        self.weight += weight;
        self.load += weight * sample.load_n;
        self.normal += weight * sample.normal_n;
        self.moments[0] += weight * sample.x_moment_n;
        self.moments[1] += weight * sample.y_moment_n;
        self.contact_tangential += weight * sample.contact_tangential_n;
        self.clamp_tangential += weight * sample.clamp_tangential_n;
        self.stick_deficit += weight * sample.stick_deficit_n;
        self.slip_deficit += weight * sample.slip_deficit_n;
        self.stick += weight * (sample.stick as f64);
        self.slip += weight * (sample.slip as f64);
        self.separated += weight * (sample.separated as f64);
        self.normal_min_n = self.normal_min_n.min(sample.smooth_normal_n);
        self.normal_max_n = self.normal_max_n.max(sample.smooth_normal_n);
        self.sigma_n_max_pa = self.sigma_n_max_pa.max(sample.sigma_n_max_pa);
        self.slip_speed_max_m_s = self.slip_speed_max_m_s.max(sample.slip_speed_max_m_s);
        self.lift_max_m = self.lift_max_m.max(sample.lift_max_m);
        for (holder, HolderSample { displacement_m, acceleration_m_s2 }) in
            self.holder.iter_mut().zip(&sample.holder)
        {
            holder.min_m = holder.min_m.min(*displacement_m);
            holder.max_m = holder.max_m.max(*displacement_m);
            holder.squares += weight * (acceleration_m_s2 * acceleration_m_s2);
        }
        for (node, observed) in self.nodes.iter_mut().zip(&sample.nodes) {
            node.y_min_m = node.y_min_m.min(observed.u_m[1]);
            node.y_max_m = node.y_max_m.max(observed.u_m[1]);
            node.lift_max_m = node.lift_max_m.max(observed.gap_m);
            node.sigma_n_max_pa = node.sigma_n_max_pa.max(observed.sigma_n_pa);
            node.slip_speed_max_m_s = node.slip_speed_max_m_s.max(observed.slip_speed_m_s);
        }
    }

    /// Adds another window. Its sums are multiplied by `factor`.
    fn merge(&mut self, other: &Self, factor: f64) {
        self.weight += factor * other.weight;
        self.load += factor * other.load;
        self.normal += factor * other.normal;
        self.moments[0] += factor * other.moments[0];
        self.moments[1] += factor * other.moments[1];
        self.contact_tangential += factor * other.contact_tangential;
        self.clamp_tangential += factor * other.clamp_tangential;
        self.stick_deficit += factor * other.stick_deficit;
        self.slip_deficit += factor * other.slip_deficit;
        self.stick += factor * other.stick;
        self.slip += factor * other.slip;
        self.separated += factor * other.separated;
        self.normal_min_n = self.normal_min_n.min(other.normal_min_n);
        self.normal_max_n = self.normal_max_n.max(other.normal_max_n);
        self.sigma_n_max_pa = self.sigma_n_max_pa.max(other.sigma_n_max_pa);
        self.slip_speed_max_m_s = self.slip_speed_max_m_s.max(other.slip_speed_max_m_s);
        self.lift_max_m = self.lift_max_m.max(other.lift_max_m);
        for (holder, more) in self.holder.iter_mut().zip(&other.holder) {
            holder.min_m = holder.min_m.min(more.min_m);
            holder.max_m = holder.max_m.max(more.max_m);
            holder.squares += factor * more.squares;
        }
        for (node, more) in self.nodes.iter_mut().zip(&other.nodes) {
            node.y_min_m = node.y_min_m.min(more.y_min_m);
            node.y_max_m = node.y_max_m.max(more.y_max_m);
            node.lift_max_m = node.lift_max_m.max(more.lift_max_m);
            node.sigma_n_max_pa = node.sigma_n_max_pa.max(more.sigma_n_max_pa);
            node.slip_speed_max_m_s = node.slip_speed_max_m_s.max(more.slip_speed_max_m_s);
        }
    }

    /// The figures of all windows together.
    pub fn merged<'a>(windows: impl IntoIterator<Item = &'a Self>) -> Self {
        windows.into_iter().fold(Self::EMPTY, |mut all, window| {
            all.merge(window, 1.0);
            all
        })
    }

    /// The figures of consecutive windows together, weighted by a Hann taper. An oscillation without a whole
    /// number of periods in the windows then leaves almost nothing in the means.
    pub fn tapered<'a>(windows: impl ExactSizeIterator<Item = &'a Self>) -> Self {
        let count = windows.len() as f64;
        windows.enumerate().fold(Self::EMPTY, |mut all, (i, window)| {
            all.merge(window, 1.0 - libm::cos(2.0 * PI * (i as f64 + 0.5) / count));
            all
        })
    }

    /// Whether no step was added.
    pub fn is_empty(&self) -> bool {
        self.weight == 0.0
    }

    /// Mean load \[N\]; 0 without a step.
    pub fn load_n(&self) -> f64 {
        ratio(self.load, self.weight)
    }

    /// ⟨T⟩/⟨F⟩ with T at the clamp.
    pub fn mu_star(&self) -> f64 {
        ratio(self.clamp_tangential, self.load)
    }

    /// μ\* of a steady state: ⟨T⟩/⟨F⟩, or ⟨T⟩/⟨N⟩ of the contact if the holder moves.
    ///
    /// The two differ by what the momentum of pin and holder changes over the window. It is nothing in a periodic state. But a
    /// heavy holder swings for a long time with little effect on the contact, and its momentum would be most of the error.
    pub fn mu_star_without_momentum(&self, holder_moves: bool) -> f64 {
        if holder_moves { self.mu_star_contact() } else { self.mu_star() }
    }

    /// ⟨T⟩/⟨F⟩ of the clamp minus ⟨T⟩/⟨N⟩ of the contact. It vanishes over a whole cycle of a periodic state.
    pub fn imbalance(&self) -> f64 {
        self.mu_star() - self.mu_star_contact()
    }

    /// ⟨T⟩/⟨N⟩ of the contact forces.
    pub fn mu_star_contact(&self) -> f64 {
        ratio(self.contact_tangential, self.normal)
    }

    /// The mean friction coefficient of the nodes, weighted by their normal forces: ⟨Σ μ_i N_i⟩/⟨N⟩.
    pub fn mu_of_nodes(&self) -> f64 {
        ratio(self.contact_tangential + self.stick_deficit + self.slip_deficit, self.normal)
    }

    /// Where the mean normal force acts: its distances from the pin's axis in x and y over the pin's width and length.
    pub fn centre(&self) -> [f64; 2] {
        self.moments.map(|moment| ratio(moment, self.normal))
    }

    /// ⟨N⟩/⟨F⟩.
    pub fn normal_over_load(&self) -> f64 {
        ratio(self.normal, self.load)
    }

    /// (1/F)⟨Σ(μN − t_y)⟩ over sticking nodes: the reduction of μ* by stick.
    pub fn stick_reduction(&self) -> f64 {
        ratio(self.stick_deficit, self.load)
    }

    /// (1/F)⟨Σ μN(1 − cos φ)⟩ over slipping nodes: the reduction of μ* by misaligned or reversed slip.
    pub fn slip_reduction(&self) -> f64 {
        ratio(self.slip_deficit, self.load)
    }

    /// Peak-to-peak displacement \[m\] of the holder in a direction, and the root mean square of its acceleration \[m/s²\].
    pub fn holder(&self, axis: usize) -> [f64; 2] {
        let HolderFigures { min_m, max_m, squares } = self.holder[axis];
        [max_m - min_m, ratio(squares, self.weight).sqrt()]
    }

    /// Shares of the node-time in stick, slip and separation.
    pub fn shares(&self) -> [f64; 3] {
        let all = self.stick + self.slip + self.separated;
        [self.stick, self.slip, self.separated].map(|part| ratio(part, all))
    }
}

/// A mean over a mean. It is 0 where the second mean is 0: without a step, load or contact.
fn ratio(part: f64, whole: f64) -> f64 {
    if whole == 0.0 { 0.0 } else { part / whole }
}
