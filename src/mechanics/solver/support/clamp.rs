//! The clamp and the top face of a scene as supports on a mesh.

use super::{Held, Rocking, RockingWay, Support, Tied};
use crate::solver::body::pin::PinMesh;
use crate::solver::error::SolverError;
use crate::spec::{Clamp, ClampSide, Holder, HolderDirection, TopFace};

/// Largest distance of the nearest node row from the clamp's width, as a fraction of that width.
const WIDTH_TOLERANCE: f64 = 0.25;

/// The nodes of a clamp, and its width on the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct ClampedStrip {
    /// Clamped nodes of the top face.
    pub nodes: Vec<usize>,
    /// Distance \[m\] from the edge to the last clamped row of nodes.
    pub width_m: f64,
}

/// Finds the clamp's nodes on the top face of `mesh`. A mesh that has clamped nodes of its own decides itself.
///
/// # Errors
/// If no node row is near the clamp's width.
pub fn clamped_strip(mesh: &PinMesh, clamp: &Clamp) -> Result<ClampedStrip, SolverError> {
    if let PinMesh::General(general) = mesh
        && let Some(nodes) = general.clamped()
    {
        return Ok(ClampedStrip { nodes: nodes.to_vec(), width_m: 0.0 });
    }
    let (low, high) = match clamp.side {
        ClampSide::InnerSide | ClampSide::LeadingEnd | ClampSide::Collet => (true, false),
        ClampSide::OuterSide | ClampSide::TrailingEnd => (false, true),
        ClampSide::BothSides | ClampSide::BothEnds => (true, true),
        ClampSide::WholeTop => (false, false),
    };
    let Some(axis) = clamp.side.axis_across() else {
        return Ok(ClampedStrip { nodes: mesh.top_nodes(), width_m: mesh.size_m()[0] });
    };
    let is_collet = clamp.side == ClampSide::Collet;
    let nodes = if is_collet { mesh.side_nodes() } else { mesh.top_nodes() };
    let rows = Rows::new(mesh, axis, &nodes);
    // The contact face stays free.
    let last_row = rows.nearest(clamp.width_m).min(rows.at_m.len() - 1 - usize::from(is_collet));
    let width_m = rows.at_m[last_row];
    // The relative tolerance of 1e-12 covers the rounding of decimal widths.
    if (width_m - clamp.width_m).abs() > WIDTH_TOLERANCE * clamp.width_m * (1.0 + 1e-12) {
        // The rows that a collet can end at lie between the top face and the contact face.
        let (first, last) = if is_collet { (1, rows.at_m.len() - 2) } else { (0, rows.at_m.len() - 1) };
        let below = rows.at_m.iter().filter(|at| **at <= clamp.width_m).count().saturating_sub(1);
        return Err(SolverError::ClampOffMesh {
            width_m: clamp.width_m,
            elements: rows.at_m.len() - 1,
            length_m: mesh.size_m()[axis],
            below_m: rows.at_m[below.max(first).min(last)],
            above_m: rows.at_m[(below + 1).max(first).min(last)],
        });
    }
    let held = |(_, row): &(usize, usize)| {
        (low && *row <= last_row) || (high && rows.at_m.len() - 1 - row <= last_row)
    };
    let nodes = nodes.into_iter().zip(rows.of_nodes.iter().copied());
    Ok(ClampedStrip { nodes: nodes.filter(held).map(|(node, _)| node).collect(), width_m })
}

/// The rows of some nodes across one direction: those of the top face, which lie symmetrically about the axis, or those of the side, from
/// the top face down.
struct Rows {
    /// Distance \[m\] of each row from the first.
    at_m: Vec<f64>,
    /// Their equal distance \[m\], if it is equal.
    spacing_m: Option<f64>,
    /// The row of each node.
    of_nodes: Vec<usize>,
}

