//! The cost of a node and step, and the additional cost of each part of a scene.

use crate::machine::Machine;
use crate::timing::{ROUNDS, seconds};
use serde::Serialize;
use std::sync::Arc;
use tribosweep::analysis::batch::Batch;
use tribosweep::analysis::lanes::{AUDIT_INTERVAL, AnyLanes, LanesOf};
use tribosweep::solver::body::hexahedron;
use tribosweep::solver::body::pin::operator::{AssembledOperator, Operator, TensorOperator};
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::interface::law::Law;
use tribosweep::solver::{Drive, InLanes, Model, RunNumber, State, StateOf, step};
use tribosweep::spec::{JobSpec, Precision, Region, StabilityMethod, TopFace};

/// Additions and multiplications of an inner node in a step, counted in
/// `solver::body::pin::operator::tensor::pass` (100) and `solver::body::pin::motion` (6 for u + β_R p, 21
/// for the motion).
const FLOPS: f64 = 127.0;
/// Numbers of a node in a step. Displacements and velocities are read and written once.
const NUMBERS: f64 = 4.0 * 3.0;

/// One mesh with one number of lanes; times in ns per node, step and job.
#[derive(Debug, Serialize)]
pub struct MeshCase {
    elements: [usize; 3],
    precision: &'static str,
    lanes: usize,
    /// The product y = K x alone.
    product_ns: f64,
    /// A step: product, integration, contact.
    step_ns: f64,
    /// Everything that a sweep does: energies, guard, statistics and detection are included.
    job_ns: f64,
    /// Lower bounds from the arithmetic and from the memory traffic of u and p.
    arithmetic_bound_ns: f64,
    traffic_bound_ns: f64,
}

const MESHES: [[usize; 3]; 5] = [[6, 8, 5], [12, 15, 10], [18, 22, 15], [24, 30, 20], [48, 60, 40]];

fn spec(elements: [usize; 3]) -> JobSpec {
    let mut spec = JobSpec { stability: StabilityMethod::Simulate, ..JobSpec::default() };
    spec.scene.pin.elements = elements;
    // All meshes can represent this width.
    spec.scene.clamp.width_m = 0.002;
    // The run is longer than any benchmark and does not stop early.
    spec.run.limit_s = 1.0;
    spec.run.stop_early = false;
    spec
}

fn model(spec: &JobSpec) -> Model {
    Model::from_scene(&spec.scene, &spec.numerics).expect("a scene that can be solved")
}

/// The jobs of a sweep over ω.
fn jobs(spec: &JobSpec, count: usize) -> Vec<JobSpec> {
    let job = |i: usize| {
        let mut job = spec.clone();
        job.scene.disk.omega_rpm = 5.0 + i as f64;
        job
    };
    (0..count).map(job).collect()
}

/// Nanoseconds per node, step and job.
fn per_node(model: &Model, jobs: usize, steps: usize, call_s: f64) -> f64 {
    call_s * 1e9 / (model.mesh().node_count() * jobs * steps) as f64
}

/// Steps per call of [`LanesOf::advance`].
const STEPS: usize = AUDIT_INTERVAL as usize;

fn lanes<const L: usize, R: RunNumber>(spec: &JobSpec, count: usize) -> LanesOf<L, R> {
    let mut lanes = LanesOf::new(Arc::new(model(spec)));
    for (lane, job) in jobs(spec, count).into_iter().enumerate() {
        lanes.begin(lane, lane as u64, job).expect("not too many steps");
    }
    settle(spec, || _ = lanes.advance(&mut |_| {}));
    lanes
}

/// Advances into frictional contact, as far as the time of a benchmark allows.
fn settle(spec: &JobSpec, mut advance: impl FnMut()) {
    let nodes: usize = spec.scene.pin.elements.iter().product();
    for _ in 0..(4_000_000 / nodes).clamp(2, 200) {
        advance();
    }
}

fn mesh<const L: usize, R: InLanes<L>>(
    elements: [usize; 3],
    precision: Precision,
    machine: &Machine,
) -> MeshCase {
    let spec = spec(elements);
    let model = model(&spec);
    let name = |what: &str| {
        let [nx, ny, nz] = elements;
        format!("mesh_{nx}x{ny}x{nz}_{}_{what}_{L}", precision.name())
    };
    let drives: [Drive; L] = std::array::from_fn(|lane| Drive {
        law: Law::coulomb(0.4),
        rate: 0.5 + 0.1 * lane as f64,
        force_n: 30.0,
        ramp_s: 5e-4,
    });
    let mut state = StateOf::<L, R>::at_rest(&model);
    settle(&spec, || (0..STEPS).for_each(|_| step(&model, &drives, &mut state)));
    let x = state.u.clone();
    let mut y = state.u.clone();
    let mut scratch = model.pin().operator().scratch::<R>(model.mesh().layout(), L);
    let product_s = seconds(&name("product"), || model.pin().operator().tangent(&x, &mut y, &mut scratch));
    let step_s = seconds(&name("step"), || step(&model, &drives, &mut state));
    let mut lanes = lanes::<L, R>(&spec, L);
    let job_s = seconds(&name("job"), || _ = lanes.advance(&mut |_| {}));
    let bytes = NUMBERS * size_of::<R>() as f64;
    let working_set = bytes / 2.0 * (model.mesh().node_count() * L) as f64;
    MeshCase {
        elements,
        precision: precision.name(),
        lanes: L,
        product_ns: per_node(&model, L, 1, product_s),
        step_ns: per_node(&model, L, 1, step_s),
        job_ns: per_node(&model, L, STEPS, job_s),
        // Vectors of one lane are padded. The padding is not counted here: the bound is that of the work
        // itself.
        // The peak was measured in double precision. A vector has twice as many numbers in single.
        arithmetic_bound_ns: FLOPS / machine.plain_gflops * size_of::<R>() as f64 / size_of::<f64>() as f64,
        traffic_bound_ns: bytes / machine.gb_per_s(working_set),
    }
}

