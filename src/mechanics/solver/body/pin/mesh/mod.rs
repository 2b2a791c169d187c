//! Meshes of a pin.
//!
//! * [`BlockMesh`] – a block of equal hexahedra. Its stiffness has a form that is fast.
//! * [`GeneralMesh`] – any hexahedra: a cylinder, a tilted pin, regions of other materials, or a mesh from a file.
//! * `cylinder` – the O-grid of a cylinder.

mod block;
mod cylinder;
mod general;

pub use block::BlockMesh;
pub use cylinder::cylinder;
pub use general::{GeneralMesh, Hexahedron, MeshParts, Tilt};

use crate::solver::field::Layout;
use std::sync::Arc;

/// The mesh of a pin. The nodes of the contact face come first.
#[derive(Debug, Clone, PartialEq)]
pub enum PinMesh {
    /// A block of equal hexahedra of one material.
    Block(BlockMesh),
    /// Any hexahedra.
    General(Arc<GeneralMesh>),
}

impl From<BlockMesh> for PinMesh {
    fn from(mesh: BlockMesh) -> Self {
        Self::Block(mesh)
    }
}

impl From<GeneralMesh> for PinMesh {
    fn from(mesh: GeneralMesh) -> Self {
        Self::General(Arc::new(mesh))
    }
}

impl PinMesh {
    /// The block, if it is one.
    pub fn block(&self) -> Option<&BlockMesh> {
        match self {
            Self::Block(mesh) => Some(mesh),
            Self::General(_) => None,
        }
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        match self {
            Self::Block(mesh) => mesh.node_count(),
            Self::General(mesh) => mesh.node_count(),
        }
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        match self {
            Self::Block(mesh) => mesh.elements().iter().product(),
            Self::General(mesh) => mesh.elements().len(),
        }
    }

    /// Number of elements in x, y and z. A cylinder has that over its diameter in x and y. A mesh without such directions has its number of
    /// elements, 1 and 1.
    pub fn divisions(&self) -> [usize; 3] {
        match self {
            Self::Block(mesh) => mesh.elements(),
            Self::General(mesh) => mesh.divisions().unwrap_or([mesh.elements().len(), 1, 1]),
        }
    }

    /// The layout of a field on all nodes. Its first plane is the contact face.
    pub fn layout(&self) -> Layout {
        match self {
            Self::Block(mesh) => mesh.layout(),
            Self::General(mesh) => mesh.layout(),
        }
    }

    /// Coordinates \[m\] of a node: x and y from the pin's axis, z from the disk.
    pub fn coordinates_m(&self, node: usize) -> [f64; 3] {
        match self {
            Self::Block(mesh) => mesh.coordinates_m(node),
            Self::General(mesh) => mesh.coordinates_m(node),
        }
    }

    /// Coordinates \[m\] of a node in the frame of the pin, which is tilted with it: x and y from the pin's axis, z from its
    /// base.
    pub fn own_coordinates_m(&self, node: usize) -> [f64; 3] {
        match self {
            Self::Block(mesh) => mesh.coordinates_m(node),
            Self::General(mesh) => mesh.own_coordinates_m(node),
        }
    }

    /// How the pin is tilted.
    pub fn tilt(&self) -> Tilt {
        match self {
            Self::Block(_) => Tilt::default(),
            Self::General(mesh) => mesh.tilt(),
        }
    }

    /// Extent \[m\] in x, y and z in the frame of the pin.
    pub fn size_m(&self) -> [f64; 3] {
        match self {
            Self::Block(mesh) => mesh.size_m(),
            Self::General(mesh) => mesh.size_m(),
        }
    }

    /// Nodes of the contact face.
    pub fn bottom_nodes(&self) -> std::ops::Range<usize> {
        match self {
            Self::Block(mesh) => mesh.bottom_nodes(),
            Self::General(mesh) => 0..mesh.contact_areas_m2().len(),
        }
    }

    /// Nodes of the face that carries the load, in ascending order.
    pub fn top_nodes(&self) -> Vec<usize> {
        match self {
            Self::Block(mesh) => mesh.top_nodes().collect(),
            Self::General(mesh) => mesh.top_nodes().to_vec(),
        }
    }

    /// Nodes of the surface beside the contact face and the face that carries the load, with their edges, in ascending order.
    pub fn side_nodes(&self) -> Vec<usize> {
        match self {
            Self::Block(mesh) => {
                let [nx, ny, _] = mesh.elements();
                let is_on_side = |node: &usize| {
                    let [x, y, _] = mesh.grid_position(*node);
                    x == 0 || x == nx || y == 0 || y == ny
                };
                (0..mesh.node_count()).filter(is_on_side).collect()
            }
            Self::General(mesh) => mesh.side_nodes(),
        }
    }

    /// Tributary areas \[m²\] of the nodes of the contact face.
    pub fn contact_areas_m2(&self) -> Vec<f64> {
        match self {
            Self::Block(mesh) => mesh.bottom_nodes().map(|node| mesh.tributary_area_m2(node)).collect(),
            Self::General(mesh) => mesh.contact_areas_m2().to_vec(),
        }
    }

    /// Tributary areas \[m²\] of the nodes of the face that carries the load.
    pub fn top_areas_m2(&self) -> Vec<f64> {
        match self {
            Self::Block(mesh) => mesh.top_nodes().map(|node| mesh.tributary_area_m2(node)).collect(),
            Self::General(mesh) => mesh.top_areas_m2().to_vec(),
        }
    }

    /// Area \[m²\] of the face that carries the load.
    pub fn top_area_m2(&self) -> f64 {
        match self {
            Self::Block(mesh) => mesh.size_m()[0] * mesh.size_m()[1],
            Self::General(mesh) => mesh.top_areas_m2().iter().sum(),
        }
    }

    /// Nodes at the centre of the leading edge (−y) and of the trailing edge (+y) of the contact face.
    pub fn edge_centres(&self) -> [usize; 2] {
        match self {
            Self::Block(mesh) => {
                let [nx, ny, _] = mesh.elements();
                [mesh.node(nx / 2, 0, 0), mesh.node(nx / 2, ny, 0)]
            }
            Self::General(mesh) => mesh.edge_centres(),
        }
    }

    /// The eight nodes of each element, numbered as in [`hexahedron`](crate::solver::body::hexahedron).
    pub fn element_nodes(&self) -> Vec<[usize; 8]> {
        match self {
            Self::Block(mesh) => {
                mesh.element_positions().map(|[i, j, k]| mesh.element_nodes(i, j, k)).collect()
            }
            Self::General(mesh) => mesh.elements().iter().map(|element| element.nodes).collect(),
        }
    }

    /// Quadrilaterals of the contact face.
    pub fn contact_faces(&self) -> Vec<[usize; 4]> {
        match self {
            Self::Block(mesh) => {
                let [nx, ny, _] = mesh.elements();
                let corners = |i, j| {
                    [
                        mesh.node(i, j, 0),
                        mesh.node(i + 1, j, 0),
                        mesh.node(i + 1, j + 1, 0),
                        mesh.node(i, j + 1, 0),
                    ]
                };
                (0..ny).flat_map(|j| (0..nx).map(move |i| corners(i, j))).collect()
            }
            Self::General(mesh) => mesh.contact_faces().to_vec(),
        }
    }
}
