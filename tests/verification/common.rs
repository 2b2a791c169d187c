//! One-dimensional columns and small helpers shared by the other files.

use tribosweep_mechanics::solver::body::pin::{BlockMesh, PinMesh, Stiffness};
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target::{self, TargetDefinition};
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::support::load::LoadShare;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep, step};

/// The reference pin's material with another Poisson's ratio.
pub fn pin_material(poisson_ratio: f64) -> Material {
    Material { young_modulus_pa: 1.0e9, poisson_ratio, density_kg_m3: 2500.0 }
}

/// Width of a column. It is so large that no lateral mode is faster than the axial ones.
pub const COLUMN_WIDTH_M: f64 = 0.1;

/// Height of a column.
pub const COLUMN_HEIGHT_M: f64 = 0.010;

/// Area of a column's cross section.
pub const COLUMN_AREA_M2: f64 = COLUMN_WIDTH_M * COLUMN_WIDTH_M;

/// A column of `layers` elements over the reference pin's height, on a plane that moves towards +y.
pub fn column_mesh(layers: usize) -> BlockMesh {
    BlockMesh::new([COLUMN_WIDTH_M, COLUMN_WIDTH_M, COLUMN_HEIGHT_M], [1, 1, layers])
}

/// Nodes of one level of a column.
pub fn level(mesh: &BlockMesh, k: usize) -> Vec<usize> {
    (0..mesh.node_count()).filter(|&node| mesh.grid_position(node)[2] == k).collect()
}

/// Ties that make every level of the column move as one in `component`.
pub fn level_ties(mesh: &BlockMesh, component: usize) -> Vec<Support> {
    (0..=mesh.elements()[2]).map(|k| Support::tied(component, level(mesh, k))).collect()
}

/// All degrees of freedom of `component`.
pub fn all_of(mesh: &BlockMesh, component: usize) -> Vec<usize> {
    (0..mesh.node_count()).map(|node| 3 * node + component).collect()
}

/// A definition with the parts that most columns share; no load, central difference, undamped.
pub fn definition(mesh: impl Into<PinMesh>, material: Material, supports: Vec<Support>) -> ModelDefinition {
    let mesh = mesh.into();
    ModelDefinition {
        target: TargetDefinition::Rigid(target::straight_plane(&mesh)),
        mesh,
        materials: vec![material],
        stiffness: Stiffness::Elastic,
        supports,
        load: Vec::<LoadShare>::new(),
        beta2: 0.5,
        beta_r_s: 0.0,
        alpha_r_per_s: 0.0,
        time_step: TimeStep::FractionOfLimit(1.0),
    }
}

/// A bar: a column that moves in z only, with ν = 0.
pub fn bar(layers: usize) -> ModelDefinition {
    let mesh = column_mesh(layers);
    let fixed = [all_of(&mesh, 0), all_of(&mesh, 1)].concat();
    definition(mesh, pin_material(0.0), vec![Support::fixed(fixed)])
}

/// No friction, no load, target at rest.
pub const IDLE: Drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// Advances one lane by `steps`.
pub fn advance(model: &Model, drive: &Drive, state: &mut State<1>, steps: usize) {
    for _ in 0..steps {
        step(model, std::slice::from_ref(drive).try_into().expect("one lane"), state);
    }
}

/// Total normal contact force of the last step [N].
pub fn normal_force_n(state: &State<1>) -> f64 {
    state.contacts.forces(0).map(|force| force[2]).sum()
}

/// Largest number of roundings of one component of K u, relative to Σ|K||u|. An entry of the element's
/// stiffness is a sum over 8 Gauss points of some 10 roundings each, up to 8 elements are added, and a row
/// has 81 products.
pub const ROUNDINGS_PER_FORCE: f64 = 8.0 * 10.0 + 8.0 + 81.0;

