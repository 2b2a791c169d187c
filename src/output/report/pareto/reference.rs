//! The figures that the jobs of a case are compared with: those of its finest job, extrapolated if the order is clean.

use super::refinement::{self, Level, Limit};
use crate::analysis::JobRecord;
use crate::report::row::{JobNumerics, JobRow};
use std::cmp::Ordering;

/// A finished job with everything that the comparison needs.
#[derive(Debug, Clone, Copy)]
pub struct DoneJob<'a> {
    /// Its row.
    pub row: &'a JobRow,
    /// Its numerics.
    pub numerics: &'a JobNumerics,
    /// Its record.
    pub record: &'a JobRecord,
}

impl<'a> DoneJob<'a> {
    /// The job of a row, if it is done and its numerics are known.
    pub(super) fn of(row: &'a JobRow) -> Option<Self> {
        Some(Self { row, numerics: row.numerics.as_ref()?, record: row.record()? })
    }
}

/// A figure that is compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figure {
    /// Its column in the export.
    pub column: &'static str,
    /// Its name for a reader.
    pub name: &'static str,
    read: fn(&JobRecord) -> Option<f64>,
}

impl Figure {
    /// Its value in a record, if it has one that is finite.
    pub fn value(&self, record: &JobRecord) -> Option<f64> {
        (self.read)(record).filter(|value| value.is_finite())
    }
}

/// The figures that are compared.
pub(super) const FIGURES: [Figure; 5] = [
    Figure { column: "mu_star", name: "μ*", read: |record| Some(record.mu_star) },
    Figure { column: "frequency_hz", name: "frequency", read: |record| record.frequency_hz },
    Figure { column: "stick_share", name: "stick", read: |record| Some(record.stick_share) },
    Figure { column: "slip_share", name: "slip", read: |record| Some(record.slip_share) },
    Figure { column: "separated_share", name: "separated", read: |record| Some(record.separated_share) },
];
/// Index of μ*.
pub(super) const MU_STAR: usize = 0;
/// Index of the frequency.
pub(super) const FREQUENCY: usize = 1;

/// What is refined along a chain of jobs that differ in nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// The mesh is refined, and the time step is given.
    Mesh,
    /// The mesh is refined at a constant fraction of the stability limit, so that the time step shrinks with it.
    MeshAndStep,
    /// The time step is refined on the finest mesh.
    Step,
}

impl Direction {
    /// The name in CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::MeshAndStep => "mesh_and_step",
            Self::Step => "step",
        }
    }
}

/// A sequence of refined jobs that ends at the reference job.
#[derive(Debug, Clone)]
pub struct Chain {
    /// What is refined.
    pub direction: Direction,
    /// Indices of its jobs among the case's jobs, coarsest first.
    pub jobs: Vec<usize>,
    /// Their element sizes or time steps [m or s].
    pub sizes: Vec<f64>,
    /// The limit of each figure; none if one of the jobs does not have the figure.
    pub limits: [Option<Limit>; FIGURES.len()],
}

/// One figure of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The value that other jobs are compared with.
    pub value: f64,
    /// Its standard error over cycles; 0 for all figures but μ*.
    pub standard_error: f64,
    /// Its uncertainty according to the chains; none without a chain.
    pub uncertainty: Option<f64>,
}

/// The figures that the jobs of a case are compared with.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Index of the finest job among the case's jobs.
    pub job: usize,
    /// The chains that end at it.
    pub chains: Vec<Chain>,
    /// The figures; none if the finest job does not have the figure (there is no frequency without a limit cycle).
    pub targets: [Option<Target>; FIGURES.len()],
}

/// Standard error of a figure; 0 for all figures but μ*.
pub(super) fn standard_error(job: &DoneJob, figure: usize) -> f64 {
    let known = figure == MU_STAR && job.record.mu_star_se.is_finite();
    if known { job.record.mu_star_se } else { 0.0 }
}

impl Reference {
    /// The reference of a case.
    ///
    /// # Panics
    /// If there are no jobs.
    pub(super) fn of(jobs: &[DoneJob]) -> Self {
        let finest_mesh = jobs.iter().map(|job| job.numerics.element_size_m).fold(f64::INFINITY, f64::min);
        let damping = jobs.iter().find(|job| job.numerics.element_size_m == finest_mesh);
        let damping = damping.map(|job| job.numerics.beta_r_s);
        let job = (0..jobs.len())
            .filter(|&i| Some(jobs[i].numerics.beta_r_s) == damping)
            .min_by(|&a, &b| finer_first(&jobs[a], &jobs[b]))
            .expect("a case has jobs");
        let chains = chains(jobs, job);
        let targets = std::array::from_fn(|figure| target(&jobs[job], &chains, figure));
        Self { job, chains, targets }
    }
}

