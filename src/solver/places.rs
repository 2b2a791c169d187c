//! Where in a field the nodes are that a step visits one by one.

use super::field::{Field, Place};
use super::model::Model;

/// Where one degree of freedom is.
#[derive(Debug, Clone, Copy)]
pub(super) struct DofPlace {
    pub place: Place,
    pub component: usize,
}

/// The nodes and degrees of freedom of a model that a step visits.
#[derive(Debug, Clone)]
pub(super) struct Places {
    pub slaves: Vec<Place>,
    /// Loaded degrees of freedom and their shares of the load.
    pub loaded: Vec<(DofPlace, f64)>,
    pub fixed: Vec<DofPlace>,
    /// Of every tied group.
    pub tied: Vec<Vec<DofPlace>>,
    /// Slave nodes that are held in a tangential direction, and in which.
    pub held: Vec<(usize, usize)>,
}

impl Places {
    pub fn new<const L: usize>(model: &Model, field: &Field<L>) -> Self {
        let dof_place = |dof: usize| DofPlace { place: field.place(dof / 3), component: dof % 3 };
        let held = model.slaves().iter().enumerate().flat_map(|(slave, node)| {
            (0..2).filter(|&c| !node.mobile[c]).map(move |component| (slave, component))
        });
        Self {
            slaves: model.slaves().iter().map(|slave| field.place(slave.node)).collect(),
            loaded: model.load().iter().map(|loaded| (dof_place(loaded.dof), loaded.share)).collect(),
            fixed: model.fixed().iter().copied().map(dof_place).collect(),
            tied: model.ties().iter().map(|tie| tie.dofs.iter().copied().map(dof_place).collect()).collect(),
            held: held.collect(),
        }
    }
}
