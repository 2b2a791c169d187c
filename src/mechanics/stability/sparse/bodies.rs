//! The bodies of a scene as rows of one stiffness matrix and lumped masses, and how their surfaces meet.
//!
//! Displacements are numbered 3·node + component: first those of the pin, then those of the disk in its nodes' own radial,
//! tangential and axial directions. The disk is taken where it is at the beginning of a run. Its material moves on under the
//! pin, and it rotates; both are slow beside the waves in it and are neglected. So the same frame serves both bodies.

use crate::solver::Model;
use crate::solver::body::Freedom;
use crate::solver::body::ring::RingBody;
use crate::solver::interface::target::patch::Grid;
use crate::solver::support::{Rocking, RockingWay, Support};
use crate::spec::TargetSurface;
use std::collections::BTreeMap;

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

/// A linear form: displacements with their shares.
pub type Form = Vec<(usize, f64)>;

/// The bodies.
#[derive(Debug)]
pub struct Bodies {
    /// Entries (column, value \[N/m\]) of every row of K, without the springs of holders.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// Mass \[kg\] of every displacement.
    pub masses_kg: Vec<f64>,
    /// Mass-proportional damping \[1/s\] of the pin. There is none with an elastic disk.
    pub alpha_r_per_s: f64,
    /// How every displacement may move.
    pub freedoms: Vec<Freedom>,
    /// Number of displacements of the pin.
    pub pin: usize,
    pub meetings: Vec<Meeting>,
    /// Ways of holders: the way as a form of displacements, with its mass \[kg\], stiffness \[N/m\] and damper \[N s/m\] (of a
    /// rotation: \[kg m²\], \[N m/rad\], \[N m s/rad\]).
    pub holders: Vec<(Form, [f64; 3])>,
    /// Rigid planes: for each displacement, its shares of the ways of its plane, which are numbered from 0 over all planes.
    pub carried: BTreeMap<usize, Form>,
}

impl Bodies {
    pub fn new(model: &Model) -> Self {
        let pin = model.pin();
        let mut rows = pin.operator().tangent_rows();
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
        let mut holders = Vec::new();
        let mut carried = BTreeMap::new();
        let mut ways = 0;
        for support in model.supports() {
            match support {
                Support::Held(held) => {
                    let form = held.tied.dofs().take(1).map(|dof| (dof, 1.0)).collect();
                    holders.push((form, [held.mass_kg, held.stiffness_n_m, held.damping_n_s_m]));
                }
                Support::Rocking(rocking) => {
                    for (at, dof) in rocking.dofs().enumerate() {
                        let shares =
                            rocking.ways.iter().enumerate().map(|(w, way)| (ways + w, way.shares[at]));
                        carried.insert(dof, shares.collect());
                    }
                    ways += rocking.ways.len();
                    holders.extend(ways_of(rocking));
                }
                Support::Fixed(_) | Support::Tied(_) => {}
            }
        }
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
            holders,
            carried,
            meetings: meetings.collect(),
            pin: first,
            rows,
            masses_kg,
            alpha_r_per_s: model.scheme().alpha_r_per_s,
            freedoms,
        }
    }
}

/// The ways of a rigid plane as forms of displacements, with mass, stiffness and damper.
fn ways_of(rocking: &Rocking) -> Vec<(Form, [f64; 3])> {
    // The model has checked that the nodes determine the ways.
    let Ok((chosen, factors)) = rocking.coordinates() else { return Vec::new() };
    let of_way = |(w, way): (usize, &RockingWay)| {
        let form = chosen.iter().enumerate().map(|(i, &at)| (3 * rocking.nodes[at] + 2, factors[(w, i)]));
        (form.collect(), [way.inertia, way.stiffness, way.damping])
    };
    rocking.ways.iter().enumerate().map(of_way).collect()
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
