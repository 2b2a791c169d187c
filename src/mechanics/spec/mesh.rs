//! A mesh from a file.

use super::check::{Violations, short};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::io::Read;

/// Largest relative difference between the extent of a mesh and the pin's `size_m`.
const EXTENT_TOLERANCE: f64 = 1.0e-3;

/// A mesh of hexahedra from a file: Gmsh MSH 4.1 as text, or Abaqus input. A study names the file. It is read with the study, and jobs have
/// its content, so that they do not depend on a file that may change.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshFile {
    /// The file, relative to the folder of the study.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Length (m) of a unit of the file: 0.001 for millimetres.
    pub length_unit_m: f64,
    /// Group of the quadrilaterals of the contact face.
    pub contact: String,
    /// Group of the quadrilaterals that carry the load.
    pub load: String,
    /// Group of the nodes that the clamp holds in x and y.
    pub clamp: String,
    /// The content of the file, which takes its place: binary numbers, compressed, in base 64.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub content: Option<String>,
    /// Extent (m) of that mesh in x, y and z.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extent_m: Option<[f64; 3]>,
    /// Its number of nodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<usize>,
    /// Its number of elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hexahedra: Option<usize>,
    /// The number of quadrilaterals of its contact face.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_faces: Option<usize>,
    /// Largest extent (m) in x and in y of one of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_edges_m: Option<[f64; 2]>,
    /// Names of its groups of elements.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<String>,
}

/// The content of a mesh's file. Nodes are numbered from 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshContent {
    /// Coordinates (m) of the nodes.
    pub nodes_m: Vec<[f64; 3]>,
    /// The nodes of each element, x fastest, then y, then z.
    pub hexahedra: Vec<[u32; 8]>,
    /// The number of each element in its file.
    pub ids: Vec<u32>,
    /// The region of each element: the index of its group in [`MeshFile::bodies`], or their number if it is in none.
    pub body_of: Vec<u32>,
    /// Quadrilaterals of the contact face, around their edges.
    pub contact: Vec<[u32; 4]>,
    /// Quadrilaterals that carry the load.
    pub load: Vec<[u32; 4]>,
    /// Nodes that the clamp holds.
    pub clamp: Vec<u32>,
}

impl MeshFile {
    /// An example that has every field.
    pub fn template() -> Self {
        Self {
            file: Some(String::new()),
            content: Some(String::new()),
            extent_m: Some([0.0; 3]),
            nodes: Some(0),
            hexahedra: Some(0),
            contact_faces: Some(0),
            contact_edges_m: Some([0.0; 2]),
            bodies: vec![String::new()],
            ..Self::default()
        }
    }

    /// The names of the groups that a study need not give.
    pub const GROUPS: [&'static str; 3] = ["contact", "load", "clamp"];

    /// The names of the groups for the contact, the load and the clamp.
    pub fn groups(&self) -> [&str; 3] {
        let given = [self.contact.as_str(), self.load.as_str(), self.clamp.as_str()];
        std::array::from_fn(|i| if given[i].is_empty() { Self::GROUPS[i] } else { given[i] })
    }

    /// The content. `None` if there is none, or if it is damaged.
    pub fn decoded(&self) -> Option<MeshContent> {
        let packed = STANDARD.decode(self.content.as_ref()?).ok()?;
        let mut bytes = Vec::new();
        ZlibDecoder::new(packed.as_slice()).read_to_end(&mut bytes).ok()?;
        MeshContent::from_bytes(&bytes)
    }

    /// The mesh of this content, in place of the file.
    #[must_use]
    pub fn with_content(&self, content: &MeshContent, bodies: Vec<String>) -> Self {
        let Self { length_unit_m, contact, load, clamp, .. } = self.clone();
        let content_text = Some(content.encoded());
        let measures = Self::measures_of(content);
        Self { content: content_text, length_unit_m, contact, load, clamp, bodies, ..measures }
    }

    /// What is known of a content without reading it.
    fn measures_of(content: &MeshContent) -> Self {
        Self {
            extent_m: Some(content.extent_m()),
            nodes: Some(content.nodes_m.len()),
            hexahedra: Some(content.hexahedra.len()),
            contact_faces: Some(content.contact.len()),
            contact_edges_m: Some(content.contact_edges_m()),
            ..Self::default()
        }
    }

    fn has_measures(&self, of: &Self) -> bool {
        let measures = |mesh: &Self| {
            (mesh.extent_m, mesh.nodes, mesh.hexahedra, mesh.contact_faces, mesh.contact_edges_m)
        };
        measures(self) == measures(of)
    }

    /// Adds every violated limit to `found`, for a pin of this size.
    pub(super) fn check(&self, size_m: [f64; 3], found: &mut Violations) {
        found.within("scene.pin.mesh.length_unit_m", self.length_unit_m);
        let Some(content) = self.decoded() else {
            let right = "a mesh that was read from scene.pin.mesh.file";
            found.add("scene.pin.mesh.content", "no mesh", right);
            return;
        };
        if !self.has_measures(&Self::measures_of(&content)) {
            let right = "the numbers of nodes and elements and the lengths of that content: name scene.pin.mesh.file again";
            found.add("scene.pin.mesh", "a content that does not fit", right);
            return;
        }
        let extent_m = content.extent_m();
        for axis in 0..3 {
            if (extent_m[axis] - size_m[axis]).abs() > EXTENT_TOLERANCE * extent_m[axis] {
                let [x, y, z] = extent_m.map(short);
                found.add(
                    &format!("scene.pin.size_m[{axis}]"),
                    size_m[axis],
                    format!(
                        "{}: the mesh measures {x} × {y} × {z} m with scene.pin.mesh.length_unit_m = {}, and size_m must say \
                         the same, so that no mesh is taken in other units",
                        short(extent_m[axis]),
                        self.length_unit_m
                    ),
                );
            }
        }
    }
}

impl MeshContent {
    /// Extent (m) in x, y and z.
    pub fn extent_m(&self) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let along = || self.nodes_m.iter().map(move |x| x[axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        })
    }

