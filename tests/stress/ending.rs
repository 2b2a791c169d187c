//! How a case ends, and whether this ending is allowed.

use crate::stress::audited::{Audited, Rounded};
use serde_json::Value;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use tribosweep_mechanics::analysis::{JobError, JobObserver, JobRecord, Moment, drive, drive_at, solve};
use tribosweep_mechanics::solver::{Model, SolverError, StateOf};
use tribosweep_mechanics::spec::{FrictionLaw, JobSpec, Precision};

/// A legal ending.
#[derive(Debug, Clone)]
pub enum Ending {
    /// A record whose energies close.
    Result(Box<Closure>),
    /// A refusal before the first step.
    Refused {
        /// The check that refused the job.
        by: &'static str,
        /// The message of the error.
        message: String,
    },
    /// A run that was stopped, with step and node.
    Diverged {
        /// The step.
        step: u64,
        /// The message of the error.
        message: String,
    },
}

/// How well the energies of a result close; see [`crate::stress::audited`].
#[derive(Debug, Clone)]
pub struct Closure {
    /// The record's outcome.
    pub outcome: &'static str,
    /// Time steps.
    pub steps: u64,
    /// |imbalance| over the rounding bound, with an audit at every step; must be ≤ 1.
    pub imbalance_over_bound: f64,
    /// |imbalance| over the energy put in, with an audit at every step.
    pub residual: f64,
    /// The rounding bound over the energy put in. The check is meaningful if this is below 1.
    pub bound_over_input: f64,
    /// The record's own residual. It includes the sampling error of the damping's work.
    pub sampled_residual: f64,
    /// Largest stored energy over the energy put in. If it is above 1, contact or damping has supplied
    /// energy.
    pub highest_stored: f64,
    /// The same for the sum of the magnitudes of the parts of the stored energy.
    pub highest_magnitude: f64,
}

#[derive(Default)]
struct Watch {
    steps: u64,
    last_progress_s: f64,
    ran_backwards: bool,
}

impl JobObserver for Watch {
    fn step(&mut self, _: &Moment<'_>) {
        self.steps += 1;
    }

    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        self.ran_backwards |= simulated_s.is_nan() || simulated_s < self.last_progress_s;
        self.last_progress_s = simulated_s;
        ControlFlow::Continue(())
    }
}

/// Solves `spec` as the queue does and judges how it ends.
///
/// # Errors
/// The reason why the ending is not allowed.
pub fn examine(spec: &JobSpec) -> Result<Ending, String> {
    let mut watch = Watch::default();
    let solved = catch_unwind(AssertUnwindSafe(|| solve(spec, &mut watch)));
    let Ok(solved) = solved else { return Err("it panicked".to_owned()) };
    require(!watch.ran_backwards, || "time ran backwards".to_owned())?;
    match solved {
        Ok(record) => match spec.numerics.precision {
            Precision::Double => result::<f64>(spec, &record, watch.steps),
            Precision::Single => result::<f32>(spec, &record, watch.steps),
        },
        Err(error) => failure(spec, &error, watch.steps),
    }
}

