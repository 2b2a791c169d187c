//! What a study that grows has found: boundaries, minima, branches and basins.

use super::calibration::Calibration;
use super::findings_table::FindingsTable;
use super::parameters;
use crate::analysis::{JobRecord, Outcome, Regime};
use crate::publish::table::{Column, FileColumns, Table};
use crate::publish::value;
use indexmap::IndexMap;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A boundary between two kinds of jobs along a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// The other parameters.
    pub rest: Vec<(String, Value)>,
    /// The parameter along which the kind changes.
    pub over: String,
    /// The kinds on the side of small values and on that of large ones.
    pub between: [String; 2],
    /// The nearest values that are known on both sides.
    pub range: [f64; 2],
    /// The width that was asked for.
    pub wanted: f64,
}

/// The smallest value of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// The other parameters.
    pub rest: Vec<(String, Value)>,
    /// The parameter along the curve.
    pub over: String,
    /// The quantity.
    pub of: String,
    /// Where it is.
    pub at: f64,
    /// The smallest value.
    pub value: f64,
    /// The next points on both sides; none at an end of the curve.
    pub neighbours: [Option<f64>; 2],
    /// The distance of the neighbours that was asked for.
    pub wanted: f64,
    /// Whether the values of the curve differ by no more than the error that was asked for.
    pub is_flat: bool,
}

/// How a job that continues others, or is continued, ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Endpoint {
    /// Macroscopic friction coefficient.
    pub mu_star: f64,
    /// Its standard error.
    pub mu_star_se: f64,
    /// Frequency \[Hz\] of a limit cycle; none for stable sliding.
    pub frequency_hz: Option<f64>,
    /// The contact regime.
    pub regime: &'static str,
    /// Whether it is a limit cycle or stable sliding: no other state can be compared.
    pub is_settled: bool,
}

/// Ends whose μ\* differ by less than this share are those of one limit cycle: less than a tenth of the distance of the two limit cycles
/// at 7 rpm (docs/evidence/growing.md), and several times what the detection of a limit cycle leaves open.
const SAME_MU_STAR: f64 = 0.003;

/// Likewise for frequencies.
const SAME_FREQUENCY: f64 = 0.005;

impl Endpoint {
    /// The end of a job with this record.
    pub fn of(record: &JobRecord) -> Self {
        Self {
            mu_star: record.mu_star,
            mu_star_se: record.mu_star_se,
            frequency_hz: record.frequency_hz,
            regime: record.regime.name(),
            is_settled: matches!(record.outcome, Outcome::Periodic | Outcome::Decayed),
        }
    }

    /// Whether two jobs ended in the same limit cycle, or both in stable sliding.
    pub fn is_same(&self, other: &Self) -> bool {
        let is_near = |a: f64, b: f64, share: f64| (a - b).abs() <= share * a.abs().max(b.abs());
        let se = 3.0 * (self.mu_star_se + other.mu_star_se);
        let mu_star =
            is_near(self.mu_star, other.mu_star, SAME_MU_STAR) || (self.mu_star - other.mu_star).abs() <= se;
        let frequency = match (self.frequency_hz, other.frequency_hz) {
            (Some(a), Some(b)) => is_near(a, b, SAME_FREQUENCY),
            (None, None) => true,
            _ => false,
        };
        self.is_settled && other.is_settled && mu_star && frequency
    }
}

/// A point that was reached on two ways.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// All parameters.
    pub parameters: Vec<(String, Value)>,
    /// The end on the way up, if it is known.
    pub up: Option<Endpoint>,
    /// The end on the way down, if it is known.
    pub down: Option<Endpoint>,
}

impl BranchPoint {
    /// Whether the two ways ended in different states; none if that is not known.
    pub fn has_hysteresis(&self) -> Option<bool> {
        let (up, down) = (self.up.as_ref()?, self.down.as_ref()?);
        (up.is_settled && down.is_settled).then(|| !up.is_same(down))
    }
}

/// One of the states in which jobs ended that were kicked from one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Basin {
    /// The parameters of the point.
    pub parameters: Vec<(String, Value)>,
    /// The mean of its ends; none for runs that failed or did not settle.
    pub end: Option<Endpoint>,
    /// Jobs that ended in it.
    pub jobs: u64,
    /// All jobs of the point that were kicked and have ended.
    pub of: u64,
}

