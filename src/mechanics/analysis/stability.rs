//! Steady sliding and its eigenvalues: what they say about a job, and the record of a job that they decide without a run.

use super::above_band::AboveBand;
use super::drive::drive;
use super::error::{JobError, check_step};
use super::lane::elastic_disk;
use super::mesh_error::error_of_sliding;
use super::mode::ComplexMode;
use super::nested::Beginning;
use super::noted::Noted;
use super::record::{EnergyTotals, JobRecord, ObservedNode, Outcome, Regime, SlidingStability};
use super::sample::OBSERVED_NAMES;
use crate::solver::interface::SlaveNode;
use crate::solver::interface::solve::Solves;
use crate::solver::{Drive, Model};
use crate::spec::{JobSpec, Precision, StabilityMethod};
use crate::stability::{Decision, Equilibrium, Mode, SlidingPoint, StabilityError, Stop, Structure};
use nalgebra::Complex;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Modes of a job that computes modes without a run.
pub const MODES: usize = 12;

/// Modes of a job whose run may be spared.
const DECIDING_MODES: usize = 8;

/// An eigenvalue whose imaginary part is a smaller share of it belongs to no vibration.
const NO_VIBRATION: f64 = 1.0e-9;

/// Structures that are kept. The threads of a worker rarely need more at a time.
const KEPT: usize = 8;

type Shared = Arc<OnceLock<Result<Structure, StabilityError>>>;

/// The structures of models, shared by threads.
///
/// A [`Structure`] takes seconds. It is made when a job needs it for the first time. Threads that need the same one
/// meanwhile wait for it. The most recent ones are kept.
#[derive(Debug, Clone, Default)]
pub struct Structures {
    /// By [`JobSpec::shared_part`], the most recent first.
    recent: Arc<Mutex<Vec<(JobSpec, Shared)>>>,
    stop: Stop,
}

impl Structures {
    /// Structures of no model yet, whose long searches for modes end with [`JobError::Interrupted`] when `is_asked` tells that somebody
    /// asked to stop.
    pub fn stopped_when(is_asked: impl Fn() -> bool + Send + Sync + 'static) -> Self {
        Self { stop: Stop::when(is_asked), ..Self::default() }
    }

    fn of(&self, spec: &JobSpec) -> Shared {
        // A structure is the same for both precisions.
        let mut part = spec.shared_part();
        part.numerics.precision = Precision::Double;
        let mut recent = self.recent.lock().unwrap_or_else(PoisonError::into_inner);
        let known = recent.iter().position(|(known, _)| *known == part);
        let entry = known.map_or_else(|| (part, Shared::default()), |place| recent.remove(place));
        let structure = Arc::clone(&entry.1);
        recent.insert(0, entry);
        recent.truncate(KEPT);
        structure
    }

    /// Asks the structure of a job of this model.
    fn with<T>(
        &self,
        spec: &JobSpec,
        model: &Model,
        ask: impl FnOnce(&Structure) -> Result<T, StabilityError>,
    ) -> Result<T, StabilityError> {
        let shared = self.of(spec);
        match shared.get_or_init(|| Ok(Structure::new(model)?.stopped_by(self.stop.clone()))) {
            Ok(structure) => ask(structure),
            Err(error) => Err(error.clone()),
        }
    }
}

/// What the eigenvalues say about a job before its run.
#[derive(Debug)]
pub enum Verdict {
    /// They decide its outcome: there is no run.
    Decided(Box<JobRecord>),
    /// The run decides. The record gets the eigenvalues, if they were computed.
    Undecided(Option<Noted>),
}

impl Verdict {
    /// The verdict for a run that takes place in any case.
    #[must_use]
    pub fn with_run(self) -> Self {
        let Self::Decided(record) = self else { return self };
        let noted =
            |stability| Noted { stability: SlidingStability { decided: false, ..stability }, grows: false };
        Self::Undecided(record.stability.map(noted))
    }
}

