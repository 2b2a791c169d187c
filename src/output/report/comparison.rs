//! The differences between several sources: studies, and files of measured points.
//!
//! The first source is the reference. A point of another source is compared with the reference at the same parameters. If
//! the reference has no job at its place on the axis, but neighbours on both sides, it is interpolated between them, along
//! the line that the figures show.

use super::layout::{Group, Layout, PlacedJob};
use super::parameters::SOURCE;
use super::reference_curves::{
    Curves, Place, alike, position_in, reference_at, reference_curves, squeals_at,
};
use super::row::JobRow;
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::sensitivity::{Mover, movers};
use super::view::View;
use crate::publish::chart::Axis;
use crate::publish::value;
use serde_json::Value;

/// The differences between the sources of a report.
pub(super) struct Comparison {
    /// The name of the first source.
    pub reference: String,
    /// Where one source squeals and the reference does not, or the reverse.
    pub contradictions: Vec<Contradiction>,
    /// Points at which both say whether it squeals.
    pub compared_squeals: usize,
    /// What a reader must know, one sentence each: inputs that differ, points without a counterpart.
    pub notes: Vec<String>,
    /// What is not compared, one sentence each: points without a counterpart, and measured points with other studies than the first.
    pub unmatched: Vec<String>,
    /// The study that shows what could move a quantity, and what its parameters do to each quantity.
    pub movers: Option<Movers>,
    /// All differences.
    pub differences: Vec<Difference>,
    /// Names of the parameters: those of the groups, of the curves and of the axis.
    pub names: Vec<String>,
    /// Short names with units of the same parameters.
    labels: Vec<String>,
}

/// What the parameters of a study do to each quantity.
pub(super) struct Movers {
    pub study: String,
    /// The movers of each quantity, or why there are none.
    pub of: Vec<(&'static Scalar, Result<Vec<Mover>, &'static str>)>,
}

/// One quantity of a point, and of the reference at the same place.
pub(super) struct Difference {
    pub source: String,
    pub is_measured: bool,
    pub scalar: &'static Scalar,
    /// Values of the parameters, as in [`Comparison::names`], and their texts.
    pub parameters: Vec<Value>,
    pub texts: Vec<String>,
    /// The curve of the reference in words.
    pub curve: String,
    pub value: f64,
    pub error: Option<f64>,
    pub reference: f64,
    pub reference_error: Option<f64>,
    pub interpolated: bool,
    /// Whether a run behind one of the values is not periodic.
    pub is_open: bool,
}

/// A point at which only one of a source and the reference squeals.
pub(super) struct Contradiction {
    pub source: String,
    pub is_measured: bool,
    /// Whether the source squeals; the reference does the opposite.
    pub squeals: bool,
    /// The frequency \[Hz\] of the source, if it squeals and that is known.
    pub frequency_hz: Option<f64>,
    /// Values of the parameters, as in [`Comparison::names`], and their texts.
    pub parameters: Vec<Value>,
    pub texts: Vec<String>,
    /// Whether the reference is known on both sides of the point only.
    pub is_between: bool,
}

/// What a source has at the points of the reference.
#[derive(Default)]
struct Matches {
    /// Points at the place of a job of the reference.
    equal: usize,
    /// Points between two jobs.
    between: usize,
    /// Other points.
    elsewhere: usize,
    /// The quantity of each value at or between jobs of the reference that have no such value.
    without_value: Vec<&'static Scalar>,
}