/// Two standard deviations of a normal distribution, nearly: 95 %.
const Z: f64 = 1.959_964;

impl Basin {
    /// The share of the kicks that ended in it, and its 95 % confidence interval (Wilson 1927).
    pub fn share(&self) -> [f64; 3] {
        let (n, p) = (self.of as f64, self.jobs as f64 / self.of as f64);
        let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        [p, (centre - half).max(0.0), (centre + half).min(1.0)]
    }
}

/// The states in which `ends` ended, the most frequent first. `ends` has none for a job that failed.
pub fn basins(parameters: &[(String, Value)], ends: &[Option<Endpoint>]) -> Vec<Basin> {
    let mut groups: Vec<Vec<&Endpoint>> = Vec::new();
    let mut others = 0;
    for end in ends {
        let Some(end) = end.as_ref().filter(|end| end.is_settled) else {
            others += 1;
            continue;
        };
        // An end that belongs to several groups joins them.
        let (own, rest): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.iter().any(|other| other.is_same(end)));
        groups = rest;
        groups.push(own.into_iter().flatten().chain([end]).collect());
    }
    let basin = |end: Option<Endpoint>, jobs: usize| Basin {
        parameters: parameters.to_vec(),
        end,
        jobs: jobs as u64,
        of: ends.len() as u64,
    };
    let mean = |group: &[&Endpoint]| {
        let mean = |value: &dyn Fn(&Endpoint) -> f64| {
            group.iter().map(|end| value(end)).sum::<f64>() / group.len() as f64
        };
        let frequency_hz = group[0].frequency_hz.map(|_| mean(&|end| end.frequency_hz.unwrap_or(0.0)));
        Endpoint {
            mu_star: mean(&|end| end.mu_star),
            mu_star_se: mean(&|end| end.mu_star_se),
            frequency_hz,
            ..group[0].clone()
        }
    };
    let mut found: Vec<Basin> = groups.iter().map(|group| basin(Some(mean(group)), group.len())).collect();
    found.sort_by(|a, b| {
        let mu_star = |basin: &Basin| basin.end.as_ref().map_or(0.0, |end| end.mu_star);
        b.jobs.cmp(&a.jobs).then(mu_star(a).total_cmp(&mu_star(b)))
    });
    found.extend((others > 0).then(|| basin(None, others)));
    found
}

/// What a study that grows has found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    /// The jobs that each wave has added, by their purposes; the first entry is the first wave.
    pub waves: Vec<BTreeMap<String, u64>>,
    /// Where the plan is, in words.
    pub state: String,
    /// Boundaries between kinds of jobs.
    pub crossings: Vec<Crossing>,
    /// Minima of curves.
    pub minima: Vec<Minimum>,
    /// Points that were reached on two ways.
    pub branches: Vec<BranchPoint>,
    /// States that were reached from single points.
    pub basins: Vec<Basin>,
    /// What measured points say about free parameters.
    pub calibration: Option<Calibration>,
}

/// Columns of the parameters of points: those that any of the points has.
fn places<T: 'static>(points: &[T], place: fn(&T) -> Vec<(String, Value)>) -> Vec<Column<T>> {
    let mut names: Vec<String> = Vec::new();
    for (name, _) in points.iter().flat_map(place) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let column = |name: String| {
        let head = parameters::head(&name);
        let of_name = move |point: &T| place(point).into_iter().find(|(own, _)| *own == name);
        Column::made(head, move |point| of_name(point).map(|(_, value)| value).into())
    };
    names.into_iter().map(column).collect()
}

/// The jobs that a wave added, with its number.
type Wave = (usize, BTreeMap<String, u64>);

const WAVES: [Column<Wave>; 3] = [
    Column::new("wave", "", "number of the wave, from 1", |(number, _)| (*number).into()),
    Column::new("jobs", "", "jobs that it added", |(_, purposes)| purposes.values().sum::<u64>().into()),
    Column::new("why", "", "what they are for", |(_, purposes)| {
        let words: Vec<_> = purposes.iter().map(|(purpose, jobs)| format!("{purpose}: {jobs}")).collect();
        words.join(", ").into()
    }),
];

