//! The points in groups, as figures and tables show them: branches over μ at each speed, and where they begin to grow.

use super::along::Along;
use super::onsets::{name_families, onsets_of, sort};
use super::ranges::{Edge, Interval, Known, Onset, Speed, bracket_by_neighbours, intervals};
use crate::analysis::ComplexMode;
use crate::analysis::branches::{Sample, branches};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::Parameters;
use crate::report::row::{JobRow, RowState};
use crate::report::stability_point::StabilityPoint;
use crate::report::view::View;
use crate::units::name_and_unit;
use indexmap::IndexMap;
use serde_json::Value;

/// The largest number of further modes that a note names.
const MOST_NAMED: usize = 3;

/// The points as rows, so that a [`Layout`] can group them. The key of a row is the number of its point. Parameters that move along
/// the way of the thresholds do not tell groups apart: the rows do not say them.
pub(in crate::report) fn rows(points: &[StabilityPoint], along: &Along) -> Vec<JobRow> {
    let kept = |point: &StabilityPoint| {
        let own = point.parameters.iter().filter(|(name, _)| !along.with.iter().any(|with| with == name));
        let own = own.map(|(name, value)| (name.to_owned(), value.clone()));
        Parameters::new(f64::NAN, f64::NAN, own.collect())
    };
    let row = |(number, point): (usize, &StabilityPoint)| JobRow {
        study: String::new(),
        job: number.to_string(),
        parameters: kept(point),
        has_one_mu: false,
        state: RowState::Pending,
        wall_s: None,
        numerics: None,
        wave: 0,
        why: None,
        inputs: Vec::new(),
    };
    points.iter().enumerate().map(row).collect()
}

/// What stands in place of a value that moves along the way.
pub(super) const MOVES: &str = "moves";

/// Points with their branches.
pub(in crate::report) struct Analysis<'a> {
    points: &'a [StabilityPoint],
    /// What thresholds are thresholds of.
    pub along: &'a Along,
    /// The parameter of the thresholds over the series, ω along the axis (or μ, if ω has thresholds), a group for each combination of
    /// the other parameters.
    pub layout: Layout<'a>,
    /// The modes of each group of the layout; none if the points are no series.
    pub groups: Vec<GroupModes>,
}

/// The modes of a group.
pub(in crate::report) struct GroupModes {
    /// By ascending ω.
    pub speeds: Vec<Speed>,
    /// The frequencies \[Hz\] of modes that grow and are alike at neighbouring speeds: the median of those at which they begin
    /// to grow. The family that grows at the smallest μ comes first.
    pub families: Vec<f64>,
}

impl<'a> Analysis<'a> {
    /// Analyses points, whose rows are `rows`.
    pub fn of(points: &'a [StabilityPoint], rows: &'a [JobRow], along: &'a Along, view: &View) -> Self {
        let view = View {
            x: Some(along.across().to_owned()),
            by: Some(along.parameter.clone()),
            descriptions: view.descriptions.clone(),
            ..View::DEFAULT
        };
        let layout = Layout::of(rows, &view);
        if !layout.scattered.is_empty() {
            let layout = layout.on_true_axes().unwrap_or(layout);
            return Self { points, along, layout, groups: Vec::new() };
        }
        let groups = layout.groups.iter().map(|group| group_modes(points, along, group)).collect();
        Self { points, along, layout, groups }
    }

    /// Whether points differ in the parameter of the thresholds alone, so that there can be thresholds. Drawn points do not.
    pub fn has_series(&self) -> bool {
        !self.groups.is_empty()
    }

    /// The number of points at which a mode grows.
    pub fn unstable_points(&self) -> usize {
        let grows = |point: &&StabilityPoint| point.leading().is_some_and(ComplexMode::grows);
        self.points.iter().filter(grows).count()
    }