impl Comparison {
    /// The differences; none if there is only one source.
    pub fn of(layout: &Layout, view: &View) -> Option<Self> {
        if layout.sources.len() < 2 {
            return None;
        }
        let scalars: Vec<&'static Scalar> =
            [MU_STAR, FREQUENCY].into_iter().chain(view.y.iter().copied()).collect();
        let by = Some(layout.by).filter(|by| *by != SOURCE);
        let outer = layout.further.iter().copied().chain(by);
        let names: Vec<&str> = outer.chain(layout.scattered.iter().copied()).chain([layout.axis]).collect();
        let mut comparison = Self {
            reference: layout.sources[0].name.to_owned(),
            contradictions: Vec::new(),
            compared_squeals: 0,
            notes: view.notes.clone(),
            unmatched: Vec::new(),
            movers: None,
            differences: Vec::new(),
            labels: names.iter().map(|name| layout.dimension(name).label.clone()).collect(),
            names: names.iter().map(|&name| name.to_owned()).collect(),
        };
        let mut others = layout.sources.iter().skip(1);
        if others.any(|source| source.is_measured)
            && layout.sources.iter().skip(1).any(|source| !source.is_measured)
        {
            comparison.unmatched.push(format!(
                "measured points are compared with {} alone; name another study first to compare them with that one",
                comparison.reference
            ));
        }
        let x_axis = layout.x_axis();
        for (index, source) in layout.sources.iter().enumerate().skip(1) {
            let mut matches = Matches::default();
            let mut found = 0;
            let (compared_before, mut says_squeal) = (comparison.compared_squeals, false);
            for group in &layout.groups {
                let curves = reference_curves(layout, group, &x_axis);
                found += curves.values().map(Vec::len).sum::<usize>();
                for job in group.jobs.iter().filter(|job| layout.series[job.series].source == index) {
                    says_squeal |= job.row.is_measured() && job.row.squeals().is_some();
                    comparison.compare(layout, group, job, &curves, &x_axis, &scalars, &mut matches);
                }
            }
            let none = matches.none_in_words(source.name, layout.sources[0].name);
            if source.is_measured && none.is_none() {
                comparison.unmatched.extend(matches.some_in_words(source.name, layout.sources[0].name));
                let of = |scalar: &&'static Scalar| {
                    matches.values_in_words(scalar, source.name, layout.sources[0].name)
                };
                comparison.unmatched.extend(scalars.iter().filter_map(of));
            }
            if none.is_none() && says_squeal && comparison.compared_squeals == compared_before {
                comparison.unmatched.push(format!(
                    "whether {} squeals is compared at none of its points: they lie beyond the jobs of {}, between one that squeals and one \
                     that does not, or at one that is not periodic",
                    source.name, layout.sources[0].name
                ));
            }
            comparison.unmatched.extend(none);
            comparison.notes.extend(matches.in_words(
                source.name,
                &layout.sources[0],
                source.is_measured,
                found,
            ));
        }
        let order = |source: &str| layout.sources.iter().position(|own| own.name == source);
        comparison.differences.sort_by_cached_key(|found| {
            let scalar = scalars.iter().position(|scalar| *scalar == found.scalar);
            (order(&found.source), scalar, found.curve.clone())
        });
        Some(comparison)
    }

    /// Takes what the parameters of a study do to each quantity, from its name and jobs. The parameter along the axis explains no
    /// difference.
    pub fn explain_by(&mut self, study: Option<(&str, &[JobRow])>) {
        let Some((name, rows)) = study else { return };
        let axis = self.names.last().map(String::as_str);
        let of = |scalar: &'static Scalar| (scalar, movers(rows, scalar, axis));
        let mut scalars: Vec<&'static Scalar> = Vec::new();
        for found in &self.differences {
            if !scalars.contains(&found.scalar) {
                scalars.push(found.scalar);
            }
        }
        self.movers = Some(Movers { study: name.to_owned(), of: scalars.into_iter().map(of).collect() });
    }

    #[expect(clippy::too_many_arguments, reason = "the state of one loop")]
    fn compare(
        &mut self,
        layout: &Layout,
        group: &Group,
        job: &PlacedJob,
        curves: &Curves,
        x_axis: &Axis,
        scalars: &[&'static Scalar],
        matches: &mut Matches,
    ) {
        let at = &group.axis_values[job.axis_index];
        let Some(x) = layout.position(x_axis, at) else { return };
        let own = &layout.series[job.series].value;
        let is_own =
            |value: &&Value| layout.by == SOURCE || own.is_null() || value::text(value) == value::text(own);
        let mut place = None;
        let (mut compared, mut without) = (Vec::new(), Vec::new());
        for (index, curve) in curves {
            let by = &layout.series[*index].value;
            if !is_own(&by) {
                continue;
            }
            let alike = (!layout.scattered.is_empty()).then(|| alike(curve, x, layout, job.row));
            let curve = alike.as_ref().unwrap_or(curve);
            place = place.max(position_in(curve, x, x_axis));
            let by_of_curve = Some(by).filter(|_| layout.by != SOURCE);
            if let Some(squeals) = job.row.squeals()
                && let Some((of_reference, is_between)) = squeals_at(curve, x, x_axis)
            {
                self.compared_squeals += 1;
                if squeals != of_reference {
                    let (parameters, texts) = self.parameters(layout, group, by_of_curve, job);
                    self.contradictions.push(Contradiction {
                        source: job.row.study.clone(),
                        is_measured: job.row.is_measured(),
                        squeals,
                        frequency_hz: FREQUENCY.value(job.row),
                        parameters,
                        texts,
                        is_between,
                    });
                }
            }
            for scalar in scalars.iter().filter(|scalar| scalar.is_settled(job.row)) {
                let Some(value) = scalar.value(job.row) else { continue };
                let Some(reference) = reference_at(curve, x, x_axis, scalar) else {
                    // That a stable reference has no frequency is said as a contradiction.
                    let is_stable = squeals_at(curve, x, x_axis).is_some_and(|(squeals, _)| !squeals);
                    if position_in(curve, x, x_axis).is_some() && !is_stable && !without.contains(scalar) {
                        without.push(*scalar);
                    }
                    continue;
                };
                compared.push(*scalar);
                let (parameters, texts) = self.parameters(layout, group, by_of_curve, job);
                let words = [group.caption(), layout.series_name(&layout.series[*index])];
                self.differences.push(Difference {
                    source: job.row.study.clone(),
                    is_measured: job.row.is_measured(),
                    scalar,
                    texts,
                    parameters,
                    curve: words.into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(", "),
                    value,
                    error: scalar.error(job.row),
                    reference: reference.value,
                    reference_error: reference.error,
                    interpolated: reference.interpolated,
                    is_open: reference.is_open || job.row.is_open(),
                });
            }
        }
        // A point of unknown friction has several curves, and one of them is enough.
        matches.without_value.extend(without.into_iter().filter(|scalar| !compared.contains(scalar)));
        *match place {
            Some(Place::Equal) => &mut matches.equal,
            Some(Place::Between) => &mut matches.between,
            None => &mut matches.elsewhere,
        } += 1;
    }

    /// The values of the parameters at a point, and their texts.
    fn parameters(
        &self,
        layout: &Layout,
        group: &Group,
        by: Option<&Value>,
        job: &PlacedJob,
    ) -> (Vec<Value>, Vec<String>) {
        let at = &group.axis_values[job.axis_index];
        let scattered = layout.scattered.iter().map(|name| job.row.parameter(name));
        let outer = group.key.iter().map(|(_, value)| value).chain(by).cloned();
        let values: Vec<Value> = outer.chain(scattered).chain([at.clone()]).collect();
        let texts = self.names.iter().zip(&values).map(|(name, value)| layout.dimension(name).text(value));
        let texts = texts.collect();
        (values, texts)
    }

    /// Where only one of a source and the reference squeals: a head, and a line for each of the first points; empty if nowhere.
    /// Nothing that a model can say is further from what is measured.
    pub fn contradictions_in_words(&self) -> Vec<String> {
        if self.contradictions.is_empty() {
            return Vec::new();
        }
        let (count, of) = (self.contradictions.len(), self.compared_squeals);
        let head = format!(
            "Squeal is contradicted at {count} of {} where both say whether it squeals:",
            value::count(of, "point")
        );
        let listed = self.contradictions.iter().take(MAX_CONTRADICTIONS).map(|found| self.in_words(found));
        let more = count.saturating_sub(MAX_CONTRADICTIONS);
        let more = (more > 0).then(|| format!("and {more} more: see differences.csv"));
        std::iter::once(head).chain(listed).chain(more).collect()
    }

    fn in_words(&self, found: &Contradiction) -> String {
        let Contradiction { source, is_measured, squeals, frequency_hz, texts, is_between, .. } = found;
        let place: Vec<String> =
            self.names.iter().zip(texts).map(|(name, text)| format!("{name} = {text}")).collect();
        let own = if *is_measured { format!("{source} (measured)") } else { source.clone() };
        let frequency =
            frequency_hz.map_or_else(String::new, |f| format!(" at {}", value::quantity(f, "Hz")));
        let between = if *is_between { " on both sides" } else { "" };
        let reference = &self.reference;
        let words = if *squeals {
            format!("{own} squeals{frequency}, and {reference} is stable{between}")
        } else {
            format!("{own} does not squeal, and {reference} squeals{between}")
        };
        format!("{}: {words}", place.join(", "))
    }

    /// A summary for each curve of the reference: heads and lines of a table.
    pub fn summary(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let head = [
            "source",
            "quantity",
            "reference",
            "points",
            "mean difference",
            "root mean square",
            "largest",
            "rms over statistical error",
        ];
        let same = |a: &Difference, b: &Difference| {
            a.source == b.source && a.scalar == b.scalar && a.curve == b.curve
        };
        let line = |part: &[Difference]| {
            let first = &part[0];
            let text = |x: f64| first.scalar.text(x);
            let count = part.len() as f64;
            let mean = part.iter().map(Difference::difference).sum::<f64>() / count;
            let square = part.iter().map(|found| found.difference().powi(2)).sum::<f64>() / count;
            let largest = part.iter().map(Difference::difference).max_by(|a, b| a.abs().total_cmp(&b.abs()));
            let ratios: Option<Vec<f64>> = part
                .iter()
                .map(|found| Some(found.difference() / found.combined_error().filter(|error| *error > 0.0)?))
                .collect();
            let over = ratios.map(|ratios| (ratios.iter().map(|r| r * r).sum::<f64>() / count).sqrt());
            vec![
                first.source.clone(),
                first.scalar.short_title(),
                first.curve.clone(),
                part.len().to_string(),
                text(mean),
                text(square.sqrt()),
                largest.map_or_else(String::new, text),
                over.map_or_else(|| value::MISSING.to_owned(), |x| value::significant(x, 3)),
            ]
        };
        (head.map(str::to_owned).into(), self.differences.chunk_by(same).map(line).collect())
    }

    /// All differences: heads and lines of a table.
    pub fn table(&self) -> (Vec<String>, impl Iterator<Item = Vec<String>>) {
        let head = ["source", "quantity"].map(str::to_owned).into_iter().chain(self.labels.iter().cloned());
        let results = ["value", &self.reference, "difference", "error", "relative"];
        let head = head.chain(results.map(str::to_owned)).collect();
        let line = |found: &Difference| {
            let mark = if found.interpolated { "*" } else { "" };
            let own = [found.source.clone(), found.scalar.short_title()];
            own.into_iter()
                .chain(found.texts.iter().cloned())
                .chain([
                    found.scalar.text_with_error(found.value, found.error),
                    found.scalar.text_with_error(found.reference, found.reference_error) + mark,
                    found.scalar.text(found.difference()),
                    found
                        .combined_error()
                        .map_or_else(|| value::MISSING.to_owned(), |x| found.scalar.error_text(x)),
                    found.deviation().map_or_else(
                        || value::MISSING.to_owned(),
                        |share| format!("{} %", value::fixed(100.0 * share, 1)),
                    ),
                ])
                .collect()
        };
        (head, self.differences.iter().map(line))
    }

    /// Short name with the unit of the parameter along the axis.
    pub fn axis_label(&self) -> &str {
        self.labels.last().map_or("", String::as_str)
    }

    /// What the tables mean.
    pub fn explanation(&self) -> String {
        format!(
            "Difference: {} minus a measured value; of another study, that study minus {0}. In per cent it is a share of what is subtracted. \
             Error: the known errors of both, combined as the root of the sum of their squares; \
             of a simulated μ* the standard error over its cycles, without that of mesh and time step. *: interpolated \
             between the two neighbours on the axis. The values here have more digits than the error of mesh and time step \
             leaves.",
            self.reference
        )
    }
}