#[rustfmt::skip]
const BOUNDARIES: [Column<Crossing>; 8] = [
    Column::new("over", "", "parameter along which the boundary was looked for; its own column has the middle", |own| own.over.as_str().into()),
    Column::new("below", "", "kind of the job below the boundary", |own| own.between[0].as_str().into()),
    Column::new("above", "", "kind of the job above it", |own| own.between[1].as_str().into()),
    Column::new("from", "that of the parameter", "value of the parameter below", |own| own.range[0].into()),
    Column::new("to", "that of the parameter", "value above", |own| own.range[1].into()),
    Column::new("middle", "that of the parameter", "half-way between the two", Crossing::middle),
    Column::new("plus_minus", "that of the parameter", "half of their distance", |own| value::significant_number(0.5 * own.width(), 2)),
    Column::new("known", "", "whether the boundary is known as well as it was asked for", |own| yes_or_no(own.is_known())),
];

#[rustfmt::skip]
const MINIMA: [Column<Minimum>; 7] = [
    Column::new("of", "", "quantity", |own| own.of.as_str().into()),
    Column::new("over", "", "parameter along the curve", |own| own.over.as_str().into()),
    Column::new("at", "that of the parameter", "where the smallest value was found", |own| own.at.into()),
    Column::new("from", "that of the parameter", "its neighbour below; empty at the end of the curve", |own| own.neighbours[0].into()),
    Column::new("to", "that of the parameter", "its neighbour above", |own| own.neighbours[1].into()),
    Column::new("value", "that of the quantity", "the smallest value", |own| value::significant_number(own.value, 5)),
    Column::new("known", "", "yes, no, or flat if the curve varies by less than was asked for", |own| if own.is_flat { "flat".into() } else { yes_or_no(own.is_known()) }),
];

#[rustfmt::skip]
const BRANCHES: [Column<BranchPoint>; 7] = [
    Column::new("mu_star_up", "", "μ* on the way up", |own| mu_star(own.up.as_ref())),
    Column::new("frequency_up_hz", "Hz", "frequency on the way up", |own| frequency(own.up.as_ref())),
    Column::new("regime_up", "", "regime on the way up", |own| regime(own.up.as_ref())),
    Column::new("mu_star_down", "", "μ* on the way down", |own| mu_star(own.down.as_ref())),
    Column::new("frequency_down_hz", "Hz", "frequency on the way down", |own| frequency(own.down.as_ref())),
    Column::new("regime_down", "", "regime on the way down", |own| regime(own.down.as_ref())),
    Column::new("hysteresis", "", "whether the two ways ended in different states: yes, no, or not known", |own| {
        own.has_hysteresis().map_or_else(|| "not known".into(), yes_or_no)
    }),
];

#[rustfmt::skip]
const BASINS: [Column<Basin>; 8] = [
    Column::new("mu_star", "", "mean μ* of the ends; empty for runs that failed or did not settle", |own| mu_star(own.end.as_ref())),
    Column::new("frequency_hz", "Hz", "mean frequency of the ends", |own| frequency(own.end.as_ref())),
    Column::new("regime", "", "contact regime", |own| regime(own.end.as_ref())),
    Column::new("jobs", "", "jobs that ended in this state", |own| own.jobs.into()),
    Column::new("of", "", "all jobs of the point that have ended", |own| own.of.into()),
    Column::new("share", "", "their quotient", |own| value::significant_number(own.share()[0], 3)),
    Column::new("share_from", "", "lower end of the 95 % confidence interval of the share", |own| value::significant_number(own.share()[1], 3)),
    Column::new("share_to", "", "its upper end", |own| value::significant_number(own.share()[2], 3)),
];

/// Rounding errors in a distance do not count.
const NEARLY: f64 = 1.000_001;

fn yes_or_no(is_true: bool) -> Value {
    if is_true { "yes" } else { "no" }.into()
}

fn mu_star(end: Option<&Endpoint>) -> Value {
    end.map(|end| value::fixed_number(end.mu_star, 4)).into()
}

fn frequency(end: Option<&Endpoint>) -> Value {
    end.and_then(|end| end.frequency_hz).map(|hz| value::fixed_number(hz, 0)).into()
}

fn regime(end: Option<&Endpoint>) -> Value {
    let words = |end: &Endpoint| {
        if end.is_settled { end.regime.to_owned() } else { format!("{}, not periodic", end.regime) }
    };
    end.map(words).into()
}

