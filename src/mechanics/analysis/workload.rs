//! What jobs take, known before their first step: nodes, time step, memory, and when they are likely to end.

use super::error::{JobError, check_step, step_count};
use crate::solver::Model;
use crate::solver::body::pin::operator::Yielding;
use crate::solver::scheme::Bound;
use crate::spec::{DiskKind, JobSpec, Precision, StabilityMethod, Strains, elasticity};
use crate::stability::Structure;
use serde::Serialize;

/// What the jobs of one model take.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Workload {
    /// Number of elements of the pin in x, y and z.
    pub elements: [usize; 3],
    /// Number type of the fields.
    pub precision: Precision,
    /// Number of nodes of the pin.
    #[serde(rename = "nodes")]
    pub pin_nodes: usize,
    /// Whether the pin has the stiffness of a general mesh.
    #[serde(skip)]
    pub is_general: bool,
    /// Whether its strains may be large.
    #[serde(skip)]
    pub has_large_strains: bool,
    /// Number of numbers that a job keeps of the past of its elements.
    pub history_len: usize,
    /// Number of nodes of the disk; 0 if it is rigid.
    pub disk_nodes: usize,
    /// Stages of the disk in a time step; 0 if it is rigid.
    #[serde(skip)]
    pub disk_stages: usize,
    /// Time step \[s\].
    pub time_step_s: f64,
    /// Stability limit \[s\] of the time step.
    pub time_step_limit_s: f64,
    /// Whether time step, limit and disk are estimated, because no model was built.
    pub is_estimate: bool,
}

/// Time of a stage of a node of the disk, relative to the time of a step of a node of the pin: its rows of K are general
/// ones. docs/evidence/elastic_disk.md has the times.
const DISK_STAGE: f64 = 5.0;

/// Time of a step of a node in single precision, relative to double precision, and the memory of a lane's fields.
/// docs/evidence/speed.md has the times.
const SINGLE: [f64; 2] = [0.6, 0.5];

/// Time of a step of a node of a general mesh, relative to that of a block: measured on 9828 nodes (docs/developers/design.md).
const GENERAL_TIME: f64 = 3.0;

/// Time of a step with large strains, relative to that of a general mesh with small ones: 4.5 on 10051 nodes and 4.7 on 567 (docs/developers/design.md).
const LARGE_STRAINS_TIME: f64 = 4.6;
/// The same of a material that may yield, as long as few elements do.
const YIELDING_TIME: f64 = 7.1;

/// Additional memory \[byte\] of an element with large strains in a model: 83 numbers and eight nodes. A mesh has about as many elements as nodes.
const LARGE_STRAINS_ELEMENT_BYTES: f64 = 83.0 * 8.0 + 8.0 * 4.0;

/// Additional memory \[byte\] of a node of a general mesh in a model: 14 pairs of nodes with 9 numbers and an index.
const GENERAL_NODE_BYTES: f64 = 14.0 * (9.0 * 8.0 + 4.0);

/// Largest angular frequency of a mesh of cubes, in wave speeds of pressure over edges: 2 over the limit of the time step.
const LARGEST_FREQUENCY: f64 = 2.15;

/// Memory of a node of the pin \[byte\]: in a model, and in each lane.
const PIN_NODE_BYTES: [f64; 2] = [90.0, 135.0];

/// Memory of a node of the disk \[byte\]: in a model, and in each lane.
const DISK_NODE_BYTES: [f64; 2] = [1200.0, 400.0];

/// Memory that complex modes of steady sliding take \[byte\] for each node of the pin: measured peaks of 18 to 20 kB for
/// meshes from 12 × 15 × 10 to 36 × 45 × 30 elements without lifted nodes, and up to 30 vectors of 24 bytes in each of the 16 remembered
/// equilibria with lifted nodes. Threads share most of it.
const MODES_NODE_BYTES: f64 = 31.0e3;

/// Memory of a job's detection \[byte\] for each step of its decay observation.
const OBSERVED_STEP_BYTES: f64 = 200.0;

/// Memory of a checkpoint \[byte\] for each node: displacement, velocity and their audit.
const CHECKPOINT_NODE_BYTES: f64 = 70.0;

impl Workload {
    /// Builds the job's model, as a run does, and takes its sizes.
    ///
    /// # Errors
    /// If the specification is not physical, the solver refuses the model, or modes have too many unknowns.
    pub fn examine(spec: &JobSpec) -> Result<Self, JobError> {
        spec.check()?;
        let model = Model::from_scene(&spec.scene, &spec.numerics)?;
        if spec.stability == StabilityMethod::Modes {
            Structure::check_size(&model)?;
        }
        Ok(Self::of(&model, spec.numerics.precision))
    }

