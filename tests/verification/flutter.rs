//! Linear flutter: the pin's coupled mode in the time domain, compared with complex eigenvalues.
//!
//! While every slave node slips and none lifts off, sliding is a linear problem. q are the free displacements
//! (base nodes held at z = 0, the top tied), N_i = (K(u + β_R v))_iz is the normal force of slave node i, d_i
//! the direction in which the disk moves under it, and V_i its speed:
//!
//! ```text
//! M q̈ + (K − μ d K_z)(q + β_R q̇) + C q̇ = f,     C_i = μN_i⁰/V_i (I − d_i d_iᵀ)
//! ```
//!
//! K_z are the rows of the normal forces. This coupling makes the problem unsymmetric. C is the change of
//! friction's direction by sideways motion, with N_i⁰ of the steady state. Growth rate and frequency are λ =
//! σ + iω, an eigenvalue of the state matrix. Source: linearisation of the model (mode-coupling instability).
//! It is solved here with dense matrices and independently of the time step; only K is the program's.
//!
//! The scheme itself is a linear recursion in this state. For the central difference p_n = (u_n − u_{n−1})/Δt
//! and
//!
//! ```text
//! (M/Δt + C) p_{n+1} = (M/Δt − β_R K_μ) p_n − K_μ u_n,     u_{n+1} = u_n + Δt p_{n+1},     K_μ = K − μ d K_z
//! ```
//!
//! Damping is evaluated half a step early and friction's direction half a step late. Both errors are of first
//! order in Δt, all others of second. The eigenvalues e^{λΔt} of the recursion are the exact answer for a run
//! at that step. So two questions are tested separately: does the program follow the recursion, and does the
//! recursion tend to λ?

use crate::verification::evidence::Evidence;
use nalgebra::{Complex, DMatrix, DVector};
use tribosweep_mechanics::analysis::{Outcome, Unobserved, drive, solve};
use tribosweep_mechanics::solver::field::Field;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::{Drive, Model, State, step};
use tribosweep_mechanics::spec::{JobSpec, StabilityMethod};

const SOURCE: &str = "complex eigenvalues of the linearised sliding problem, dense";

/// A coarse pin on a disk that is so fast that all nodes are pressed on it in steady sliding. Every job runs.
fn spec(mu: f64, safety_factor: f64) -> JobSpec {
    let mut spec = JobSpec { stability: StabilityMethod::Simulate, ..JobSpec::default() };
    spec.scene.pin.elements = [3, 4, 2];
    spec.scene.clamp.width_m = 0.004;
    spec.scene.load.ramp_s = 0.0;
    spec.scene.contact.mu = mu;
    spec.scene.disk.omega_rpm = 60.0;
    spec.numerics.beta_r_s = 2.0e-7;
    spec.numerics.safety_factor = safety_factor;
    spec
}

/// The linearised sliding problem of a model.
struct Sliding {
    /// Degrees of freedom of the mesh that move with each coordinate of q.
    moved: Vec<Vec<usize>>,
    mass: DVector<f64>,
    /// K − μ d K_z.
    stiffness: DMatrix<f64>,
    /// C.
    turning: DMatrix<f64>,
    beta_r_s: f64,
    steady: DVector<f64>,
}