impl Crossing {
    fn middle(&self) -> Value {
        value::significant_number(0.5 * (self.range[0] + self.range[1]), 6)
    }

    /// Whether it is known as well as was asked for.
    fn is_known(&self) -> bool {
        self.width() <= self.wanted * NEARLY
    }

    fn width(&self) -> f64 {
        self.range[1] - self.range[0]
    }

    /// All parameters; that along which the boundary was looked for is half-way.
    fn place(&self) -> Vec<(String, Value)> {
        self.rest.iter().cloned().chain([(self.over.clone(), self.middle())]).collect()
    }
}

impl Minimum {
    fn is_known(&self) -> bool {
        let mut sides = self.neighbours.iter().flatten().peekable();
        sides.peek().is_some() && sides.all(|x| (x - self.at).abs() <= self.wanted * NEARLY)
    }

    /// All parameters.
    fn place(&self) -> Vec<(String, Value)> {
        self.rest.iter().cloned().chain([(self.over.clone(), self.at.into())]).collect()
    }
}

/// The columns, for the page of columns.
pub(super) fn described() -> [FileColumns; 5] {
    [
        FileColumns::new(&["waves.csv"], "A line is a wave of jobs that the program added.", &WAVES),
        FileColumns::new(&["boundaries.csv"], "A line is a boundary between two kinds of jobs.", &BOUNDARIES),
        FileColumns::new(&["minima.csv"], "A line is the smallest value of a curve.", &MINIMA),
        FileColumns::new(&["branches.csv"], "A line is a point that was reached on two ways.", &BRANCHES),
        FileColumns::new(
            &["basins.csv"],
            "A line is a state in which jobs ended that were kicked from a point.",
            &BASINS,
        ),
    ]
}

impl Findings {
    /// The tables, without empty ones.
    pub(super) fn tables(&self) -> Vec<FindingsTable> {
        let tables = [
            FindingsTable {
                heading: "Waves",
                meaning: "The jobs that the program added to those of the study, and why.",
                table: self.waves_table(),
            },
            FindingsTable {
                heading: "Boundaries",
                meaning: "Where jobs of one kind have a neighbour of another kind. The boundary lies between the two values, at the \
                          middle plus or minus half of their distance; it is known if that distance is what the study asks for.",
                table: table("boundaries", &self.crossings, Crossing::place, &BOUNDARIES),
            },
            FindingsTable {
                heading: "Minima",
                meaning: "The smallest value of each curve. The minimum of a curve with one minimum lies between the neighbours; it is \
                          known if they are as near as the study asks for. There is no value beyond the ends of a \
                          curve, and where jobs failed. The minimum of a curve is not looked for if it is flat.",
                table: table("minima", &self.minima, Minimum::place, &MINIMA),
            },
            FindingsTable {
                heading: "Branches",
                meaning: "The state that each point reaches from its neighbour, on the way up and on the way down. There is hysteresis \
                          where the two are different limit cycles, or where one of them is stable sliding.",
                table: table("branches", &self.branches, |own| own.parameters.clone(), &BRANCHES),
            },
            FindingsTable {
                heading: "Basins",
                meaning: "The states in which the jobs ended that were kicked from each point, and their shares with 95 % \
                          confidence intervals (Wilson). A line without μ* has the runs that failed or did not settle.",
                table: table("basins", &self.basins, |own| own.parameters.clone(), &BASINS),
            },
        ];
        let own = self.calibration.iter().flat_map(Calibration::tables);
        tables.into_iter().filter(|found| !found.table.lines.is_empty()).chain(own).collect()
    }