/// Decides a job without a run on its own mesh, if its method of stability allows that and its eigenvalues are clear.
///
/// A job that begins in a limit cycle is not judged: it can only be simulated.
///
/// # Errors
/// If the run would take too many steps; if a job that has no run has no eigenvalues either, or a figure overflows.
pub fn judge(
    spec: &JobSpec,
    model: &Model,
    beginning: &Beginning,
    structures: &Structures,
) -> Result<Verdict, JobError> {
    // A job is refused for what it asks, not for what its eigenvalues say.
    check_step(spec, model.time_step_s())?;
    if beginning.motion.is_some() {
        return Ok(Verdict::Undecided(None));
    }
    match spec.stability {
        StabilityMethod::Modes => {
            let point =
                structures.with(spec, model, |structure| structure.point(model, &drive(spec), MODES))?;
            // Without a mode, sliding is stable if every mode that can grow was looked for.
            let is_known = sliding_stability(&point, false).above_band.is_known();
            let is_stable = point.modes.first().map_or(is_known, |mode| growth(mode) < 0.0);
            let outcome = if is_stable { Outcome::Decayed } else { Outcome::Unstable };
            let mut record = record(spec, model, &point, outcome);
            record.start.clone_from(&beginning.start);
            let record = record.with_errors_of_modes();
            match record.non_finite_number() {
                None => Ok(Verdict::Decided(Box::new(record))),
                Some(figure) => Err(JobError::NotFinite { figure }),
            }
        }
        StabilityMethod::Eigenvalues if spec.eigenvalues_may_decide() => {
            // Without an equilibrium or eigenvalues the run decides.
            let start = beginning.start.as_ref();
            let coarser_decayed = start.is_some_and(|start| start.outcome == Some(Outcome::Decayed));
            let decide = |structure: &Structure| {
                structure.decide(model, &drive(spec), DECIDING_MODES, coarser_decayed)
            };
            let (point, verdict, is_safely_stable) = match structures.with(spec, model, decide) {
                Ok(found) => found,
                Err(StabilityError::Interrupted) => return Err(JobError::Interrupted),
                Err(_) => return Ok(Verdict::Undecided(None)),
            };
            let mut record = record(spec, model, &point, Outcome::Decayed);
            // A decided job is stable as far as anybody can know without its run.
            record.regime = Regime::Stable;
            for stability in
                record.stability.iter_mut().filter(|own| coarser_decayed && !own.above_band.is_known())
            {
                stability.above_band = AboveBand::CoarserRun;
            }
            record.start.clone_from(&beginning.start);
            let record = record.judged_by(spec.accuracy);
            Ok(match (record.non_finite_number(), is_safely_stable) {
                (None, true) => Verdict::Decided(Box::new(record)),
                (None, false) => Verdict::Undecided(Some(Noted {
                    stability: sliding_stability(&point, false),
                    grows: verdict == Decision::Unstable,
                })),
                (Some(_), _) => Verdict::Undecided(None),
            })
        }
        StabilityMethod::Eigenvalues | StabilityMethod::Simulate => Ok(Verdict::Undecided(None)),
    }
}

/// A mode of steady sliding with its shape: complex amplitudes of the pin, three per node, the largest of which is 1.
pub type Shape = (ComplexMode, Vec<Complex<f64>>);

/// The [`MODES`] leading modes of steady sliding at the point of a job, with their shapes.
///
/// # Errors
/// If there is no equilibrium, or if an iteration does not converge.
pub fn shapes(spec: &JobSpec, model: &Model, structures: &Structures) -> Result<Vec<Shape>, JobError> {
    // The number of modes is that of the record, so that both have the same ones.
    let of = |structure: &Structure| structure.point_with_shapes(model, &drive(spec), MODES);
    let point = structures.with(spec, model, of)?;
    Ok(point.modes.into_iter().map(|mode| (complex_mode(&mode), mode.shape)).collect())
}

fn growth(mode: &Mode) -> f64 {
    mode.eigenvalue_per_s.re
}

