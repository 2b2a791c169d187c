//! The record of one job: all results of its run.

use super::above_band::AboveBand;
use super::nested::CoarseStart;
pub use super::outcome::{Outcome, Regime};
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

impl SlidingStability {
    fn figures(&self) -> impl Iterator<Item = (String, f64)> {
        let Self { mu_star, band_hz, damped_above_hz, modes, .. } = self;
        let of_mode = |(index, mode): (usize, &ComplexMode)| {
            let ComplexMode { frequency_hz, growth_rate_per_s, damping_ratio, residual, is_converged: _ } =
                *mode;
            let figures = [
                ("frequency_hz", frequency_hz),
                ("growth_rate_per_s", growth_rate_per_s),
                ("damping_ratio", damping_ratio),
                ("residual", residual),
            ];
            figures.map(|(name, value)| (format!("modes[{index}].{name}"), value))
        };
        let own = [("mu_star".to_owned(), *mu_star), ("band_hz".to_owned(), *band_hz)];
        let damped = damped_above_hz.map(|limit_hz| ("damped_above_hz".to_owned(), limit_hz));
        own.into_iter().chain(damped).chain(modes.iter().enumerate().flat_map(of_mode))
    }
}

impl EnergyTotals {
    fn figures(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let Self { kinetic_j, elastic_j, load_work_j, drive_work_j, friction_j, damping_j, contact_loss_j } =
            *self;
        let figures = [
            ("kinetic_j", kinetic_j),
            ("elastic_j", elastic_j),
            ("load_work_j", load_work_j),
            ("drive_work_j", drive_work_j),
            ("friction_j", friction_j),
            ("damping_j", damping_j),
            ("contact_loss_j", contact_loss_j),
        ];
        figures.into_iter()
    }
}

impl ObservedNode {
    fn figures(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let Self { name: _, y_peak_to_peak_m, lift_max_m, sigma_n_max_pa, slip_speed_max_m_s } = self;
        let figures = [
            ("y_peak_to_peak_m", *y_peak_to_peak_m),
            ("lift_max_m", *lift_max_m),
            ("sigma_n_max_pa", *sigma_n_max_pa),
            ("slip_speed_max_m_s", *slip_speed_max_m_s),
        ];
        figures.into_iter()
    }
}

impl ElasticDisk {
    fn figures(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let Self {
            elements: _,
            track_element_m: [along_m, across_m, down_m],
            longest_edge_m,
            stages: _,
            sweeps_mean,
            sweeps_max,
            residual_max,
        } = *self;
        let figures = [
            ("track_element_m[0]", along_m),
            ("track_element_m[1]", across_m),
            ("track_element_m[2]", down_m),
            ("longest_edge_m", longest_edge_m),
            ("sweeps_mean", sweeps_mean),
            ("sweeps_max", sweeps_max),
            ("residual_max", residual_max),
        ];
        figures.into_iter()
    }
}

