//! Nodes of the contact face, selected by name or by coordinates.

use crate::publish::value::rounded;
use crate::solver::body::pin::PinMesh;

/// The nodes that have names, with their positions across the sliding direction (x) and along it (y), from −1 to 1. The
/// disk moves towards +y, so the front is at −1.
const NAMED: [(&str, [i8; 2]); 9] = [
    ("front_centre", [0, -1]),
    ("rear_centre", [0, 1]),
    ("centre", [0, 0]),
    ("inner_centre", [-1, 0]),
    ("outer_centre", [1, 0]),
    ("front_inner", [-1, -1]),
    ("front_outer", [1, -1]),
    ("rear_inner", [-1, 1]),
    ("rear_outer", [1, 1]),
];

/// A node of the contact face, selected by a user.
#[derive(Debug, Clone, PartialEq)]
pub enum NodeSelector {
    /// A node with a name.
    Named(&'static str),
    /// The node nearest to the coordinates x and y \[m\] from the pin's axis.
    At([f64; 2]),
}

impl NodeSelector {
    /// The paper's node 1 and node 2.
    pub const DEFAULT: [Self; 2] = [Self::Named("front_centre"), Self::Named("rear_centre")];

    /// Reads a name, or `X,Y` in millimetres from the pin's axis.
    ///
    /// # Errors
    /// A message that says what is expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some((name, _)) = NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(Self::Named(name));
        }
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|mm| mm.is_finite());
        let coordinates =
            text.split_once(',').and_then(|(x, y)| Some([number(x)? * 1e-3, number(y)? * 1e-3]));
        coordinates.map(Self::At).ok_or_else(|| {
            let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
            format!(
                "expected one of {}, or X,Y in millimetres from the pin's axis, for example -3,0",
                names.join(", ")
            )
        })
    }

    /// The slave node.
    ///
    /// # Errors
    /// A message if the coordinates are outside of the contact face.
    pub fn resolve(&self, mesh: &PinMesh) -> Result<ObservedNode, String> {
        let [lx, ly, _] = mesh.size_m();
        let [x, y] = match self {
            Self::At(at) => *at,
            Self::Named(name) => {
                let found = NAMED.iter().find(|(known, _)| known == name);
                let [across, along] = found.map_or([0, 0], |(_, place)| *place);
                [f64::from(across) * lx / 2.0, f64::from(along) * ly / 2.0]
            }
        };
        // A tolerance of half a micrometre, because coordinates are read as decimal millimetres.
        if x.abs() > lx / 2.0 + 5e-7 || y.abs() > ly / 2.0 + 5e-7 {
            return Err(format!(
                "{},{} mm is not on the contact face; expected x from {} to {} and y from {} to {}",
                rounded(x * 1e3),
                rounded(y * 1e3),
                -lx * 500.0,
                lx * 500.0,
                -ly * 500.0,
                ly * 500.0
            ));
        }
        let slave = nearest(mesh, [x, y]);
        let [x, y, _] = mesh.own_coordinates_m(slave);
        let place = format!("x = {:.2} mm, y = {:.2} mm", x * 1e3, y * 1e3);
        let (name, title) = match self {
            Self::Named(name) => ((*name).to_owned(), format!("{} ({place})", name.replace('_', " "))),
            Self::At(_) => (format!("x{:+.3}_y{:+.3}mm", x * 1e3, y * 1e3), place),
        };
        Ok(ObservedNode { name, title, slave, at_m: [x, y] })
    }
}

/// The slave node nearest to a position \[m\]. With an odd number of elements no node of a block is in the middle. The lower one is
/// taken, as in the record.
fn nearest(mesh: &PinMesh, [x, y]: [f64; 2]) -> usize {
    if let Some(block) = mesh.block() {
        let ([lx, ly, _], [nx, ny, _]) = (block.size_m(), block.elements());
        let index = |at: f64, length: f64, n: usize| {
            let exact = (at / length + 0.5) * n as f64;
            ((exact - 0.5 - 1e-9).ceil().max(0.0) as usize).min(n)
        };
        return block.node(index(x, lx, nx), index(y, ly, ny), 0);
    }
    let distance = |slave: &usize| {
        let [sx, sy, _] = mesh.own_coordinates_m(*slave);
        (sx - x).hypot(sy - y)
    };
    mesh.bottom_nodes().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or_default()
}

/// A node of the contact face whose history is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservedNode {
    /// Its name, which may be a part of a file name.
    pub name: String,
    /// Its name and coordinates for a reader.
    pub title: String,
    /// Its number among the slave nodes.
    pub slave: usize,
    /// Its x and y \[m\] from the pin's axis.
    pub at_m: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::body::pin::BlockMesh;

    fn mesh() -> BlockMesh {
        BlockMesh::new([0.012, 0.015, 0.010], [12, 15, 10])
    }

    /// Protects: the names in a job's record mean the same nodes here: the middle of the leading and of the trailing edge,
    /// even if no node is exactly in the middle of a side.
    #[test]
    fn names_mean_what_records_mean() {
        let pin = mesh().into();
        let found: Vec<_> =
            NodeSelector::DEFAULT.iter().map(|selector| selector.resolve(&pin).unwrap().slave).collect();
        assert_eq!(found, [mesh().node(6, 0, 0), mesh().node(6, 15, 0)]);
        let centre = NodeSelector::parse("centre").unwrap().resolve(&pin).unwrap();
        assert_eq!(centre.slave, mesh().node(6, 7, 0));
        let corner = NodeSelector::parse("rear_outer").unwrap().resolve(&pin).unwrap();
        assert_eq!((corner.slave, corner.at_m), (mesh().node(12, 15, 0), [0.006, 0.0075]));
    }

    /// Protects: coordinates select the nearest node, and the name of the node has its own coordinates.
    #[test]
    fn coordinates_give_the_nearest_node() {
        let node = NodeSelector::parse("-2.4,3.1").unwrap().resolve(&mesh().into()).unwrap();
        assert_eq!(node.slave, mesh().node(4, 11, 0));
        assert_eq!(node.name, "x-2.000_y+3.500mm");
        let edge = NodeSelector::parse("6,-7.5").unwrap().resolve(&mesh().into()).unwrap();
        assert_eq!(edge.slave, mesh().node(12, 0, 0));
    }

    /// Protects: an invalid selection is refused, and the message says what is expected.
    #[test]
    fn other_texts_are_refused() {
        for text in ["front", "1;2", "1,inf", ""] {
            let error = NodeSelector::parse(text).unwrap_err();
            assert!(error.contains("front_centre") && error.contains("millimetres"), "{error}");
        }
        let error = NodeSelector::parse("7,0").unwrap().resolve(&mesh().into()).unwrap_err();
        assert!(error.contains("7,0 mm") && error.contains("x from -6 to 6"), "{error}");
    }
}
