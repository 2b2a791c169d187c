//! The analysis of one lane. It receives the run step by step.

use super::cycles::{Cycle, CycleCutter};
use super::decay::{self, DecayMonitor};
use super::drive::drive;
use super::lines;
use super::mesh_error::error_of_sliding;
use super::nested::CoarseStart;
use super::noted::Noted;
use super::plastic::{self, NEGLIGIBLE_SHARE};
use super::program::ProgramWindows;
use super::record::{
    ElasticDisk, EnergyTotals, HolderMotion, JobRecord, ObservedNode, Outcome, PlasticFlow, Regime,
    SlidingStability,
};
use super::sample::{DIRECTIONS, OBSERVED_NAMES, Sample};
use super::steady::{self, Obstacle, SteadyState};
use super::sums::Sums;
use super::window::{LateWindow, Settling, Trailing, Window};
use crate::solver::Model;
use crate::solver::body::ring::RingBody;
use crate::solver::energy::Energies;
use crate::solver::interface::solve::Solves;
use crate::spec::{Holder, JobSpec, Precision, SlowTimes};
use crate::stability::SlidingFriction;
use serde::{Deserialize, Serialize};

/// Evaluates the run of one job and creates its record.
#[derive(Serialize, Deserialize)]
pub struct LaneAnalysis {
    #[serde(skip)]
    spec: JobSpec,
    cutter: CycleCutter,
    /// None if the run is shorter than one observation: the monitor would store samples, but could never
    /// judge them.
    monitor: Option<DecayMonitor>,
    cycles: Vec<Cycle>,
    steady: Option<SteadyState>,
    /// The cycles of T, if a holder moves.
    swings: Option<Swings>,
    /// Whether all oscillations decay, and whether the means have settled, too.
    oscillations_decay: bool,
    decays: bool,
    late: LateWindow,
    trailing: Trailing,
    /// The windows of a job with a program. Such a run has no steady state, and nothing looks for one.
    windows: Option<ProgramWindows>,
    /// The eigenvalues that left the decision to the run, if they were computed.
    stability: Option<SlidingStability>,
    /// Whether they know a growing mode that the run may not show: in single precision a growth that begins at rounding is
    /// hidden for a long time.
    may_grow_from_rounding: bool,
    /// Width and length \[m\] of the contact face.
    extent_m: [f64; 2],
    /// The run on a coarser mesh, if there was one.
    start: Option<CoarseStart>,
}

/// The cycles of the force T that a holder carries.
#[derive(Serialize, Deserialize)]
struct Swings {
    cutter: CycleCutter,
    cycles: Vec<Cycle>,
    steady: Option<SteadyState>,
}

impl Swings {
    fn of(slow: SlowTimes, time_step_s: f64, ramp_s: f64) -> Self {
        let cutter = CycleCutter::of_holder(time_step_s, ramp_s, slow.swing_s);
        Self { cutter, cycles: Vec::new(), steady: None }
    }

    fn push(&mut self, sample: &Sample, energies: &Energies, spec: &JobSpec) {
        let Some(cycle) = self.cutter.push(sample, energies) else { return };
        self.cycles.push(cycle);
        let slow = spec.scene.slow_times();
        self.steady = slow.and_then(|slow| steady::find_swing(&self.cycles, &spec.detection, slow));
    }
}

impl LaneAnalysis {
    /// The analysis of the job `spec`.
    pub fn new(model: &Model, spec: JobSpec) -> Self {
        let ramp_s = spec.scene.load.ramp_s;
        // Times are multiples of the step, so two steps are added as a tolerance.
        let slidable_s = spec.run.limit_s - ramp_s + 2.0 * model.time_step_s();
        let has_program = !spec.scene.program.is_constant();
        let late_s = (1.0 - spec.run.average_last_fraction) * spec.run.limit_s;
        let observation_s = spec.observation_s();
        let observes = !has_program && observation_s <= slidable_s;
        let (time_step_s, floor) = (model.time_step_s(), decay_floor(model, &spec));
        let moves = !spec.scene.holder.is_ideal();
        let slow = spec.scene.slow_times().filter(|_| moves && !has_program);
        Self {
            cutter: CycleCutter::new(model, ramp_s),
            monitor: observes.then(|| DecayMonitor::new(time_step_s, ramp_s, observation_s, floor, moves)),
            cycles: Vec::new(),
            steady: None,
            swings: slow.map(|slow| Swings::of(slow, time_step_s, ramp_s)),
            oscillations_decay: false,
            decays: false,
            late: LateWindow::from(if has_program { ramp_s } else { late_s }),
            trailing: Trailing::new(observation_s, time_step_s),
            windows: has_program.then(|| ProgramWindows::of(&spec)),
            stability: None,
            may_grow_from_rounding: false,
            extent_m: model.interface().extent_m(),
            start: None,
            spec,
        }
    }

