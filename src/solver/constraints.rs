//! Fixed and tied degrees of freedom.

use super::error::SolverError;
use super::mesh::BlockMesh;

/// Nodes that share one displacement in one component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tie {
    /// The component: x = 0, y = 1, z = 2.
    pub component: usize,
    /// The nodes, at least one.
    pub nodes: Vec<usize>,
}

/// What holds the block besides contact.
#[derive(Debug, Clone, Default)]
pub struct Constraints {
    /// Degrees of freedom (3·node + component) that never move.
    pub fixed: Vec<usize>,
    /// Groups that move as one.
    pub ties: Vec<Tie>,
}

/// How one degree of freedom may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// By itself.
    Free,
    /// Not at all.
    Fixed,
    /// With the others of tie number .0.
    Tied(usize),
}

impl Constraints {
    /// The freedom of every degree of freedom of `mesh`.
    ///
    /// # Errors
    /// If a constraint is out of range or a degree of freedom is constrained twice, or if a tie
    /// mixes contact-face nodes with others: the contact solve treats each slave node by its own
    /// mass, which is right for a tied group only when the whole group is in contact alike.
    pub fn freedoms(&self, mesh: &BlockMesh) -> Result<Vec<Freedom>, SolverError> {
        let mut freedoms = vec![Freedom::Free; 3 * mesh.node_count()];
        let mut set = |dof: usize, freedom| match freedoms.get_mut(dof) {
            Some(slot @ Freedom::Free) => {
                *slot = freedom;
                Ok(())
            }
            Some(_) => Err(SolverError::Constraints(format!("degree of freedom {dof} is constrained twice"))),
            None => Err(SolverError::Constraints(format!("degree of freedom {dof} does not exist"))),
        };
        for &dof in &self.fixed {
            set(dof, Freedom::Fixed)?;
        }
        for (group, tie) in self.ties.iter().enumerate() {
            for &node in &tie.nodes {
                set(3 * node + tie.component, Freedom::Tied(group))?;
            }
            let on_contact_face = tie.nodes.iter().filter(|node| mesh.bottom_nodes().contains(node)).count();
            if tie.nodes.is_empty() || (on_contact_face > 0 && on_contact_face < tie.nodes.len()) {
                return Err(SolverError::Constraints(format!(
                    "tie {group} must hold at least one node, all or none of them on the contact face"
                )));
            }
        }
        Ok(freedoms)
    }
}