impl Sliding {
    fn new(model: &Model, drive: &Drive, mu: f64) -> Self {
        let n = 3 * model.mesh().block().unwrap().node_count();
        let k = stiffness(model);
        let top_z: Vec<usize> = model.mesh().block().unwrap().top_nodes().map(|node| 3 * node + 2).collect();
        let fixed = fixed_dofs(model, n);
        let mut moved = vec![top_z.clone()];
        for dof in 0..n {
            let closed = dof % 3 == 2 && model.mesh().block().unwrap().bottom_nodes().contains(&(dof / 3));
            if !closed && !fixed.contains(&dof) && !top_z.contains(&dof) {
                moved.push(vec![dof]);
            }
        }
        let size = moved.len();
        let t = DMatrix::from_fn(n, size, |dof, q| f64::from(u8::from(moved[q].contains(&dof))));
        let mass = DVector::from_fn(size, |q, _| {
            moved[q].iter().map(|dof| model.pin().masses_kg()[dof / 3]).sum::<f64>()
        });
        // Friction μ N_i d_i on the slave nodes, N = K_z u.
        let mut sliding = k.clone();
        for slave in model.slaves() {
            let speed = slave.surface_motion[0].hypot(slave.surface_motion[1]);
            for c in 0..2 {
                let d = slave.surface_motion[c] / speed;
                for column in 0..n {
                    sliding[(3 * slave.node + c, column)] -= mu * d * k[(3 * slave.node + 2, column)];
                }
            }
        }
        let sliding = t.transpose() * sliding * &t;
        let mut load = DVector::zeros(size);
        load[0] = -drive.force_n;
        let steady = sliding.clone().lu().solve(&load).expect("sliding has a steady state");
        let normal_n = &k * (&t * &steady);
        let mut turning = DMatrix::zeros(n, n);
        for slave in model.slaves() {
            let speed = slave.surface_motion[0].hypot(slave.surface_motion[1]);
            let rate = mu * normal_n[3 * slave.node + 2] / (speed * drive.rate);
            assert!(rate > 0.0, "every node of the steady state is pressed on the disk");
            for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let along = slave.surface_motion[r] * slave.surface_motion[c] / (speed * speed);
                turning[(3 * slave.node + r, 3 * slave.node + c)] =
                    rate * (f64::from(u8::from(r == c)) - along);
            }
        }
        let turning = t.transpose() * turning * &t;
        Self { moved, mass, stiffness: sliding, turning, beta_r_s: model.scheme().beta_r_s, steady }
    }

    /// The matrix of d/dt (q, q̇/ω₀), which has the eigenvalues λ; ω₀ balances its rows.
    fn state_matrix(&self) -> DMatrix<f64> {
        let size = self.moved.len();
        let damping = &self.stiffness * self.beta_r_s + &self.turning;
        DMatrix::from_fn(2 * size, 2 * size, |row, column| match (row < size, column < size) {
            (true, _) => {
                if column == size + row {
                    OMEGA_0
                } else {
                    0.0
                }
            }
            (false, true) => -self.stiffness[(row - size, column)] / self.mass[row - size] / OMEGA_0,
            (false, false) => -damping[(row - size, column - size)] / self.mass[row - size],
        })
    }

    /// The matrix of one time step of (q, p/ω₀), which has the eigenvalues e^{λΔt}.
    fn step_matrix(&self, dt: f64) -> DMatrix<f64> {
        let size = self.moved.len();
        let mass = DMatrix::from_diagonal(&self.mass) / dt;
        let implicit = (&mass + &self.turning).lu();
        let from_p = implicit.solve(&(mass - &self.stiffness * self.beta_r_s)).expect("regular");
        let from_u = -implicit.solve(&self.stiffness).expect("regular") / OMEGA_0;
        let mut matrix = DMatrix::identity(2 * size, 2 * size);
        matrix.view_mut((size, size), (size, size)).copy_from(&from_p);
        matrix.view_mut((size, 0), (size, size)).copy_from(&from_u);
        let ahead = dt * OMEGA_0;
        let mut displacement = matrix.view_mut((0, 0), (size, size));
        displacement += from_u * ahead;
        matrix.view_mut((0, size), (size, size)).copy_from(&(from_p * ahead));
        matrix
    }

    /// The fastest growing mode of the continuous problem.
    fn leading(&self) -> Complex<f64> {
        self.fastest_growing(|_| true)
    }

    /// The fastest growing mode whose frequency is within a tenth of `frequency_hz`.
    fn leading_near(&self, frequency_hz: f64) -> Complex<f64> {
        self.fastest_growing(|lambda| (lambda.im / HZ / frequency_hz - 1.0).abs() < 0.1)
    }

    fn fastest_growing(&self, among: impl Fn(&Complex<f64>) -> bool) -> Complex<f64> {
        let values = self.state_matrix().complex_eigenvalues();
        let candidates = values.iter().filter(|lambda| lambda.im > 0.0 && among(lambda));
        *candidates.max_by(|a, b| a.re.total_cmp(&b.re)).expect("such a mode exists")
    }

    /// The mode of the recursion at the step `dt` whose eigenvalue is nearest to `lambda`.
    fn at_step(&self, dt: f64, lambda: Complex<f64>) -> Mode {
        let matrix = self.step_matrix(dt).map(Complex::from);
        let (value, right) = eigenpair(&matrix, (lambda * dt).exp());
        let (_, left) = eigenpair(&matrix.transpose(), value);
        Mode { lambda: value.ln() / dt, right, left }
    }
}

