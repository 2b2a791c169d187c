//! The true highest mode of a constrained block, from dense eigenvalues of the program's own operator.

use nalgebra::DMatrix;
use tribosweep_mechanics::solver::body::Freedom;
use tribosweep_mechanics::solver::support::{self, Support};
use tribosweep_mechanics::solver::{Model, ModelDefinition, SolverError, TimeStep, scheme};

/// The highest mode.
pub struct Mode {
    /// Its angular frequency [rad/s].
    pub omega: f64,
    /// Its shape at all degrees of freedom, largest entry 1.
    pub shape: Vec<f64>,
    /// Its modal mass [kg], shapeᵀ M shape.
    pub mass_kg: f64,
}

/// The highest mode of `definition`'s block under its constraints. With `closed`, the contact face is held in
/// z.
pub fn highest(definition: &ModelDefinition, closed: bool) -> Mode {
    let mesh = &definition.mesh;
    let mut supports = definition.supports.clone();
    if closed {
        supports.push(Support::fixed(mesh.bottom_nodes().map(|node| 3 * node + 2)));
    }
    let freedoms = support::freedoms(&supports, mesh).expect("the block's own supports");
    let model =
        Model::new(ModelDefinition { time_step: TimeStep::FractionOfLimit(0.5), ..definition.clone() })
            .expect("a model below its limit");
    let masses = model.pin().masses_kg();

    // For every independent motion: the degrees of freedom that move with it.
    let mut motions: Vec<Vec<usize>> = Vec::new();
    let mut tied = std::collections::BTreeMap::new();
    for (dof, freedom) in freedoms.iter().enumerate() {
        match freedom {
            Freedom::Fixed => {}
            // The scenes of these modes have no holder that rotates.
            Freedom::Free | Freedom::Carried => motions.push(vec![dof]),
            Freedom::Tied(group) => {
                let at = *tied.entry(*group).or_insert_with(|| {
                    motions.push(Vec::new());
                    motions.len() - 1
                });
                motions[at].push(dof);
            }
        }
    }
    let mass: Vec<f64> = motions.iter().map(|dofs| dofs.iter().map(|dof| masses[dof / 3]).sum()).collect();
    let mut matrix = DMatrix::<f64>::zeros(motions.len(), motions.len());
    let mut x = vec![0.0; freedoms.len()];
    for (column, dofs) in motions.iter().enumerate() {
        x.fill(0.0);
        for &dof in dofs {
            x[dof] = 1.0;
        }
        let y = model.pin().stiffness_times(&x);
        for (row, others) in motions.iter().enumerate() {
            let force: f64 = others.iter().map(|&dof| y[dof]).sum();
            matrix[(row, column)] = force / (mass[row] * mass[column]).sqrt();
        }
    }
    let eigen = ((&matrix + matrix.transpose()) * 0.5).symmetric_eigen();
    let top = eigen.eigenvalues.imax();
    let mut shape = vec![0.0; freedoms.len()];
    for (motion, dofs) in motions.iter().enumerate() {
        for &dof in dofs {
            shape[dof] = eigen.eigenvectors[(motion, top)] / mass[motion].sqrt();
        }
    }
    let largest = shape.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    for value in &mut shape {
        *value /= largest;
    }
    let mass_kg = shape.iter().enumerate().map(|(dof, value)| masses[dof / 3] * value * value).sum();
    Mode { omega: eigen.eigenvalues[top].sqrt(), shape, mass_kg }
}

/// The model of `definition` at a fraction of its **true** stability limit, which is above the program's
/// bound.
pub fn at_fraction(definition: &ModelDefinition, mode: &Mode, fraction: f64) -> Result<Model, SolverError> {
    let limit_s = scheme::time_step_limit_s(mode.omega, definition.beta2, definition.beta_r_s);
    let time_step = TimeStep::Unchecked(fraction * limit_s);
    Model::new(ModelDefinition { time_step, ..definition.clone() })
}

/// Largest |λ| of the amplification matrix (`solver::scheme`) of a mode of frequency `omega`.
pub fn growth_per_step(omega: f64, model: &Model) -> f64 {
    let w2 = (omega * model.time_step_s()).powi(2);
    let b = model.scheme().beta_r_s / model.time_step_s();
    let determinant = 1.0 - (model.scheme().beta2 - 0.5 + b) * w2;
    let trace = 2.0 - (0.5 + model.scheme().beta2 + b) * w2;
    let discriminant = trace * trace - 4.0 * determinant;
    if discriminant < 0.0 { determinant.sqrt() } else { (trace.abs() + discriminant.sqrt()) / 2.0 }
}
