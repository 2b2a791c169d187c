//! Results that are there and should be doubted: one list for the page and for the warnings of the command line.

use crate::analysis::{JobRecord, Outcome, PlasticFlow};
use crate::publish::value::{count, significant};
use crate::report::row::JobRow;
use crate::report::words::parameters_in_words;

/// A reason to doubt a result.
#[derive(Debug)]
pub struct Doubt {
    /// The heading of the jobs that have it.
    pub heading: &'static str,
    /// What is so in a job that has it, in a few words.
    briefly: &'static str,
    /// The same for a warning.
    what: &'static str,
    /// Why a job has it, with its numbers; `None` if it does not have it.
    pub why: fn(&JobRow) -> Option<String>,
}

/// All reasons, in the order of the page.
pub static DOUBTS: [Doubt; 4] = [
    Doubt {
        heading: "Accuracy not reached",
        briefly: "the accuracy is not reached",
        what: "the accuracy that is asked for is not reached, also on the finest mesh",
        why: not_accurate,
    },
    Doubt {
        heading: "Still yielding",
        briefly: "the material goes on yielding",
        what: "the material goes on yielding within the averaging window (column plastic_share)",
        why: yields,
    },
    Doubt {
        heading: "Large residuals",
        briefly: "a residual is large",
        what: "a residual is above 0.01 (columns energy_residual and identity_residual): do not use the means",
        why: does_not_close,
    },
    Doubt {
        heading: "The pin hops",
        briefly: "the pin hops",
        what: "the pin hops: its normal force goes from nothing to more than ten times the load (columns n_over_f_min and n_over_f_max)",
        why: hops,
    },
];

impl Doubt {
    fn jobs<'a>(&self, rows: impl IntoIterator<Item = &'a JobRow>) -> Vec<&'a JobRow> {
        rows.into_iter().filter(|row| (self.why)(row).is_some()).collect()
    }
}

/// A warning for each reason that some jobs have.
pub fn warnings(rows: &[JobRow]) -> Vec<String> {
    let warning = |doubt: &Doubt| {
        let jobs = doubt.jobs(rows);
        let first = jobs.first()?;
        let has_several_studies = rows.iter().any(|row| row.study != first.study);
        let of_study = if has_several_studies { format!(" of {}", first.study) } else { String::new() };
        let place = parameters_in_words(first) + &of_study;
        Some(match jobs.len() {
            1 => format!("in the job at {place} {}", doubt.what),
            several => format!("in {several} jobs (the first one at {place}) {}", doubt.what),
        })
    };
    DOUBTS.iter().filter_map(warning).collect()
}

/// How many jobs should be doubted and why, in a sentence; `None` if there are none. `open` says that jobs without a period count, too.
pub(in crate::report) fn in_words<'a>(
    rows: impl IntoIterator<Item = &'a JobRow>,
    open: bool,
) -> Option<String> {
    let rows: Vec<&JobRow> = rows.into_iter().filter(|row| row.record().is_some()).collect();
    let is_open = |row: &JobRow| open && row.is_open();
    let is_doubted = |row: &&&JobRow| is_open(row) || DOUBTS.iter().any(|doubt| (doubt.why)(row).is_some());
    let doubted = rows.iter().filter(is_doubted).count();
    let not_periodic = ("the motion is not periodic", rows.iter().filter(|row| is_open(row)).count());
    let of_doubts = DOUBTS.iter().map(|doubt| (doubt.briefly, doubt.jobs(rows.iter().copied()).len()));
    let why: Vec<String> = std::iter::once(not_periodic)
        .chain(of_doubts)
        .filter(|(_, jobs)| *jobs > 0)
        .map(|(what, jobs)| format!("{what} ({jobs})"))
        .collect();
    let of = count(rows.len(), "job");
    (doubted > 0).then(|| format!("Doubt the results of {doubted} of {of}: {}.", why.join(", ")))
}

fn not_accurate(row: &JobRow) -> Option<String> {
    let record = row.record().filter(|record| record.accuracy_reached == Some(false))?;
    Some(match record.mesh_error() {
        Ok(_) if record.start.is_none() => "there is no coarser mesh to compare with".to_owned(),
        Ok(own) => format!(
            "the error of μ* may be {}, {} % of it",
            significant(own.mu_star, 2),
            significant(100.0 * own.mu_star / record.mu_star.abs(), 2)
        ),
        Err(why) => format!("the error of μ* is unknown: {}", why.reason()),
    })
}

fn yields(row: &JobRow) -> Option<String> {
    let flow = row.record()?.plastic.filter(PlasticFlow::is_yielding)?;
    Some(format!(
        "the plastic work is {} % of the sum of it and the work of friction in the window, and the shape of the pin may go on changing; the \
         largest plastic strain is {}",
        significant(100.0 * flow.share, 2),
        significant(flow.strain_max, 2)
    ))
}

/// The largest residual with which the means of a job can be used. Those of `figure7` are a tenth of it. That of μ\* is absolute.
const LARGEST_RESIDUAL: f64 = 0.01;

fn does_not_close(row: &JobRow) -> Option<String> {
    let record = row.record()?;
    let residuals = [
        ("energies of the run", record.energy_residual.abs()),
        ("identities of the window", record.identity_residual()),
    ];
    let open: Vec<String> = residuals
        .into_iter()
        .filter(|(_, residual)| *residual > LARGEST_RESIDUAL)
        .map(|(of, residual)| format!("the {of} have a residual of {}", significant(residual, 2)))
        .collect();
    (!open.is_empty()).then(|| open.join(", and "))
}

/// The normal force over the load of a pin that flies and lands: nearly none, and more than three times the most in `figure7`, which is 3.
const FLIGHT: f64 = 0.05;
const LANDING: f64 = 10.0;

fn hops(row: &JobRow) -> Option<String> {
    let hops = |record: &&JobRecord| record.n_over_f_min < FLIGHT && record.n_over_f_max > LANDING;
    let record = row.record().filter(hops)?;
    let of_landings = if record.outcome == Outcome::Periodic {
        ", and the frequency is that with which its flights repeat"
    } else {
        ""
    };
    Some(format!(
        "the normal force reaches {} times the load, and the nodes of the base are apart from the disk for {} % of the time on average: the \
         whole pin flies and lands{of_landings}",
        significant(record.n_over_f_max, 3),
        significant(100.0 * record.separated_share, 2)
    ))
}