fn complex_mode(mode: &Mode) -> ComplexMode {
    let eigenvalue = mode.eigenvalue_per_s;
    let size = libm::hypot(eigenvalue.re, eigenvalue.im);
    // Rounding gives an eigenvalue without a vibration a small imaginary part of either sign.
    let vibrates = eigenvalue.im > NO_VIBRATION * size;
    let frequency_hz = if vibrates { eigenvalue.im / TAU } else { 0.0 };
    ComplexMode {
        damping_ratio: if size == 0.0 { 0.0 } else { -eigenvalue.re / size },
        residual: mode.residual,
        is_converged: mode.is_converged,
        ..ComplexMode::of(frequency_hz, eigenvalue.re)
    }
}

/// What is known above the band of a point.
fn above_band(point: &SlidingPoint) -> AboveBand {
    // The reduced way has modes near the end of its band badly; the sparse way has all of them.
    match point.damped_above_hz {
        _ if point.has_all_modes => AboveBand::Nothing,
        Some(limit_hz) if limit_hz <= point.sure_hz() => AboveBand::Damped,
        _ => AboveBand::NotLookedAt,
    }
}

/// What the eigenvalues of a point say, and whether they `decided` the job.
fn sliding_stability(point: &SlidingPoint, decided: bool) -> SlidingStability {
    let Equilibrium { in_contact, mu_star, .. } = &point.equilibrium;
    let contact_nodes = in_contact.iter().filter(|&&is_closed| is_closed).count();
    SlidingStability {
        decided,
        contact_nodes,
        lifted_nodes: in_contact.len() - contact_nodes,
        mu_star: *mu_star,
        band_hz: point.band_hz,
        above_band: above_band(point),
        damped_above_hz: point.damped_above_hz,
        modes: point.modes.iter().map(complex_mode).collect(),
    }
}

/// A node of the contact face in steady sliding.
#[derive(Debug, Clone, Copy)]
struct SlidingNode {
    sigma_n_pa: f64,
    /// Speed of the disk under it; 0 if it is lifted.
    slip_speed_m_s: f64,
    /// Distance from the undeformed disk; 0 if it is in contact.
    lift_m: f64,
    /// What friction lacks in y, over the scale of μ: N(1 − cos φ), with the angle φ of the disk's motion from +y.
    misaligned_n: f64,
}

impl SlidingNode {
    fn of(slave: usize, node: &SlaveNode, equilibrium: &Equilibrium, drive: &Drive) -> Self {
        let [x, y] = node.surface_motion;
        let motion = libm::hypot(x, y);
        if !equilibrium.in_contact[slave] {
            let gap_m = node.initial_gap_m + equilibrium.u_m[3 * node.node + 2] - equilibrium.disk_z_m[slave];
            let lift_m = gap_m.max(0.0);
            return Self { sigma_n_pa: 0.0, slip_speed_m_s: 0.0, lift_m, misaligned_n: 0.0 };
        }
        let normal_n = equilibrium.normal_n[slave];
        let misalignment = if motion == 0.0 { 0.0 } else { 1.0 - y / motion };
        Self {
            sigma_n_pa: normal_n / node.area_m2,
            slip_speed_m_s: (motion * drive.rate).abs(),
            lift_m: 0.0,
            misaligned_n: normal_n * misalignment * equilibrium.mu_share[slave],
        }
    }
}

