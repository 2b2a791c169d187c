//! The record of one job: every figure that was found in its run.

use super::steady::Obstacle;
use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// A periodic steady state was reached.
    Periodic,
    /// The oscillation decays at a measured negative growth rate: sliding is stable.
    Decayed,
    /// The time limit came first; the figures are averages over the last part of the run.
    NotPeriodic,
}

impl Outcome {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Periodic => "periodic",
            Self::Decayed => "decayed",
            Self::NotPeriodic => "not_periodic",
        }
    }
}

/// The contact regime, from the shares of node-time spent in each state over whole cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Regime {
    /// All nodes in contact slip, and the oscillation decays.
    Stable,
    /// Stick and slip, (almost) no separation.
    StickSlip,
    /// Stick, slip and separation.
    StickSlipSeparation,
    /// Slip and separation, (almost) no stick.
    SlipSeparation,
    /// (Almost) all nodes slip, but neither a decay nor a limit cycle was established.
    Undecided,
}

impl Regime {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::StickSlip => "stick_slip",
            Self::StickSlipSeparation => "stick_slip_separation",
            Self::SlipSeparation => "slip_separation",
            Self::Undecided => "undecided",
        }
    }
}

/// Energies [J] of a run: the state at its end and the work done and lost since its start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyTotals {
    /// Kinetic energy of the pin.
    pub kinetic_j: f64,
    /// Elastic energy of the pin.
    pub elastic_j: f64,
    /// Work of the normal load.
    pub load_work_j: f64,
    /// Work done on the pin by the disk's drive, `Σ f_t·V Δt`.
    pub drive_work_j: f64,
    /// Dissipated by friction.
    pub friction_j: f64,
    /// Dissipated by the damping `β_R` and by β₂ > ½.
    pub damping_j: f64,
    /// Lost in contact impacts (nodes that close or stick with a velocity jump).
    pub contact_loss_j: f64,
}

/// Figures of one observed contact node over the averaging window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObservedNode {
    /// `front_centre` (leading end) or `rear_centre` (trailing end).
    pub name: String,
    /// Peak-to-peak displacement [m] in y.
    pub y_peak_to_peak_m: f64,
    /// Largest gap [m].
    pub lift_max_m: f64,
    /// Largest normal contact stress [Pa] (smoothed as the job's).
    pub sigma_n_max_pa: f64,
    /// Largest slip speed [m/s] while in contact.
    pub slip_speed_max_m_s: f64,
}

/// The mesh and the contact solves of an elastic disk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ElasticDisk {
    /// Elements in θ, r and z.
    pub elements: [usize; 3],
    /// Longest edge [m] of the elements under the track, in θ, r and z.
    pub track_element_m: [f64; 3],
    /// Longest edge [m] elsewhere.
    pub longest_edge_m: f64,
    /// Stages that the disk takes in a time step.
    pub stages: usize,
    /// Gauss–Seidel sweeps of a contact solve, on average.
    pub sweeps_mean: f64,
    /// Most sweeps of a contact solve.
    pub sweeps_max: f64,
    /// Largest residual of a solve: by how much a force misses its own row of the contact equations, over the largest
    /// force.
    pub residual_max: f64,
}

/// What was found in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JobRecord {
    /// How the run ended.
    pub outcome: Outcome,
    /// The contact regime.
    pub regime: Regime,
    /// Macroscopic friction coefficient μ* = ⟨T⟩/⟨F⟩, T from the clamp's reactions.
    pub mu_star: f64,
    /// Standard error of `mu_star` over cycles (over equal parts of the window when sliding is stable).
    pub mu_star_se: f64,
    /// The same ratio from the mean contact forces, a check.
    pub mu_star_contact: f64,
    /// Fundamental frequency [Hz] of the total normal contact force; of a run that is not periodic the mean
    /// rate of its section crossings; none when sliding is stable or has no cycles.
    pub frequency_hz: Option<f64>,
    /// Share of the node-time in stick.
    pub stick_share: f64,
    /// Share of the node-time in slip.
    pub slip_share: f64,
    /// Share of the node-time separated.
    pub separated_share: f64,
    /// Smallest total normal contact force over F in the window (smoothed, see `analysis`).
    pub n_over_f_min: f64,
    /// Largest total normal contact force over F in the window (smoothed).
    pub n_over_f_max: f64,
    /// Largest nodal normal contact stress [Pa] in the window (smoothed).
    pub sigma_n_max_pa: f64,
    /// Largest slip speed [m/s] of a node in contact in the window.
    pub slip_speed_max_m_s: f64,
    /// Largest gap [m] of a node in the window.
    pub lift_max_m: f64,
    /// Whole limit cycles in the averaging window; 0 when stable.
    pub cycles: usize,
    /// Section crossings that make up one limit cycle (1 for a simple cycle).
    pub crossings_per_cycle: usize,
    /// Simulated time [s] at the end of the run.
    pub simulated_s: f64,
    /// Start [s] of the averaging window.
    pub window_start_s: f64,
    /// Time steps taken.
    pub steps: u64,
    /// The time step used [s].
    pub time_step_s: f64,
    /// The stability limit [s] of the operator used.
    pub time_step_limit_s: f64,
    /// The clamp's width [m] that the mesh actually gives.
    pub clamp_width_m: f64,
    /// |energy balance| over the energy put in: how well the energies close.
    pub energy_residual: f64,
    /// Residual of μ − μ* = `(1/F)⟨Σ(μN − t_y)⟩`, absolute.
    pub macroscopic_identity_residual: f64,
    /// Residual of work of drive and load = friction + damping + contact loss + change of stored energy over
    /// the window, over the drive's work.
    pub energy_identity_residual: f64,
    /// Contact loss over the drive's work in the window: what the identity ⟨T⟩V = friction + damping of the
    /// continuous problem misses on this mesh and time step.
    pub contact_loss_share: f64,
    /// What sticking nodes take off μ*: `(1/F)⟨Σ_stick(μN − t_y)⟩`.
    pub mu_reduction_stick: f64,
    /// What misaligned or reversed slip takes off μ*: `(1/F)⟨Σ_slip μN(1 − cos φ)⟩`.
    pub mu_reduction_slip: f64,
    /// Growth rate [1/s] of the fastest growing (or slowest decaying) strong line of the total normal force
    /// at the end of the run, when the last of it was steady sliding; negative: sliding is stable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth_rate_per_s: Option<f64>,
    /// Why the run was not found periodic, where it was not (nor to decay).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<Obstacle>,
    /// The elastic disk, if it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<ElasticDisk>,
    /// Energies at the end of the run.
    pub energy: EnergyTotals,
    /// The two observed nodes.
    pub nodes: Vec<ObservedNode>,
}

impl JobRecord {
    /// The larger of the two identity residuals.
    pub fn identity_residual(&self) -> f64 {
        self.macroscopic_identity_residual.abs().max(self.energy_identity_residual.abs())
    }

    /// The path of a figure that is not a finite number, if there is one.
    ///
    /// JSON has no such number: it would be stored as null, and nobody could read the record again.
    pub fn non_finite_figure(&self) -> Option<String> {
        let text = serde_json::to_string(self).ok()?;
        let mut reader = serde_json::Deserializer::from_str(&text);
        match serde_path_to_error::deserialize::<_, Self>(&mut reader) {
            Ok(read) if read == *self => None,
            Ok(_) => Some("a figure".to_owned()),
            Err(error) => Some(error.path().to_string()),
        }
    }
}