impl MeshCase {
    /// The larger of the two bounds.
    fn bound_ns(&self) -> f64 {
        self.arithmetic_bound_ns.max(self.traffic_bound_ns)
    }

    fn keep_faster(&mut self, other: &Self) {
        self.product_ns = self.product_ns.min(other.product_ns);
        self.step_ns = self.step_ns.min(other.step_ns);
        self.job_ns = self.job_ns.min(other.job_ns);
    }
}

/// A mesh with 1, 2, 4 and 8 lanes.
fn lane_counts<R: InLanes<1> + InLanes<2> + InLanes<4> + InLanes<8>>(
    elements: [usize; 3],
    precision: Precision,
    machine: &Machine,
) -> [MeshCase; 4] {
    [
        mesh::<1, R>(elements, precision, machine),
        mesh::<2, R>(elements, precision, machine),
        mesh::<4, R>(elements, precision, machine),
        mesh::<8, R>(elements, precision, machine),
    ]
}

/// All meshes in both precisions.
pub fn meshes(machine: &Machine) -> Vec<MeshCase> {
    let of = |elements| {
        let double = lane_counts::<f64>(elements, Precision::Double, machine);
        double.into_iter().chain(lane_counts::<f32>(elements, Precision::Single, machine))
    };
    let round = || -> Vec<MeshCase> { MESHES.into_iter().flat_map(of).collect() };
    let mut best = round();
    for _ in 1..ROUNDS {
        best.iter_mut().zip(round()).for_each(|(best, case)| best.keep_faster(&case));
    }
    println!(
        "\n{FLOPS} operations on {NUMBERS} numbers of u and p per node and step; ns per node, step and job:"
    );
    println!("{:>16} precision lanes  product    step     job   bound  reached by step, job", "elements");
    for case in &best {
        let bound_ns = case.bound_ns();
        println!(
            "{:>16} {:>9} {:5} {:8.2} {:7.2} {:7.2} {bound_ns:7.2} {:8.0} % {:5.0} %",
            format!("{:?}", case.elements),
            case.precision,
            case.lanes,
            case.product_ns,
            case.step_ns,
            case.job_ns,
            100.0 * bound_ns / case.step_ns,
            100.0 * bound_ns / case.job_ns
        );
    }
    best
}

/// The times of a scene with some part and without it, in ns per node, step and job.
#[derive(Debug, Serialize)]
pub struct Pair {
    what: &'static str,
    with_ns: f64,
    without_ns: f64,
}

impl Pair {
    fn new(what: &'static str, with_ns: f64, without_ns: f64) -> Self {
        Self { what, with_ns, without_ns }
    }

    fn keep_faster(&mut self, other: &Self) {
        self.with_ns = self.with_ns.min(other.with_ns);
        self.without_ns = self.without_ns.min(other.without_ns);
    }
}

/// Time of a step of one scene with eight lanes, in ns per node, step and job.
fn stepping<R: InLanes<8>>(name: &str, spec: &JobSpec, mu: f64) -> f64 {
    let model = model(spec);
    let drives = [Drive { law: Law::coulomb(mu), rate: 0.7, force_n: 30.0, ramp_s: 5.0e-4 }; 8];
    let mut state = StateOf::<8, R>::at_rest(&model);
    settle(spec, || (0..STEPS).for_each(|_| step(&model, &drives, &mut state)));
    per_node(&model, 8, 1, seconds(name, || step(&model, &drives, &mut state)))
}

/// The cost of each part of a scene and of the bookkeeping, on 12 × 15 × 10 elements with eight lanes.
pub fn pairs() -> Vec<Pair> {
    let mut best = round_of_pairs();
    for _ in 1..ROUNDS {
        best.iter_mut().zip(round_of_pairs()).for_each(|(best, pair)| best.keep_faster(&pair));
    }
    println!("\n12 × 15 × 10 elements, 8 lanes; ns per node, step and job:");
    for Pair { what, with_ns, without_ns } in &best {
        println!("{what:<58} {with_ns:6.2}, without {without_ns:6.2}, ratio {:.2}", with_ns / without_ns);
    }
    best
}