fn require(holds: bool, otherwise: impl Fn() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn failure(spec: &JobSpec, error: &JobError, steps: u64) -> Result<Ending, String> {
    let message = error.to_string();
    let by = match error {
        JobError::Spec(_) => "JobSpec::check",
        JobError::Solver(SolverError::TimeStepTooLarge { .. }) => "time step above the limit",
        JobError::Solver(SolverError::ClampOffMesh { .. }) => "clamp off the mesh",
        JobError::Solver(SolverError::BeyondSinglePrecision { .. }) => "beyond single precision",
        JobError::TooManySteps { .. } => "too many steps",
        JobError::RiseTooSteep { .. } => "friction that rises too steeply",
        JobError::Solver(SolverError::Diverged { step, node, .. }) => {
            let nodes: usize = spec.scene.pin.elements.iter().map(|n| n + 1).product();
            require(*step == steps && *node < nodes, || format!("step {step} of {steps}, node {node}"))?;
            require(!message.contains("NaN"), || format!("a message with NaN: {message}"))?;
            return Ok(Ending::Diverged { step: *step, message });
        }
        other => return Err(format!("it ended as no case may, after {steps} steps: {other:?}: {message}")),
    };
    require(steps == 0, || format!("refused after {steps} steps: {message}"))?;
    let field = ["scene.", "numerics.", "run.", "detection."].iter().any(|part| message.contains(part));
    require(field, || format!("a refusal that names no field: {message}"))?;
    Ok(Ending::Refused { by, message })
}

fn result<R: Rounded>(spec: &JobSpec, record: &JobRecord, steps: u64) -> Result<Ending, String> {
    require(record.steps == steps && steps > 0, || format!("{} of {steps} steps", record.steps))?;
    stored_as_it_is(record)?;
    plausible(spec, record, R::EPSILON)?;
    let model = Model::from_scene(&spec.scene, &spec.numerics).map_err(|error| error.to_string())?;
    let mut run = Audited::<R>::new(&model, drive(spec), StateOf::at_rest(&model));
    if spec.scene.program.is_constant() {
        run.run(steps);
    } else {
        for n in 0..steps {
            run.drive = drive_at(spec, n as f64 * model.time_step_s(), model.time_step_s());
            run.run(1);
        }
        // The bounds are those of the largest load.
        run.drive = drive(spec);
    }
    same_energies(record, &run)?;

    let (energies, bound_j) = (run.energies(), run.rounding_bound_j());
    let imbalance_j = energies.imbalance_j().abs();
    let input_j = energies.input_j();
    let over = |part: f64, whole: f64| if part == 0.0 { 0.0 } else { part / whole };
    let closure = Closure {
        outcome: record.outcome.name(),
        steps,
        imbalance_over_bound: over(imbalance_j, bound_j),
        residual: over(imbalance_j, input_j),
        bound_over_input: over(bound_j, input_j),
        sampled_residual: record.energy_residual,
        highest_stored: run.highest_ratios()[0],
        highest_magnitude: run.highest_ratios()[1],
    };
    require(closure.imbalance_over_bound <= 1.0, || {
        format!("the energies do not close: {closure:?}: {energies:?}")
    })?;
    // The imbalance of the record is the sampling error of the damping's work and nothing else.
    let (exact, sampled) = (run.energies_at_job_audit(), run.sampled_energies());
    let unexplained_j = (sampled.imbalance_j() + sampled.damping_j) - (exact.imbalance_j() + exact.damping_j);
    require(unexplained_j.abs() <= bound_j, || format!("sampling changed {unexplained_j} J: {closure:?}"))?;
    Ok(Ending::Result(Box::new(closure)))
}

/// Checks that a record is unchanged after the queue stores it and the report reads it. No figure is null
/// except those that may be absent.
fn stored_as_it_is(record: &JobRecord) -> Result<(), String> {
    let text = serde_json::to_string(record).map_err(|error| error.to_string())?;
    let read: JobRecord = serde_json::from_str(&text).map_err(|error| format!("{error}: {text}"))?;
    require(read == *record, || format!("read back differently: {text}"))?;
    let Ok(Value::Object(fields)) = serde_json::to_value(record) else { return Err("no object".to_owned()) };
    let null = fields.iter().find(|(name, value)| value.is_null() && *name != "frequency_hz");
    require(null.is_none(), || format!("null: {null:?}"))
}

/// Checks facts that hold for every record, whatever the scene.
fn plausible(spec: &JobSpec, record: &JobRecord, epsilon: f64) -> Result<(), String> {
    let shares = [record.stick_share, record.slip_share, record.separated_share];
    let rounding = 1.0e-9;
    let sum: f64 = shares.iter().sum();
    let within = shares.iter().all(|share| (0.0..=1.0 + rounding).contains(share));
    require(within && (sum - 1.0).abs() < rounding, || format!("shares {shares:?}"))?;
    // Where no node's friction exceeds μN, neither does the mean. The direction and the product are rounded.
    let contact = spec.scene.contact.in_use();
    let most = match contact.law {
        // Friction that rises with the speed, or that outlives a fall of the normal force, has no such limit.
        FrictionLaw::Exponential if contact.slope_s_m.is_some() => f64::INFINITY,
        FrictionLaw::PrakashClifton => f64::INFINITY,
        _ => {
            let scale = contact.mu / contact.mu_of_speed.fast().unwrap_or(1.0);
            let table = contact.mu_of_speed.0.iter().map(|[_, mu]| scale * mu).fold(0.0, f64::max);
            let largest = contact.mu.max(contact.mu_static.unwrap_or(0.0)).max(table);
            largest * (1.0 + rounding + 100.0 * epsilon)
        }
    };
    require(record.mu_star_contact.abs() <= most, || {
        format!("mean contact friction {}", record.mu_star_contact)
    })?;
    // Contact pushes and never pulls.
    let extremes = [record.n_over_f_min, record.n_over_f_max];
    require(extremes[0] >= 0.0 && extremes[0] <= extremes[1], || format!("N/F {extremes:?}"))?;
    let time_s = record.steps as f64 * record.time_step_s;
    require((record.simulated_s - time_s).abs() <= rounding * time_s, || format!("{time_s} s"))
}

/// Checks that the audited run is the job's run: its sampled ledger has the same bits.
fn same_energies<R: Rounded>(record: &JobRecord, run: &Audited<'_, R>) -> Result<(), String> {
    let (job, again) = (&record.energy, run.sampled_energies());
    let pairs = [
        (job.kinetic_j, again.kinetic_j),
        (job.elastic_j, again.elastic_j),
        (job.load_work_j, again.load_work_j),
        (job.drive_work_j, again.drive_work_j),
        (job.friction_j, again.friction_j),
        (job.damping_j, again.damping_j),
        (job.contact_loss_j, again.contact_loss_j),
    ];
    let same = pairs.iter().all(|(a, b)| a.to_bits() == b.to_bits());
    require(same, || format!("another run: {job:?} and {again:?}"))
}