    /// All points.
    pub fn points(&self) -> &'a [StabilityPoint] {
        self.points
    }

    /// The point of a row.
    pub fn point(&self, row: &JobRow) -> &'a StabilityPoint {
        point_of(self.points, row)
    }

    /// The value of a series on the other axis, without the name of the parameter.
    pub fn across_in_words(&self, speed: &Speed) -> String {
        let across = self.along.across();
        if self.along.moves(across) {
            return MOVES.to_owned();
        }
        self.layout.dimension(across).text(&speed.omega)
    }

    /// Of a series: the place at which sliding becomes unstable first, the ranges in which it is unstable, the frequency of the mode
    /// that grows first, and what else there is to say.
    pub fn words(&self, speed: &Speed) -> [String; 4] {
        let frequency = speed.intervals.first().map(|interval| value::quantity(interval.frequency_hz, "Hz"));
        let frequency = frequency.unwrap_or_else(|| value::MISSING.to_owned());
        let (_, unit) = name_and_unit(&self.along.parameter);
        [speed.threshold_in_words(unit), speed.intervals_in_words(unit), frequency, self.note(speed)]
    }

    fn note(&self, speed: &Speed) -> String {
        let mut words = Vec::new();
        let value_of = |x: f64| self.layout.dimension(&self.along.parameter).near(x);
        match speed.intervals.as_slice() {
            _ if speed.mus[0] >= speed.mus[1] => {}
            [] if !speed.without_modes.is_empty() => {}
            [] => words.push(format!("{} up to {}", speed.known.no_growth(), value_of(speed.mus[1]))),
            [first, ..] => {
                if matches!(first.from, Edge::Outside(_)) {
                    words.push("unstable at the smallest value already".to_owned());
                }
                if let Some(Interval { to: Edge::At(end), .. }) = speed.intervals.last() {
                    let (_, unit) = name_and_unit(&self.along.parameter);
                    let last = value::quantity(speed.mus[1], unit);
                    words.push(format!("{} from {} to {last}", speed.known.no_growth(), value_of(*end)));
                }
                if !first.is_converged {
                    words.push("not converged".to_owned());
                }
                if matches!(first.from, Edge::At(_)) && speed.lowest().is_some_and(|onset| !onset.is_followed)
                {
                    words.push(
                        "the mode was not followed through its threshold, whose mesh error is not known"
                            .to_owned(),
                    );
                }
            }
        }
        if !speed.without_modes.is_empty() {
            let name = self.layout.dimension(&self.along.parameter).symbol();
            let (_, unit) = name_and_unit(&self.along.parameter);
            let places = speed.without_modes.iter().map(|at| value::quantity(*at, unit)).collect::<Vec<_>>();
            let places = places.join(", ");
            words.push(format!(
                "no mode was found at {name} = {places}: whether sliding is stable there is not known"
            ));
        }
        if !speed.shared.is_empty() {
            let places = speed.shared.iter().map(|at| value_of(*at)).collect::<Vec<_>>().join(", ");
            words.push(format!(
                "several points have {places}, because {} there",
                self.along.with_in_words("changes", "change")
            ));
        }
        // The other modes, each where it begins to grow for the first time.
        let first = speed.onsets.first().map(|onset| onset.branch);
        let perhaps_older = speed.perhaps_older();
        let mut more: IndexMap<usize, String> = IndexMap::new();
        let mut unsure: IndexMap<usize, String> = IndexMap::new();
        for onset in speed.onsets.iter().filter(|onset| Some(onset.branch) != first) {
            // Only the changes of the fastest growing mode are narrowed down.
            let words = || {
                let about = if onset.below.is_some() { "about " } else { "" };
                let end = onset.ends.as_ref();
                let end = end.map_or_else(String::new, |end| format!(" to about {}", value_of(end.at)));
                let frequency = value::quantity(onset.frequency_hz, "Hz");
                format!("{frequency} from {about}{}{end}", value_of(onset.mu))
            };
            let list = if perhaps_older.contains(&onset.branch) { &mut unsure } else { &mut more };
            list.entry(onset.branch).or_insert_with(words);
        }
        if !more.is_empty() {
            let verb = if more.len() == 1 { "grows, too" } else { "grow, too" };
            let named: Vec<&str> = more.values().take(MOST_NAMED).map(String::as_str).collect();
            let rest = if more.len() > MOST_NAMED { ", …" } else { "" };
            let count = value::count(more.len() as u32, "more mode");
            words.push(format!("{count} {verb}: {}{rest}", named.join(", ")));
        }
        if !unsure.is_empty() {
            let named: Vec<&str> = unsure.values().take(MOST_NAMED).map(String::as_str).collect();
            words.push(format!("perhaps the same mode, which could not be followed: {}", named.join(", ")));
        }
        words.join("; ")
    }

    /// Which parameter the thresholds belong to, in a sentence, if it is not μ alone.
    pub fn along_in_words(&self) -> Option<String> {
        let Along { parameter, with } = self.along;
        let together = if with.is_empty() {
            String::new()
        } else {
            format!("; {} with it", self.along.with_in_words("moves", "move"))
        };
        (!self.along.is_mu() || !with.is_empty())
            .then(|| format!("Thresholds are those of {parameter}, which this study varies{together}."))
    }
}