impl Rows {
    fn new(mesh: &PinMesh, axis: usize, nodes: &[usize]) -> Self {
        let is_downwards = axis == 2;
        if let Some(block) = mesh.block() {
            let h = block.element_size_m()[axis];
            let last = block.elements()[axis];
            let row = |node: &usize| {
                let row = block.grid_position(*node)[axis];
                if is_downwards { last - row } else { row }
            };
            return Self {
                at_m: (0..=last).map(|row| row as f64 * h).collect(),
                spacing_m: Some(h),
                of_nodes: nodes.iter().map(row).collect(),
            };
        }
        let sign = if is_downwards { -1.0 } else { 1.0 };
        let positions: Vec<f64> =
            nodes.iter().map(|&node| sign * mesh.own_coordinates_m(node)[axis]).collect();
        let mut sorted = positions.clone();
        sorted.sort_by(f64::total_cmp);
        // Nodes of a row agree to the rounding of their coordinates.
        let near = 1e-9 * mesh.size_m()[axis];
        sorted.dedup_by(|next, kept| *next - *kept <= near);
        let row = |position: &f64| sorted.partition_point(|at| *at < position - near);
        Self {
            of_nodes: positions.iter().map(row).collect(),
            at_m: sorted.iter().map(|at| at - sorted[0]).collect(),
            spacing_m: None,
        }
    }

    /// The row nearest to a distance; of two, the farther one.
    fn nearest(&self, width_m: f64) -> usize {
        if let Some(spacing_m) = self.spacing_m {
            return ((width_m / spacing_m).round() as usize).min(self.at_m.len() - 1);
        }
        let distance = |row: usize| (self.at_m[row] - width_m).abs();
        let mut nearest = 0;
        for row in 1..self.at_m.len() {
            if distance(row) <= distance(nearest) {
                nearest = row;
            }
        }
        nearest
    }
}

/// The supports of a clamp (x and y of its nodes) and of the top face, on a holder.
pub fn supports(mesh: &PinMesh, strip: &ClampedStrip, top: TopFace, holder: &Holder) -> Vec<Support> {
    let held = |tied: Tied, direction: HolderDirection| {
        let HolderDirection { mass_kg, stiffness_n_m, damping_n_s_m } = direction;
        Support::Held(Held { tied, mass_kg, stiffness_n_m, damping_n_s_m })
    };
    let directions = holder.directions();
    let is_rigid = |component: &usize| directions[*component].is_none();
    let rigid: Vec<usize> = [0, 1].into_iter().filter(is_rigid).collect();
    let mut supports = Vec::new();
    if !rigid.is_empty() {
        let fixed =
            strip.nodes.iter().flat_map(|&node| rigid.iter().map(move |component| 3 * node + component));
        supports.push(Support::fixed(fixed));
    }
    for component in [0, 1] {
        if let Some(direction) = directions[component] {
            supports.push(held(Tied { component, nodes: strip.nodes.clone() }, direction));
        }
    }
    if holder.rotates() && top == TopFace::TiedInZ {
        supports.push(Support::Rocking(rocking(mesh, holder)));
        return supports;
    }
    match (top, directions[2]) {
        (TopFace::TiedInZ, None) => supports.push(Support::tied(2, mesh.top_nodes())),
        (TopFace::TiedInZ, Some(direction)) => {
            supports.push(held(Tied { component: 2, nodes: mesh.top_nodes() }, direction));
        }
        (TopFace::FreeInZ, _) => {}
    }
    supports
}