/// A frequency [rad/s] of the size of the squeal's, to balance displacements and velocities.
const OMEGA_0: f64 = 1.0e5;

/// K, column by column, from the program's operator.
fn stiffness(model: &Model) -> DMatrix<f64> {
    let n = 3 * model.mesh().block().unwrap().node_count();
    let mut k = DMatrix::zeros(n, n);
    for column in 0..n {
        let mut unit = vec![0.0; n];
        unit[column] = 1.0;
        k.column_mut(column).copy_from_slice(&model.pin().stiffness_times(&unit));
    }
    k
}

/// The x and y degrees of freedom of the top nodes within the clamp's width of the inner side.
fn fixed_dofs(model: &Model, n: usize) -> Vec<usize> {
    let mesh = model.mesh().block().unwrap();
    let edge = -mesh.size_m()[0] / 2.0 + model.clamp_width_m() * 1.001;
    (0..n)
        .filter(|dof| dof % 3 < 2)
        .filter(|dof| mesh.top_nodes().contains(&(dof / 3)) && mesh.coordinates_m(dof / 3)[0] <= edge)
        .collect()
}

/// λ = σ + iω of one mode of the recursion, with its right and left vectors (q, p/ω₀).
struct Mode {
    lambda: Complex<f64>,
    right: DVector<Complex<f64>>,
    left: DVector<Complex<f64>>,
}

impl Sliding {
    fn spread(&self, q: &DVector<f64>, field: &mut Field<1>) {
        for (dofs, value) in self.moved.iter().zip(q.iter()) {
            for &dof in dofs {
                field[dof] = *value;
            }
        }
    }

    fn gather(&self, field: &Field<1>) -> DVector<f64> {
        DVector::from_iterator(self.moved.len(), self.moved.iter().map(|dofs| field[dofs[0]]))
    }
}

/// The eigenvalue nearest to `guess` and its vector, by inverse iteration.
fn eigenpair(matrix: &DMatrix<Complex<f64>>, guess: Complex<f64>) -> (Complex<f64>, DVector<Complex<f64>>) {
    let size = matrix.nrows();
    let mut shifted = matrix.clone();
    for i in 0..size {
        // The shift differs from the eigenvalue by more than rounding, so that the factors exist.
        shifted[(i, i)] -= guess * (1.0 + 1e-10);
    }
    let lu = shifted.lu();
    let mut x = DVector::from_fn(size, |i, _| Complex::from(1.0 + (i as f64).sin()));
    x /= Complex::from(x.norm());
    for _ in 0..200 {
        let mut next = lu.solve(&x).expect("beside the eigenvalue the matrix is regular");
        next /= Complex::from(next.norm());
        let turned = x.dotc(&next);
        let settled = (next.clone() - &x * turned).norm() < 1e-13;
        x = next;
        if settled {
            break;
        }
    }
    (x.dotc(&(matrix * &x)), x)
}

