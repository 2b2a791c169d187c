//! An example of a record, for tests: it has every figure that a record can have. Tests change single fields of it.

use super::above_band::AboveBand;
use super::mode::ComplexMode;
use super::nested::CoarseStart;
use super::program::{Direction, ProgramWindow};
use super::record::{
    ElasticDisk, EnergyTotals, HolderMotion, JobRecord, ObservedNode, Outcome, PlasticFlow, Regime,
    SlidingStability,
};
use super::sample::OBSERVED_NAMES;
use super::steady::Obstacle;

impl JobRecord {
    /// A run that is not periodic, with every figure that a record can have.
    #[doc(hidden)]
    pub fn example() -> Self {
        let node = |name: &str| ObservedNode {
            name: name.to_owned(),
            y_peak_to_peak_m: 1e-6,
            lift_max_m: 1e-7,
            sigma_n_max_pa: 1e6,
            slip_speed_max_m_s: 0.1,
        };
        let holder = |direction: &str| HolderMotion {
            direction: direction.to_owned(),
            peak_to_peak_m: 1e-6,
            acceleration_rms_m_s2: 0.5,
        };
        Self {
            outcome: Outcome::NotPeriodic,
            regime: Regime::StickSlip,
            mu_star: 0.3,
            mu_star_se: 0.0005,
            mu_star_contact: 0.3,
            frequency_hz: Some(14_512.4),
            stick_share: 0.25,
            slip_share: 0.5,
            separated_share: 0.25,
            n_over_f_min: 0.5,
            n_over_f_max: 1.5,
            sigma_n_max_pa: 1.25e6,
            slip_speed_max_m_s: 0.125,
            lift_max_m: 3.0e-7,
            cycles: 40,
            crossings_per_cycle: 1,
            simulated_s: 0.0875,
            window_start_s: 0.08,
            steps: 350_000,
            time_step_s: 2.5e-7,
            time_step_limit_s: 5e-7,
            elements: Some([12, 15, 10]),
            clamp_width_m: 0.001,
            energy_residual: 1.5e-9,
            macroscopic_identity_residual: -3e-4,
            energy_identity_residual: 1e-4,
            contact_loss_share: 0.01,
            mu_reduction_stick: 0.05,
            mu_reduction_slip: 0.02,
            growth_rate_per_s: Some(-200.0),
            obstacle: Some(Obstacle::Unsteady { figure: "period".to_owned(), spread: 0.1, drift: 0.2 }),
            stability: Some(SlidingStability::example()),
            sliding_mesh_error: Some(3e-5),
            accuracy_reached: Some(false),
            start: Some(CoarseStart {
                elements: [6, 8, 5],
                outcome: Some(Outcome::Periodic),
                only_compared: false,
                regime: Some(Regime::StickSlip),
                same_clamp: Some(true),
                modes: vec![ComplexMode::of(1.5e4, 90.0)],
                simulated_s: 0.002,
                mu_star: Some(0.3),
                frequency_hz: Some(14_400.0),
                start: None,
            }),
            disk: Some(ElasticDisk {
                elements: [1, 2, 3],
                track_element_m: [0.1, 0.2, 0.3],
                longest_edge_m: 0.5,
                stages: 2,
                sweeps_mean: 4.5,
                sweeps_max: 7.0,
                residual_max: 1e-12,
            }),
            holder: ["x", "y", "z"].map(holder).into(),
            windows: [Direction::Up, Direction::Down]
                .map(|direction| ProgramWindow { direction, ..ProgramWindow::example() })
                .into(),
            plastic: Some(PlasticFlow { strain_max: 0.004, work_j: 2.0e-5, share: 5.0e-5 }),
            energy: EnergyTotals::default(),
            nodes: OBSERVED_NAMES.map(node).into(),
        }
    }
}

impl SlidingStability {
    /// Eigenvalues beside a run, with one mode, which grows.
    #[doc(hidden)]
    pub fn example() -> Self {
        Self {
            decided: false,
            contact_nodes: 30,
            lifted_nodes: 2,
            mu_star: 0.4,
            band_hz: 5e4,
            above_band: AboveBand::NotLookedAt,
            damped_above_hz: Some(4e4),
            modes: vec![ComplexMode {
                frequency_mesh_error_hz: Some(20.0),
                growth_rate_mesh_error_per_s: Some(10.0),
                residual: 1e-9,
                ..ComplexMode::of(1.5e4, 100.0)
            }],
        }
    }
}

impl ProgramWindow {
    /// A window on the way up, in which every figure is known.
    #[doc(hidden)]
    pub fn example() -> Self {
        Self {
            time_s: [0.5, 0.75],
            direction: Direction::Up,
            omega_rpm: 7.5,
            load_n: 30.0,
            mu_star: 0.3,
            mu_star_contact: 0.31,
            frequency_hz: Some(1.5e4),
            n_amplitude: 0.25,
            y_peak_to_peak_m: 1e-6,
            stick_share: 0.25,
            slip_share: 0.5,
            separated_share: 0.25,
        }
    }
}
