//! How long the jobs took.

use super::{Parts, figures};
use crate::publish::page::{Block, Grid, Section, Text, Tile};
use crate::publish::value;
use crate::report::figure::RUN_TIMES;
use crate::report::layout::parameters_in_words;
use crate::report::row::JobRow;
use crate::report::times::Times;
use crate::report::tooltip::short_key;

pub(super) fn section(parts: &Parts) -> Section {
    let Some(times) = Times::of(parts.report.rows) else {
        return Section::new("times", "Run times", vec![Block::text("No job has ended yet.")]);
    };
    let tile = |name: &str, seconds: f64| Tile::new(name, value::duration(seconds), "");
    let mut tiles = vec![
        Tile::new("thread time, all jobs", value::duration(times.total_s), value::count(times.jobs, "job")),
        tile("shortest", times.min_s),
        tile("median", times.median_s),
        tile("mean", times.mean_s),
        tile("longest", times.max_s),
    ];
    let speed = |steps| Tile::new("steps per second", value::fixed(steps, 0), "of a job, per thread");
    tiles.extend(times.steps_per_s.map(speed));
    let heads = ["parameters", "thread time", "steps", "steps per second", "job"];
    let lines = times.slowest.iter().map(|(row, seconds)| slow(row, *seconds));
    let words = "The time of a job is its share of the time of its thread. Jobs that are advanced together have equal shares.";
    Section::new(
        "times",
        "Run times",
        vec![
            Block::Text(Text::from(words).and(figures::download(parts, &RUN_TIMES))),
            Block::Tiles(tiles),
            Block::Heading("Slowest jobs".to_owned()),
            Block::Table(Grid::of(&heads, lines, "run_times.csv")),
        ],
    )
}

fn slow(row: &JobRow, seconds: f64) -> Vec<Text> {
    let steps = row.record().map(|record| record.steps);
    let known = |text: Option<String>| text.unwrap_or_else(|| value::MISSING.to_owned()).into();
    let per_second = steps.filter(|_| seconds > 0.0).map(|steps| value::fixed(steps as f64 / seconds, 0));
    vec![
        parameters_in_words(row).into(),
        value::duration(seconds).into(),
        known(steps.map(|steps| steps.to_string())),
        known(per_second),
        Text::code(short_key(row)),
    ]
}
