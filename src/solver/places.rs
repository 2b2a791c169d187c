//! Where in a field the nodes are that a step visits one by one.

use super::field::{Field, Place};
use super::model::Model;

/// One degree of freedom.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub place: Place,
    pub component: usize,
}

/// The nodes and degrees of freedom of a model that a step visits.
#[derive(Debug, Clone)]
pub(super) struct Places {
    pub slaves: Vec<Place>,
    /// Loaded degrees of freedom and their shares of the load.
    pub loaded: Vec<(Spot, f64)>,
    pub fixed: Vec<Spot>,
    /// Of every tied group.
    pub tied: Vec<Vec<Spot>>,
    /// Slave nodes that are held in a tangential direction, and in which.
    pub held: Vec<(usize, usize)>,
}

impl Places {
    pub fn new<const L: usize>(model: &Model, field: &Field<L>) -> Self {
        let spot = |dof: usize| Spot { place: field.place(dof / 3), component: dof % 3 };
        let held = model.slaves().iter().enumerate().flat_map(|(slave, node)| {
            (0..2).filter(|&c| !node.mobile[c]).map(move |component| (slave, component))
        });
        Self {
            slaves: model.slaves().iter().map(|slave| field.place(slave.node)).collect(),
            loaded: model.load().iter().map(|loaded| (spot(loaded.dof), loaded.share)).collect(),
            fixed: model.fixed().iter().copied().map(spot).collect(),
            tied: model.ties().iter().map(|tie| tie.dofs.iter().copied().map(spot).collect()).collect(),
            held: held.collect(),
        }
    }
}