/// The record of a job that has no run: steady sliding, with the `outcome` that the eigenvalues say.
fn record(spec: &JobSpec, model: &Model, point: &SlidingPoint, outcome: Outcome) -> JobRecord {
    let drive = drive(spec);
    let stability = sliding_stability(point, true);
    let is_stable = outcome == Outcome::Decayed && stability.above_band.is_known();
    let of = |(slave, node)| SlidingNode::of(slave, node, &point.equilibrium, &drive);
    let nodes: Vec<SlidingNode> = model.slaves().iter().enumerate().map(of).collect();
    let largest = |value: fn(&SlidingNode) -> f64| nodes.iter().map(value).fold(0.0, f64::max);
    // The time step is not in the key of modes that do not depend on it.
    let is_without_step = spec.stability == StabilityMethod::Modes && !spec.modes_need_time_step();
    let mu_star = stability.mu_star;
    let slip_reduction =
        point.equilibrium.mu * nodes.iter().map(|node| node.misaligned_n).sum::<f64>() / drive.force_n;
    let all = nodes.len() as f64;
    let observed = OBSERVED_NAMES.iter().zip(model.interface().edge_centres());
    JobRecord {
        outcome,
        regime: if is_stable { Regime::Stable } else { Regime::Undecided },
        mu_star,
        mu_star_se: 0.0,
        mu_star_contact: mu_star,
        frequency_hz: None,
        stick_share: 0.0,
        slip_share: stability.contact_nodes as f64 / all,
        separated_share: stability.lifted_nodes as f64 / all,
        n_over_f_min: 1.0,
        n_over_f_max: 1.0,
        sigma_n_max_pa: largest(|node| node.sigma_n_pa),
        slip_speed_max_m_s: largest(|node| node.slip_speed_m_s),
        lift_max_m: largest(|node| node.lift_m),
        cycles: 0,
        crossings_per_cycle: 1,
        simulated_s: 0.0,
        window_start_s: 0.0,
        steps: 0,
        time_step_s: if is_without_step { 0.0 } else { model.time_step_s() },
        time_step_limit_s: model.time_step_limit_s(),
        elements: spec.scene.pin.own_elements(),
        clamp_width_m: model.clamp_width_m(),
        energy_residual: 0.0,
        macroscopic_identity_residual: if spec.scene.contact.law.is_always_mu() {
            spec.scene.contact.mu - mu_star - slip_reduction
        } else {
            // As in a run: μ* is that of the contact.
            0.0
        },
        energy_identity_residual: 0.0,
        contact_loss_share: 0.0,
        plastic: None,
        mu_reduction_stick: 0.0,
        mu_reduction_slip: slip_reduction,
        growth_rate_per_s: point.modes.first().map(growth),
        obstacle: None,
        stability: Some(stability),
        sliding_mesh_error: Some(error_of_sliding(spec, model)),
        accuracy_reached: None,
        start: None,
        windows: Vec::new(),
        disk: model.ring().map(|body| elastic_disk(body, &Solves::default(), 1)),
        holder: Vec::new(),
        energy: EnergyTotals::default(),
        nodes: observed.map(|(name, slave)| observed_node(name, &nodes[slave])).collect(),
    }
}