/// The top face as a rigid plane on a holder. The axes of rotation cross where the pin's own axis meets the top face.
fn rocking(mesh: &PinMesh, holder: &Holder) -> Rocking {
    let nodes = mesh.top_nodes();
    let [centre_x, centre_y, _] = match mesh {
        PinMesh::Block(_) => [0.0; 3],
        PinMesh::General(general) => general.tilt().turned([0.0, 0.0, general.size_m()[2]]),
    };
    let way = |direction: HolderDirection, share: &dyn Fn([f64; 3]) -> f64| RockingWay {
        shares: nodes.iter().map(|&node| share(mesh.coordinates_m(node))).collect(),
        inertia: direction.mass_kg,
        stiffness: direction.stiffness_n_m,
        damping: direction.damping_n_s_m,
    };
    let massless = HolderDirection { mass_kg: 0.0, stiffness_n_m: 0.0, damping_n_s_m: 0.0 };
    let mut ways = vec![way(holder.directions()[2].unwrap_or(massless), &|_| 1.0)];
    let [about_x, about_y] = holder.rotations();
    ways.extend(about_x.map(|direction| way(direction, &|[_, y, _]| y - centre_y)));
    ways.extend(about_y.map(|direction| way(direction, &|[x, _, _]| centre_x - x)));
    Rocking { nodes, ways }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::body::pin::{BlockMesh, GeneralMesh, Tilt, cylinder};

    const SIZE_M: [f64; 3] = [0.012, 0.015, 0.010];

    fn strip(elements: [usize; 3], side: ClampSide, width_m: f64) -> Result<ClampedStrip, SolverError> {
        clamped_strip(&BlockMesh::new(SIZE_M, elements).into(), &Clamp { side, width_m })
    }

    /// Protects: a width in metres gives the same strip on every mesh that has a node row there.
    #[test]
    fn width_means_the_same_on_every_mesh() {
        for elements in [[6, 8, 5], [12, 15, 10], [18, 22, 15], [24, 30, 20]] {
            let found = strip(elements, ClampSide::InnerSide, 0.002).unwrap();
            assert!((found.width_m - 0.002).abs() < 1e-15);
            assert_eq!(found.nodes.len(), (elements[0] / 6 + 1) * (elements[1] + 1));
        }
    }

    type Held = fn([f64; 3]) -> bool;

    /// Protects: each named side clamps the nodes that its name says.
    #[test]
    fn sides_are_where_their_names_say() {
        let mesh = BlockMesh::new(SIZE_M, [12, 15, 10]);
        let cases: [(ClampSide, Held); 7] = [
            (ClampSide::InnerSide, |x| x[0] < -0.00499),
            (ClampSide::OuterSide, |x| x[0] > 0.00499),
            (ClampSide::BothSides, |x| x[0].abs() > 0.00499),
            (ClampSide::LeadingEnd, |x| x[1] < -0.00649),
            (ClampSide::TrailingEnd, |x| x[1] > 0.00649),
            (ClampSide::BothEnds, |x| x[1].abs() > 0.00649),
            (ClampSide::WholeTop, |_| true),
        ];
        for (side, held) in cases {
            let expected: Vec<_> = mesh.top_nodes().filter(|&n| held(mesh.coordinates_m(n))).collect();
            assert_eq!(strip([12, 15, 10], side, 0.001).unwrap().nodes, expected, "{}", side.name());
        }
    }

    /// Protects: a width without a node row near it is refused, and the error names the nearest possible widths.
    #[test]
    fn a_width_between_rows_is_refused() {
        let error = strip([6, 8, 5], ClampSide::InnerSide, 0.001).unwrap_err();
        let SolverError::ClampOffMesh { below_m, above_m, .. } = error else { panic!("{error}") };
        assert_eq!((below_m, above_m), (0.0, 0.002));
    }

    /// Protects: a collet holds the nodes of the side down to the row nearest to its length, on blocks and cylinders, and neither the inside
    /// of the top face nor the contact face.
    #[test]
    fn a_collet_holds_the_side() {
        let block: PinMesh = BlockMesh::new(SIZE_M, [6, 5, 10]).into();
        let round = GeneralMesh::new(&cylinder([0.008, 0.008, 0.010], 6, 10), Tilt::default()).unwrap();
        for (mesh, is_on_side) in [
            (block, (|x| x[0].abs() > 0.00599 || x[1].abs() > 0.00749) as fn([f64; 3]) -> bool),
            (PinMesh::from(round), |x| libm::hypot(x[0], x[1]) > 0.00399),
        ] {
            let clamp = |width_m| Clamp { side: ClampSide::Collet, width_m };
            let found = clamped_strip(&mesh, &clamp(0.0039)).unwrap();
            let expected: Vec<usize> = (0..mesh.node_count())
                .filter(|&node| {
                    let x = mesh.own_coordinates_m(node);
                    is_on_side(x) && x[2] > 0.0059
                })
                .collect();
            let mut nodes = found.nodes.clone();
            nodes.sort_unstable();
            assert!((found.width_m - 0.004).abs() < 1e-12 && !nodes.is_empty());
            assert_eq!(nodes, expected);
            let whole = clamped_strip(&mesh, &clamp(0.01)).unwrap();
            assert!((whole.width_m - 0.009).abs() < 1e-12, "the contact face stays free");
        }
    }
}
