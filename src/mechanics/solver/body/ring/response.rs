//! Response of the disk to forces on its top nodes within one step.

use super::mesh::RingMesh;
use super::operator::{RingOperator, RingScratch};
use super::stages::Stages;
use crate::solver::field::Field;

/// B M⁻¹ \[1/kg\] between the nodes of the track and the nodes up to m − 1 nodes away, for m stages. It is the
/// displacement per force, divided by the step's factor of Δt²a, in the nodes' own directions.
#[derive(Debug, Clone)]
pub struct Response {
    reach: usize,
    /// Index of the neighbourhood in `loads`, for every column of nodes of the track.
    columns: Vec<usize>,
    rows: usize,
    /// Neighbourhood → row of the track → depth, row and column → component of the motion → component of the force.
    /// Row and column run from −reach to reach.
    loads: Vec<Vec<[[f64; 3]; 3]>>,
}

/// Number of lanes: one for each component of the force, and an empty one.
const LANES: usize = 4;

impl Response {
    /// The response of the stages of a step. `inverse_mass` is 1/m \[1/kg\] of every node, 0 where it is held.
    pub fn new(
        mesh: &RingMesh,
        operator: &RingOperator,
        inverse_mass: &[f64],
        stages: &Stages,
        time_step_s: f64,
    ) -> Self {
        let reach = stages.count() - 1;
        let track = mesh.track();
        let [all_columns, _, _] = mesh.nodes_per_axis();
        let columns = if track.sectors == all_columns { all_columns } else { track.sectors + 1 };
        let mut kinds: Vec<Vec<Option<usize>>> = Vec::new();
        let mut loads = Vec::new();
        let rows = track.elements + 1;
        let of_column = (0..columns)
            .map(|j| {
                let around = |offset| column_at(mesh, j, offset).map(|column| operator.classes()[column]);
                let kind: Vec<_> = (-(reach as isize)..=reach as isize).map(around).collect();
                kinds.iter().position(|known| *known == kind).unwrap_or_else(|| {
                    kinds.push(kind);
                    loads.push(
                        (0..rows)
                            .flat_map(|row| {
                                let node = mesh.node(j, track.first_row + row, 0);
                                unit_forces(mesh, operator, inverse_mass, stages, time_step_s, node)
                            })
                            .collect::<Vec<_>>(),
                    );
                    kinds.len() - 1
                })
            })
            .collect();
        Self { reach, columns: of_column, rows, loads }
    }

    /// Largest distance, in nodes, at which a force acts within a step.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// Response \[1/kg\] to a force on the node at this column and row of the track: depth, then row and column
    /// from −reach to reach, columns fastest. It is zero where there is no node.
    pub fn of(&self, column: usize, row: usize) -> &[[[f64; 3]; 3]] {
        let all = &self.loads[self.columns[column]];
        let each = all.len() / self.rows;
        &all[row * each..(row + 1) * each]
    }
}

/// The column `offset` columns further; `None` beyond the ends of a sector.
pub fn column_at(mesh: &RingMesh, column: usize, offset: isize) -> Option<usize> {
    let [columns, _, _] = mesh.nodes_per_axis();
    let at = column as isize + offset;
    if mesh.is_closed() {
        Some(at.rem_euclid(columns as isize) as usize)
    } else {
        usize::try_from(at).ok().filter(|at| *at < columns)
    }
}

/// Runs the stages of a step from rest with a unit force on one node, for each component.
fn unit_forces(
    mesh: &RingMesh,
    operator: &RingOperator,
    inverse_mass: &[f64],
    stages: &Stages,
    time_step_s: f64,
    node: usize,
) -> Vec<[[f64; 3]; 3]> {
    let [_, rows, planes] = mesh.nodes_per_axis();
    let field = || Field::<LANES>::zeros(mesh.layout());
    let (mut d, mut before, mut product) = (field(), field(), field());
    let mut scratch = RingScratch::new(operator);
    for stage in stages.stages() {
        operator.product(&d, &mut product, &mut scratch);
        for (moved, inverse) in inverse_mass.iter().enumerate() {
            let place = d.place(moved);
            for c in 0..3 {
                for lane in 0..LANES {
                    let force = if moved == node && c == lane { 1.0 } else { 0.0 };
                    let next = stage.own * d.at(place, c)[lane]
                        - stage.before * before.at(place, c)[lane]
                        - stage.force_s2 * inverse * (product.at(place, c)[lane] - force);
                    before.at_mut(place, c)[lane] = next;
                }
            }
        }
        std::mem::swap(&mut d, &mut before);
    }
    let scale = 2.0 / (time_step_s * time_step_s);
    let reach = stages.count() as isize - 1;
    let [j, i, _] = mesh.grid_position(node);
    let mut moved = Vec::new();
    for depth in 0..=reach {
        for row in -reach..=reach {
            for column in -reach..=reach {
                let at = column_at(mesh, j, column)
                    .zip(usize::try_from(i as isize + row).ok().filter(|at| *at < rows))
                    .filter(|_| (depth as usize) < planes);
                moved.push(at.map_or([[0.0; 3]; 3], |(column, row)| {
                    let place = d.place(mesh.node(column, row, depth as usize));
                    std::array::from_fn(|c| std::array::from_fn(|lane| scale * d.at(place, c)[lane]))
                }));
            }
        }
    }
    moved
}
