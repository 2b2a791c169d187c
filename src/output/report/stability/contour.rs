//! The line on which a quantity is zero, between points that have values of it.

use std::collections::HashMap;
use std::ops::Range;

/// A point with a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Node {
    pub x: f64,
    pub y: f64,
    pub value: f64,
}

/// The lines on which the value is zero, by linear interpolation; in the logarithm of x, if that is how x is drawn.
///
/// Points with equal x are a column. The strip between two neighbouring columns is divided into triangles, so that columns may
/// have different points. Points in a single column or row have no area between them: their lines cross all of `across` or
/// `up`, the ranges of the axes.
pub(in crate::report) fn zero_line(
    nodes: &[Node],
    is_log: bool,
    across: &Range<f64>,
    up: &Range<f64>,
) -> Vec<Vec<(f64, f64)>> {
    let mut nodes: Vec<Node> = nodes.iter().copied().filter(|node| node.value.is_finite()).collect();
    nodes.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    nodes.dedup_by(|b, a| (a.x, a.y) == (b.x, b.y));
    let columns: Vec<&[Node]> = nodes.chunk_by(|a, b| a.x == b.x).collect();
    let cut = |a: Node, b: Node| crossing(a, b, is_log);
    if let [column] = columns.as_slice() {
        let lines = column.windows(2).filter_map(|pair| cut(pair[0], pair[1]));
        return lines.map(|(_, y)| vec![(across.start, y), (across.end, y)]).collect();
    }
    if nodes.windows(2).all(|pair| pair[0].y == pair[1].y) {
        let lines = nodes.windows(2).filter_map(|pair| cut(pair[0], pair[1]));
        return lines.map(|(x, _)| vec![(x, up.start), (x, up.end)]).collect();
    }
    let mut segments = Vec::new();
    for pair in columns.windows(2) {
        for [a, b, c] in triangles(pair[0], pair[1]) {
            let cuts: Vec<(f64, f64)> =
                [(a, b), (b, c), (a, c)].into_iter().filter_map(|(a, b)| cut(a, b)).collect();
            // A line through a corner of a triangle alone has no length there.
            if let [from, to] = cuts[..]
                && from != to
            {
                segments.push([from, to]);
            }
        }
    }
    join(&segments)
}

/// Where the value changes its sign between two points. A value of zero counts as positive.
fn crossing(a: Node, b: Node, is_log: bool) -> Option<(f64, f64)> {
    if (a.value < 0.0) == (b.value < 0.0) {
        return None;
    }
    // Neighbouring triangles give the same place to the last bit, so that their lines can be joined.
    let (from, to) = if (a.x, a.y) < (b.x, b.y) { (a, b) } else { (b, a) };
    let share = from.value / (from.value - to.value);
    let x = if from.x == to.x {
        from.x
    } else if is_log {
        from.x * (to.x / from.x).powf(share)
    } else {
        from.x + share * (to.x - from.x)
    };
    Some((x, from.y + share * (to.y - from.y)))
}

/// Triangles that fill the strip between two columns.
fn triangles(left: &[Node], right: &[Node]) -> Vec<[Node; 3]> {
    let (mut i, mut j) = (0, 0);
    let mut found = Vec::new();
    while i + 1 < left.len() || j + 1 < right.len() {
        let next = |column: &[Node], at: usize| column.get(at + 1).map_or(f64::INFINITY, |node| node.y);
        if next(left, i) <= next(right, j) {
            found.push([left[i], left[i + 1], right[j]]);
            i += 1;
        } else {
            found.push([left[i], right[j], right[j + 1]]);
            j += 1;
        }
    }
    found
}

type Bits = (u64, u64);

/// Joins segments with common ends to lines.
fn join(segments: &[[(f64, f64); 2]]) -> Vec<Vec<(f64, f64)>> {
    let bits = |at: (f64, f64)| -> Bits { (at.0.to_bits(), at.1.to_bits()) };
    let mut ends: HashMap<Bits, Vec<usize>> = HashMap::new();
    for (number, segment) in segments.iter().enumerate() {
        for end in segment {
            ends.entry(bits(*end)).or_default().push(number);
        }
    }
    let mut is_used = vec![false; segments.len()];
    let mut lines = Vec::new();
    for number in 0..segments.len() {
        if is_used[number] {
            continue;
        }
        is_used[number] = true;
        let mut line = segments[number].to_vec();
        for _ in 0..2 {
            // First at one end, then at the other.
            line.reverse();
            loop {
                let last = line[line.len() - 1];
                let next = ends[&bits(last)].iter().copied().find(|next| !is_used[*next]);
                let Some(next) = next else { break };
                is_used[next] = true;
                let [from, to] = segments[next];
                line.push(if bits(from) == bits(last) { to } else { from });
            }
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(x: f64, y: f64, value: f64) -> Node {
        Node { x, y, value }
    }

    fn line(nodes: &[Node], is_log: bool) -> Vec<Vec<(f64, f64)>> {
        zero_line(nodes, is_log, &(0.0..10.0), &(0.0..1.0))
    }

    /// Protects: the zero line of a plane is that plane's straight line, as one line from side to side, also if columns have
    /// points of their own.
    #[test]
    fn a_plane_has_its_straight_line() {
        let value = |x: f64, y: f64| y - 0.1 - 0.05 * x;
        let mut nodes: Vec<Node> = (0..=8)
            .flat_map(|i| (0..=6).map(move |j| (f64::from(i), 0.1 * f64::from(j))))
            .map(|(x, y)| node(x, y, value(x, y)))
            .collect();
        nodes.extend([(3.0, 0.27), (4.0, 0.31), (4.0, 0.33)].map(|(x, y)| node(x, y, value(x, y))));
        nodes.reverse();
        let found = line(&nodes, false);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].iter().all(|(x, y)| value(*x, *y).abs() < 1e-12), "{found:?}");
        let mut ends = [found[0][0].0, found[0][found[0].len() - 1].0];
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [0.0, 8.0]);
    }

    /// Protects: on a logarithmic axis the line is straight in the logarithm. Without points of both signs there is no line.
    #[test]
    fn the_axis_may_be_logarithmic() {
        let value = |x: f64, y: f64| y - 0.2 * x.log10();
        let nodes = [1.0, 10.0, 100.0, 1000.0];
        let nodes: Vec<Node> =
            nodes.iter().flat_map(|x| [0.05, 0.3, 0.5].map(|y| node(*x, y, value(*x, y)))).collect();
        let found = line(&nodes, true);
        assert_eq!(found.len(), 1);
        assert!(found[0].iter().all(|(x, y)| value(*x, *y).abs() < 1e-12), "{found:?}");
        let positive: Vec<Node> =
            nodes.iter().map(|own| Node { value: own.value.abs() + 1.0, ..*own }).collect();
        assert_eq!((line(&positive, true).len(), line(&[], true).len()), (0, 0));
    }

    /// Protects: a single column has a horizontal line, a single row a vertical one, each across the whole axis. Numbers that
    /// are not finite are left out.
    #[test]
    fn a_single_column_or_row_has_a_line() {
        let column = [node(2.0, 0.1, -1.0), node(2.0, 0.2, f64::NAN), node(2.0, 0.5, 1.0)];
        assert_eq!(line(&column, false), [[(0.0, 0.1 + 0.5 * 0.4), (10.0, 0.1 + 0.5 * 0.4)]]);
        let row = [node(1.0, 0.4, -1.0), node(3.0, 0.4, 1.0)];
        assert_eq!(line(&row, false), [[(2.0, 0.0), (2.0, 1.0)]]);
    }
}