/// λ of a mode in the time domain. The mode disturbs steady sliding, but so little that no node changes its
/// state. Projection on the left vector gives its amplitude.
fn followed(model: &Model, drive: &Drive, sliding: &Sliding, mode: &Mode) -> Complex<f64> {
    let size = sliding.moved.len();
    let (q, p) = (mode.right.rows(0, size), mode.right.rows(size, size) * Complex::from(OMEGA_0));
    let largest = q.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let share = DISTURBANCE * sliding.steady.amax() / largest;
    let mut state = State::<1>::at_rest(model);
    sliding.spread(&(&sliding.steady + q.map(|x| x.re) * share), &mut state.u);
    sliding.spread(&(p.map(|x| x.re) * share), &mut state.p);
    // This skips the first step, which has half the force for a start from given velocities.
    state.step = 1;
    let dt = model.time_step_s();
    let steps = (FOLLOWED_S / dt) as usize;
    let amplitude = |state: &State<1>| {
        let q = sliding.gather(&state.u) - &sliding.steady;
        let p = sliding.gather(&state.p) / OMEGA_0;
        let both = q.iter().chain(p.iter());
        mode.left.iter().zip(both).map(|(l, x)| l * *x).fold(Complex::from(0.0), |s, x| s + x)
    };
    let mut logarithm = Complex::from(0.0);
    let mut before = amplitude(&state);
    for n in 0..steps {
        step(model, std::slice::from_ref(drive).try_into().expect("one lane"), &mut state);
        assert!(state.contacts.states(0).all(|s| s == ContactState::Slip), "step {n}: not steady sliding");
        let after = amplitude(&state);
        logarithm += (after / before).ln();
        before = after;
    }
    logarithm / (steps as f64 * dt)
}

/// Amplitude of the disturbance over the steady deflection. Friction's direction makes the problem nonlinear.
/// The neglected terms are of this size relative to the others.
const DISTURBANCE: f64 = 1.0e-7;

/// Time over which a mode is followed: fifteen periods of the squeal.
const FOLLOWED_S: f64 = 1.0e-3;

fn case(mu: f64, safety_factor: f64) -> (Model, Drive) {
    let spec = spec(mu, safety_factor);
    (Model::from_scene(&spec.scene, &spec.numerics).unwrap(), drive(&spec))
}

const HZ: f64 = std::f64::consts::TAU;

/// Protects: a run in steady sliding follows the recursion: friction, its direction, the coupling through N,
/// and damping.
#[test]
fn runs_follow_the_recursion() {
    let mut growth = Evidence::new("Flutter", "growth rate [1/s] of a run against the recursion", SOURCE);
    let mut frequency = Evidence::new("Flutter", "frequency [Hz] of a run against the recursion", SOURCE);
    for mu in [0.1, 0.2, 0.3, 0.4] {
        for safety_factor in [0.8, 0.4] {
            let (model, drive) = case(mu, safety_factor);
            let sliding = Sliding::new(&model, &drive, mu);
            let exact = sliding.at_step(model.time_step_s(), sliding.leading());
            let found = followed(&model, &drive, &sliding, &exact);
            let size = exact.lambda.norm();
            let label = format!("μ {mu}, {safety_factor} of the limit");
            growth.bounded(&label, found.re, exact.lambda.re, size, DISTURBANCE);
            frequency.bounded(&label, found.im / HZ, exact.lambda.im / HZ, size / HZ, DISTURBANCE);
        }
    }
    let why = "what a disturbance of this size leaves out, relative to |λ|";
    growth.judge_bounded(why);
    frequency.judge_bounded(why);
}

/// Protects: the recursion tends to the continuous problem, with the order that its half steps give.
#[test]
fn the_recursion_converges_in_first_order() {
    let (model, drive) = case(0.4, 0.4);
    let sliding = Sliding::new(&model, &drive, 0.4);
    let exact = sliding.leading();
    let mut growth = Evidence::new("Flutter", "growth rate [1/s] over the time step", SOURCE);
    let mut frequency = Evidence::new("Flutter", "frequency [Hz] over the time step", SOURCE);
    for dt in [1.6e-7, 8.0e-8, 4.0e-8, 2.0e-8] {
        let lambda = sliding.at_step(dt, exact).lambda;
        growth.found(format!("Δt {dt:e} s"), lambda.re, exact.re, exact.norm());
        frequency.found(format!("Δt {dt:e} s"), lambda.im / HZ, exact.im / HZ, exact.norm() / HZ);
    }
    // λ is the logarithm of a number next to 1, divided by Δt. Its error is rounding over |λ|Δt, times the
    // condition of the eigenproblem.
    let rounding = 1.0e3 * f64::EPSILON / (exact.norm() * 2.0e-8);
    growth.judge_order(1.0, 2.0, rounding);
    frequency.judge_order(1.0, 2.0, rounding);
}

