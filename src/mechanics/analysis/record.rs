//! The record of one job: all results of its run.

use super::above_band::AboveBand;
use super::mode::ComplexMode;
use super::nested::CoarseStart;
pub use super::outcome::{Outcome, Regime};
pub use super::plastic::PlasticFlow;
use super::program::ProgramWindow;
use super::steady::Obstacle;
use serde::{Deserialize, Serialize};

/// Energies \[J\] of a run: those stored at its end, and the work and the losses since its start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EnergyTotals {
    /// Kinetic energy of the pin and of an elastic disk.
    pub kinetic_j: f64,
    /// Elastic energy of the pin and of an elastic disk.
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
    /// Peak-to-peak displacement \[m\] in y.
    pub y_peak_to_peak_m: f64,
    /// Largest gap \[m\].
    pub lift_max_m: f64,
    /// Largest normal contact stress \[Pa\], smoothed like that of the job.
    pub sigma_n_max_pa: f64,
    /// Largest slip speed \[m/s\] while in contact.
    pub slip_speed_max_m_s: f64,
}

/// The motion of a holder in one direction over the averaging window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HolderMotion {
    /// The direction: `x`, `y` or `z`.
    pub direction: String,
    /// Peak-to-peak displacement \[m\].
    pub peak_to_peak_m: f64,
    /// Root mean square of the acceleration \[m/s²\].
    pub acceleration_rms_m_s2: f64,
}

/// The mesh and the contact solves of an elastic disk.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ElasticDisk {
    /// Elements in θ, r and z.
    pub elements: [usize; 3],
    /// Longest edge \[m\] of the elements under the track, in θ, r and z.
    pub track_element_m: [f64; 3],
    /// Longest edge \[m\] elsewhere.
    pub longest_edge_m: f64,
    /// Stages that the disk takes in a time step.
    pub stages: usize,
    /// Mean number of Gauss–Seidel sweeps of a contact solve.
    pub sweeps_mean: f64,
    /// Largest number of sweeps of a contact solve.
    pub sweeps_max: f64,
    /// Largest residual of a solve: the error of a force in its own row of the contact equations, over the
    /// largest force.
    pub residual_max: f64,
}

/// What the eigenvalues of steady sliding say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SlidingStability {
    /// Whether they decided the outcome, without a run.
    pub decided: bool,
    /// Slave nodes in contact in steady sliding.
    pub contact_nodes: usize,
    /// Slave nodes that are lifted in steady sliding.
    pub lifted_nodes: usize,
    /// Macroscopic friction coefficient of steady sliding.
    pub mu_star: f64,
    /// Frequency \[Hz\] up to which modes were looked for.
    pub band_hz: f64,
    /// What is known above that frequency.
    #[serde(default)]
    pub above_band: AboveBand,
    /// A frequency \[Hz\] above which damping wins, by an estimated bound; none if none is known.
    #[serde(default)]
    pub damped_above_hz: Option<f64>,
    /// The leading modes, largest growth rate first.
    pub modes: Vec<ComplexMode>,
}

