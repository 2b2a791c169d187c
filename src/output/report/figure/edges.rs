//! Where the cells of a map on true axes end.

use crate::publish::chart::Axis;
use serde_json::Value;

/// The values along one axis, ascending, and the boundaries of their cells.
pub(super) struct CellEdges {
    pub values: Vec<f64>,
    /// One more than values.
    edges: Vec<f64>,
    pub axis: Axis,
}

impl CellEdges {
    /// Boundaries half-way between neighbours, on a logarithmic axis at their geometric mean. The outer cells reach as far
    /// outwards as inwards.
    pub fn of(values: impl Iterator<Item = f64>, logarithmic: bool) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let as_values: Vec<Value> = values.iter().map(|x| (*x).into()).collect();
        let is_log = matches!(Axis::for_values(&as_values, logarithmic.then_some(true)), Axis::Log(_));
        let to = |x: f64| if is_log { x.ln() } else { x };
        let from = |t: f64| if is_log { t.exp() } else { t };
        let at: Vec<f64> = values.iter().map(|x| to(*x)).collect();
        let alone = match at.as_slice() {
            [only] if !is_log && *only != 0.0 => only.abs() / 4.0,
            _ => 0.5,
        };
        let half = |pair: Option<&[f64]>| pair.map_or(alone, |pair| (pair[1] - pair[0]) / 2.0);
        let (first, last) = (at.first().copied().unwrap_or(0.5), at.last().copied().unwrap_or(0.5));
        let mut edges = vec![first - half(at.windows(2).next())];
        edges.extend(at.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
        edges.push(last + half(at.windows(2).next_back()));
        let edges: Vec<f64> = edges.into_iter().map(from).collect();
        let range = edges[0]..edges[edges.len() - 1];
        let axis = match (values.is_empty(), is_log) {
            (true, _) => Axis::Names(Vec::new()),
            (false, true) => Axis::Log(range),
            (false, false) => Axis::Linear(range),
        };
        Self { values, edges, axis }
    }

    /// The boundaries of the cell of a value.
    pub fn around(&self, value: f64) -> [f64; 2] {
        let index = self.values.partition_point(|own| *own < value);
        [self.edges[index], self.edges[index + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: cells meet half-way between their values, on a logarithmic axis at the geometric mean, and the outer ones
    /// are symmetric. A single value has a cell too, also at zero.
    #[test]
    fn cells_meet_half_way() {
        let linear = CellEdges::of([0.1, 0.4, 0.2].into_iter(), false);
        let near = |edges: &[f64], expected: &[f64]| {
            assert_eq!(edges.len(), expected.len());
            let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(1.0);
            assert!(edges.iter().zip(expected).all(is_near), "{edges:?} {expected:?}");
        };
        near(&linear.edges, &[0.05, 0.15, 0.3, 0.5]);
        let speeds = CellEdges::of([1.0, 4.0, 100.0].into_iter(), true);
        assert!(matches!(speeds.axis, Axis::Log(_)));
        near(&speeds.edges, &[0.5, 2.0, 20.0, 500.0]);
        near(&CellEdges::of([0.4].into_iter(), false).edges, &[0.3, 0.5]);
        near(&CellEdges::of([0.0].into_iter(), true).edges, &[-0.5, 0.5]);
        assert!(matches!(CellEdges::of(std::iter::empty(), true).axis, Axis::Names(_)));
    }
}