    /// What was found, in sentences.
    pub(super) fn in_words(&self) -> Vec<String> {
        let mut kinds: IndexMap<(&str, [&str; 2]), Vec<&Crossing>> = IndexMap::new();
        for own in &self.crossings {
            kinds.entry((&own.over, own.between.each_ref().map(String::as_str))).or_default().push(own);
        }
        let boundary = |((over, [below, above]), own): ((&str, [&str; 2]), Vec<&Crossing>)| {
            let place = match &own[..] {
                [only] if only.rest.is_empty() => String::new(),
                [only] => format!(
                    " at {}",
                    parameters::assignments(only.rest.iter().map(|(name, value)| (&**name, value.clone())))
                ),
                several => format!(" in {} places", several.len()),
            };
            let least = own.iter().map(|one| one.range[0]).fold(f64::INFINITY, f64::min);
            let most = own.iter().map(|one| one.range[1]).fold(f64::NEG_INFINITY, f64::max);
            let [least, most] =
                [parameters::assignment(over, &least.into()), parameters::in_words(over, &most.into())];
            let open = own.iter().filter(|one| !one.is_known()).count();
            let open = match open {
                0 => String::new(),
                _ if own.len() == 1 => " (not yet as near as was asked for)".to_owned(),
                open => format!(" ({open} of them not yet as near as was asked for)"),
            };
            let [below, above] = [below, above].map(kind_in_words);
            format!("The boundary from {below} to {above} lies between {least} and {most}{place}{open}.")
        };
        let mut words: Vec<String> = kinds.into_iter().map(boundary).collect();
        let ways = || self.branches.iter().filter_map(BranchPoint::has_hysteresis);
        if ways().count() > 0 {
            let (with, all) = (ways().filter(|has| *has).count(), value::count(ways().count(), "point"));
            words.push(format!("The way up and the way down end in different states at {with} of {all}."));
        }
        words.extend(self.calibration.iter().flat_map(Calibration::in_words));
        words
    }

    fn waves_table(&self) -> Table {
        let waves: Vec<Wave> = (1..).zip(self.waves.iter().cloned()).collect();
        Table::of("waves", &WAVES, &waves)
    }

    /// The waves and the state of the plan, for a terminal.
    pub fn as_text(&self) -> String {
        let line = |line: Vec<String>| format!("wave {}, jobs: {} ({})\n", line[0], line[1], line[2]);
        let waves: String = self.waves_table().cells().into_iter().map(line).collect();
        format!("{waves}{}\n", self.state)
    }

    /// The same for programs.
    pub fn waves_json(&self) -> Value {
        let waves: Vec<Value> = self.waves.iter().map(|wave| json!(wave)).collect();
        json!({ "waves": waves, "state": self.state })
    }
}

/// The name of a kind of jobs for a reader.
fn kind_in_words(kind: &str) -> String {
    let regimes = [Regime::Stable, Regime::StickSlip, Regime::StickSlipSeparation, Regime::SlipSeparation];
    let regime = regimes.into_iter().find(|regime| regime.name() == kind);
    regime.map_or_else(|| kind.replace('_', " "), |regime| regime.label().to_owned())
}

/// Points with all their parameters and what was found there.
fn table<T: 'static>(
    stem: &'static str,
    points: &[T],
    place: fn(&T) -> Vec<(String, Value)>,
    own: &[Column<T>],
) -> Table {
    let columns: Vec<Column<T>> = places(points, place).into_iter().chain(own.iter().cloned()).collect();
    Table::of(stem, &columns, points)
}

#[cfg(test)]
mod tests {
    use super::{Endpoint, basins};

    fn end(mu_star: f64, frequency_hz: f64) -> Endpoint {
        let frequency_hz = Some(frequency_hz);
        Endpoint { mu_star, mu_star_se: 0.0, frequency_hz, regime: "stick_slip", is_settled: true }
    }

    /// Protects: ends are grouped by μ\* and frequency, runs that did not settle are counted by themselves, and shares have intervals
    /// that contain them (Wilson's of 8 of 10 are 0.490 and 0.943).
    #[test]
    fn ends_are_grouped_into_limit_cycles() {
        let mut ends: Vec<Option<Endpoint>> =
            (0..8).map(|i| Some(end(0.264 + 1e-4 * f64::from(i), 15e3))).collect();
        ends.push(Some(end(0.268, 15e3)));
        ends.push(None);
        let found = basins(&[], &ends);
        let jobs: Vec<u64> = found.iter().map(|basin| basin.jobs).collect();
        assert_eq!(jobs, [8, 1, 1]);
        assert!(found[2].end.is_none());
        let [share, low, high] = found[0].share();
        assert!(
            (share - 0.8).abs() < 1e-12 && (low - 0.490).abs() < 1e-3 && (high - 0.943).abs() < 1e-3,
            "{low} {high}"
        );
    }
}
