//! The bodies of a scene as rows of one stiffness matrix and lumped masses, and how their surfaces meet.
//!
//! Displacements are numbered 3·node + component: first those of the pin, then those of the disk in its nodes' own radial,
//! tangential and axial directions. The disk is taken where it is at the beginning of a run. Its material moves on under the
//! pin, and it rotates; both are slow beside the waves in it and are neglected. So the same frame serves both bodies.

use crate::solver::Model;
use crate::solver::body::Freedom;
use crate::solver::body::hexahedron;
use crate::solver::body::pin::operator::{AssembledOperator, Operator};
use crate::solver::body::ring::RingBody;
use crate::solver::interface::target::patch::Grid;
use crate::solver::support::Support;
use crate::spec::TargetSurface;

/// A node of the contact face on its target.
#[derive(Debug)]
pub struct Meeting {
    /// Node of the pin.
    pub node: usize,
    pub initial_gap_m: f64,
    /// Direction of the target's velocity.
    pub forward: [f64; 2],
    /// Speed of the target per unit of the drive's rate.
    pub speed_per_rate: f64,
    /// Displacements of the disk with their shares in the displacement of its surface under the node, for x, y and z. They are
    /// empty on a rigid disk.
    pub surface: [Vec<(usize, f64)>; 3],
}

/// The bodies.
#[derive(Debug)]
pub struct Bodies {
    /// Entries (column, value \[N/m\]) of every row of K, without the springs of holders.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// Mass \[kg\] of every displacement.
    pub masses_kg: Vec<f64>,
    /// How every displacement may move.
    pub freedoms: Vec<Freedom>,
    /// Number of displacements of the pin.
    pub pin: usize,
    pub meetings: Vec<Meeting>,
    /// Holders: one of the displacements of the group, mass \[kg\], stiffness \[N/m\] and damper \[N s/m\].
    pub holders: Vec<(usize, [f64; 3])>,
}

impl Bodies {
    pub fn new(model: &Model) -> Self {
        let pin = model.pin();
        let mut rows = match (pin.operator(), pin.mesh().block()) {
            (Operator::Tensor(_), Some(mesh)) => {
                let element = hexahedron::stiffness(pin.material(), mesh.element_size_m());
                AssembledOperator::of_block(mesh, &element).rows()
            }
            (Operator::Assembled(operator), _) => operator.rows(),
            (Operator::Tensor(_), None) => unreachable!("only a block has a tensor product"),
        };
        let first = rows.len();
        let mut masses_kg: Vec<f64> = pin.masses_kg().iter().flat_map(|mass| [*mass; 3]).collect();
        let mut freedoms = pin.freedoms().to_vec();
        if let Some(ring) = model.ring() {
            for node in 0..ring.mesh().node_count() {
                for dof in 3 * node..3 * node + 3 {
                    let row = ring.operator().row(dof);
                    rows.push(row.into_iter().map(|(column, value)| (first + column, value)).collect());
                    masses_kg.push(ring.masses_kg()[node]);
                    let is_held = ring.inverse_mass()[node] == 0.0;
                    freedoms.push(if is_held { Freedom::Fixed } else { Freedom::Free });
                }
            }
        }
        let holders = model.supports().iter().filter_map(|support| match support {
            Support::Held(held) => {
                Some((held.tied.dofs().next()?, [held.mass_kg, held.stiffness_n_m, held.damping_n_s_m]))
            }
            Support::Fixed(_) | Support::Tied(_) => None,
        });
        let meetings = model.slaves().iter().map(|slave| {
            let [x, y] = slave.surface_motion;
            let speed_per_rate = libm::hypot(x, y);
            Meeting {
                node: slave.node,
                initial_gap_m: slave.initial_gap_m,
                forward: [x / speed_per_rate, y / speed_per_rate],
                speed_per_rate,
                surface: model.ring().map_or_else(Default::default, |ring| surface(ring, first, [y, -x])),
            }
        });
        Self {
            holders: holders.collect(),
            meetings: meetings.collect(),
            pin: first,
            rows,
            masses_kg,
            freedoms,
        }
    }
}

/// The displacements of the disk's surface at a point (X, Y) \[m\] from its axis, with their shares in x, y and z.
fn surface(ring: &RingBody, first: usize, [x, y]: [f64; 2]) -> [Vec<(usize, f64)>; 3] {
    let mesh = ring.mesh();
    let grid = Grid::new(mesh, ring.target());
    let (along, across) = (grid.along(libm::atan2(y, x)), grid.across(libm::hypot(x, y)));
    let from = along.cell - grid.margin();
    let shares = match ring.target() {
        TargetSurface::Bilinear => Grid::bilinear(along, across, from).to_vec(),
        TargetSurface::Ferguson => grid.ferguson(along, across, from).to_vec(),
    };
    let mut surface: [Vec<(usize, f64)>; 3] = Default::default();
    for share in shares.iter().filter(|share| share.weight != 0.0) {
        let column = grid.track_column(from + share.column as isize);
        let node = mesh.node(column, mesh.track().first_row + share.row, 0);
        let (sin, cos) = libm::sincos(mesh.angles_rad()[column]);
        let dof = first + 3 * node;
        surface[0].extend([(dof, cos * share.weight), (dof + 1, -sin * share.weight)]);
        surface[1].extend([(dof, sin * share.weight), (dof + 1, cos * share.weight)]);
        surface[2].push((dof + 2, share.weight));
    }
    surface
}