/// A bar along z: it moves in z only, and is ten times as wide as long, so that its limit is cΔt/h = 1.
pub fn axial_bar(length_m: f64, layers: usize, material: Material, top_fixed: bool) -> ModelDefinition {
    let mesh = BlockMesh::new([10.0 * length_m, 10.0 * length_m, length_m], [1, 1, layers]);
    let mut fixed = [all_of(&mesh, 0), all_of(&mesh, 1)].concat();
    if top_fixed {
        fixed.extend(mesh.top_nodes().map(|node| 3 * node + 2));
    }
    definition(mesh, material, vec![Support::fixed(fixed)])
}

/// The step of a column at a given cΔt/h, c the speed of pressure waves.
pub fn step_at_cfl(definition: &ModelDefinition, cfl: f64) -> TimeStep {
    let h = definition.mesh.block().unwrap().element_size_m()[2];
    TimeStep::Given(cfl * h / definition.materials[0].pressure_wave_speed_m_s())
}

/// Order ⅔ (to the digits that are shown) of errors that a dispersed front causes. The phase error of the
/// central difference is cubic in frequency, so a front that has travelled L is smeared over (h²L)^⅓.
pub const FRONT_ORDER: f64 = 0.667;

/// Rows of a tensor.
pub type Matrix = [[f64; 3]; 3];

/// The nodes of the pin \[m\].
pub fn positions(model: &Model) -> Vec<[f64; 3]> {
    (0..model.mesh().node_count()).map(|node| model.mesh().coordinates_m(node)).collect()
}

/// The displacements of x → F x.
pub fn uniform(model: &Model, f: Matrix) -> Vec<f64> {
    let moved = |x: [f64; 3]| f.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
    positions(model)
        .into_iter()
        .flat_map(|x| std::array::from_fn::<f64, 3, _>(|c| moved(x)[c] - x[c]))
        .collect()
}

/// V P = Σ f ⊗ X of forces on a body of uniform stress.
pub fn stress_of(model: &Model, force: &[f64]) -> Matrix {
    let [a, b, c] = model.mesh().size_m();
    let mut sum = [[0.0; 3]; 3];
    for (node, x) in positions(model).into_iter().enumerate() {
        for i in 0..3 {
            for j in 0..3 {
                sum[i][j] += force[3 * node + i] * x[j] / (a * b * c);
            }
        }
    }
    sum
}

/// Rows of K as the program applies it: 3·node + component → (column, value [N/m]).
///
/// A row reaches only the neighbouring nodes in every direction, so nodes three apart can share a product. 81
/// products with unit displacements give all columns.
pub fn stiffness_rows(model: &Model) -> Vec<Vec<(usize, f64)>> {
    let mesh = model.mesh().block().unwrap();
    let dofs = 3 * mesh.node_count();
    let mut unit = vec![0.0; dofs];
    let mut rows = vec![Vec::with_capacity(81); dofs];
    let counts = mesh.nodes_per_axis();
    for colour in 0..27 {
        let offset = [colour % 3, colour / 3 % 3, colour / 9];
        let coloured = |node: &usize| {
            let grid = mesh.grid_position(*node);
            (0..3).all(|a| grid[a] % 3 == offset[a])
        };
        for c in 0..3 {
            unit.fill(0.0);
            (0..mesh.node_count()).filter(coloured).for_each(|node| unit[3 * node + c] = 1.0);
            let force = model.pin().stiffness_times(&unit);
            for node in 0..mesh.node_count() {
                let grid = mesh.grid_position(node);
                // The one node of this colour within reach, if the block has it.
                let near: Option<Vec<usize>> = (0..3)
                    .map(|a| {
                        let reach = grid[a].saturating_sub(1)..(grid[a] + 2).min(counts[a]);
                        reach.into_iter().find(|i| i % 3 == offset[a])
                    })
                    .collect();
                let Some(near) = near else { continue };
                let column = 3 * mesh.node(near[0], near[1], near[2]) + c;
                for row in 3 * node..3 * node + 3 {
                    rows[row].push((column, force[row]));
                }
            }
        }
    }
    rows
}
