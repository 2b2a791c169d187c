//! The quadratic eigenvalue problem in a basis that is normalized to the mass 1.
//!
//! ```text
//! P(λ) = λ² + (1 + β λ) (K − μ AᵀB) + λ D
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// P(λ) in a basis, with real matrices.
#[derive(Debug, Clone)]
pub struct Pencil {
    /// K − μ AᵀB.
    pub stiffness: Mat<f64>,
    /// The damping of sideways slip D.
    pub sideways: Mat<f64>,
    /// β \[s\].
    pub damping_s: f64,
}

/// How time passes: what takes the place of λ², βλ and λ in P.
#[derive(Debug, Clone, Copy)]
pub enum Clock {
    /// Continuously.
    Continuous,
    /// In steps of the β₂ method, with u_n and p_n proportional to zⁿ, z = exp(λΔt). With g = 1 + (½+β₂)(z−1), the
    /// acceleration is (z−1)²/(gΔt²) u, p is (z−1)/(gΔt) u, and the slip of a step is (z−1) u.
    Steps { time_step_s: f64, beta2: f64, beta_r_s: f64 },
}

/// Factors of the mass, of K − μ AᵀB and of D, or their derivatives.
struct Factors {
    inertia: c64,
    elastic: c64,
    sideways: c64,
}

/// An eigenvalue with its right and left eigenvectors in the basis.
#[derive(Debug, Clone)]
pub struct Pair {
    pub value: c64,
    pub right: Vec<c64>,
    pub left: Vec<c64>,
}

/// Steps of Newton's method for one eigenvalue.
const STEPS: usize = 12;
/// Steps of inverse iteration before them, which turn the vector to the nearest eigenvector.
const TURNS: usize = 2;
/// Relative change after which an eigenvalue is not improved further: the method is quadratic.
const CHANGE: f64 = 1e-9;

