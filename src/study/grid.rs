//! The grid of a study: all combinations of the values of its axes.

use super::axis::Axis;
use super::draft::{Draft, Resolved};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde_json::Value;

/// The axes in the order of the file. The first axis is the slowest: its value changes last from point to point.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub axes: Vec<Axis>,
}

impl Grid {
    /// Number of points; 1 without axes.
    pub(super) fn size(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// The job of every point: `draft` with the values of the point.
    pub(super) fn resolve(&self, draft: &Draft) -> Vec<Resolved> {
        let mut draft = draft.clone();
        self.axes.iter().for_each(|axis| draft.mark(axis.parameter));
        let at_point = |draft: &mut Draft, point| {
            for (axis, index) in self.axes.iter().zip(self.indices_of(point)) {
                draft.put(axis.parameter, &axis.values[index]);
            }
            draft.resolve()
        };
        (0..self.size()).into_par_iter().map_init(|| draft.clone(), at_point).collect()
    }

    /// The parameters and their values at a point.
    pub(super) fn parameters_at(&self, point: usize) -> Vec<(String, Value)> {
        let pair =
            |(axis, index): (&Axis, usize)| (axis.parameter.name.to_owned(), axis.values[index].clone());
        self.axes.iter().zip(self.indices_of(point)).map(pair).collect()
    }

    /// The index of each axis' value at a point: the digits of the point's number in the mixed radix of the axes'
    /// lengths, the last axis being the lowest digit.
    pub(super) fn indices_of(&self, mut point: usize) -> Vec<usize> {
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = point % axis.values.len();
            point /= axis.values.len();
        }
        indices
    }
}