/// Protects: at 0.4 of the limit (a step of 1.9 µs on this coarse mesh) the squeal is as accurate as the
/// program promises: its frequency to 0.5 %, its growth rate to 5 %.
#[test]
fn the_squeal_is_right_at_a_working_step() {
    let (model, drive) = case(0.4, 0.4);
    let sliding = Sliding::new(&model, &drive, 0.4);
    let exact = sliding.leading();
    let found = followed(&model, &drive, &sliding, &sliding.at_step(model.time_step_s(), exact));
    let resolution = format!("Δt {:.2e} s", model.time_step_s());
    let mut growth = Evidence::new("Flutter", "growth rate [1/s] of the squeal at μ = 0.4", SOURCE);
    growth.bounded(&resolution, found.re, exact.re, exact.re, 0.05);
    growth.judge_bounded("the accuracy that is promised, 5 %");
    let mut frequency = Evidence::new("Flutter", "frequency [Hz] of the squeal at μ = 0.4", SOURCE);
    frequency.bounded(&resolution, found.im / HZ, exact.im / HZ, exact.im / HZ, 0.005);
    frequency.judge_bounded("the accuracy that is promised, 0.5 %");
}

/// The μ between `low` and `high` at which `growth` vanishes, by the secant rule.
fn onset(mut low: f64, mut high: f64, growth: impl Fn(f64) -> f64) -> f64 {
    let (mut at_low, mut at_high) = (growth(low), growth(high));
    assert!(
        at_low < 0.0 && at_high > 0.0,
        "the onset lies between {low} and {high}: {at_low}, {at_high} 1/s"
    );
    for _ in 0..30 {
        let next = high - at_high * (high - low) / (at_high - at_low);
        (low, at_low) = (high, at_high);
        (high, at_high) = (next, growth(next));
        if at_high == at_low || (high - low).abs() < 1e-10 {
            break;
        }
    }
    high
}

/// Protects: the onset of squeal, measured from the growth in runs, tends to that of the eigenvalues.
#[test]
fn onset_of_squeal_is_that_of_the_eigenvalues() {
    let exact = onset(0.2, 0.3, |mu| {
        let (model, drive) = case(mu, 0.4);
        Sliding::new(&model, &drive, mu).leading_near(SQUEAL_HZ).re
    });
    let mut evidence = Evidence::new("Flutter", "onset μ of the squeal, from growth in runs", SOURCE);
    for safety_factor in [0.2, 0.1, 0.05] {
        let found = onset(0.2, 0.3, |mu| {
            let (model, drive) = case(mu, safety_factor);
            let sliding = Sliding::new(&model, &drive, mu);
            let mode = sliding.at_step(model.time_step_s(), sliding.leading_near(SQUEAL_HZ));
            followed(&model, &drive, &sliding, &mode).re
        });
        evidence.found(format!("{safety_factor} of the limit"), found, exact, exact);
    }
    // A run's growth rate is known to DISTURBANCE·|λ|; it rises by some 3·10⁴ 1/s per unit of μ.
    evidence.judge_order(1.0, 2.0, DISTURBANCE * SQUEAL_HZ * HZ / 3.0e4);
}

/// Frequency of the coupled modes, which lie at 15 to 16 kHz. The onset is that of these modes, not that of
/// the line that decays most slowly.
const SQUEAL_HZ: f64 = 15_500.0;

/// Protects: the growth rate that a job reports as evidence of stable sliding is that of the eigenvalue.
#[test]
fn reported_decay_is_the_eigenvalue() {
    let mut evidence = Evidence::new("Flutter", "growth rate [1/s] in the record of a stable job", SOURCE);
    for mu in [0.1, 0.2] {
        let (model, drive) = case(mu, 0.7);
        let exact = Sliding::new(&model, &drive, mu).leading();
        let record = solve(&spec(mu, 0.7), &mut Unobserved).unwrap();
        assert_eq!(record.outcome, Outcome::Decayed);
        let found = record.growth_rate_per_s.expect("a decayed job has a growth rate");
        evidence.bounded(format!("μ {mu}"), found, exact.re, exact.re, 0.05);
    }
    evidence.judge_bounded("the accuracy that is promised, 5 %");
}
