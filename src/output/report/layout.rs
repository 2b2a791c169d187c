//! How tables and figures lay out the parameters of a study: one parameter along the rows, one over the columns, and a
//! table or panel for each combination of the others.
//!
//! Usually ω is along the rows and μ over the columns; a [`View`] chooses others. If rows have several sources (studies,
//! files of measured points), each source has columns of its own.

use super::dimension::Dimension;
use super::parameters::{MU, OMEGA, SOURCE, parameter_names};
use super::row::{JobRow, RowState};
use super::view::View;
use crate::publish::chart::Axis;
use crate::publish::value;
use indexmap::IndexMap;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

pub(super) use super::words::parameters_in_words;

/// A study laid out in two dimensions, once per combination of its further parameters.
pub(super) struct Layout<'a> {
    /// The parameter along the rows of a table and the abscissa of a figure: ω if it varies, or if nothing else does.
    pub axis: &'a str,
    /// The parameter over the columns of a table, and of the curves of a figure: μ if it varies.
    pub by: &'a str,
    /// The other parameters that vary.
    pub further: Vec<&'a str>,
    /// The parameters that are the same in every job.
    pub constants: Vec<(&'a str, Value)>,
    /// The columns of a table and the curves of a figure: the values of `by`, ascending, each once for every source that
    /// has it.
    pub series: Vec<Series>,
    /// The studies and files that the rows come from, in the order of the rows.
    pub sources: Vec<Source<'a>>,
    /// One group per combination of `further`, in the order of the study.
    pub groups: Vec<Group<'a>>,
    /// Parameters that vary freely in the only group, because the jobs are points and no grid. Points are not joined by lines then.
    pub scattered: Vec<&'a str>,
    /// The parameters that vary, and then those that are constant and have a place in the layout: tables of points have them.
    pub varied: Vec<&'a str>,
    dimensions: HashMap<&'a str, Dimension>,
}

/// A study, or a file of measured points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Source<'a> {
    pub name: &'a str,
    pub is_measured: bool,
}

/// A column of a table, or a curve of a figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// The value of [`Layout::by`]; null if it is not known.
    pub value: Value,
    /// Index of the value among the different ones.
    pub value_index: usize,
    /// Index in [`Layout::sources`].
    pub source: usize,
}

/// The jobs with one combination of the further parameters.
pub(super) struct Group<'a> {
    /// The combination, in the order of [`Layout::further`].
    pub key: Vec<(&'a str, Value)>,
    /// Its jobs.
    pub jobs: Vec<PlacedJob<'a>>,
    /// The values along the axis: ascending if they are numbers, otherwise in the order of the study.
    pub axis_values: Vec<Value>,
    words: String,
}

/// A job with its position in the layout.
#[derive(Clone, Copy)]
pub(super) struct PlacedJob<'a> {
    pub row: &'a JobRow,
    /// Index of its value in [`Group::axis_values`].
    pub axis_index: usize,
    /// Index in [`Layout::series`].
    pub series: usize,
}

/// Fewer jobs are shown as a grid in any case.
const FEWEST_SCATTERED: usize = 6;

/// The rows of a layout with the names of their parameters that differ.
struct Varying<'a> {
    rows: Vec<&'a JobRow>,
    names: Vec<&'a str>,
    sources: Vec<Source<'a>>,
}

impl<'a> Varying<'a> {
    fn new(rows: Vec<&'a JobRow>) -> (Self, Vec<&'a str>) {
        let varies = |name: &str| {
            let mut texts = rows.iter().map(|row| value::text(&row.parameter(name)));
            let first = texts.next();
            texts.any(|text| Some(text) != first)
        };
        let all = parameter_names(rows.iter().map(|row| &row.parameters));
        let (names, constant) = all.into_iter().partition(|name| varies(name));
        let mut sources: Vec<Source> = Vec::new();
        for row in &rows {
            if !sources.iter().rev().any(|source| source.name == row.study) {
                sources.push(Source { name: &row.study, is_measured: row.is_measured() });
            }
        }
        (Self { rows, names, sources }, constant)
    }

    fn varies(&self, name: &str) -> bool {
        if name == SOURCE { self.sources.len() > 1 } else { self.names.contains(&name) }
    }