impl Pencil {
    /// All eigenvalues with frequency ≥ 0 and their eigenvectors. The largest growth rate comes first.
    pub fn eigenpairs(&self) -> Vec<(c64, Vec<c64>)> {
        let n = self.stiffness.nrows();
        // In the unit 1/scale of time all entries are of order one.
        let scale = (0..n).map(|i| self.stiffness[(i, i)]).fold(0.0, f64::max).sqrt();
        let matrix = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => 0.0,
            (true, false) => f64::from(u8::from(i == j - n)),
            (false, true) => -self.stiffness[(i - n, j)] / (scale * scale),
            (false, false) => {
                -(self.damping_s * self.stiffness[(i - n, j - n)] + self.sideways[(i - n, j - n)]) / scale
            }
        });
        let Ok(eigen) = matrix.eigen() else { return Vec::new() };
        let mut found: Vec<(c64, usize)> = (0..2 * n)
            .map(|k| (eigen.S()[k] * scale, k))
            .filter(|(value, _)| value.im >= 0.0 && value.re.is_finite())
            .collect();
        found.sort_by(|(a, _), (b, _)| b.re.total_cmp(&a.re).then(a.im.total_cmp(&b.im)));
        found.into_iter().map(|(value, k)| (value, (0..n).map(|i| eigen.U()[(i, k)]).collect())).collect()
    }

    /// The eigenpairs that continue those of a smaller basis: each the one whose vector is most alike, and none twice. The
    /// nearest eigenvalue may belong to another mode.
    pub fn followed(&self, pairs: &[Pair]) -> Vec<(c64, Vec<c64>)> {
        let mut all = self.eigenpairs();
        let follow = |pair: &Pair| {
            let alike = all.iter().map(|(_, right)| likeness(&pair.right, right)).enumerate();
            match alike.max_by(|(_, a), (_, b)| a.total_cmp(b)) {
                Some((at, _)) => all.swap_remove(at),
                None => (pair.value, pair.right.clone()),
            }
        };
        pairs.iter().map(follow).collect()
    }

    /// The factors of P and those of its derivative.
    fn factors(&self, clock: Clock, value: c64) -> [Factors; 2] {
        let one = c64::new(1.0, 0.0);
        match clock {
            Clock::Continuous => [
                Factors { inertia: value * value, elastic: one + value * self.damping_s, sideways: value },
                Factors { inertia: value * 2.0, elastic: one * self.damping_s, sideways: one },
            ],
            Clock::Steps { time_step_s, beta2, beta_r_s } => {
                let z = (value * time_step_s).exp();
                let (step, weight) = (z - one, 0.5 + beta2);
                let g = one + step * weight;
                let slope = z * time_step_s;
                let square = time_step_s * time_step_s;
                [
                    Factors {
                        inertia: step * step / (g * square),
                        elastic: one + step / g * (beta_r_s / time_step_s),
                        sideways: step / time_step_s,
                    },
                    Factors {
                        inertia: slope * (step * 2.0 * g - step * step * weight) / (g * g * square),
                        elastic: slope / (g * g) * (beta_r_s / time_step_s),
                        sideways: slope / time_step_s,
                    },
                ]
            }
        }
    }

    fn at(&self, clock: Clock, value: c64) -> Mat<c64> {
        let n = self.stiffness.nrows();
        let [Factors { inertia, elastic, sideways }, _] = self.factors(clock, value);
        Mat::from_fn(n, n, |i, j| {
            let own = if i == j { inertia } else { c64::new(0.0, 0.0) };
            own + elastic * self.stiffness[(i, j)] + sideways * self.sideways[(i, j)]
        })
    }

    /// dP/dλ applied to a vector.
    fn slope(&self, clock: Clock, value: c64, x: &Mat<c64>) -> Mat<c64> {
        let n = self.stiffness.nrows();
        let [_, Factors { inertia, elastic, sideways }] = self.factors(clock, value);
        let mut product = Mat::zeros(n, 1);
        for j in 0..n {
            let x = x[(j, 0)];
            let (own, elastic, sideways) = (inertia * x, elastic * x, sideways * x);
            product[(j, 0)] += own;
            for i in 0..n {
                product[(i, 0)] += elastic * self.stiffness[(i, j)] + sideways * self.sideways[(i, j)];
            }
        }
        product
    }

    /// Improves an eigenvalue and its right eigenvector by inverse iteration with Newton's method, and finds its left
    /// eigenvector.
    pub fn polish(&self, clock: Clock, value: c64, right: &[c64]) -> Pair {
        let n = self.stiffness.nrows();
        let mut value = value;
        let mut x = Mat::from_fn(n, 1, |i, _| right.get(i).copied().unwrap_or(c64::new(0.0, 0.0)));
        let mut factors = self.at(clock, value).partial_piv_lu();
        for step in 0..TURNS + STEPS {
            normalize(&mut x);
            let y = factors.solve(self.slope(clock, value, &x));
            let (mut xx, mut xy) = (c64::new(0.0, 0.0), c64::new(0.0, 0.0));
            for i in 0..n {
                xx += x[(i, 0)].conj() * x[(i, 0)];
                xy += x[(i, 0)].conj() * y[(i, 0)];
            }
            let change = xx / xy;
            x = y;
            if step < TURNS {
                continue;
            }
            if !(change.re.is_finite() && change.im.is_finite()) {
                break;
            }
            value -= change;
            if change.norm() <= CHANGE * value.norm() {
                break;
            }
            factors = self.at(clock, value).partial_piv_lu();
        }
        normalize(&mut x);
        let mut left = Mat::from_fn(n, 1, |i, _| x[(i, 0)]);
        for _ in 0..2 {
            left = factors.solve_adjoint(&left);
            normalize(&mut left);
        }
        let vector = |x: &Mat<c64>| (0..n).map(|i| x[(i, 0)]).collect();
        Pair { value, right: vector(&x), left: vector(&left) }
    }
}

/// The cosine between two vectors, of which one may have more components.
fn likeness(a: &[c64], b: &[c64]) -> f64 {
    let norm = |x: &[c64]| x.iter().map(c64::norm_sqr).sum::<f64>().sqrt();
    let product: c64 = a.iter().zip(b).map(|(a, b)| a.conj() * b).sum();
    product.norm() / (norm(a) * norm(b))
}

/// Divides by the component of the largest modulus.
fn normalize(x: &mut Mat<c64>) {
    let largest = (0..x.nrows()).fold(c64::new(0.0, 0.0), |largest, i| {
        if x[(i, 0)].norm_sqr() > largest.norm_sqr() { x[(i, 0)] } else { largest }
    });
    for i in 0..x.nrows() {
        x[(i, 0)] /= largest;
    }
}
