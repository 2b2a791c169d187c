//! What a study takes as text and JSON, for `validate`, `submit --dry-run` and `run`.

use super::error::CliError;
use super::output::log;
use crate::analysis::Workload;
use crate::publish::table::{Column, Table};
use crate::publish::value::{count, quantity, significant};
use crate::queue::{Clock, Location, Queue, Replaced};
use crate::spec::Precision;
use crate::sweep::{self, Forecast, Group, OtherClamps, Plan, TimeRange};
use crate::worker::Eta;
use serde_json::{Value, json};
use std::time::Duration;

/// The largest number of groups that the text lists.
const MOST_GROUPS: usize = 8;

/// Shorter times are not told apart.
const SHORT: Duration = Duration::from_secs(2);

/// Reads the forecast of a study with the states of its jobs in the database, if there is one, and the study of its
/// name that it would replace. Creates nothing.
pub(crate) fn read(
    plan: &Plan,
    threads: usize,
    db: &Location,
) -> Result<(Forecast, Option<Replaced>), CliError> {
    sweep::block_on(async {
        let Some(queue) = Queue::open_if_exists(db.clone(), Clock::OfDatabase).await? else {
            return Ok((Forecast::new(plan, None, threads).await?, None));
        };
        sweep::with_open(queue, async |queue| {
            let forecast = Forecast::new(plan, Some(queue), threads).await?;
            Ok((forecast, plan.preview_replacement(queue).await?))
        })
        .await
    })
}

/// That more jobs follow, in a line; empty for a study that does not grow.
pub(crate) fn growth(plan: &Plan) -> String {
    let most = plan.study().most_jobs();
    most.map_or_else(String::new, |most| {
        format!("growth    more jobs follow when these have ended, up to {most} in all\n")
    })
}

/// The forecast in lines of at most 80 characters, if the path of the database is short.
pub(crate) fn as_text(forecast: &Forecast, db: &Location) -> String {
    let mut lines = Vec::new();
    lines.push(format!("memory    {}", memory(forecast)));
    let states = forecast.checkpoints_bytes;
    let states =
        if states > 0.0 { format!(", and {} for states of long jobs", bytes(states)) } else { String::new() };
    lines.push(format!("disk      about {} of results{states}", bytes(forecast.results_bytes)));
    lines.push(match forecast.known {
        None => format!("database  {db} does not exist yet"),
        Some(known) => {
            let failed = if known.failed > 0 { format!(", {} failed", known.failed) } else { String::new() };
            let open =
                if known.open > 0 { format!(", {} pending or running", known.open) } else { String::new() };
            format!("database  {} of {} done{failed}{open}", known.done, count(forecast.jobs, "job"))
        }
    });
    lines.push(format!("time      {}", time(forecast)));
    if forecast.time.is_some() {
        lines.push(format!("          at {}", speed(forecast)));
    }
    format!("{}{}\n", table(&forecast.groups), lines.join("\n"))
}

fn memory(forecast: &Forecast) -> String {
    let here = forecast
        .memory_here_bytes
        .map_or_else(String::new, |here| format!("; this machine has {}", bytes(here as f64)));
    format!("about {} with {}{here}", bytes(forecast.memory_bytes), with(forecast.threads))
}

/// `60 s to 3 min with 2 threads here (7 min if all jobs run to their limits)`.
fn time(forecast: &Forecast) -> String {
    let with = with(forecast.threads);
    let Some(TimeRange { low, high, limit, .. }) = forecast.time else {
        let why =
            if forecast.has_modes_left { "unknown: modes have no forecast" } else { "none: no job is left" };
        return why.to_owned();
    };
    if limit < SHORT {
        return format!("less than {} s with {with} here", SHORT.as_secs());
    }
    let single = |time: Duration| Eta { low: time, high: time }.to_string().replacen("about ", "", 1);
    let range = if low < SHORT { format!("up to {}", single(high)) } else { Eta { low, high }.to_string() };
    // Most jobs end before their limits, unless they may not.
    if limit > high.mul_f64(1.1) {
        return format!("{range} with {with} here ({} if all jobs run to their limits)", single(limit));
    }
    format!("{range} with {with} here")
}

/// What the time is based on.
fn speed(forecast: &Forecast) -> String {
    match forecast.speed.jobs {
        0 => "a typical speed: too few jobs have finished in the database".to_owned(),
        jobs => format!("the speed of {jobs} finished jobs in the database"),
    }
}

fn with(threads: usize) -> String {
    count(threads, "thread")
}

/// The columns of a group of jobs.
const COLUMNS: [Column<Group>; 7] = [
    Column::new("mesh", "", "", |group| mesh(&group.workload).into()),
    Column::new("nodes", "", "", |group| nodes(&group.workload).into()),
    Column::new("jobs", "", "", |group| group.jobs.into()),
    Column::new("time step", "", "", |group| {
        format!("{}{}", about(group), quantity(group.workload.time_step_s, "s")).into()
    }),
    Column::new("its limit", "", "", |group| {
        format!("{}{}", about(group), quantity(group.workload.time_step_limit_s, "s")).into()
    }),
    Column::new("steps", "", "", |group| format!("{}{}", about(group), grouped(group.steps)).into()),
    Column::new("memory", "", "", |group| bytes(group.memory_bytes).into()),
];