    /// The parameters besides that along the axis, if the jobs are points and no grid: if two numbers or more have nearly as many values
    /// as there are jobs. Otherwise none.
    fn scattered(&self, axis: &str) -> Vec<&'a str> {
        let jobs = || self.rows.iter().filter(|row| !row.is_measured());
        let count = jobs().count();
        let has_many = |name: &&str| {
            let numbers = jobs().map(|row| row.parameter(name).as_f64().map(f64::to_bits));
            let different = numbers.collect::<Option<HashSet<u64>>>();
            different.is_some_and(|different| 4 * different.len() > 3 * count)
        };
        if count < FEWEST_SCATTERED || self.names.iter().filter(|name| has_many(name)).count() < 2 {
            return Vec::new();
        }
        self.names.iter().copied().filter(|name| *name != axis).collect()
    }

    /// The parameter along the axis.
    fn axis(&self) -> &'a str {
        self.names.iter().copied().find(|name| *name != MU).unwrap_or(OMEGA)
    }

    /// The parameter of the curves.
    fn by(&self, axis: &str) -> &'a str {
        let varying = [MU].into_iter().chain(self.names.iter().copied()).chain([SOURCE]);
        let usual = if axis == MU { OMEGA } else { MU };
        varying.into_iter().find(|name| *name != axis && self.varies(name)).unwrap_or(usual)
    }
}

impl<'a> Layout<'a> {
    /// The usual layout of a study.
    pub fn new(rows: &'a [JobRow]) -> Self {
        Self::of(rows, &View::DEFAULT)
    }

    /// Lays out rows. This compares the values of all jobs as text, which is slow: a report shares one layout between all
    /// its tables and figures.
    pub fn of(rows: impl IntoIterator<Item = &'a JobRow>, view: &View) -> Self {
        Self::laid_out(rows, view, true)
    }

    /// The same jobs with the only scattered parameter as that of the curves, for a map on true axes; none if there is no such
    /// parameter, or if there are several.
    pub fn on_true_axes(&self) -> Option<Self> {
        let [by] = self.scattered[..] else { return None };
        let rows = self.groups.iter().flat_map(|group| &group.jobs).map(|job| job.row);
        let view = View { x: Some(self.axis.to_owned()), by: Some(by.to_owned()), ..View::default() };
        let mut own = Self::laid_out(rows, &view, false);
        let others = self.dimensions.iter().filter(|(name, _)| **name != by);
        own.dimensions.extend(others.map(|(name, dimension)| (*name, dimension.clone())));
        Some(own)
    }

    fn laid_out(rows: impl IntoIterator<Item = &'a JobRow>, view: &View, may_scatter: bool) -> Self {
        let (varying, constant) = Varying::new(rows.into_iter().collect());
        let known = |name: &Option<String>| {
            let own = varying.names.iter().chain(&constant).chain(&[SOURCE]);
            let name = name.as_deref()?;
            own.copied().find(|own| *own == name)
        };
        let axis = known(&view.x).unwrap_or_else(|| varying.axis());
        let by = known(&view.by).filter(|by| *by != axis).unwrap_or_else(|| varying.by(axis));
        let scattered = if may_scatter { varying.scattered(axis) } else { Vec::new() };
        let by = if scattered.is_empty() { by } else { SOURCE };
        let is_placed = |name: &str| name == axis || name == by;
        let further =
            varying.names.iter().copied().filter(|name| !is_placed(name) && !scattered.contains(name));
        let further: Vec<&str> = further.collect();
        let constants = varying.rows.first().map_or_else(Vec::new, |row| {
            // A constant ω or μ is in the heads of tables, if it has no other place.
            let named = constant.iter().filter(|name| !is_placed(name));
            named.map(|&name| (name, row.parameter(name))).collect()
        });
        let placed = further.iter().chain(&scattered).copied().chain([axis, by]);
        let names = [OMEGA, MU, SOURCE].into_iter().chain(placed);
        let dimensions = names
            .map(|name| {
                let description = view.descriptions.get(name).map(String::as_str);
                (name, Dimension::new(name, description, view.is_log.get(name).copied(), &varying.rows))
            })
            .collect();
        let varied = varying.names.iter().chain(&constant).copied();
        let varied = varied.filter(|name| varying.varies(name) || is_placed(name)).collect();
        let (series, series_of) = series(&varying, by);
        let mut layout = Self {
            axis,
            by,
            further,
            constants,
            series,
            sources: varying.sources,
            groups: Vec::new(),
            scattered,
            varied,
            dimensions,
        };
        layout.groups = layout.group(&varying.rows, &series_of);
        layout
    }