    /// Adds the eigenvalues of steady sliding to the record.
    pub fn note(&mut self, Noted { stability, grows }: Noted) {
        self.stability = Some(stability);
        self.may_grow_from_rounding = grows && self.spec.numerics.precision == Precision::Single;
    }

    /// Adds the run on a coarser mesh to the record.
    pub fn start_from(&mut self, start: Option<CoarseStart>) {
        self.start = start;
    }

    /// Whether other jobs may continue this one.
    pub fn can_be_continued(&self) -> bool {
        self.spec.continuation.is_some()
    }

    /// The run on a coarser mesh, if there was one.
    pub fn start(&self) -> Option<&CoarseStart> {
        self.start.as_ref()
    }

    /// Time \[s\] that the job could have simulated meanwhile on its own mesh, about.
    pub fn spent_s(&self) -> f64 {
        self.start.as_ref().map_or(0.0, |start| start.spent_s(self.spec.scene.pin.elements))
    }

    /// Adds the job's specification to an analysis that was read from a checkpoint, which does not contain
    /// it.
    #[must_use]
    pub fn of(self, spec: JobSpec) -> Self {
        Self { spec, ..self }
    }

    /// Adds a step. `energies` are those of the last audit.
    pub fn push(&mut self, sample: &Sample, energies: &Energies) {
        let cycle = self.cutter.push(sample, energies);
        if let Some(windows) = &mut self.windows {
            windows.push(&self.spec, sample, cycle.as_ref());
            self.late.push(sample, energies);
            self.trailing.push(sample, energies);
            return;
        }
        if let Some(cycle) = cycle {
            self.cycles.push(cycle);
            self.steady = steady::find(&self.cycles, &self.spec.detection, self.spec.scene.slow_times());
        }
        if let Some(swings) = &mut self.swings {
            swings.push(sample, energies, &self.spec);
        }
        self.late.push(sample, energies);
        self.trailing.push(sample, energies);
        let decay = self.monitor.as_mut().is_some_and(|monitor| monitor.push(sample));
        let decay = decay && !self.may_grow_from_rounding;
        // The means hardly change from step to step.
        let is_due = decay && (!self.oscillations_decay || self.trailing.begins_block());
        if is_due && !self.decays {
            self.decays = self.settling().is_done(self.spec.detection.drift_tolerance)
                && self.trailing.flow_share(energies).abs() <= NEGLIGIBLE_SHARE;
        }
        self.decays &= decay;
        self.oscillations_decay = decay;
    }

    /// How far the means of decaying sliding are from their ends.
    fn settling(&self) -> Settling {
        self.trailing.settling(|[x, y]| steady_mu(&self.spec, self.extent_m, [x, y]))
    }

    /// Whether the holder moves, with the pin's top.
    fn holder_moves(&self) -> bool {
        !self.spec.scene.holder.is_ideal()
    }

    /// Whether the run can stop: its state is periodic, or it was measured to decay.
    pub fn is_settled(&self) -> bool {
        self.periodic().is_some() || self.decays
    }

    /// The periodic state with its cycles: those of N, or else those of the holder.
    fn periodic(&self) -> Option<(SteadyState, &[Cycle])> {
        let of_n = self.steady.map(|steady| (steady, self.cycles.as_slice()));
        of_n.or_else(|| {
            let swings = self.swings.as_ref()?;
            Some((swings.steady?, swings.cycles.as_slice()))
        })
    }

