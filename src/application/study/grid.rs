//! The points of a study: all combinations of its samples and the values of its axes, as far as its conditions keep them.

use super::axis::Axis;
use super::conditions::Conditions;
use super::draft::{Draft, Resolved};
use super::json::encode;
use super::parameter::Parameter;
use super::samples::Samples;
use crate::spec::JobSpec;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde_json::Value;

/// Samples and axes, the axes in the order of the file. Samples are the slowest, then comes the first axis: its value changes last
/// from point to point.
#[derive(Debug, Clone, Default)]
pub(super) struct Grid {
    pub samples: Option<Samples>,
    pub axes: Vec<Axis>,
    conditions: Conditions,
    /// The numbers of the combinations that the conditions keep; all without conditions.
    kept: Option<Vec<usize>>,
}

impl Grid {
    /// A grid of these axes alone.
    pub(super) fn of_axes(axes: Vec<Axis>) -> Self {
        Self { axes, ..Self::default() }
    }

    /// The parameters that it varies: those of the samples, then those of the axes.
    pub(super) fn parameters(&self) -> impl Iterator<Item = &'static Parameter> + '_ {
        let of_samples = self.samples.iter().flat_map(|samples| samples.parameters.iter().copied());
        of_samples.chain(self.axes.iter().map(|axis| axis.parameter))
    }

    /// What points must fulfil. [`Grid::select`] comes after it.
    pub(super) fn set_conditions(&mut self, conditions: Conditions) {
        self.conditions = conditions;
    }

    /// Keeps the points that fulfil the conditions. Other parameters have the values of `base`. Returns the number of points.
    pub(super) fn select(&mut self, base: &JobSpec) -> usize {
        self.kept = None;
        if !self.conditions.is_empty() {
            let base = encode(base);
            let is_kept = |point: &usize| self.conditions.keep(&self.values_at(*point), &base);
            self.kept = Some((0..self.size()).filter(is_kept).collect());
        }
        self.size()
    }

    /// Whether a point that it need not have fulfils the conditions.
    pub(super) fn keeps(&self, point: &[(&'static Parameter, &Value)], base: &JobSpec) -> bool {
        self.conditions.is_empty() || self.conditions.keep(point, &encode(base))
    }

    /// Number of points; 1 without samples and axes.
    pub(super) fn size(&self) -> usize {
        let of_samples = self.samples.as_ref().map_or(1, |samples| samples.rows.len());
        let all = self.axes.iter().map(|axis| axis.values.len()).product::<usize>() * of_samples;
        self.kept.as_ref().map_or(all, Vec::len)
    }

    /// The job of every point: `draft` with the values of the point.
    pub(super) fn resolve(&self, draft: &Draft) -> Vec<Resolved> {
        let mut draft = draft.clone();
        self.parameters().for_each(|parameter| draft.mark(parameter));
        let at_point = |draft: &mut Draft, point| {
            for (parameter, value) in self.values_at(point) {
                draft.put(parameter, value);
            }
            draft.resolve()
        };
        (0..self.size()).into_par_iter().map_init(|| draft.clone(), at_point).collect()
    }

    /// The parameters and their values at a point.
    fn values_at(&self, point: usize) -> Vec<(&'static Parameter, &Value)> {
        let (row, indices) = self.place_of(point);
        let of_samples = self
            .samples
            .iter()
            .flat_map(|samples| samples.parameters.iter().copied().zip(&samples.rows[row]));
        let of_axes =
            self.axes.iter().zip(&indices).map(|(axis, index)| (axis.parameter, &axis.values[*index]));
        of_samples.chain(of_axes).collect()
    }

    /// The names of the parameters and their values at a point.
    pub(super) fn parameters_at(&self, point: usize) -> Vec<(String, Value)> {
        let values = self.values_at(point).into_iter();
        values.map(|(parameter, value)| (parameter.name.to_owned(), value.clone())).collect()
    }

    /// The index of each axis' value at a point.
    pub(super) fn indices_of(&self, point: usize) -> Vec<usize> {
        self.place_of(point).1
    }

    /// The number of the sample and the index of each axis' value at a point: the digits of the number of its combination in the
    /// mixed radix of the axes' lengths, the last axis being the lowest digit.
    pub(super) fn place_of(&self, point: usize) -> (usize, Vec<usize>) {
        let mut number = self.kept.as_ref().map_or(point, |kept| kept[point]);
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = number % axis.values.len();
            number /= axis.values.len();
        }
        (number, indices)
    }

    /// Number of points with the same value of an axis as this point.
    pub(super) fn points_like(&self, point: usize, axis: usize) -> usize {
        if self.kept.is_none() {
            return self.size() / self.axes[axis].values.len();
        }
        let index = self.indices_of(point)[axis];
        (0..self.size()).filter(|other| self.indices_of(*other)[axis] == index).count()
    }
}