fn round_of_pairs() -> Vec<Pair> {
    let base = spec([12, 15, 10]);
    let full = stepping::<f64>("pair_full", &base, 0.4);
    let mut undamped = base.clone();
    undamped.numerics.beta_r_s = 0.0;
    let mut free = base.clone();
    free.scene.top = TopFace::FreeInZ;
    let model = model(&base);
    let drives = [Drive { law: Law::coulomb(0.4), rate: 0.7, force_n: 30.0, ramp_s: 5.0e-4 }; 8];
    let mut state = State::<8>::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, AUDIT_INTERVAL);
    let audited_s = seconds("pair_energies", || {
        for _ in 0..STEPS {
            ledger.before_step(&model, &state);
            step(&model, &drives, &mut state);
            ledger.after_step(&model, &drives, &state);
        }
    });
    let audited = per_node(&model, 8, STEPS, audited_s);
    let mut analysed = lanes::<8, f64>(&base, 8);
    let analysed_s = seconds("pair_analysis", || _ = analysed.advance(&mut |_| {}));
    let analysed_ns = per_node(&model, 8, STEPS, analysed_s);
    let mut history = Vec::new();
    let observed_s = seconds("pair_history", || {
        history.clear();
        analysed.advance(&mut |moment| history.push(*moment.sample));
    });
    let block = model.mesh().block().expect("a block");
    let element = hexahedron::stiffness(model.pin().material(), block.element_size_m());
    let forms = [
        ("pair_assembled", Operator::Assembled(AssembledOperator::of_block(block, &element))),
        ("pair_tensor", Operator::Tensor(TensorOperator::new(block, model.pin().material()))),
    ];
    let x = state.u.clone();
    let mut y = state.u.clone();
    let [assembled, tensor] = forms.map(|(name, operator)| {
        let mut scratch = operator.scratch(model.mesh().layout(), 8);
        per_node(&model, 8, 1, seconds(name, || operator.tangent(&x, &mut y, &mut scratch)))
    });
    vec![
        Pair::new("damping: β_R > 0, or 0", full, stepping::<f64>("pair_undamped", &undamped, 0.4)),
        Pair::new("friction: μ > 0, or 0", full, stepping::<f64>("pair_frictionless", &base, 0.0)),
        Pair::new("top face: tied in z, or free", full, stepping::<f64>("pair_free", &free, 0.4)),
        Pair::new("energies and what the divergence guard compares, or none", audited, full),
        Pair::new("statistics and detection, or energies alone", analysed_ns, audited),
        Pair::new("history of every step, or none", per_node(&model, 8, STEPS, observed_s), analysed_ns),
        Pair::new("eight jobs in eight lanes, or each alone", alone(&base), analysed_ns),
        Pair::new("three jobs in eight lanes, or in four", sparse(&base), narrowed(&base)),
        general::<f64>("a general mesh or a block of 9828 nodes, double precision"),
        general::<f32>("a general mesh or a block of 9828 nodes, single precision"),
        Pair::new("product with the assembled rows, or by tensor products", assembled, tensor),
    ]
}

/// A step with the operator of general meshes, or with that of a block. The pin consists of two regions of the same material, so both
/// compute the same motion.
fn general<R: InLanes<8>>(what: &'static str) -> Pair {
    let block = spec([20, 25, 17]);
    let mut general = block.clone();
    let pin = &mut general.scene.pin;
    pin.regions = vec![Region {
        above_m: Some(pin.size_m[2] * 8.0 / 17.0),
        group: None,
        young_modulus_pa: pin.young_modulus_pa,
        poisson_ratio: pin.poisson_ratio,
        density_kg_m3: pin.density_kg_m3,
        plasticity: None,
    }];
    Pair::new(what, stepping::<R>("pair_general", &general, 0.4), stepping::<R>("pair_block", &block, 0.4))
}

fn alone(base: &JobSpec) -> f64 {
    let mut one = lanes::<1, f64>(base, 1);
    per_node(&model(base), 1, STEPS, seconds("pair_alone", || _ = one.advance(&mut |_| {})))
}

fn sparse(base: &JobSpec) -> f64 {
    let mut eight = lanes::<8, f64>(base, 3);
    per_node(&model(base), 3, STEPS, seconds("pair_sparse", || _ = eight.advance(&mut |_| {})))
}

fn narrowed(base: &JobSpec) -> f64 {
    let mut batch = Batch::new(base).expect("a scene that can be solved");
    for (ticket, job) in jobs(base, 3).into_iter().enumerate() {
        batch.begin(ticket as u64, job).expect("not too many steps");
    }
    settle(base, || _ = batch.advance());
    per_node(&model(base), 3, STEPS, seconds("pair_narrowed", || _ = batch.advance()))
}
