//! What a study that grows has found: boundaries, minima, branches and basins.

use super::export::io_error;
use crate::analysis::{JobRecord, Outcome};
use crate::publish::page::Grid;
use crate::publish::value;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io;

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
/// at 7 rpm (docs/growing.md), and several times what the detection of a limit cycle leaves open.
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
    /// The share of the kicks that ended in it, and the interval that has the true share with 95 % (Wilson 1927).
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
}

/// A table of findings.
pub(super) struct FindingsTable {
    /// The name of its file of data, without the ending.
    pub stem: &'static str,
    pub heading: &'static str,
    pub meaning: &'static str,
    pub header: Vec<String>,
    pub lines: Vec<Vec<String>>,
}

/// Names of the parameters of the first entry, as heads of columns.
fn names(parameters: Option<&Vec<(String, Value)>>) -> Vec<String> {
    parameters.into_iter().flatten().map(|(name, _)| name.clone()).collect()
}

fn values(parameters: &[(String, Value)]) -> Vec<String> {
    parameters.iter().map(|(_, value)| value::text(value)).collect()
}

fn header(parameters: Vec<String>, own: &[&str]) -> Vec<String> {
    parameters.into_iter().chain(own.iter().map(|name| (*name).to_owned())).collect()
}

impl Findings {
    /// The tables, without empty ones.
    pub(super) fn tables(&self) -> Vec<FindingsTable> {
        let tables = [
            self.waves_table(),
            self.crossings_table(),
            self.minima_table(),
            self.branches_table(),
            self.basins_table(),
        ];
        tables.into_iter().filter(|table| !table.lines.is_empty()).collect()
    }

    fn waves_table(&self) -> FindingsTable {
        let line = |(wave, purposes): (usize, &BTreeMap<String, u64>)| {
            let words: Vec<_> = purposes.iter().map(|(purpose, jobs)| format!("{purpose}: {jobs}")).collect();
            vec![(wave + 1).to_string(), purposes.values().sum::<u64>().to_string(), words.join(", ")]
        };
        FindingsTable {
            stem: "waves",
            heading: "Waves",
            meaning: "The jobs that the program added to those of the study, and why.",
            header: header(Vec::new(), &["wave", "jobs", "why"]),
            lines: self.waves.iter().enumerate().map(line).collect(),
        }
    }

    fn crossings_table(&self) -> FindingsTable {
        let line = |own: &Crossing| {
            let [low, high] = own.range;
            let middle = value::significant(0.5 * (low + high), 6);
            let reach = value::significant(0.5 * (high - low), 2);
            let is_known = if high - low <= own.wanted * 1.000_001 { "yes" } else { "no" };
            let kinds = own.between.iter().cloned();
            let numbers =
                [value::text(&low.into()), value::text(&high.into()), middle, reach, is_known.to_owned()];
            values(&own.rest).into_iter().chain([own.over.clone()]).chain(kinds).chain(numbers).collect()
        };
        FindingsTable {
            stem: "boundaries",
            heading: "Boundaries",
            meaning: "Where jobs of one kind have a neighbour of another kind. The boundary lies between the two values, at the \
                      middle plus or minus half of their distance; it is known if that distance is what the study asks for.",
            header: header(
                names(self.crossings.first().map(|own| &own.rest)),
                &["over", "below", "above", "from", "to", "middle", "plus_minus", "known"],
            ),
            lines: self.crossings.iter().map(line).collect(),
        }
    }

    fn minima_table(&self) -> FindingsTable {
        let line = |own: &Minimum| {
            let side = |side: Option<f64>| side.map_or("no value".to_owned(), |x| value::text(&x.into()));
            let has_neighbour = own.neighbours.iter().any(Option::is_some);
            let is_known = has_neighbour
                && own.neighbours.iter().flatten().all(|x| (x - own.at).abs() <= own.wanted * 1.000_001);
            let known = match (own.is_flat, is_known) {
                (true, _) => "flat",
                (false, true) => "yes",
                (false, false) => "no",
            };
            let numbers = [
                value::text(&own.at.into()),
                side(own.neighbours[0]),
                side(own.neighbours[1]),
                value::significant(own.value, 5),
                known.to_owned(),
            ];
            let names = [own.of.clone(), own.over.clone()];
            values(&own.rest).into_iter().chain(names).chain(numbers).collect()
        };
        FindingsTable {
            stem: "minima",
            heading: "Minima",
            meaning: "The smallest value of each curve. The minimum of a curve with one minimum lies between the neighbours; it is \
                      known if they are as near as the study asks for. There is no value beyond the ends of a \
                      curve, and where jobs failed. The minimum of a curve is not looked for if it is flat.",
            header: header(
                names(self.minima.first().map(|own| &own.rest)),
                &["of", "over", "at", "from", "to", "value", "known"],
            ),
            lines: self.minima.iter().map(line).collect(),
        }
    }