impl Difference {
    /// How far the simulation is above a measured value; of two studies, how far this one is above the reference.
    pub fn difference(&self) -> f64 {
        if self.is_measured { self.reference - self.value } else { self.value - self.reference }
    }

    pub fn combined_error(&self) -> Option<f64> {
        match (self.error, self.reference_error) {
            (None, None) => None,
            (a, b) => Some(a.unwrap_or(0.0).hypot(b.unwrap_or(0.0))),
        }
    }
}

impl Matches {
    /// That no point has a counterpart, in a sentence; none if one has.
    fn none_in_words(&self, source: &str, reference: &str) -> Option<String> {
        (self.equal + self.between == 0 && self.elsewhere > 0).then(|| {
            format!(
                "no point of {source} is at the parameters of a job of {reference}, or between two of its jobs: nothing of {source} is \
                 compared"
            )
        })
    }

    /// That some points have no counterpart, in a sentence; none if all have one.
    fn some_in_words(&self, source: &str, reference: &str) -> Option<String> {
        (self.elsewhere > 0).then(|| {
            format!(
                "{} of the {} points of {source} {} compared with nothing: no finished job of {reference} is at their parameters, or on both sides of \
                 them",
                self.elsewhere,
                self.equal + self.between + self.elsewhere,
                if self.elsewhere == 1 { "is" } else { "are" }
            )
        })
    }