    /// The sizes of a model whose jobs run in this precision.
    pub fn of(model: &Model, precision: Precision) -> Self {
        let disk = model.ring();
        Self {
            elements: model.mesh().divisions(),
            precision,
            pin_nodes: model.mesh().node_count(),
            is_general: model.mesh().block().is_none(),
            has_large_strains: model.pin().operator().law().is_some(),
            history_len: model.pin().operator().history_len(),
            disk_nodes: disk.map_or(0, |disk| disk.mesh().node_count()),
            disk_stages: disk.map_or(0, |disk| disk.stages().count()),
            time_step_s: model.time_step_s(),
            time_step_limit_s: model.time_step_limit_s(),
            is_estimate: false,
        }
    }

    /// Estimates the sizes without building the model. The time step is right within some ten percent.
    ///
    /// # Errors
    /// If the mesh has no node row near the clamp's width. Other reasons to refuse the model are not found.
    pub fn estimate(spec: &JobSpec) -> Result<Self, JobError> {
        Model::clamp_width_on_mesh_m(&spec.scene)?;
        let pin = &spec.scene.pin;
        let wave_speed =
            elasticity::pressure_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
        let shortest = pin.element_edges_m().into_iter().fold(f64::INFINITY, f64::min);
        let omega_max = LARGEST_FREQUENCY * wave_speed / shortest;
        let numerics = &spec.numerics;
        let bound =
            Bound { omega_max_rad_s: omega_max, damping_per_s: numerics.alpha_r_per_s.unwrap_or(0.0) };
        let limit_s = bound.time_step_limit_s(numerics.beta2, numerics.beta_r_s);
        let disk = &spec.scene.disk;
        let (disk_nodes, disk_stages) = match disk.kind {
            DiskKind::Rigid => (0, 0),
            DiskKind::Elastic => (disk.ring.estimated_nodes(pin, disk.track_radius_m) as usize, 2),
        };
        Ok(Self {
            elements: pin.elements,
            precision: numerics.precision,
            pin_nodes: pin.node_count() as usize,
            is_general: !pin.is_plain_block(),
            has_large_strains: pin.strains == Strains::Finite,
            history_len: pin.element_count() as usize
                * Yielding::numbers_per_element(&pin.plasticity_of_materials()),
            disk_nodes,
            disk_stages,
            time_step_s: numerics.time_step_s.unwrap_or(numerics.safety_factor * limit_s),
            time_step_limit_s: limit_s,
            is_estimate: true,
        })
    }

    /// Number of steps that simulate `simulated_s` seconds.
    ///
    /// # Errors
    /// If a run may not have so many steps.
    pub fn steps(&self, simulated_s: f64) -> Result<u64, JobError> {
        step_count(simulated_s, self.time_step_s)
    }

    /// Number of steps of a job of these sizes.
    ///
    /// # Errors
    /// If there are too many, or if a step cannot follow the job's friction law.
    pub fn steps_of(&self, spec: &JobSpec) -> Result<u64, JobError> {
        check_step(spec, self.time_step_s)
    }

    /// Cost of a run of `simulated_s` seconds: steps times nodes, in nodes of the pin in double precision.
    pub fn node_steps(&self, simulated_s: f64) -> f64 {
        let disk = DISK_STAGE * (self.disk_nodes * self.disk_stages) as f64;
        let [time, _] = self.over_double();
        let general = match (self.is_general, self.has_large_strains) {
            (_, true) if self.history_len > 0 => GENERAL_TIME * YIELDING_TIME,
            (_, true) => GENERAL_TIME * LARGE_STRAINS_TIME,
            (true, false) => GENERAL_TIME,
            (false, false) => 1.0,
        };
        time * (general * self.pin_nodes as f64 + disk) * (simulated_s / self.time_step_s).ceil().max(1.0)
    }

    /// Time of a step and memory of a lane over those in double precision.
    fn over_double(&self) -> [f64; 2] {
        match self.precision {
            Precision::Double => [1.0, 1.0],
            Precision::Single => SINGLE,
        }
    }

    /// The largest number of jobs for which it pays off to advance them together.
    pub fn widest(&self) -> usize {
        // All lanes of a general mesh share what is read of its stiffness, which is more than their fields.
        let most = if self.is_general { GENERAL_NODES_TIMES_LANES } else { NODES_TIMES_LANES };
        [8, 4, 2].into_iter().find(|lanes| lanes * self.pin_nodes <= most).unwrap_or(1)
    }