    /// Largest extent (m) in x and in y of a quadrilateral of the contact face.
    fn contact_edges_m(&self) -> [f64; 2] {
        let extent_m = |face: &[u32; 4], axis: usize| {
            let along = face.iter().filter_map(|&node| self.nodes_m.get(node as usize)).map(|x| x[axis]);
            let [low, high] =
                along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            high - low
        };
        [0, 1].map(|axis| self.contact.iter().map(|face| extent_m(face, axis)).fold(0.0, f64::max))
    }

    /// What two equal meshes have in common: everything but the numbers in their files, with bodies as `body` numbers them.
    pub fn identity(&self, body: impl Fn(u32) -> u32) -> Vec<u8> {
        let body_of = self.body_of.iter().map(|&of| body(of)).collect();
        Self { ids: vec![0; self.ids.len()], body_of, ..self.clone() }.to_bytes()
    }

    /// The text that takes the place of a file.
    ///
    /// # Panics
    /// Never: nothing is read or written but memory.
    pub fn encoded(&self) -> String {
        let bytes = self.to_bytes();
        let mut packed = Vec::new();
        let mut encoder = ZlibEncoder::new(bytes.as_slice(), Compression::best());
        encoder.read_to_end(&mut packed).expect("memory can be read");
        STANDARD.encode(packed)
    }

    fn to_bytes(&self) -> Vec<u8> {
        let counts =
            [self.nodes_m.len(), self.hexahedra.len(), self.contact.len(), self.load.len(), self.clamp.len()];
        let mut bytes: Vec<u8> = counts.iter().flat_map(|&count| (count as u32).to_le_bytes()).collect();
        // The bytes of coordinates are stored place by place, because those of the same place are alike.
        let coordinates: Vec<[u8; 8]> = self.nodes_m.as_flattened().iter().map(|x| x.to_le_bytes()).collect();
        for place in 0..8 {
            bytes.extend(coordinates.iter().map(|x| x[place]));
        }
        let numbers = self
            .hexahedra
            .as_flattened()
            .iter()
            .chain(&self.ids)
            .chain(&self.body_of)
            .chain(self.contact.as_flattened())
            .chain(self.load.as_flattened())
            .chain(&self.clamp);
        let mut before = 0_u32;
        for &number in numbers {
            // Differences of neighbours are small.
            bytes.extend(number.wrapping_sub(before).to_le_bytes());
            before = number;
        }
        bytes
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (counts, bytes) = bytes.split_at_checked(20)?;
        let counts: Vec<usize> =
            counts.as_chunks::<4>().0.iter().map(|count| u32::from_le_bytes(*count) as usize).collect();
        let [nodes, hexahedra, contact, load, clamp] = counts[..] else { return None };
        let (coordinates, bytes) = bytes.split_at_checked(24 * nodes)?;
        let number = |index: usize| -> f64 {
            f64::from_le_bytes(std::array::from_fn(|place| coordinates[place * 3 * nodes + index]))
        };
        let nodes_m = (0..nodes).map(|node| std::array::from_fn(|axis| number(3 * node + axis))).collect();
        let total = 10 * hexahedra + 4 * contact + 4 * load + clamp;
        if bytes.len() != 4 * total {
            return None;
        }
        let mut before = 0_u32;
        let mut numbers = bytes.as_chunks::<4>().0.iter().map(|difference| {
            before = before.wrapping_add(u32::from_le_bytes(*difference));
            before
        });
        let mut take = |count: usize| -> Vec<u32> { numbers.by_ref().take(count).collect() };
        Some(Self {
            nodes_m,
            hexahedra: take(8 * hexahedra).as_chunks::<8>().0.to_vec(),
            ids: take(hexahedra),
            body_of: take(hexahedra),
            contact: take(4 * contact).as_chunks::<4>().0.to_vec(),
            load: take(4 * load).as_chunks::<4>().0.to_vec(),
            clamp: take(clamp),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a mesh comes back as it was, and damaged text is no mesh.
    #[test]
    fn content_survives_its_text() {
        let content = MeshContent {
            nodes_m: (0..12)
                .map(|n| [f64::from(n), 0.1 * f64::from(n), -1.0e-3 / f64::from(n + 1)])
                .collect(),
            hexahedra: vec![[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]],
            ids: vec![17, 4_000_000_000],
            body_of: vec![0, 1],
            contact: vec![[0, 1, 3, 2]],
            load: vec![[8, 9, 11, 10]],
            clamp: vec![8, 11],
        };
        let text = content.encoded();
        let decoded =
            |text: &str| MeshFile { content: Some(text.to_owned()), ..MeshFile::default() }.decoded();
        assert_eq!(decoded(&text), Some(content));
        assert_eq!(decoded(&text[..text.len() / 2]), None);
        assert_eq!(decoded("not base 64"), None);
    }
}
