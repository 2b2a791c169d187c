//! The slave nodes: their initial gaps, and the velocity of the target under them.

use super::target::SurfaceMotion;
use super::{Layer, Relief};
use crate::solver::body::Freedom;
use crate::solver::body::pin::PinBody;
use crate::solver::field::{FieldOf, Layout};
use crate::solver::number::Number;

/// A node of the contact face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlaveNode {
    /// Index in the mesh of the pin.
    pub node: usize,
    /// Lumped mass \[kg\].
    pub mass_kg: f64,
    /// Tributary area \[m²\].
    pub area_m2: f64,
    /// Position in the contact face \[m\], x and y from the pin's axis.
    pub position_m: [f64; 2],
    /// Gap \[m\] between the undeformed pin and the undeformed target. The gap of a node is this plus its
    /// displacement in z, minus the displacement of the target. Over a [`Relief`] it is that over the mean plane.
    pub initial_gap_m: f64,
    /// Velocity of the target under the node per unit of the drive's rate, x and y: \[m\] for a disk, 1 for a
    /// plane.
    pub surface_motion: [f64; 2],
    /// Whether each component can move, that is, is not fixed.
    pub mobile: [bool; 3],
}

/// The slave nodes of a pin, numbered like the nodes of its contact face.
#[derive(Debug, Clone)]
pub struct Interface {
    slaves: Vec<SlaveNode>,
    relief: Option<Relief>,
    layer: Option<Layer>,
    layout: Layout,
    extent_m: [f64; 2],
    edge_centres: [usize; 2],
}

impl Interface {
    /// The contact face of `pin` on a target that moves with `surface_motion` under the slave nodes.
    ///
    /// # Panics
    /// If there is not one surface velocity per node of the contact face.
    pub fn new(pin: &PinBody, surface_motion: &SurfaceMotion) -> Self {
        let mesh = pin.mesh();
        assert_eq!(surface_motion.len(), mesh.bottom_nodes().len(), "one surface velocity per slave node");
        let slaves = mesh
            .bottom_nodes()
            .zip(mesh.contact_areas_m2())
            .zip(surface_motion)
            .map(|((node, area_m2), surface_motion)| {
                let [x, y, _] = mesh.coordinates_m(node);
                SlaveNode {
                    node,
                    mass_kg: pin.masses_kg()[node],
                    area_m2,
                    position_m: [x, y],
                    initial_gap_m: 0.0,
                    surface_motion: *surface_motion,
                    mobile: std::array::from_fn(|c| pin.freedoms()[3 * node + c] != Freedom::Fixed),
                }
            })
            .collect();
        let [lx, ly, _] = mesh.size_m();
        Self {
            slaves,
            relief: None,
            layer: None,
            layout: mesh.layout().first_plane(),
            extent_m: [lx, ly],
            edge_centres: mesh.edge_centres(),
        }
    }

    /// The same slave nodes with other initial gaps \[m\].
    pub(in crate::solver) fn with_initial_gaps(mut self, gap_m: impl Fn(&SlaveNode) -> f64) -> Self {
        for node in &mut self.slaves {
            node.initial_gap_m = gap_m(node);
        }
        self
    }

    /// The same slave nodes on a target with these heights. The lowest node touches at the beginning.
    pub(in crate::solver) fn with_relief(mut self, relief: Relief) -> Self {
        let gaps_m = relief.gaps_m(&self.slaves);
        for (node, gap_m) in self.slaves.iter_mut().zip(gaps_m) {
            node.initial_gap_m = gap_m;
        }
        self.relief = Some(relief);
        self
    }

    /// The same slave nodes on a layer.
    pub(in crate::solver) fn with_layer(self, layer: Layer) -> Self {
        Self { layer: Some(layer), ..self }
    }

    /// The layer between the nodes and the target; none if they touch it.
    pub fn layer(&self) -> Option<&Layer> {
        self.layer.as_ref()
    }

    /// The heights of the target; none if it is a plane.
    pub fn relief(&self) -> Option<&Relief> {
        self.relief.as_ref()
    }

    /// The slave nodes.
    pub fn slaves(&self) -> &[SlaveNode] {
        &self.slaves
    }

    /// Width of the contact face \[m\] in x and in y.
    pub fn extent_m(&self) -> [f64; 2] {
        self.extent_m
    }

    /// Slave nodes at the centre of the leading edge (−y) and of the trailing edge (+y).
    pub fn edge_centres(&self) -> [usize; 2] {
        self.edge_centres
    }

    /// The layout of a field on the slave nodes.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// A field with three values per slave node, the same in all lanes.
    pub fn field<const L: usize, R: Number>(&self, values: impl Fn(&SlaveNode) -> [f64; 3]) -> FieldOf<L, R> {
        let mut field = FieldOf::zeros(self.layout);
        for (slave, node) in self.slaves.iter().enumerate() {
            let place = field.place(slave);
            for (component, value) in values(node).into_iter().enumerate() {
                *field.at_mut(place, component) = [R::from_f64(value); L];
            }
        }
        field
    }
}