fn finer_first(a: &DoneJob, b: &DoneJob) -> Ordering {
    let (n, m) = (a.numerics, b.numerics);
    n.element_size_m
        .total_cmp(&m.element_size_m)
        .then(n.beta2.total_cmp(&m.beta2))
        .then(a.record.time_step_s.total_cmp(&b.record.time_step_s))
        .then(n.stop_early.cmp(&m.stop_early))
        .then(m.limit_s.total_cmp(&n.limit_s))
        .then(n.tolerance.total_cmp(&m.tolerance))
        .then(n.drift_tolerance.total_cmp(&m.drift_tolerance))
        .then(m.cycles.cmp(&n.cycles))
        // Double precision comes before single, and a start from rest is free of another mesh.
        .then(n.precision.cmp(&m.precision))
        .then(m.start.cmp(&n.start))
}

fn target(finest: &DoneJob, chains: &[Chain], figure: usize) -> Option<Target> {
    let value = FIGURES[figure].value(finest.record)?;
    let mut target = Target { value, standard_error: standard_error(finest, figure), uncertainty: None };
    let mut step_is_covered = false;
    for chain in chains {
        let Some(limit) = chain.limits[figure] else { continue };
        // A chain of meshes at a fraction of the stability limit extrapolates the time step to 0 as well. A chain of
        // steps must not correct for that a second time.
        if !(chain.direction == Direction::Step && step_is_covered) {
            target.value += limit.value - value;
            *target.uncertainty.get_or_insert(0.0) += limit.uncertainty;
        }
        step_is_covered |= chain.direction == Direction::MeshAndStep && limit.order.is_ok();
    }
    Some(target)
}

fn chains(jobs: &[DoneJob], finest: usize) -> Vec<Chain> {
    let end = &jobs[finest];
    let same_step = |job: &DoneJob| (job.record.time_step_s / end.record.time_step_s - 1.0).abs() < 1.0e-9;
    let at_fraction = end.numerics.safety_factor.is_some();
    let mesh =
        |job: &DoneJob| differs_in_mesh_only(job.numerics, end.numerics) && (at_fraction || same_step(job));
    let step = |job: &DoneJob| differs_in_step_only(job.numerics, end.numerics);
    let direction = if at_fraction { Direction::MeshAndStep } else { Direction::Mesh };
    let of = |direction, size: fn(&DoneJob) -> f64, belongs: &dyn Fn(&DoneJob) -> bool| {
        let mut levels: Vec<usize> = (0..jobs.len()).filter(|&i| belongs(&jobs[i])).collect();
        levels.sort_by(|&a, &b| size(&jobs[b]).total_cmp(&size(&jobs[a])));
        levels.dedup_by(|a, b| size(&jobs[*a]) == size(&jobs[*b]));
        let done: Vec<&DoneJob> = levels.iter().map(|&i| &jobs[i]).collect();
        (levels.len() > 1).then(|| Chain {
            direction,
            sizes: done.iter().map(|job| size(job)).collect(),
            limits: std::array::from_fn(|figure| limit(&done, size, figure)),
            jobs: levels,
        })
    };
    [
        of(direction, |job| job.numerics.element_size_m, &mesh),
        of(Direction::Step, |job| job.record.time_step_s, &step),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn limit(levels: &[&DoneJob], size: fn(&DoneJob) -> f64, figure: usize) -> Option<Limit> {
    let levels: Option<Vec<Level>> = levels
        .iter()
        .map(|job| {
            let value = FIGURES[figure].value(job.record)?;
            Some(Level { size: size(job), value, standard_error: standard_error(job, figure) })
        })
        .collect();
    refinement::limit(&levels?)
}

/// Largest ratio of the refinement in one direction to that in another. It is not 1, because numbers of elements are
/// integers, and a block of 12 × 15 × 10 mm cannot be divided into cubes of every size.
const ALIKE: f64 = 1.15;

/// Whether both meshes are refined by about the same factor in x, y and z, all else equal.
fn differs_in_mesh_only(a: &JobNumerics, b: &JobNumerics) -> bool {
    let ratios: [f64; 3] = std::array::from_fn(|axis| a.elements[axis] as f64 / b.elements[axis] as f64);
    let (low, high) =
        (ratios.into_iter().fold(f64::INFINITY, f64::min), ratios.into_iter().fold(0.0, f64::max));
    let same_mesh =
        JobNumerics { elements: a.elements, element_size_m: a.element_size_m, nodes: a.nodes, ..b.clone() };
    high <= ALIKE * low && same_mesh == *a
}

fn differs_in_step_only(a: &JobNumerics, b: &JobNumerics) -> bool {
    let fraction = a.safety_factor.is_some() == b.safety_factor.is_some();
    fraction && JobNumerics { safety_factor: a.safety_factor, ..b.clone() } == *a
}
