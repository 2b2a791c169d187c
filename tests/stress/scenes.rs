//! Small scenes for time steps below and above the limit.

use tribosweep_mechanics::solver::body::pin::Stiffness;
use tribosweep_mechanics::solver::body::pin::{BlockMesh, PinMesh};
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::support::clamp;
use tribosweep_mechanics::solver::support::load::{self, LoadShare};
use tribosweep_mechanics::solver::{Drive, ModelDefinition, State, TimeStep, material::Material};
use tribosweep_mechanics::spec::{Clamp, ClampSide, Holder, TopFace};

/// The reference pin's material.
pub const MATERIAL: Material =
    Material { young_modulus_pa: 1.0e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };

/// No load, no friction, target at rest.
pub const IDLE: Drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: 0.0, ramp_s: 0.0 };

/// The reference pin on a coarse mesh. One node row of its inner side is clamped, and the top is tied in z.
pub fn pin(elements: [usize; 3]) -> ModelDefinition {
    let mesh = PinMesh::from(BlockMesh::new([0.012, 0.015, 0.010], elements));
    let clamp = Clamp { side: ClampSide::InnerSide, width_m: 0.0 };
    let strip = clamp::clamped_strip(&mesh, &clamp).expect("a row at the edge");
    ModelDefinition {
        materials: vec![MATERIAL],
        stiffness: Stiffness::Elastic,
        supports: clamp::supports(&mesh, &strip, TopFace::TiedInZ, &Holder::default()),
        load: load::normal_load(&mesh),
        target: TargetDefinition::Rigid(target::rotating_disk(&mesh, 0.0914)),
        beta2: 0.5,
        beta_r_s: 0.0,
        alpha_r_per_s: 0.0,
        time_step: TimeStep::FractionOfLimit(0.7),
        mesh,
    }
}

/// The pin without its load, for runs in the air.
pub fn in_the_air(definition: ModelDefinition) -> ModelDefinition {
    ModelDefinition { load: Vec::<LoadShare>::new(), ..definition }
}

/// The state of an undeformed pin `height_m` above the plane. It moves with `speed_m_s` times `shape`.
pub fn lifted(
    model: &tribosweep_mechanics::solver::Model,
    height_m: f64,
    speed_m_s: f64,
    shape: &[f64],
) -> State<1> {
    let mut state = State::at_rest(model);
    for (dof, shape) in shape.iter().enumerate() {
        state.p[dof] = speed_m_s * shape;
        if dof % 3 == 2 {
            state.u[dof] = height_m;
        }
    }
    state
}