    /// The record of a run that ended after `steps` steps with these final `energies`. `solves` are the
    /// contact solves on an elastic disk, `plastic` the plastic work \[J\] and the largest plastic strain of a pin that may yield.
    pub fn record(
        &self,
        model: &Model,
        steps: u64,
        energies: &Energies,
        solves: Option<&Solves>,
        plastic: Option<[f64; 2]>,
    ) -> JobRecord {
        let simulated_s = steps as f64 * model.time_step_s();
        let periodic = self.periodic();
        let outcome = match periodic {
            _ if self.windows.is_some() => Outcome::Completed,
            _ if self.decays => Outcome::Decayed,
            Some(_) => Outcome::Periodic,
            None => Outcome::NotPeriodic,
        };
        let window = self.window(simulated_s);
        let sums = &window.sums;
        let [stick, slip, separated] = sums.shares();
        let load_n = self.spec.scene.load.force_n;
        let holder_moves = self.holder_moves();
        // The blocks of a decay have its trend in them, and the window is tapered.
        let mu_star_se = if self.decays {
            self.settling().error()
        } else {
            steady::standard_error_with_drift(&window.mu_star_parts)
        };
        JobRecord {
            outcome,
            regime: regime(outcome, stick, separated, self.spec.detection.regime_threshold),
            mu_star: sums.mu_star_without_momentum(holder_moves),
            mu_star_se,
            mu_star_contact: sums.mu_star_contact(),
            frequency_hz: window.frequency_hz,
            stick_share: stick,
            slip_share: slip,
            separated_share: separated,
            n_over_f_min: sums.normal_min_n / load_n,
            n_over_f_max: sums.normal_max_n / load_n,
            sigma_n_max_pa: sums.sigma_n_max_pa,
            slip_speed_max_m_s: sums.slip_speed_max_m_s,
            lift_max_m: sums.lift_max_m,
            cycles: window.cycles,
            crossings_per_cycle: self.crossings_per_cycle(),
            simulated_s,
            window_start_s: window.start_s,
            steps,
            time_step_s: model.time_step_s(),
            time_step_limit_s: model.time_step_limit_s(),
            elements: self.spec.scene.pin.own_elements(),
            clamp_width_m: model.clamp_width_m(),
            energy_residual: energies.relative_residual(),
            macroscopic_identity_residual: if self.spec.scene.contact.law.is_always_mu() {
                let mu = self.spec.scene.contact.mu;
                mu - sums.mu_star() - sums.stick_reduction() - sums.slip_reduction()
            } else {
                // The mean coefficient is not known otherwise, and that of the contact is what remains.
                sums.mu_star_contact() - sums.mu_star()
            },
            energy_identity_residual: energy_identity(&window.energies, energies),
            contact_loss_share: contact_loss_share(&window.energies, energies),
            mu_reduction_stick: sums.stick_reduction(),
            mu_reduction_slip: sums.slip_reduction(),
            growth_rate_per_s: self.monitor.as_ref().and_then(DecayMonitor::growth_rate_per_s),
            obstacle: (outcome == Outcome::NotPeriodic).then(|| self.obstacle(energies)),
            stability: self.stability.clone(),
            sliding_mesh_error: self.decays.then(|| error_of_sliding(&self.spec, model)),
            accuracy_reached: None,
            start: self.start.clone(),
            disk: model.ring().zip(solves).map(|(body, solves)| elastic_disk(body, solves, steps)),
            holder: holder_motion(&self.spec.scene.holder, sums),
            windows: self.windows.as_ref().map_or_else(Vec::new, |windows| windows.all(&self.spec)),
            plastic: plastic.map(|[work_j, strain_max]| PlasticFlow {
                strain_max,
                work_j,
                share: plastic::share(&window.energies, energies),
            }),
            energy: totals(energies),
            nodes: observed_nodes(sums),
        }
        .judged_by(self.spec.accuracy)
    }

    /// Crossings of N = F in one limit cycle; 1 if there is none. In a cycle of the holder it is the nearest whole number.
    fn crossings_per_cycle(&self) -> usize {
        let Some((state, cycles)) = self.periodic() else { return 1 };
        if self.steady.is_some() {
            return state.crossings_per_cycle;
        }
        let window = &cycles[cycles.len() - state.window_crossings..];
        let [start_s, end_s] = [window[0].start_s, window[window.len() - 1].end_s];
        let of_n =
            self.cycles.iter().filter(|cycle| cycle.start_s >= start_s && cycle.end_s <= end_s).count();
        let groups = window.len() / state.crossings_per_cycle;
        (of_n as f64 / groups as f64).round().max(1.0) as usize
    }

    /// Why the end of the run counts neither as periodic nor as decayed.
    fn obstacle(&self, energies: &Energies) -> Obstacle {
        if self.oscillations_decay {
            let share = self.trailing.flow_share(energies);
            if share.abs() > NEGLIGIBLE_SHARE {
                return Obstacle::Flow { share };
            }
            let Settling { still_to_come, imbalance, .. } = self.settling();
            return Obstacle::Creep { still_to_come, imbalance };
        }
        steady::obstacle(&self.cycles, &self.spec.detection, self.spec.scene.slow_times())
    }