/// The results of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JobRecord {
    /// How the run ended.
    #[serde(rename = "status", alias = "outcome")]
    pub outcome: Outcome,
    /// The contact regime.
    pub regime: Regime,
    /// Macroscopic friction coefficient μ* = ⟨T⟩/⟨F⟩. T comes from the clamp's reactions.
    pub mu_star: f64,
    /// Standard error of `mu_star`, from its values in single cycles (in equal parts of the window if sliding
    /// is stable).
    pub mu_star_se: f64,
    /// The same ratio from the mean contact forces, as a check.
    pub mu_star_contact: f64,
    /// Fundamental frequency \[Hz\] of the total normal contact force. For a run that is not periodic it is
    /// the mean rate of the section crossings. It is none if sliding is stable or has no cycles.
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
    /// Largest nodal normal contact stress \[Pa\] in the window (smoothed).
    pub sigma_n_max_pa: f64,
    /// Largest slip speed \[m/s\] of a node in contact in the window.
    pub slip_speed_max_m_s: f64,
    /// Largest gap \[m\] of a node in the window.
    pub lift_max_m: f64,
    /// Number of whole limit cycles in the averaging window; 0 if sliding is stable.
    pub cycles: usize,
    /// Section crossings that make up one limit cycle (1 for a simple cycle).
    pub crossings_per_cycle: usize,
    /// Simulated time \[s\] at the end of the run.
    pub simulated_s: f64,
    /// Start \[s\] of the averaging window.
    pub window_start_s: f64,
    /// Time steps taken.
    pub steps: u64,
    /// The time step used \[s\].
    pub time_step_s: f64,
    /// The stability limit \[s\] of the operator used.
    pub time_step_limit_s: f64,
    /// Elements of the pin's mesh in x, y and z; none of a mesh from a file, and in records of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[usize; 3]>,
    /// Width \[m\] of the clamp on the mesh, which may differ from the specified one.
    pub clamp_width_m: f64,
    /// |Imbalance| of the energies over the energy put in.
    pub energy_residual: f64,
    /// Residual of the identity μ − μ* = `(1/F)⟨Σ(μN − t_y)⟩`, absolute.
    pub macroscopic_identity_residual: f64,
    /// Residual of the energy identity over the window, relative to the drive's work. The identity is: work
    /// of drive and load = friction + damping + contact loss + change of stored energy.
    pub energy_identity_residual: f64,
    /// Contact loss over the drive's work in the window. On this mesh and with this time step, the identity
    /// ⟨T⟩V = friction + damping of the continuous problem has this error.
    pub contact_loss_share: f64,
    /// Reduction of μ* by sticking nodes: `(1/F)⟨Σ_stick(μN − t_y)⟩`.
    pub mu_reduction_stick: f64,
    /// Reduction of μ* by misaligned or reversed slip: `(1/F)⟨Σ_slip μN(1 − cos φ)⟩`.
    pub mu_reduction_slip: f64,
    /// Growth rate \[1/s\] of the fastest growing (or slowest decaying) strong line at the end of the run, if
    /// the run ended in steady sliding. If it is negative, sliding is stable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth_rate_per_s: Option<f64>,
    /// Why the run is not periodic; none if it is periodic or decays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<Obstacle>,
    /// The eigenvalues of steady sliding; none if they were not computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<SlidingStability>,
    /// Bound of the error that the mesh makes in μ\* if all nodes in contact slip steadily; none in another outcome, and in records of earlier
    /// versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sliding_mesh_error: Option<f64>,
    /// Whether the mesh error is as small as the job asks for; none if it asks for no accuracy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy_reached: Option<bool>,
    /// The run on a coarser mesh that came before; none if there was none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<CoarseStart>,
    /// The elastic disk; none if the disk is rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<ElasticDisk>,
    /// The holder in the directions in which it moves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holder: Vec<HolderMotion>,
    /// The windows of a run whose speed or load changes in time; empty for another run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub windows: Vec<ProgramWindow>,
    /// The plastic flow; none if no material of the pin yields.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plastic: Option<PlasticFlow>,
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

    /// The path of a number that is not finite, if there is one.
    ///
    /// JSON has no such number. It would be stored as null, and the record could not be read again, or would lack the number.
    pub fn non_finite_number(&self) -> Option<String> {
        let stored = serde_json::to_value(self).unwrap_or_default();
        match serde_path_to_error::deserialize::<_, Self>(stored) {
            Err(error) => Some(error.path().to_string()),
            Ok(read) => (read != *self).then(|| OPTIONAL.to_owned()),
        }
    }
}

/// What is said of a number without a path: null stands for an absent number, too.
const OPTIONAL: &str = "one of the numbers that may be absent, such as frequency_hz";

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// The paths of all real numbers.
    fn real_numbers(at: &str, value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Number(number) if number.is_f64() => found.push(at.to_owned()),
            Value::Array(values) => {
                for (i, value) in values.iter().enumerate() {
                    real_numbers(&format!("{at}/{i}"), value, found);
                }
            }
            Value::Object(fields) => {
                for (name, value) in fields {
                    real_numbers(&format!("{at}/{name}"), value, found);
                }
            }
            _ => {}
        }
    }

    /// Protects: each real number that a record stores is read again, as it was, so that comparing finds one that JSON does not have. A
    /// number that is not finite is named.
    #[test]
    fn every_number_is_looked_at() {
        let stored = serde_json::to_value(JobRecord::example()).unwrap();
        let mut paths = Vec::new();
        real_numbers("", &stored, &mut paths);
        assert!(paths.len() > 60, "{paths:?}");
        let record: JobRecord = serde_json::from_value(stored.clone()).unwrap();
        assert_eq!((record.non_finite_number(), &record), (None, &JobRecord::example()));
        for path in &paths {
            let mut without = stored.clone();
            *without.pointer_mut(path).unwrap() = Value::Null;
            let read: Result<JobRecord, _> = serde_json::from_value(without);
            assert!(read.is_err() || read.unwrap() != record, "{path}");
        }

        let mut record = JobRecord::example();
        record.nodes[1].sigma_n_max_pa = f64::INFINITY;
        assert_eq!(record.non_finite_number().as_deref(), Some("nodes[1].sigma_n_max_pa"));
        let mut record = JobRecord::example();
        record.frequency_hz = Some(f64::NAN);
        assert_eq!(record.non_finite_number().as_deref(), Some(OPTIONAL));
    }
}