    /// Memory \[byte\] of a thread that advances `jobs` jobs together, each with a decay observation of `observation_s`.
    pub fn memory_bytes(&self, jobs: usize, observation_s: f64) -> f64 {
        let [_, lane_over_double] = self.over_double();
        let lanes = lane_over_double * jobs.next_power_of_two() as f64;
        let [pin, disk] = [(PIN_NODE_BYTES, self.pin_nodes), (DISK_NODE_BYTES, self.disk_nodes)]
            .map(|([model, lane], nodes)| (model + lane * lanes) * nodes as f64);
        let general = if self.is_general { GENERAL_NODE_BYTES * self.pin_nodes as f64 } else { 0.0 };
        let large =
            if self.has_large_strains { LARGE_STRAINS_ELEMENT_BYTES * self.pin_nodes as f64 } else { 0.0 };
        let history = 8.0 * lanes * self.history_len as f64;
        pin + general
            + large
            + history
            + disk
            + jobs as f64 * OBSERVED_STEP_BYTES * observation_s / self.time_step_s
    }

    /// Memory \[byte\] that complex modes of steady sliding take.
    pub fn modes_bytes(&self) -> f64 {
        MODES_NODE_BYTES * self.pin_nodes as f64
    }

    /// Size \[byte\] of a checkpoint.
    pub fn checkpoint_bytes(&self) -> f64 {
        CHECKPOINT_NODE_BYTES * (self.pin_nodes + self.disk_nodes) as f64 + 8.0 * self.history_len as f64
    }
}

/// Nodes times lanes above which another lane costs more than it saves: the fields that a step reads and
/// writes then no longer fit into the core's caches. The value is measured; see docs/evidence/speed.md.
const NODES_TIMES_LANES: usize = 40_000;

/// The same for general meshes.
const GENERAL_NODES_TIMES_LANES: usize = 1_600_000;

/// When a job is likely to end, in simulated time \[s\].
///
/// A job ends when its state is periodic or decays, which is not known in advance. In the studies that docs/evidence/speed.md lists, the
/// mean over a study's jobs was between `early_s` and `late_s`; single jobs end earlier or at their limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ending {
    /// The mean of a study, if most of its jobs become periodic soon.
    pub early_s: f64,
    /// The usual mean of a study.
    pub likely_s: f64,
    /// The mean of a study, if many of its jobs do not become periodic.
    pub late_s: f64,
    /// The limit.
    pub limit_s: f64,
    /// Whether these are times of a run. Modes have none, and these times stand for what they take.
    pub has_run: bool,
}

/// Ends of jobs after the ramp, in decay observations, without the cycles that count: early, likely, late.
const OBSERVATIONS: [f64; 3] = [0.4, 0.9, 1.7];

/// Period of a limit cycle in transit times of shear waves over the pin's height: that of the first shear modes of
/// a block that is clamped on one side.
const PERIOD: f64 = 2.6;

/// The time that complex modes take, as that of a run, in decay observations. It orders jobs and predicts times roughly.
const MODES: f64 = 0.1;

impl Ending {
    /// When a job is likely to end.
    pub fn of(spec: &JobSpec) -> Self {
        if spec.stability == StabilityMethod::Modes {
            // There is no run, but modes take as long as a short one.
            let limit_s = MODES * spec.observation_s();
            return Self { early_s: limit_s, likely_s: limit_s, late_s: limit_s, limit_s, has_run: false };
        }
        let limit_s = spec.run.limit_s;
        if !spec.run.stop_early || !spec.scene.program.is_constant() {
            return Self { early_s: limit_s, likely_s: limit_s, late_s: limit_s, limit_s, has_run: true };
        }
        let pin = &spec.scene.pin;
        let shear =
            elasticity::shear_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
        let cycles_s = spec.detection.cycles as f64 * PERIOD * pin.extent_m()[2] / shear;
        let [early_s, likely_s, late_s] = OBSERVATIONS.map(|observations| {
            let end = spec.scene.load.ramp_s + observations * spec.observation_s() + cycles_s;
            end.min(limit_s)
        });
        Self { early_s, likely_s, late_s, limit_s, has_run: true }
    }

    /// The share of the job's work that is left after `simulated_s` seconds, from 0 to 1.
    pub fn share_left(&self, simulated_s: f64) -> f64 {
        if simulated_s < LATE_SHARE * self.likely_s || self.likely_s >= self.limit_s {
            return (1.0 - simulated_s / self.likely_s).clamp(0.0, 1.0);
        }
        // A job that has not ended when it was expected to may end at any time up to its limit.
        let begun_s = LATE_SHARE * self.likely_s;
        let left = (self.limit_s - simulated_s) / (self.limit_s - begun_s);
        (1.0 - LATE_SHARE) * left.clamp(0.0, 1.0)
    }
}