    fn branches_table(&self) -> FindingsTable {
        let line = |own: &BranchPoint| {
            let hysteresis = match own.has_hysteresis() {
                Some(true) => "yes",
                Some(false) => "no",
                None => "not known",
            };
            let ends = [&own.up, &own.down].into_iter().flat_map(|end| end_cells(end.as_ref()));
            values(&own.parameters).into_iter().chain(ends).chain([hysteresis.to_owned()]).collect()
        };
        FindingsTable {
            stem: "branches",
            heading: "Branches",
            meaning: "The state that each point reaches from its neighbour, on the way up and on the way down. There is hysteresis \
                      where the two are different limit cycles, or where one of them is stable sliding.",
            header: header(
                names(self.branches.first().map(|own| &own.parameters)),
                &[
                    "mu_star_up",
                    "frequency_up_hz",
                    "regime_up",
                    "mu_star_down",
                    "frequency_down_hz",
                    "regime_down",
                    "hysteresis",
                ],
            ),
            lines: self.branches.iter().map(line).collect(),
        }
    }

    fn basins_table(&self) -> FindingsTable {
        let line = |own: &Basin| {
            let [share, low, high] = own.share().map(|share| value::significant(share, 3));
            let end = end_cells(own.end.as_ref());
            let counts = [own.jobs.to_string(), own.of.to_string(), share, low, high];
            values(&own.parameters).into_iter().chain(end).chain(counts).collect()
        };
        FindingsTable {
            stem: "basins",
            heading: "Basins",
            meaning: "The states in which the jobs ended that were kicked from each point, and their shares with the interval that has \
                      the true share with a probability of 95 % (Wilson). A line without μ* has the runs that failed or did not settle.",
            header: header(
                names(self.basins.first().map(|own| &own.parameters)),
                &["mu_star", "frequency_hz", "regime", "jobs", "of", "share", "share_from", "share_to"],
            ),
            lines: self.basins.iter().map(line).collect(),
        }
    }

    /// The waves and the state of the plan, for a terminal.
    pub fn as_text(&self) -> String {
        let line = |line: Vec<String>| format!("wave {}, jobs: {} ({})\n", line[0], line[1], line[2]);
        let waves: String = self.waves_table().lines.into_iter().map(line).collect();
        format!("{waves}{}\n", self.state)
    }

    /// The same for programs.
    pub fn waves_json(&self) -> Value {
        let waves: Vec<Value> = self.waves.iter().map(|wave| json!(wave)).collect();
        json!({ "waves": waves, "state": self.state })
    }
}

impl FindingsTable {
    /// The table for readers.
    pub fn grid(&self) -> Grid {
        let heads: Vec<&str> = self.header.iter().map(String::as_str).collect();
        Grid::of(&heads, self.lines.iter().cloned(), &format!("{}.csv", self.stem))
    }

    /// The table as CSV.
    ///
    /// # Errors
    /// None: it is written into memory.
    pub fn csv(&self) -> io::Result<Vec<u8>> {
        let mut out = csv::Writer::from_writer(Vec::new());
        out.write_record(&self.header).map_err(io_error)?;
        for line in &self.lines {
            out.write_record(line).map_err(io_error)?;
        }
        out.into_inner().map_err(|error| io::Error::other(error.to_string()))
    }
}

/// μ\*, frequency and regime.
fn end_cells(end: Option<&Endpoint>) -> [String; 3] {
    let Some(end) = end else { return [String::new(), String::new(), String::new()] };
    let frequency = end.frequency_hz.map_or(String::new(), |hz| value::fixed(hz, 0));
    let regime = if end.is_settled { end.regime.to_owned() } else { format!("{}, not periodic", end.regime) };
    [value::fixed(end.mu_star, 4), frequency, regime]
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
