//! The quadratic eigenvalue problem in a basis that is normalized to the mass 1.
//!
//! ```text
//! P(λ) = λ² + α λ + (1 + β λ) (K − μ AᵀB) + λ (D + Σ C)
//! ```

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, c64};
use std::cmp::Ordering;

/// P(λ) in a basis, with real matrices.
#[derive(Debug, Clone)]
pub struct Pencil {
    /// K − μ AᵀB.
    pub stiffness: Mat<f64>,
    /// The damping of sideways slip D.
    pub sideways: Mat<f64>,
    /// Other dampers C, by the moment of a step at which they take the velocity.
    pub viscous: Vec<(Sampling, Mat<f64>)>,
    /// β \[s\].
    pub damping_s: f64,
    /// α \[1/s\].
    pub alpha_r_per_s: f64,
}

/// The velocity that a damper of a run takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// p at the beginning of the step.
    Beginning,
    /// The increment of the step before over the time step.
    StepBefore,
    /// The increment of the step itself over the time step.
    Step,
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
    /// Factors of other dampers, by [`Sampling`].
    viscous: [c64; 3],
}

/// An eigenvalue with its right and left eigenvectors in the basis.
#[derive(Debug, Clone)]
pub struct Pair {
    pub value: c64,
    pub right: Vec<c64>,
    pub left: Vec<c64>,
}

/// Largest number of steps for one eigenvalue.
const STEPS: usize = 24;
/// Steps with the same factors.
const STEPS_OF_FACTORS: usize = 6;
/// Relative change or residual below which an eigenvalue is not improved further.
const CHANGE: f64 = 1e-12;

