//! Supports: what holds the pin, apart from contact.
//!
//! * [`Fixed`] – degrees of freedom that never move. Their residual is the reaction force on the pin, from which T
//!   is computed.
//! * [`Tied`] – nodes that share one displacement in one component.
//! * [`Held`] – nodes on a holder with a mass, a spring and a damper. The force on the frame is part of T.
//! * [`Rocking`] – nodes that move in z as a rigid plane, on a holder that also rotates.
//! * [`clamp`] – the supports that represent a scene's clamp and top face.
//! * [`load`] – the normal load, which acts on the same planes.
//!
//! A support acts on the residual, stores energy, has a damping that does work, and has a share of the stability limit
//! ([`Bound`]). A rigid support has neither energy nor damping nor a share of the limit. To add a kind of support, write a file
//! that implements `AppliedSupport` for it, and add a variant to [`Support`].

mod applied;
pub mod clamp;
mod fixed;
mod held;
pub mod load;
mod rocking;
mod tied;
mod weights;

pub(in crate::solver) use applied::{AppliedSupport, Supported};
pub use fixed::Fixed;
pub use held::Held;
pub use rocking::{Rocking, RockingWay};
pub use tied::Tied;

use super::body::pin::PinMesh;
use super::body::{EnergySums, Freedom};
use super::error::SolverError;
use super::field::{FieldOf, Layout};
use super::number::Number;
use super::scheme::{Bound, Scheme};
use fixed::AppliedFixed;
use held::AppliedHeld;
use rocking::AppliedRocking;
use tied::AppliedTie;

/// A support in the definition of a model.
#[derive(Debug, Clone, PartialEq)]
pub enum Support {
    /// Degrees of freedom that never move.
    Fixed(Fixed),
    /// Nodes that share a displacement.
    Tied(Tied),
    /// Nodes on a holder.
    Held(Held),
    /// Nodes on a holder that rotates.
    Rocking(Rocking),
}

impl Support {
    /// Fixes degrees of freedom (3·node + component).
    pub fn fixed(dofs: impl IntoIterator<Item = usize>) -> Self {
        Self::Fixed(Fixed { dofs: dofs.into_iter().collect() })
    }

    /// Ties nodes in one component.
    pub fn tied(component: usize, nodes: impl IntoIterator<Item = usize>) -> Self {
        Self::Tied(Tied { component, nodes: nodes.into_iter().collect() })
    }

    /// The degrees of freedom (3·node + component) on which the support acts.
    pub fn dofs(&self) -> Vec<usize> {
        match self {
            Self::Fixed(fixed) => fixed.dofs.clone(),
            Self::Tied(tied) | Self::Held(Held { tied, .. }) => tied.dofs().collect(),
            Self::Rocking(rocking) => rocking.dofs().collect(),
        }
    }

    /// The nodes that share a displacement, if the support ties nodes.
    pub fn tie(&self) -> Option<&Tied> {
        match self {
            Self::Fixed(_) | Self::Rocking(_) => None,
            Self::Tied(tied) | Self::Held(Held { tied, .. }) => Some(tied),
        }
    }

    /// Contribution to the stability limit of a pin with these lumped masses \[kg\]. A rigid support contributes
    /// nothing, because it can only lower the largest frequency.
    pub fn bound(&self, masses_kg: &[f64]) -> Bound {
        match self {
            Self::Fixed(_) | Self::Tied(_) => Bound::default(),
            Self::Held(held) => held.bound(masses_kg),
            Self::Rocking(rocking) => rocking.bound(masses_kg),
        }
    }

    fn applied<const L: usize, R: Number>(
        &self,
        layout: Layout,
        masses_kg: &[f64],
    ) -> Box<dyn AppliedSupport<L, R>> {
        match self {
            Self::Fixed(fixed) => Box::new(AppliedFixed::new(fixed, layout, L)),
            Self::Tied(tied) => Box::new(AppliedTie::new(tied, layout, L, masses_kg, 0.0)),
            Self::Held(held) => Box::new(AppliedHeld::<L, R>::new(held, layout, masses_kg)),
            Self::Rocking(rocking) => Box::new(AppliedRocking::<L, R>::new(rocking, layout, masses_kg)),
        }
    }
}