/// A complex mode of small vibrations about steady sliding.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComplexMode {
    /// Frequency \[Hz\].
    pub frequency_hz: f64,
    /// Growth rate \[1/s\]; negative if the mode decays.
    pub growth_rate_per_s: f64,
    /// Damping ratio ζ = −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Residual of the full problem, relative.
    pub residual: f64,
    /// Whether the residual is within the tolerance.
    pub is_converged: bool,
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
    /// The run on a coarser mesh from which this one started; none if there was none.
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
    /// JSON has no such number. It would be stored as null, and the record could not be read again.
    pub fn non_finite_figure(&self) -> Option<String> {
        self.figures().into_iter().find(|(_, value)| !value.is_finite()).map(|(path, _)| path)
    }

    /// Every real number of the record with its path. The pattern names all fields, so that none can be
    /// forgotten.
    fn figures(&self) -> Vec<(String, f64)> {
        let Self {
            outcome: _,
            regime: _,
            mu_star,
            mu_star_se,
            mu_star_contact,
            frequency_hz,
            stick_share,
            slip_share,
            separated_share,
            n_over_f_min,
            n_over_f_max,
            sigma_n_max_pa,
            slip_speed_max_m_s,
            lift_max_m,
            cycles: _,
            crossings_per_cycle: _,
            simulated_s,
            window_start_s,
            steps: _,
            time_step_s,
            time_step_limit_s,
            clamp_width_m,
            energy_residual,
            macroscopic_identity_residual,
            energy_identity_residual,
            contact_loss_share,
            mu_reduction_stick,
            mu_reduction_slip,
            growth_rate_per_s,
            obstacle,
            stability,
            start,
            disk,
            holder,
            windows,
            energy,
            nodes,
        } = self;
        let mut figures = vec![
            ("mu_star".to_owned(), *mu_star),
            ("mu_star_se".to_owned(), *mu_star_se),
            ("mu_star_contact".to_owned(), *mu_star_contact),
            ("stick_share".to_owned(), *stick_share),
            ("slip_share".to_owned(), *slip_share),
            ("separated_share".to_owned(), *separated_share),
            ("n_over_f_min".to_owned(), *n_over_f_min),
            ("n_over_f_max".to_owned(), *n_over_f_max),
            ("sigma_n_max_pa".to_owned(), *sigma_n_max_pa),
            ("slip_speed_max_m_s".to_owned(), *slip_speed_max_m_s),
            ("lift_max_m".to_owned(), *lift_max_m),
            ("simulated_s".to_owned(), *simulated_s),
            ("window_start_s".to_owned(), *window_start_s),
            ("time_step_s".to_owned(), *time_step_s),
            ("time_step_limit_s".to_owned(), *time_step_limit_s),
            ("clamp_width_m".to_owned(), *clamp_width_m),
            ("energy_residual".to_owned(), *energy_residual),
            ("macroscopic_identity_residual".to_owned(), *macroscopic_identity_residual),
            ("energy_identity_residual".to_owned(), *energy_identity_residual),
            ("contact_loss_share".to_owned(), *contact_loss_share),
            ("mu_reduction_stick".to_owned(), *mu_reduction_stick),
            ("mu_reduction_slip".to_owned(), *mu_reduction_slip),
        ];
        figures.extend(frequency_hz.map(|value| ("frequency_hz".to_owned(), value)));
        figures.extend(growth_rate_per_s.map(|value| ("growth_rate_per_s".to_owned(), value)));
        if let Some(obstacle) = obstacle {
            figures.extend(obstacle.figures().map(|(path, value)| (format!("obstacle.{path}"), value)));
        }
        if let Some(stability) = stability {
            let own = stability.figures();
            figures.extend(own.map(|(path, value)| (format!("stability.{path}"), value)));
        }
        if let Some(start) = start {
            figures.extend(start.figures().map(|(path, value)| (format!("start.{path}"), value)));
        }
        if let Some(disk) = disk {
            figures.extend(disk.figures().map(|(path, value)| (format!("disk.{path}"), value)));
        }
        for HolderMotion { direction, peak_to_peak_m, acceleration_rms_m_s2 } in holder {
            figures.push((format!("holder.{direction}.peak_to_peak_m"), *peak_to_peak_m));
            figures.push((format!("holder.{direction}.acceleration_rms_m_s2"), *acceleration_rms_m_s2));
        }
        for (i, window) in windows.iter().enumerate() {
            figures.extend(window.figures().map(|(path, value)| (format!("windows[{i}].{path}"), value)));
        }
        figures.extend(energy.figures().map(|(path, value)| (format!("energy.{path}"), value)));
        for (i, node) in nodes.iter().enumerate() {
            figures.extend(node.figures().map(|(path, value)| (format!("nodes[{i}].{path}"), value)));
        }
        figures
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// A record in which every optional field is present.
    fn full() -> JobRecord {
        let disk = ElasticDisk {
            elements: [1, 2, 3],
            track_element_m: [0.1, 0.2, 0.3],
            longest_edge_m: 0.5,
            stages: 2,
            sweeps_mean: 4.5,
            sweeps_max: 7.0,
            residual_max: 1e-12,
        };
        let node = ObservedNode {
            name: "front_centre".to_owned(),
            y_peak_to_peak_m: 1e-6,
            lift_max_m: 1e-7,
            sigma_n_max_pa: 1e6,
            slip_speed_max_m_s: 0.1,
        };
        JobRecord {
            outcome: Outcome::NotPeriodic,
            regime: Regime::Undecided,
            mu_star: 0.3,
            mu_star_se: 0.001,
            mu_star_contact: 0.3,
            frequency_hz: Some(15e3),
            stick_share: 0.25,
            slip_share: 0.5,
            separated_share: 0.25,
            n_over_f_min: 0.5,
            n_over_f_max: 1.5,
            sigma_n_max_pa: 1e6,
            slip_speed_max_m_s: 0.1,
            lift_max_m: 1e-7,
            cycles: 20,
            crossings_per_cycle: 1,
            simulated_s: 0.01,
            window_start_s: 0.005,
            steps: 40_000,
            time_step_s: 2.5e-7,
            time_step_limit_s: 5e-7,
            clamp_width_m: 0.001,
            energy_residual: 1e-9,
            macroscopic_identity_residual: 1e-4,
            energy_identity_residual: 1e-4,
            contact_loss_share: 0.01,
            mu_reduction_stick: 0.05,
            mu_reduction_slip: 0.02,
            growth_rate_per_s: Some(-200.0),
            obstacle: Some(Obstacle::Unsteady { figure: "period".to_owned(), spread: 0.1, drift: 0.2 }),
            stability: Some(SlidingStability {
                decided: false,
                contact_nodes: 4,
                lifted_nodes: 0,
                mu_star: 0.4,
                band_hz: 5e4,
                above_band: AboveBand::Damped,
                damped_above_hz: Some(4e4),
                modes: vec![ComplexMode {
                    frequency_hz: 1.5e4,
                    growth_rate_per_s: 100.0,
                    damping_ratio: -1e-3,
                    residual: 1e-9,
                    is_converged: true,
                }],
            }),
            start: Some(CoarseStart::of_tests()),
            disk: Some(disk),
            holder: vec![HolderMotion {
                direction: "y".to_owned(),
                peak_to_peak_m: 1e-6,
                acceleration_rms_m_s2: 0.5,
            }],
            windows: vec![ProgramWindow::of_tests()],
            energy: EnergyTotals::default(),
            nodes: vec![node.clone(), node],
        }
    }

    fn real_numbers(value: &Value) -> usize {
        match value {
            Value::Number(number) => usize::from(number.is_f64()),
            Value::Array(values) => values.iter().map(real_numbers).sum(),
            Value::Object(fields) => fields.values().map(real_numbers).sum(),
            _ => 0,
        }
    }

    /// Protects: the check for finite numbers covers every real number that a record stores exactly once, and
    /// it names a number that is not finite.
    #[test]
    fn every_number_is_looked_at() {
        let record = full();
        assert_eq!(record.non_finite_figure(), None);
        let figures = record.figures();
        assert_eq!(figures.len(), real_numbers(&serde_json::to_value(&record).unwrap()));
        let paths: std::collections::BTreeSet<_> = figures.iter().map(|(path, _)| path).collect();
        assert_eq!(paths.len(), figures.len(), "{figures:?}");

        let mut record = full();
        record.nodes[1].sigma_n_max_pa = f64::INFINITY;
        assert_eq!(record.non_finite_figure().as_deref(), Some("nodes[1].sigma_n_max_pa"));
        record.frequency_hz = Some(f64::NAN);
        assert_eq!(record.non_finite_figure().as_deref(), Some("frequency_hz"));
    }
}