    /// How many values of a quantity have a counterpart without this quantity, in a sentence; none if all have one with it.
    fn values_in_words(&self, scalar: &Scalar, source: &str, reference: &str) -> Option<String> {
        let values = self.without_value.iter().filter(|own| **own == scalar).count();
        (values > 0).then(|| {
            let (verb, place) = if values == 1 { ("is", "its place") } else { ("are", "their places") };
            let why = if [MU_STAR, FREQUENCY].contains(&scalar) {
                ", because it slides steadily, is not periodic, or has modes alone"
            } else {
                ""
            };
            format!(
                "{} of {} in {source} {verb} compared with nothing: a job of {reference} at {place}, or on one side, has no such value{why}",
                value::count(values, "value"),
                scalar.name
            )
        })
    }

    fn in_words(
        &self,
        source: &str,
        reference: &super::layout::Source,
        is_measured: bool,
        of_reference: usize,
    ) -> Vec<String> {
        let Self { equal, between, elsewhere, .. } = *self;
        let all = equal + between + elsewhere;
        let mut words = Vec::new();
        if equal < all {
            let verb = |count: usize, one, several| if count == 1 { one } else { several };
            words.push(format!(
                "{equal} of the {all} points of {source} {} at the parameters of a job of {3}; {between} {} between two jobs of \
                 {3}, and {elsewhere} {} no counterpart there.",
                verb(equal, "is", "are"),
                verb(between, "is", "are"),
                verb(elsewhere, "has", "have"),
                reference.name
            ));
        }
        if !is_measured && equal < of_reference {
            words.push(format!(
                "{} of the {of_reference} jobs of {} have no counterpart in {source}.",
                of_reference - equal,
                reference.name
            ));
        }
        words
    }
}

/// Largest number of contradictions in a list. All of them are in `differences.csv`.
const MAX_CONTRADICTIONS: usize = 20;