/// How every degree of freedom (3·node + component) of `mesh` may move with these supports.
///
/// # Errors
/// If a support is out of range, if a degree of freedom is supported twice, if a tie mixes nodes of the contact
/// face with others, or if a holder has nodes of the contact face. The contact solve uses the mass of each slave node alone. For a tied group this is right only
/// if all its nodes are in contact alike.
pub fn freedoms(supports: &[Support], mesh: &PinMesh) -> Result<Vec<Freedom>, SolverError> {
    let mut freedoms = vec![Freedom::Free; 3 * mesh.node_count()];
    let mut set = |dof: usize, freedom| match freedoms.get_mut(dof) {
        Some(slot @ Freedom::Free) => {
            *slot = freedom;
            Ok(())
        }
        Some(_) => Err(SolverError::Constraints(format!("degree of freedom {dof} is constrained twice"))),
        None => Err(SolverError::Constraints(format!("degree of freedom {dof} does not exist"))),
    };
    let mut groups = 0;
    for support in supports {
        match support {
            Support::Fixed(fixed) => {
                for &dof in &fixed.dofs {
                    set(dof, Freedom::Fixed)?;
                }
            }
            Support::Tied(tied) | Support::Held(Held { tied, .. }) => {
                for dof in tied.dofs() {
                    set(dof, Freedom::Tied(groups))?;
                }
                let on_contact_face =
                    tied.nodes.iter().filter(|node| mesh.bottom_nodes().contains(node)).count();
                if tied.nodes.is_empty() || (on_contact_face > 0 && on_contact_face < tied.nodes.len()) {
                    return Err(SolverError::Constraints(format!(
                        "tie {groups} must hold at least one node, all or none of them on the contact face"
                    )));
                }
                if on_contact_face > 0 && matches!(support, Support::Held(_)) {
                    return Err(SolverError::Constraints(format!(
                        "holder {groups} must not hold nodes of the contact face"
                    )));
                }
                groups += 1;
            }
            Support::Rocking(rocking) => {
                rocking.coordinates()?;
                for dof in rocking.dofs() {
                    set(dof, Freedom::Carried)?;
                }
                if rocking.nodes.iter().any(|node| mesh.bottom_nodes().contains(node)) {
                    return Err(SolverError::Constraints(
                        "a rocking holder must not hold nodes of the contact face".to_owned(),
                    ));
                }
            }
        }
    }
    Ok(freedoms)
}

/// All supports in every lane, ties last.
#[derive(Debug)]
pub(in crate::solver) struct AppliedSupports<const L: usize, R: Number>(Vec<Box<dyn AppliedSupport<L, R>>>);

impl<const L: usize, R: Number> AppliedSupports<L, R> {
    /// Prepares the supports of a pin with these lumped masses \[kg\].
    pub fn new(supports: &[Support], layout: Layout, masses_kg: &[f64]) -> Self {
        // A tie replaces the residual, so everything that adds to the residual acts before.
        let is_tie = |support: &&Support| !matches!(support, Support::Fixed(_));
        let (ties, others): (Vec<_>, Vec<_>) = supports.iter().partition(is_tie);
        Self(others.into_iter().chain(ties).map(|support| support.applied(layout, masses_kg)).collect())
    }

    /// Lets all supports act on the pin. Returns the sum of their reaction forces on the pin \[N\]: x, y and z.
    pub fn act(&mut self, pin: &mut Supported<'_, L, R>) -> [[f64; L]; 3] {
        let mut reaction_n = [[0.0; L]; 3];
        for support in &mut self.0 {
            support.act(pin, &mut reaction_n);
        }
        reaction_n
    }

    /// Displacement \[m\] and acceleration \[m/s²\] of the holder in x, y and z at t_n; zeros where it does not move.
    pub fn holder_motion(&self) -> [[[f64; L]; 2]; 3] {
        let mut motion = [[[0.0; L]; 2]; 3];
        for (component, found) in self.0.iter().filter_map(|support| support.motion()) {
            motion[component] = found;
        }
        motion
    }

    /// Adds the energies of all supports to those of the bodies.
    pub fn add_energies(
        &self,
        scheme: &Scheme,
        steps_done: &[u64; L],
        u_after: &FieldOf<L, R>,
        total: &mut EnergySums<L>,
    ) {
        for support in &self.0 {
            support.add_energies(scheme, steps_done, u_after, total);
        }
    }
}

impl<const L: usize, R: Number> Clone for AppliedSupports<L, R> {
    fn clone(&self) -> Self {
        Self(self.0.iter().map(|support| support.boxed()).collect())
    }
}