impl Pencil {
    /// The first-order form of P, whose eigenvalues are those of P over the scale \[1/s\] that is returned. In this unit of time all
    /// entries are of order one.
    fn first_order(&self) -> (Mat<f64>, f64) {
        let n = self.stiffness.nrows();
        let scale = (0..n).map(|i| self.stiffness[(i, i)]).fold(0.0, f64::max).sqrt();
        let matrix = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => 0.0,
            (true, false) => f64::from(u8::from(i == j - n)),
            (false, true) => -self.stiffness[(i - n, j)] / (scale * scale),
            (false, false) => {
                let (i, j) = (i - n, j - n);
                let own = self.damping_s * self.stiffness[(i, j)] + self.sideways[(i, j)];
                let own = if i == j { own + self.alpha_r_per_s } else { own };
                -self.viscous.iter().fold(own, |sum, (_, matrix)| sum + matrix[(i, j)]) / scale
            }
        });
        (matrix, scale)
    }

    /// All eigenvalues with frequency ≥ 0. The largest growth rate comes first.
    pub fn eigenvalues(&self) -> Vec<c64> {
        let (matrix, scale) = self.first_order();
        let values = matrix.eigenvalues().unwrap_or_default();
        let mut found: Vec<c64> = values.into_iter().map(|value| value * scale).filter(is_mode).collect();
        found.sort_by(growing_first);
        found
    }

    /// As [`Self::eigenvalues`], with their right eigenvectors. This takes twice as long.
    fn eigenpairs(&self) -> Vec<(c64, Vec<c64>)> {
        let (matrix, scale) = self.first_order();
        let Ok(eigen) = matrix.eigen() else { return Vec::new() };
        let mut found: Vec<(c64, usize)> = (0..matrix.nrows())
            .map(|k| (eigen.S()[k] * scale, k))
            .filter(|(value, _)| is_mode(value))
            .collect();
        found.sort_by(|(a, _), (b, _)| growing_first(a, b));
        let vector = |k: usize| (0..self.stiffness.nrows()).map(|i| eigen.U()[(i, k)]).collect();
        found.into_iter().map(|(value, k)| (value, vector(k))).collect()
    }

    /// The eigenpairs that continue those of a smaller basis: each the one whose vector is most alike, and none twice. The
    /// nearest eigenvalue may belong to another mode.
    pub fn continued(&self, pairs: &[Pair]) -> Vec<Pair> {
        let mut all = self.eigenpairs();
        let follow = |pair: &Pair| {
            let alike = all.iter().map(|(_, right)| likeness(&pair.right, right)).enumerate();
            match alike.max_by(|(_, a), (_, b)| a.total_cmp(b)) {
                Some((at, _)) => {
                    let (value, right) = all.swap_remove(at);
                    self.polish(Clock::Continuous, value, Some(&right))
                }
                None => pair.clone(),
            }
        };
        pairs.iter().map(follow).collect()
    }

    /// The factors of P and those of its derivative.
    fn factors(&self, clock: Clock, value: c64) -> [Factors; 2] {
        let one = c64::new(1.0, 0.0);
        let alpha = self.alpha_r_per_s;
        match clock {
            Clock::Continuous => [
                Factors {
                    inertia: value * value + value * alpha,
                    elastic: one + value * self.damping_s,
                    sideways: value,
                    viscous: [value; 3],
                },
                Factors {
                    inertia: value * 2.0 + one * alpha,
                    elastic: one * self.damping_s,
                    sideways: one,
                    viscous: [one; 3],
                },
            ],
            Clock::Steps { time_step_s, beta2, beta_r_s } => {
                let exponent = value * time_step_s;
                let (sin, cos) = libm::sincos(exponent.im);
                let z = c64::new(cos, sin) * libm::exp(exponent.re);
                let (step, weight) = (z - one, 0.5 + beta2);
                let g = one + step * weight;
                let slope = z * time_step_s;
                let square = time_step_s * time_step_s;
                [
                    Factors {
                        inertia: step * step / (g * square) + step / g * (alpha / time_step_s),
                        elastic: one + step / g * (beta_r_s / time_step_s),
                        sideways: step / time_step_s,
                        viscous: [step / g, step / z, step].map(|factor| factor / time_step_s),
                    },
                    Factors {
                        inertia: slope * (step * 2.0 * g - step * step * weight) / (g * g * square)
                            + slope / (g * g) * (alpha / time_step_s),
                        elastic: slope / (g * g) * (beta_r_s / time_step_s),
                        sideways: slope / time_step_s,
                        viscous: [slope / (g * g), slope / (z * z), slope].map(|factor| factor / time_step_s),
                    },
                ]
            }
        }
    }

    fn at(&self, clock: Clock, value: c64) -> Mat<c64> {
        let n = self.stiffness.nrows();
        let [Factors { inertia, elastic, sideways, viscous }, _] = self.factors(clock, value);
        Mat::from_fn(n, n, |i, j| {
            let own = if i == j { inertia } else { c64::new(0.0, 0.0) };
            let own = own + elastic * self.stiffness[(i, j)] + sideways * self.sideways[(i, j)];
            let others = self.viscous.iter();
            others.fold(own, |sum, (sampling, matrix)| sum + viscous[*sampling as usize] * matrix[(i, j)])
        })
    }

    /// Improves an eigenvalue by residual inverse iteration (Neumaier, 1985), and finds its right and left eigenvectors.
    /// One factorization serves if the given eigenvalue is close. A right eigenvector of a smaller basis is a better start than
    /// none if the eigenvalue is not.
    pub fn polish(&self, clock: Clock, value: c64, right: Option<&[c64]>) -> Pair {
        let n = self.stiffness.nrows();
        let mut value = value;
        let mut factors = self.at(clock, value).partial_piv_lu();
        let mut x = match right {
            Some(right) => Mat::from_fn(n, 1, |i, _| right.get(i).copied().unwrap_or(c64::new(0.0, 0.0))),
            None => right_vector(&factors, n),
        };
        normalize(&mut x);
        let mut left = left_vector(&factors, &x);
        for step in 1..=STEPS {
            let products = self.products(&x);
            let before = value;
            value = self.root(clock, value, &products, &left);
            let [at, _] = self.factors(clock, value);
            let residual = products.combined(&at);
            if !(value.re.is_finite() && value.im.is_finite()) {
                break;
            }
            let is_exact = norm(&residual) <= CHANGE * at.inertia.norm() * norm(&x);
            if is_exact || (step > 1 && (value - before).norm() <= CHANGE * value.norm()) {
                break;
            }
            x -= factors.solve(&residual);
            normalize(&mut x);
            if step % STEPS_OF_FACTORS == 0 {
                factors = self.at(clock, value).partial_piv_lu();
                left = left_vector(&factors, &x);
            }
        }
        let vector = |x: &Mat<c64>| (0..n).map(|i| x[(i, 0)]).collect();
        Pair { value, right: vector(&x), left: vector(&left) }
    }

    /// yᴴ P′(λ) x of a pair.
    pub fn slope_form(&self, pair: &Pair) -> c64 {
        let column = |of: &[c64]| Mat::from_fn(of.len(), 1, |i, _| of[i]);
        let (x, y) = (column(&pair.right), column(&pair.left));
        let [_, slopes] = self.factors(Clock::Continuous, pair.value);
        self.products(&x).forms(&y).combined(&slopes)
    }

    fn products<'a>(&self, x: &'a Mat<c64>) -> Products<'a> {
        let viscous = self.viscous.iter().map(|(sampling, matrix)| (*sampling, times(matrix, x)));
        Products {
            own: x,
            elastic: times(&self.stiffness, x),
            sideways: times(&self.sideways, x),
            viscous: viscous.collect(),
        }
    }

    /// The root λ of yᴴ P(λ) x = 0 by Newton's method. Its error is that of x times that of y.
    fn root(&self, clock: Clock, value: c64, x: &Products<'_>, y: &Mat<c64>) -> c64 {
        let forms = x.forms(y);
        let mut value = value;
        for _ in 0..STEPS {
            let [at, slope] = self.factors(clock, value).map(|factors| forms.combined(&factors));
            let change = at / slope;
            value -= change;
            // This is false for NaN.
            let goes_on = change.norm() > CHANGE * value.norm();
            if !goes_on {
                break;
            }
        }
        value
    }
}