    /// The averaging window:
    /// * Decayed: the last observation time, tapered, whether or not it contains cycles.
    /// * Periodic: the cycles in which the state was found periodic. If `stop_early` is false: all whole
    ///   cycles in the last part of the run.
    /// * Neither: all whole cycles in the last part of the run. If they are too few or cover less than half
    ///   of this part: the part itself. If not a single step falls into it: the last observation time.
    /// * With a program: the run after the load's ramp. Its μ* has no standard error, because it is no mean of a steady state.
    fn window(&self, simulated_s: f64) -> Window {
        let moves = self.holder_moves();
        if self.decays {
            return self.trailing.window(true, moves);
        }
        let periodic = self.periodic();
        let (crossings, all) =
            periodic.map_or((1, self.cycles.as_slice()), |(steady, all)| (steady.crossings_per_cycle, all));
        let cycles = match periodic {
            Some((steady, _)) if self.spec.run.stop_early => &all[all.len() - steady.window_crossings..],
            _ => &all[all.partition_point(|c| c.start_s < self.late.start_s)..],
        };
        let whole = &cycles[cycles.len() % crossings..];
        let duration_s = whole.last().map_or(0.0, |last| last.end_s - whole[0].start_s);
        let covers = periodic.is_some() || duration_s >= 0.5 * (simulated_s - self.late.start_s);
        if whole.len() < 2 * crossings || !covers {
            let trailing = self.trailing.window(false, moves);
            if self.late.sums.is_empty() {
                return trailing;
            }
            return Window {
                start_s: self.late.start_s,
                sums: self.late.sums,
                energies: self.late.energies.unwrap_or_default(),
                // There are no cycles here, so equal blocks of the last observation time replace them.
                mu_star_parts: if self.windows.is_none() { trailing.mu_star_parts } else { Vec::new() },
                cycles: 0,
                frequency_hz: None,
            };
        }
        let mu_star_parts: Vec<f64> = whole
            .chunks_exact(crossings)
            .map(|group| Sums::merged(group.iter().map(|cycle| &cycle.sums)).mu_star_without_momentum(moves))
            .collect();
        Window {
            start_s: whole[0].start_s,
            sums: Sums::merged(whole.iter().map(|cycle| &cycle.sums)),
            energies: whole[0].energies,
            cycles: mu_star_parts.len(),
            mu_star_parts,
            frequency_hz: Some(steady::frequency_hz(whole, crossings)),
        }
    }
}

/// The friction coefficient of steady sliding at a point of the contact face, in its width and length from the pin's axis; none for a law that
/// uses the past. The disk moves there as fast as its distance from the axis of the disk says.
fn steady_mu(spec: &JobSpec, [width_m, length_m]: [f64; 2], [x, y]: [f64; 2]) -> Option<f64> {
    let radius_m = libm::hypot(spec.scene.disk.track_radius_m + width_m * x, length_m * y);
    let friction = SlidingFriction::new(&[radius_m], &drive(spec)).ok()?;
    Some(friction.mu_of(0))
}

/// Amplitude, over F, below which growth and decay cannot be measured.
fn decay_floor(model: &Model, spec: &JobSpec) -> f64 {
    match spec.numerics.precision {
        Precision::Single => decay::SINGLE_FLOOR,
        Precision::Double if model.ring().is_some() => decay::ELASTIC_FLOOR,
        Precision::Double => lines::ROUNDING,
    }
}

/// The regime that follows from the outcome and the shares of stick and separation.
fn regime(outcome: Outcome, stick: f64, separated: f64, threshold: f64) -> Regime {
    match (stick > threshold, separated > threshold) {
        _ if outcome == Outcome::Decayed => Regime::Stable,
        (true, true) => Regime::StickSlipSeparation,
        (true, false) => Regime::StickSlip,
        (false, true) => Regime::SlipSeparation,
        // A limit cycle with little stick and little separation is named after the larger share.
        (false, false) if outcome == Outcome::Periodic && stick >= separated => Regime::StickSlip,
        (false, false) if outcome == Outcome::Periodic => Regime::SlipSeparation,
        (false, false) => Regime::Undecided,
    }
}

/// (work of drive and load − losses − change of stored energy) / drive work, over the window.
fn energy_identity(start: &Energies, end: &Energies) -> f64 {
    let drive_j = end.drive_work_j - start.drive_work_j;
    if drive_j == 0.0 { 0.0 } else { (end.imbalance_j() - start.imbalance_j()) / drive_j }
}