fn observed_node(name: &str, node: &SlidingNode) -> ObservedNode {
    ObservedNode {
        name: name.to_owned(),
        y_peak_to_peak_m: 0.0,
        lift_max_m: node.lift_m,
        sigma_n_max_pa: node.sigma_n_pa,
        slip_speed_max_m_s: node.slip_speed_m_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec() -> JobSpec {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = [3, 4, 3];
        spec.scene.clamp.width_m = 0.004;
        spec
    }

    fn point(model: &Model, growth_per_s: f64) -> SlidingPoint {
        let slaves = model.slaves();
        let mut in_contact = vec![true; slaves.len()];
        in_contact[0] = false;
        let area_m2: f64 = slaves[1..].iter().map(|node| node.area_m2).sum();
        let normal_n = |node: &SlaveNode| 30.0 * node.area_m2 / area_m2;
        let mut normal_n: Vec<f64> = slaves.iter().map(normal_n).collect();
        normal_n[0] = 0.0;
        let mut u_m = vec![0.0; 3 * model.mesh().node_count()];
        u_m[3 * slaves[0].node + 2] = 2.0e-6;
        let misaligned = slaves.iter().zip(&normal_n).map(|(node, n)| {
            n * node.surface_motion[1] / libm::hypot(node.surface_motion[0], node.surface_motion[1])
        });
        let mu_star = 0.4 * misaligned.sum::<f64>() / 30.0;
        let mode = Mode {
            eigenvalue_per_s: Complex::new(growth_per_s, 300.0),
            eigenvalue_in_steps_per_s: Complex::new(growth_per_s, 300.0),
            residual: 1.0e-10,
            growth_error_per_s: 0.0,
            is_converged: true,
            shape: Vec::new(),
        };
        SlidingPoint {
            equilibrium: Equilibrium {
                u_m,
                normal_n,
                mu_share: vec![1.0; in_contact.len()],
                disk_z_m: vec![0.0; in_contact.len()],
                in_contact,
                mu: 0.4,
                mu_star,
            },
            modes: vec![mode],
            band_hz: 5.0e4,
            basis: 40,
            has_all_modes: true,
            damped_above_hz: None,
            is_reduced: true,
        }
    }

    /// Protects: the record of a job without a run describes steady sliding: its shares, stress, lift and the part of
    /// μ − μ* that the disk's curved motion makes, with which the macroscopic identity closes.
    #[test]
    fn a_decided_record_describes_steady_sliding() {
        let spec = spec();
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let record = record(&spec, &model, &point(&model, -400.0), Outcome::Decayed);
        assert_eq!((record.regime, record.steps, record.frequency_hz), (Regime::Stable, 0, None));
        assert_eq!((record.slip_share, record.separated_share), (19.0 / 20.0, 1.0 / 20.0));
        assert_eq!((record.lift_max_m, record.growth_rate_per_s), (2.0e-6, Some(-400.0)));
        let pressure_pa = 30.0 / model.slaves()[1..].iter().map(|node| node.area_m2).sum::<f64>();
        assert!((record.sigma_n_max_pa / pressure_pa - 1.0).abs() < 1.0e-12);
        assert!(record.mu_reduction_slip > 0.0 && record.macroscopic_identity_residual.abs() < 1.0e-12);
        assert_eq!(record.non_finite_number(), None);
        let stability = record.stability.unwrap();
        assert!(stability.decided && stability.modes[0].damping_ratio == 0.8);
        assert_eq!((stability.contact_nodes, stability.lifted_nodes), (19, 1));
    }

    /// Protects: a mode that does not vibrate has the frequency 0 whatever rounding its eigenvalue has, and a slow vibration keeps its own.
    #[test]
    fn a_mode_that_does_not_vibrate_has_no_frequency() {
        let mut mode =
            point(&Model::from_scene(&spec().scene, &spec().numerics).unwrap(), -400.0).modes.remove(0);
        for (im, expected_hz) in [(-2.0e-11, 0.0), (2.0e-11, 0.0), (TAU, 1.0)] {
            mode.eigenvalue_per_s = Complex::new(-15_649.9, im);
            assert_eq!(complex_mode(&mode).frequency_hz, expected_hz);
        }
    }

    /// Protects: what is above a band is known only if the basis has all modes, or if none can grow from where its modes are sure.
    #[test]
    fn what_is_above_the_band_is_said() {
        let mut point = point(&Model::from_scene(&spec().scene, &spec().numerics).unwrap(), -400.0);
        assert_eq!(above_band(&point), AboveBand::Nothing);
        point.has_all_modes = false;
        assert_eq!(above_band(&point), AboveBand::NotLookedAt);
        for (limit_hz, is_reduced, expected) in [
            (4.9e4, true, AboveBand::NotLookedAt),
            (4.2e4, true, AboveBand::Damped),
            (4.9e4, false, AboveBand::Damped),
            (5.1e4, false, AboveBand::NotLookedAt),
        ] {
            (point.damped_above_hz, point.is_reduced) = (Some(limit_hz), is_reduced);
            assert_eq!(above_band(&point), expected);
        }
    }

    /// Protects: threads share the structure of a model, whatever the friction, speed, load and run of their jobs.
    #[test]
    fn structures_are_shared_by_model() {
        let structures = Structures::default();
        let own = structures.of(&spec());
        let mut other = spec();
        other.scene.contact.mu = 0.7;
        other.run.limit_s = 0.01;
        other.stability = StabilityMethod::Modes;
        assert!(Arc::ptr_eq(&own, &structures.clone().of(&other)));
        for nz in 4..4 + KEPT {
            other.scene.pin.elements[2] = nz;
            assert!(!Arc::ptr_eq(&own, &structures.of(&other)));
        }
        assert!(!Arc::ptr_eq(&own, &structures.of(&spec())), "the oldest is forgotten");
    }
}