/// Share of the likely time after which a job is expected to end at any time.
const LATE_SHARE: f64 = 0.8;

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the estimate without a model agrees with the model, for materials, damping and meshes that differ, and the
    /// sizes of an elastic disk are those of its model.
    #[test]
    fn the_estimate_agrees_with_the_model() {
        let mut specs = [JobSpec::default(), JobSpec::default(), JobSpec::default()];
        for spec in &mut specs {
            spec.scene.pin.elements = [6, 8, 5];
            spec.scene.clamp.width_m = 0.002;
        }
        specs[1].scene.pin.young_modulus_pa = 2.1e11;
        specs[1].numerics.beta_r_s = 1.0e-6;
        specs[2].scene.disk.kind = DiskKind::Elastic;
        specs[2].scene.disk.ring.element_size_m = 0.012;
        specs[2].scene.disk.ring.coarse_element_size_m = 0.06;
        for spec in specs {
            let [exact, estimate] = [Workload::examine(&spec), Workload::estimate(&spec)].map(Result::unwrap);
            assert_eq!((exact.pin_nodes, exact.is_estimate), (7 * 9 * 6, false));
            assert_eq!(estimate.pin_nodes, exact.pin_nodes);
            let ratio = estimate.time_step_s / exact.time_step_s;
            assert!((0.7..1.4).contains(&ratio), "{ratio}");
            assert_eq!(exact.disk_nodes > 0, spec.scene.disk.kind == DiskKind::Elastic);
            let ratio = (estimate.disk_nodes + 1) as f64 / (exact.disk_nodes + 1) as f64;
            assert!((0.5..2.0).contains(&ratio), "{ratio}");
        }
    }

    /// Protects: a workload has the time step of the run, and what a run refuses is refused: a step above the limit, a mesh
    /// without a row at the clamp's edge, and too many steps.
    #[test]
    fn what_a_run_refuses_is_refused() {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = [2, 2, 2];
        spec.scene.clamp.width_m = 0.0;
        let found = Workload::examine(&spec).unwrap();
        assert!(
            (found.time_step_s / found.time_step_limit_s / spec.numerics.safety_factor - 1.0).abs() < 1e-12
        );
        let refused = |change: fn(&mut JobSpec)| {
            let mut spec = spec.clone();
            change(&mut spec);
            Workload::examine(&spec).and_then(|found| found.steps(spec.run.limit_s)).unwrap_err()
        };
        let error = refused(|spec| spec.numerics.time_step_s = Some(1.0e-3));
        assert!(error.to_string().contains("above the stability limit"), "{error}");
        let error = refused(|spec| spec.scene.clamp.width_m = 0.002);
        assert!(error.to_string().contains("no node row"), "{error}");
        let changes: [fn(&mut JobSpec); 2] =
            [|spec| spec.numerics.time_step_s = Some(1.0e-12), |spec| spec.scene.pin.density_kg_m3 = 2.5e-9];
        for change in changes {
            let error = refused(change);
            assert!(matches!(error, JobError::TooManySteps { .. }), "{error}");
        }
    }

    /// Protects: jobs end in order between early and late and never after their limit, a run that may not stop early ends at
    /// the limit, and the share that is left falls from one to zero.
    #[test]
    fn jobs_end_before_their_limit() {
        let mut spec = JobSpec::default();
        let ending = Ending::of(&spec);
        assert!(ending.early_s < ending.likely_s && ending.likely_s < ending.late_s, "{ending:?}");
        assert!(ending.late_s < ending.limit_s, "{ending:?}");
        let shares: Vec<f64> =
            (0..=100).map(|i| ending.share_left(ending.limit_s * f64::from(i) / 100.0)).collect();
        assert!(shares[0] == 1.0 && shares[100] == 0.0 && shares.is_sorted_by(|a, b| a >= b), "{shares:?}");
        spec.run.stop_early = false;
        let ending = Ending::of(&spec);
        assert_eq!((ending.early_s, ending.late_s), (0.04, 0.04));
        assert_eq!(ending.share_left(0.01), 0.75);
        // Modes take no run, but some time.
        spec.stability = StabilityMethod::Modes;
        let ending = Ending::of(&spec);
        assert!(ending.likely_s > 0.0 && ending.limit_s < 0.04, "{ending:?}");
        assert_eq!([0.0, ending.limit_s].map(|seconds| ending.share_left(seconds)), [1.0, 0.0]);
    }
}