/// Contact loss / drive work, over the window.
fn contact_loss_share(start: &Energies, end: &Energies) -> f64 {
    let drive_j = end.drive_work_j - start.drive_work_j;
    if drive_j == 0.0 { 0.0 } else { (end.contact_loss_j - start.contact_loss_j) / drive_j }
}

/// The mesh of an elastic disk, and its contact solves in so many steps.
pub(super) fn elastic_disk(body: &RingBody, solves: &Solves, steps: u64) -> ElasticDisk {
    let made = body.mesh().report();
    ElasticDisk {
        elements: made.elements,
        track_element_m: made.track_element_m,
        longest_edge_m: made.longest_edge_m,
        stages: body.stages().count(),
        sweeps_mean: solves.sweeps / steps as f64,
        sweeps_max: solves.most_sweeps,
        residual_max: solves.residual,
    }
}

fn totals(energies: &Energies) -> EnergyTotals {
    EnergyTotals {
        kinetic_j: energies.kinetic_j,
        elastic_j: energies.elastic_j,
        load_work_j: energies.load_work_j,
        drive_work_j: energies.drive_work_j,
        friction_j: energies.friction_j,
        damping_j: energies.damping_j,
        contact_loss_j: energies.contact_loss_j,
    }
}

/// The directions in which a holder moves.
fn holder_motion(holder: &Holder, sums: &Sums) -> Vec<HolderMotion> {
    let motion = |axis: usize| {
        let [peak_to_peak_m, acceleration_rms_m_s2] = sums.holder(axis);
        HolderMotion { direction: DIRECTIONS[axis].to_owned(), peak_to_peak_m, acceleration_rms_m_s2 }
    };
    let moves = holder.directions();
    (0..3).filter(|axis| moves[*axis].is_some()).map(motion).collect()
}

fn observed_nodes(sums: &Sums) -> Vec<ObservedNode> {
    OBSERVED_NAMES
        .iter()
        .zip(&sums.nodes)
        .map(|(name, node)| ObservedNode {
            name: (*name).to_owned(),
            y_peak_to_peak_m: node.y_peak_to_peak_m(),
            lift_max_m: node.lift_max_m,
            sigma_n_max_pa: node.sigma_n_max_pa,
            slip_speed_max_m_s: node.slip_speed_max_m_s,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{contact_loss_share, energy_identity, regime};
    use crate::analysis::record::{Outcome, Regime};
    use crate::solver::energy::Energies;

    /// Protects: stick and separation each count from the threshold on. A limit cycle with little of both is named after
    /// the larger share, another run is undecided, and decayed sliding is stable whatever the shares.
    #[test]
    fn a_regime_follows_from_the_shares() {
        for (outcome, stick, separated, expected) in [
            (Outcome::Periodic, 0.3, 0.2, Regime::StickSlipSeparation),
            (Outcome::Periodic, 0.3, 0.0, Regime::StickSlip),
            (Outcome::Periodic, 0.0, 0.2, Regime::SlipSeparation),
            (Outcome::NotPeriodic, 0.3, 0.0, Regime::StickSlip),
            (Outcome::NotPeriodic, 0.0, 0.2, Regime::SlipSeparation),
            (Outcome::Periodic, 0.004, 0.002, Regime::StickSlip),
            (Outcome::Periodic, 0.002, 0.004, Regime::SlipSeparation),
            (Outcome::NotPeriodic, 0.004, 0.002, Regime::Undecided),
            (Outcome::Decayed, 0.3, 0.2, Regime::Stable),
        ] {
            let found = regime(outcome, stick, separated, 0.01);
            assert_eq!(found, expected, "{outcome:?}, stick {stick}, separated {separated}");
        }
    }

    /// Protects: energies are balanced over the window, relative to the work of the drive in it, and a window without
    /// such work has shares of zero.
    #[test]
    fn energies_are_those_of_the_window() {
        let start = Energies { drive_work_j: 3.0, friction_j: 1.0, kinetic_j: 2.0, ..Energies::default() };
        let end = Energies { drive_work_j: 7.0, contact_loss_j: 0.5, friction_j: 4.0, ..start };
        // Put in are 4 J, lost are 3 J by friction and 0.5 J in impacts.
        assert_eq!((energy_identity(&start, &end), contact_loss_share(&start, &end)), (0.125, 0.125));
        assert_eq!((energy_identity(&end, &end), contact_loss_share(&end, &end)), (0.0, 0.0));
    }
}