fn point_of<'a>(points: &'a [StabilityPoint], row: &JobRow) -> &'a StabilityPoint {
    // The rows are those of these points.
    &points[row.job.parse::<usize>().unwrap_or_default()]
}

fn group_modes(points: &[StabilityPoint], along: &Along, group: &Group) -> GroupModes {
    let of_speed = |(index, omega): (usize, &Value)| {
        let own = group.jobs.iter().filter(|job| job.axis_index == index);
        let mut own: Vec<&StabilityPoint> = own.map(|job| point_of(points, job.row)).collect();
        // Of two results at one μ that of the grid counts.
        own.sort_by_key(|point| !point.on_grid);
        speed(omega, along, &own)
    };
    let mut speeds: Vec<Speed> = group.axis_values.iter().enumerate().map(of_speed).collect();
    let families = name_families(&mut speeds);
    GroupModes { speeds, families }
}

fn speed(omega: &Value, along: &Along, points: &[&StabilityPoint]) -> Speed {
    let place = |point: &StabilityPoint| point.parameter(&along.parameter).as_f64().unwrap_or(f64::NAN);
    let moved = |point: &StabilityPoint| {
        let with = along.with.iter().map(|name| value::text(&point.parameter(name)));
        (place(point).to_bits(), with.collect::<Vec<_>>())
    };
    let mut known = std::collections::HashSet::new();
    let points: Vec<&StabilityPoint> =
        points.iter().copied().filter(|point| known.insert(moved(point))).collect();
    let mut sorted: Vec<(f64, &StabilityPoint)> = points.iter().map(|point| (place(point), *point)).collect();
    Along::sort(&mut sorted, |point| point.on_grid);
    let sample = |&(mu, point): &(f64, &StabilityPoint)| Sample { mu, modes: point.stability.modes.clone() };
    let mus = sorted.iter().map(|(at, _)| *at);
    let mus = mus.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], mu| [low.min(mu), high.max(mu)]);
    let branches = branches(&sorted.iter().map(sample).collect::<Vec<_>>());
    let mut onsets: Vec<Onset> =
        branches.iter().enumerate().flat_map(|(number, branch)| onsets_of(number, branch)).collect();
    let leading: Vec<(f64, Option<ComplexMode>)> =
        sorted.iter().map(|(at, point)| (*at, point.leading().copied())).collect();
    bracket_by_neighbours(&mut onsets, &leading);
    sort(&mut onsets, &branches);
    let without_modes = sorted.iter().filter(|(_, point)| point.stability.modes.is_empty());
    let without_modes = without_modes.map(|(at, _)| *at).collect();
    let mut shared: Vec<f64> =
        sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[0].0).collect();
    shared.dedup();
    let known = Known::of_stable(&points);
    let intervals = intervals(&leading, &onsets);
    Speed { omega: omega.clone(), mus, branches, onsets, intervals, without_modes, shared, known }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{AboveBand, SlidingStability, UnknownError};
    use crate::report::figure::StabilityPlot::{LockIn, Map, Thresholds};
    use crate::report::figure::stability_figures;

    fn of(omega_rpm: f64, mu: f64, further: &[(&str, f64)]) -> Parameters {
        let further = further.iter().map(|(name, value)| ((*name).to_owned(), (*value).into()));
        Parameters::new(omega_rpm, mu, further.collect())
    }

    fn point(omega_rpm: f64, mu: f64, modes: &[(f64, f64)]) -> StabilityPoint {
        let mode = |&(frequency_hz, growth_rate_per_s): &(f64, f64)| {
            ComplexMode::of(frequency_hz, growth_rate_per_s)
        };
        let modes = modes.iter().map(mode).collect();
        let stability = SlidingStability { mu_star: mu, modes, ..SlidingStability::example() };
        StabilityPoint {
            parameters: of(omega_rpm, mu, &[]),
            on_grid: true,
            stands_alone: Some(UnknownError::NoCoarserMesh),
            stability,
        }
    }

    /// Protects: modes of neighbouring speeds with nearly the same frequency are one family, the one with the smallest threshold
    /// comes first, and a speed without a growing mode says up to which μ it is stable, or that this is not known because a point
    /// has no modes.
    #[test]
    fn families_and_thresholds() {
        let points = [
            point(1.0, 0.1, &[(10_000.0, -10.0), (20_000.0, 5.0)]),
            point(1.0, 0.3, &[(10_000.0, 10.0), (20_000.0, 10.0)]),
            point(2.0, 0.1, &[(10_100.0, -30.0), (20_100.0, -5.0)]),
            point(2.0, 0.3, &[(10_100.0, 10.0), (20_100.0, 5.0)]),
            point(4.0, 0.1, &[(10_200.0, -30.0)]),
            point(4.0, 0.3, &[(10_200.0, -10.0)]),
            point(8.0, 0.1, &[(10_200.0, -30.0)]),
            point(8.0, 0.3, &[]),
        ];
        let along = Along::mu();
        let rows = rows(&points, &along);
        let found = Analysis::of(&points, &rows, &along, &View::DEFAULT);
        let group = &found.groups[0];
        assert_eq!(group.families, [20_100.0, 10_100.0]);
        let words: Vec<String> = group.speeds.iter().map(|speed| speed.threshold_in_words("")).collect();
        assert_eq!(words, ["≤ 0.1", "0.2", "> 0.3", value::MISSING]);
        let notes: Vec<String> = group.speeds.iter().map(|speed| found.note(speed)).collect();
        assert_eq!(notes[2], "no mode below 50 kHz grows up to μ = 0.3");
        assert_eq!(notes[3], "no mode was found at μ = 0.3: whether sliding is stable there is not known");
        let families: Vec<Vec<usize>> = group
            .speeds
            .iter()
            .map(|speed| speed.onsets.iter().map(|onset| onset.family).collect())
            .collect();
        assert_eq!(families, [vec![0, 1], vec![0, 1], vec![], vec![]]);
        assert_eq!(group.speeds[1].onsets[0].frequency_hz, 20_100.0);
        let ranges: Vec<String> = group.speeds.iter().map(|speed| speed.intervals_in_words("")).collect();
        assert_eq!(ranges, ["≤ 0.1 to ≥ 0.3", "0.2 to ≥ 0.3", "none", value::MISSING]);
        assert_eq!(found.along_in_words(), None);
    }

    /// Protects: a mode that changes too much to be followed is not counted as one more that grows, also beside another one. If both grow at
    /// one point, or if the first one has ceased to grow, it is another.
    #[test]
    fn a_lost_mode_is_no_further_one() {
        let lost = "perhaps the same mode, which could not be followed: 11 kHz from μ = 0.3";
        let note = |points: &[(f64, &[(f64, f64)])]| {
            let points: Vec<StabilityPoint> =
                points.iter().map(|(mu, modes)| point(1.0, *mu, modes)).collect();
            let along = Along::mu();
            let rows = rows(&points, &along);
            let found = Analysis::of(&points, &rows, &along, &View::DEFAULT);
            found.note(&found.groups[0].speeds[0])
        };
        let begins = [(0.1, &[(10_000.0, -10.0)][..]), (0.2, &[(10_000.0, 10.0)][..])];
        let of = |rest: &[(f64, &[(f64, f64)])]| note(&[&begins[..], rest].concat());
        assert_eq!(of(&[(0.3, &[(11_000.0, 30.0)])]), lost);
        let both = of(&[(0.3, &[(11_000.0, 30.0), (10_000.0, 20.0)])]);
        assert_eq!(both, "1 more mode grows, too: 11 kHz from μ = 0.3");
        let other = of(&[(0.3, &[(10_000.0, -30.0)]), (0.4, &[(11_000.0, 30.0), (10_000.0, -40.0)])]);
        assert_eq!(other, "1 more mode grows, too: 11 kHz from about μ = 0.35");
        let beside = note(&[
            (0.1, &[(10_000.0, -10.0), (40_000.0, -10.0)]),
            (0.2, &[(10_000.0, 10.0), (40_000.0, 10.0)]),
            (0.3, &[(11_000.0, 30.0), (40_000.0, 30.0)]),
        ]);
        assert_eq!(beside, format!("1 more mode grows, too: 40 kHz from about μ = 0.15; {lost}"));
    }

    /// Protects: a mode that is known from some point on, before which no mode grows, has its threshold between the two, and says that it was not followed. Beside another mode that grows, or at the smallest value, it has none.
    #[test]
    fn a_mode_that_appears_has_a_threshold() {
        let points: Vec<StabilityPoint> = [
            (0.1, &[(10_000.0, -10.0)][..]),
            (0.2, &[(10_000.0, -10.0), (30_000.0, 30.0)][..]),
            (0.3, &[(30_000.0, 40.0), (50_000.0, 10.0)][..]),
        ]
        .into_iter()
        .map(|(mu, modes)| point(1.0, mu, modes))
        .collect();
        let along = Along::mu();
        let rows = rows(&points, &along);
        let found = Analysis::of(&points, &rows, &along, &View::DEFAULT);
        let speed = &found.groups[0].speeds[0];
        assert_eq!(speed.threshold_in_words(""), "0.125");
        let known: Vec<_> =
            speed.onsets.iter().map(|onset| (onset.below, onset.above, onset.is_followed)).collect();
        assert_eq!(known, [(Some(0.1), 0.2, false), (None, 0.3, false)]);
        assert!(found.note(speed).starts_with("the mode was not followed through its threshold"));
    }

    /// Protects: of two modes that grow at the first value already, the row, its note and the first sentence of the page name the faster one
    /// first, and the note the other.
    #[test]
    fn of_modes_that_grow_from_the_beginning_the_fastest_is_named() {
        let points = [
            point(1.0, 0.1, &[(30_000.0, 900.0), (6_000.0, 3.0)]),
            point(1.0, 0.2, &[(6_000.0, -3.0), (30_000.0, -10.0)]),
        ];
        let along = Along::mu();
        let rows = rows(&points, &along);
        let found = Analysis::of(&points, &rows, &along, &View::DEFAULT);
        let speed = &found.groups[0].speeds[0];
        assert_eq!(found.words(speed)[2], "30 kHz");
        assert_eq!(speed.lowest().map(|onset| onset.frequency_hz), Some(30_000.0));
        assert!(
            found.note(speed).ends_with("1 more mode grows, too: 6 kHz from μ = 0.1 to about μ = 0.15"),
            "{}",
            found.note(speed)
        );
    }

    /// Protects: thresholds are those of the parameter that is varied, in a zip with all that move with it, and the table says so.
    /// Sliding that is unstable at small values and stable at large ones gets its range, not a threshold.
    #[test]
    fn thresholds_of_a_zip_are_along_it() {
        let at = |modulus_pa: f64, rate: f64| {
            let mut point = point(7.0, 0.3, &[(10_000.0, rate)]);
            point.parameters =
                of(7.0, 0.3, &[("young_modulus_pa", modulus_pa), ("load_n", 1.0e-8 * modulus_pa)]);
            point.stability.above_band = AboveBand::Damped;
            point
        };
        let points = [at(1.0e9, 30.0), at(2.0e9, 10.0), at(3.0e9, -10.0), at(4.0e9, -20.0)];
        let along = Along { parameter: "young_modulus_pa".to_owned(), with: vec!["load_n".to_owned()] };
        let (table, notes) = super::super::thresholds_table(&points, &along);
        let names: Vec<&str> = table.names().collect();
        assert_eq!(names, ["omega_rpm", "young_modulus_pa_c", "unstable", "frequency", "note"]);
        assert_eq!(table.lines.len(), 1);
        let line: Vec<String> = table.lines[0].iter().map(value::text).collect();
        assert_eq!(line[1..3], ["≤ 1 GPa", "≤ 1 GPa to 2.5 GPa"]);
        assert!(line[4].contains("stable from young_modulus = 2.5 GPa to 4 GPa"), "{}", line[4]);
        let said = "Thresholds are those of young_modulus_pa, which this study varies; load_n moves with it.";
        assert_eq!(notes, [said]);
    }

    /// Protects: drawn points, which differ in several parameters, are no series. They have no thresholds and no lock-in, because a mode
    /// of one point is not that of the next. With ω and μ alone they have a map.
    #[test]
    fn drawn_points_have_no_thresholds() {
        let drawn = |k: u32| {
            let mu = 0.1 + 0.05 * f64::from(k);
            let omega_rpm = 7.0 + f64::from(k % 5);
            let mut point = point(omega_rpm, mu, &[(10_000.0, f64::from(k) - 3.5)]);
            point.parameters = of(omega_rpm, mu, &[("load_n", f64::from(20 + 7 * k % 11))]);
            point
        };
        let mut points: Vec<StabilityPoint> = (0..8).map(drawn).collect();
        for has_load in [true, false] {
            let along = Along::mu();
            let rows = rows(&points, &along);
            let found = Analysis::of(&points, &rows, &along, &View::DEFAULT);
            assert!(!found.has_series());
            assert_eq!(found.unstable_points(), 4);
            let drawn = |plot| stability_figures(&points, &along, &View::DEFAULT, plot).len();
            assert_eq!([LockIn, Thresholds, Map].map(drawn), [0, 0, usize::from(!has_load)]);
            for (k, point) in points.iter_mut().enumerate() {
                point.parameters = of(7.0 + k as f64, point.parameters.mu(), &[]);
            }
        }
    }

    /// Protects: along a zip that moves μ and ω there is one series. Thresholds are those of μ or of ω, each with all its ranges.
    #[test]
    fn a_zip_may_move_both() {
        let points = [-10.0, 10.0, 20.0, -20.0, -30.0, 30.0].into_iter().enumerate().map(|(k, rate)| {
            let mut point = point(5.0 + k as f64, 0.1 * (k + 1) as f64, &[(10_000.0, rate)]);
            point.stability.above_band = AboveBand::Damped;
            point
        });
        let points: Vec<StabilityPoint> = points.collect();
        for (parameter, with, expected) in [
            ("mu", "omega_rpm", ["omega_rpm", "mu_c", "0.15", "0.15 to 0.35; 0.55 to ≥ 0.6"]),
            ("omega_rpm", "mu", ["mu", "omega_rpm_c", "5.5 rpm", "5.5 rpm to 7.5 rpm; 9.5 rpm to ≥ 10 rpm"]),
        ] {
            let along = Along { parameter: parameter.to_owned(), with: vec![with.to_owned()] };
            let (table, notes) = super::super::thresholds_table(&points, &along);
            assert_eq!(table.lines.len(), 1, "{table:?}");
            let line: Vec<String> = table.lines[0].iter().map(value::text).collect();
            let heads: Vec<&str> = table.names().collect();
            assert_eq!([heads[0], heads[1], &line[1], &line[2]], expected);
            assert_eq!(line[0], "moves");
            let said = format!(
                "Thresholds are those of {parameter}, which this study varies; {with} moves with it."
            );
            assert_eq!(notes, [said]);
        }
    }

    /// Protects: no point of a zip is left out where a value is there twice. Sliding becomes unstable there if it does so between the two.
    #[test]
    fn points_that_share_a_value_both_count() {
        let at = |mu: f64, load_n: f64, rate: f64| {
            let mut point = point(7.0, mu, &[(10_000.0, rate)]);
            point.parameters = of(7.0, mu, &[("load_n", load_n)]);
            point
        };
        let mut points =
            vec![at(0.1, 10.0, -10.0), at(0.3, 30.0, -5.0), at(0.3, 50.0, 5.0), at(0.5, 70.0, 9.0)];
        let along = Along { parameter: "mu".to_owned(), with: vec!["load_n".to_owned()] };
        for _ in 0..2 {
            let (table, _) = super::super::thresholds_table(&points, &along);
            let line: Vec<String> = table.lines[0].iter().map(value::text).collect();
            assert_eq!(line[1..4], ["0.3", "0.3 to ≥ 0.5", "10 kHz"]);
            assert!(
                line[4].contains("several points have μ = 0.3, because load_n changes there"),
                "{}",
                line[4]
            );
            points.reverse();
        }
        // Two results of one point are one.
        points.push(at(0.1, 10.0, 30.0));
        let (table, _) = super::super::thresholds_table(&points, &along);
        assert_eq!(table.lines[0][1], "0.3");
    }
}