/// A vector with its products with K − μ AᵀB, D and C.
struct Products<'a> {
    own: &'a Mat<c64>,
    elastic: Mat<c64>,
    sideways: Mat<c64>,
    viscous: Vec<(Sampling, Mat<c64>)>,
}

/// Products of one vector with those of another.
struct Forms {
    own: c64,
    elastic: c64,
    sideways: c64,
    viscous: Vec<(Sampling, c64)>,
}

impl Forms {
    fn combined(&self, factors: &Factors) -> c64 {
        let own =
            factors.inertia * self.own + factors.elastic * self.elastic + factors.sideways * self.sideways;
        let others = self.viscous.iter();
        others.fold(own, |sum, (sampling, form)| sum + factors.viscous[*sampling as usize] * form)
    }
}

impl Products<'_> {
    /// P(λ) x.
    fn combined(&self, factors: &Factors) -> Mat<c64> {
        Mat::from_fn(self.own.nrows(), 1, |i, _| {
            let own = factors.inertia * self.own[(i, 0)]
                + factors.elastic * self.elastic[(i, 0)]
                + factors.sideways * self.sideways[(i, 0)];
            let others = self.viscous.iter();
            others.fold(own, |sum, (sampling, of)| sum + factors.viscous[*sampling as usize] * of[(i, 0)])
        })
    }

    /// The products with yᴴ.
    fn forms(&self, y: &Mat<c64>) -> Forms {
        Forms {
            own: dot(y, self.own),
            elastic: dot(y, &self.elastic),
            sideways: dot(y, &self.sideways),
            viscous: self.viscous.iter().map(|(sampling, of)| (*sampling, dot(y, of))).collect(),
        }
    }
}

/// A real matrix times a complex vector.
fn times(matrix: &Mat<f64>, x: &Mat<c64>) -> Mat<c64> {
    let parts = Mat::from_fn(x.nrows(), 2, |i, part| if part == 0 { x[(i, 0)].re } else { x[(i, 0)].im });
    let product = matrix * &parts;
    Mat::from_fn(matrix.nrows(), 1, |i, _| c64::new(product[(i, 0)], product[(i, 1)]))
}

/// The right eigenvector by inverse iteration, from a vector that is orthogonal to no mode.
fn right_vector(factors: &PartialPivLu<c64>, n: usize) -> Mat<c64> {
    let mut right = Mat::from_fn(n, 1, |i, _| c64::new(libm::cos(i as f64), libm::sin(0.7 * i as f64)));
    for _ in 0..2 {
        right = factors.solve(&right);
        normalize(&mut right);
    }
    right
}

/// The left eigenvector by inverse iteration, from the right one.
fn left_vector(factors: &PartialPivLu<c64>, right: &Mat<c64>) -> Mat<c64> {
    let mut left = right.clone();
    for _ in 0..2 {
        left = factors.solve_adjoint(&left);
        normalize(&mut left);
    }
    left
}

/// xᴴ y.
fn dot(x: &Mat<c64>, y: &Mat<c64>) -> c64 {
    (0..x.nrows()).map(|i| x[(i, 0)].conj() * y[(i, 0)]).sum()
}

fn norm(x: &Mat<c64>) -> f64 {
    (0..x.nrows()).map(|i| x[(i, 0)].norm_sqr()).sum::<f64>().sqrt()
}

/// Whether an eigenvalue is one of a mode, of which conjugate eigenvalues are one.
fn is_mode(value: &c64) -> bool {
    value.im >= 0.0 && value.re.is_finite()
}

fn growing_first(a: &c64, b: &c64) -> Ordering {
    b.re.total_cmp(&a.re).then(a.im.total_cmp(&b.im))
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