    /// What is the same in all jobs, in words; may be empty.
    pub fn constants_in_words(&self) -> String {
        super::parameters::assignments(self.constants.iter().cloned())
    }

    /// How the values of a parameter are written.
    ///
    /// # Panics
    /// If the layout has no such parameter: another axis in its place would be a wrong figure.
    pub fn dimension(&self, name: &str) -> &Dimension {
        self.dimensions.get(name).unwrap_or_else(|| panic!("`{name}` is no parameter of this layout"))
    }

    /// Name and unit of the axis.
    pub fn axis_name(&self) -> &str {
        &self.dimension(self.axis).title
    }

    /// The parameter of the curves in words: `μ`, `clamp_width [mm]`, `source`.
    pub fn by_words(&self) -> String {
        let words = &self.dimension(self.by).label;
        if self.has_sources() { format!("{words} and source") } else { words.clone() }
    }

    /// Symbol and unit of the axis.
    pub fn axis_label(&self) -> &str {
        &self.dimension(self.axis).label
    }

    /// A value along the axis as text, in the unit of the axis.
    pub fn axis_text(&self, value: &Value) -> String {
        self.dimension(self.axis).text(value)
    }

    /// The axis of a figure, which is the same in all its panels. Its numbers are in the unit of [`Layout::axis_name`].
    pub fn x_axis(&self) -> Axis {
        self.dimension(self.axis).axis(self.axis == OMEGA)
    }

    /// The position of a value on [`Layout::x_axis`].
    pub fn position(&self, axis: &Axis, value: &Value) -> Option<f64> {
        self.dimension(self.axis).position(axis, value)
    }

    /// A column of a table or a curve of a figure in words: `μ = 0.4`, with the source if there are several.
    pub fn series_name(&self, series: &Series) -> String {
        let source = self.sources.get(series.source).map_or("", |source| source.name);
        if self.by == SOURCE {
            return source.to_owned();
        }
        let words = self.dimension(self.by).assignment(&series.value);
        match (self.has_sources(), series.value.is_null()) {
            (false, _) => words,
            (true, true) => source.to_owned(),
            (true, false) => format!("{words}, {source}"),
        }
    }

    /// The value of a column or curve in words, without the parameter's name: `0.4`, with the source if there are several.
    pub fn series_value(&self, series: &Series) -> String {
        let source = self.sources.get(series.source).map_or("", |source| source.name);
        let words = self.dimension(self.by).text(&series.value);
        match (self.has_sources(), series.value.is_null()) {
            (false, _) => words,
            (true, true) => source.to_owned(),
            (true, false) => format!("{words} {source}"),
        }
    }

    /// Whether a source is more than the value of [`Layout::by`].
    pub fn has_sources(&self) -> bool {
        self.sources.len() > 1 && self.by != SOURCE
    }