/// A table of the groups with a head.
fn table(groups: &[Group]) -> String {
    let listed = if groups.len() > MOST_GROUPS { MOST_GROUPS - 1 } else { groups.len() };
    let (shown, left_out) = groups.split_at(listed);
    let text = Table::of("forecast", &COLUMNS, shown).aligned(|column| column > 0);
    if left_out.is_empty() {
        return text;
    }
    let jobs = count(left_out.iter().map(|group| group.jobs).sum::<usize>(), "job");
    format!("{text}… and {} more meshes, precisions or time steps with {jobs}\n", left_out.len())
}

fn about(group: &Group) -> &'static str {
    if group.workload.is_estimate { "~" } else { "" }
}

fn mesh(workload: &Workload) -> String {
    let elements = match workload.elements {
        // A mesh from a file has no directions.
        [count, 1, 1] if workload.is_general => format!("{} elements", grouped(count as u64)),
        [nx, ny, nz] => format!("{nx}×{ny}×{nz}"),
    };
    match workload.precision {
        Precision::Double => elements,
        Precision::Single => format!("{elements}, single"),
    }
}

fn nodes(workload: &Workload) -> String {
    let pin = grouped(workload.pin_nodes as u64);
    match workload.disk_nodes {
        0 => pin,
        disk => format!("{pin} + {}", grouped(disk as u64)),
    }
}

/// `16 275`.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A size with two digits: `39 MB`, `1.2 GB`.
fn bytes(size: f64) -> String {
    let (factor, unit) = match size {
        1e9.. => (1e9, "GB"),
        1e6.. => (1e6, "MB"),
        _ => (1e3, "kB"),
    };
    let size = size / factor;
    if size < 10.0 { format!("{} {unit}", significant(size, 2)) } else { format!("{size:.0} {unit}") }
}

/// Warns of jobs that need more memory than this machine has, and of clamps that make mesh errors unknown. Returns the number of warnings.
pub(crate) fn warn(forecast: &Forecast) -> usize {
    let warnings = [
        forecast.exceeds_memory().then(|| {
            format!(
                "the jobs need {}; take fewer threads or a coarser mesh, or run them on another machine",
                memory(forecast)
            )
        }),
        forecast.other_clamps.as_ref().map(clamps_in_words),
    ];
    for warning in warnings.iter().flatten() {
        log(format_args!("warning: {warning}"));
    }
    warnings.iter().flatten().count()
}

fn clamps_in_words(OtherClamps { jobs, width_m, coarser_width_m, elements }: &OtherClamps) -> String {
    let coarser = coarser_width_m.map_or_else(
        || "no coarser mesh fits it".to_owned(),
        |width_m| format!("{} on the coarser one", quantity(width_m, "m")),
    );
    let better = elements.map_or_else(String::new, |(number, axis)| {
        format!("; {number} elements in {axis} have the same clamp on both")
    });
    format!(
        "but for steady sliding, the mesh error stays unknown in {}: the clamp is {} wide on the mesh, and {coarser}{better}",
        count(*jobs, "job"),
        quantity(*width_m, "m")
    )
}

/// Says before the work how long it takes, unless it is short.
pub(crate) fn announce(forecast: &Forecast) {
    warn(forecast);
    if forecast.has_modes_left {
        log(format_args!("expected time: {}", time(forecast)));
    } else if forecast.time.is_some_and(|time| time.limit >= SHORT) {
        log(format_args!("expected time: {}, at {}", time(forecast), speed(forecast)));
    }
}

/// The forecast for programs.
pub(crate) fn as_json(forecast: &Forecast, replaced: Option<&Replaced>, plan: &Plan) -> Value {
    let mut json = json!(forecast);
    json["study"] = plan.name().into();
    json["warnings"] = json!(plan.study().warnings());
    json["replaced"] = json!(replaced);
    json
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::SweepError;

    fn forecast(study: &str) -> Forecast {
        let plan = Plan::parse(study, "study.json").unwrap();
        sweep::block_on::<_, SweepError>(Forecast::new(&plan, None, 2)).unwrap()
    }

    /// Protects: the text says mesh, steps, memory, disk and time in lines of at most 80 characters, and lists no more than
    /// eight groups, however many there are.
    #[test]
    fn the_text_fits_eighty_columns() {
        let one = r#"{ "scene": { "pin": { "elements": [3, 4, 3] }, "clamp": { "width_m": 0.004 } } }"#;
        let text = as_text(&forecast(one), &Location::parse("none.db".into()));
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        for word in [
            "3×4×3",
            "80",
            "memory",
            "disk",
            "none.db does not exist yet",
            "less than 2 s with 1 thread here",
        ] {
            assert!(text.contains(word), "{word}: {text}");
        }
        let many = r#"{ "scene": { "pin": { "elements": [3, 4, 3] }, "clamp": { "side": "whole_top" } },
                        "disk": {}, "run": { "limit_s": 0.03 },
                        "grid": { "young_modulus_pa": { "from": 1e9, "to": 4e9, "count": 20, "spacing": "log" } } }"#;
        let many = many.replace("\"disk\": {},", "");
        let text = as_text(&forecast(&many), &Location::parse("none.db".into()));
        assert!(text.contains("… and 13 more meshes, precisions or time steps with 13 jobs"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }

    /// Protects: numbers and sizes are written with spaces and in units that people read.
    #[test]
    fn numbers_are_readable() {
        assert_eq!([7, 999, 16_275, 1_845_726].map(grouped), ["7", "999", "16 275", "1 845 726"]);
        let sizes = [250.0, 4.26e3, 39.4e6, 9.96e9, 1.26e9].map(bytes);
        assert_eq!(sizes, ["0.25 kB", "4.3 kB", "39 MB", "10 GB", "1.3 GB"]);
    }
}