    fn group(&self, rows: &[&'a JobRow], series_of: &[usize]) -> Vec<Group<'a>> {
        let mut groups = Groups::default();
        for (row, &series) in rows.iter().zip(series_of) {
            let key: Vec<_> = self.further.iter().map(|&name| (name, row.parameter(name))).collect();
            groups.place(row, key, series, row.parameter(self.axis));
        }
        groups.finish(self)
    }
}

/// Groups in the making.
#[derive(Default)]
struct Groups<'a> {
    /// The groups with their values along the axis. Values are compared as they are shown: 1 and 1.0 are equal.
    found: IndexMap<Vec<String>, (Group<'a>, IndexMap<String, Value>)>,
    /// Measured points that are not known to belong to one group.
    anywhere: Vec<Unplaced<'a>>,
}

/// A row with the parameters of its group, some of which are not known, its series, and its value along the axis.
type Unplaced<'a> = (&'a JobRow, Vec<(&'a str, Value)>, usize, Value);

impl<'a> Groups<'a> {
    fn place(&mut self, row: &'a JobRow, key: Vec<(&'a str, Value)>, series: usize, at: Value) {
        let is_unknown = key.iter().any(|(_, value)| value.is_null());
        if is_unknown && matches!(row.state, RowState::Measured(_)) {
            self.anywhere.push((row, key, series, at));
            return;
        }
        let number = self.number(key);
        self.add(number, row, series, at);
    }

    fn number(&mut self, key: Vec<(&'a str, Value)>) -> usize {
        let entry = self.found.entry(key.iter().map(|(_, value)| value::text(value)).collect());
        let number = entry.index();
        let group = Group { key, jobs: Vec::new(), axis_values: Vec::new(), words: String::new() };
        entry.or_insert((group, IndexMap::new()));
        number
    }

    fn add(&mut self, number: usize, row: &'a JobRow, series: usize, at: Value) {
        let (group, values) = &mut self.found[number];
        let value = values.entry(value::text(&at));
        let axis_index = value.index();
        value.or_insert(at);
        group.jobs.push(PlacedJob { row, axis_index, series });
    }

    fn finish(mut self, layout: &Layout) -> Vec<Group<'a>> {
        for (row, key, series, at) in std::mem::take(&mut self.anywhere) {
            let agrees = |group: &Group| {
                let pairs = group.key.iter().zip(&key);
                pairs.clone().all(|((_, a), (_, b))| b.is_null() || value::text(a) == value::text(b))
            };
            let fitting: Vec<usize> = (0..self.found.len()).filter(|&i| agrees(&self.found[i].0)).collect();
            if fitting.is_empty() {
                let number = self.number(key);
                self.add(number, row, series, at);
                continue;
            }
            for number in fitting {
                self.add(number, row, series, at.clone());
            }
        }
        if self.found.is_empty() {
            // A study without jobs has empty tables and figures.
            self.number(Vec::new());
        }
        let finished = |(mut group, values): (Group<'a>, IndexMap<String, Value>)| {
            group.axis_values = values.into_values().collect();
            group.sort_axis();
            let words = group.key.iter().map(|(name, value)| layout.dimension(name).assignment(value));
            group.words = words.collect::<Vec<_>>().join(", ");
            group
        };
        self.found.into_values().map(finished).collect()
    }
}

/// Largest number of figures of a kind on a page.
pub(super) const MAX_SHEETS: usize = 2;
/// Largest number of combinations of further parameters that are shown.
pub(super) const MAX_GROUPS: usize = 6;

impl Group<'_> {
    /// The combination in words; empty if there are no further parameters.
    pub fn caption(&self) -> String {
        self.words.clone()
    }

    /// The group with some of its jobs alone.
    pub fn only(&self, is_kept: impl Fn(&JobRow) -> bool) -> Self {
        Self {
            key: self.key.clone(),
            jobs: self.jobs.iter().filter(|job| is_kept(job.row)).copied().collect(),
            axis_values: self.axis_values.clone(),
            words: self.words.clone(),
        }
    }

    fn sort_axis(&mut self) {
        let rank = value::sort_numbers(&mut self.axis_values);
        for job in &mut self.jobs {
            job.axis_index = rank[job.axis_index];
        }
    }
}

/// The series of the rows, and the index of each row's series.
fn series(varying: &Varying, by: &str) -> (Vec<Series>, Vec<usize>) {
    let mut values: IndexMap<String, Value> = IndexMap::new();
    let mut of_rows = Vec::with_capacity(varying.rows.len());
    for row in &varying.rows {
        let value = row.parameter(by);
        let entry = values.entry(value::text(&value));
        let index = entry.index();
        entry.or_insert(value);
        let source = varying.sources.iter().position(|source| source.name == row.study).unwrap_or(0);
        of_rows.push((index, source));
    }
    let mut values: Vec<Value> = values.into_values().collect();
    let rank = value::sort_known(&mut values);
    for (index, _) in &mut of_rows {
        *index = rank[*index];
    }
    let mut found = of_rows.clone();
    found.sort_unstable();
    found.dedup();
    let numbers: HashMap<(usize, usize), usize> = found.iter().enumerate().map(|(n, at)| (*at, n)).collect();
    let series = found
        .iter()
        .map(|&(value_index, source)| Series { value: values[value_index].clone(), value_index, source })
        .collect();
    (series, of_rows.iter().map(|at| numbers[at]).collect())
}
