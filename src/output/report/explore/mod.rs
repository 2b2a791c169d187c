//! The page to explore: all jobs with all results, as charts that the reader chooses, and as a table.
//!
//! The page is one file, which loads nothing. Charts are drawn by Apache ECharts, which is in the page; the report itself
//! needs no script. The data are columns of the export, so that names and meanings are the same everywhere.

mod packed;

use super::columns;
use super::input::Report;
use super::parameters::{MU, OMEGA, parameter_names};
use super::row::JobRow;
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::sensitivity::{self, REGIME, sensitivities};
use crate::publish::{SheetLine, html, value};
use crate::units::name_and_unit;
use maud::{Markup, PreEscaped, html};
use packed::{Values, write_embedded};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::io;

/// The name of the page.
pub(super) const PAGE: &str = "explore.html";
/// The library that draws the charts: version 6.1.0, as published, under the Apache License 2.0.
const ECHARTS: &str = include_str!("echarts.min.js");
const SCRIPT: &str = include_str!("explore.js");
const STYLE: &str = include_str!("explore.css");
/// More jobs have no importance of parameters, because their intervals of confidence take long.
const MOST_WEIGHED: usize = 20_000;
/// Digits of a number. `export --all` writes all of them.
const DIGITS: usize = 7;
/// Characters of a job's key. Commands take them for the whole key.
const KEY: usize = 16;
/// Stands in the page where the data go.
const DATA: &str = "\u{0}";

/// Writes the page. `pages` has the addresses of the pages of some jobs. The data of many jobs are large, so they go straight to `out`.
///
/// # Errors
/// Those of `out`.
pub(super) fn write(report: &Report, pages: &HashMap<String, String>, out: &mut Vec<u8>) -> io::Result<()> {
    let measured = report.rows.iter().filter(|row| row.is_measured()).count();
    let body: Markup = html! {
        p {
            "All " (value::count(report.rows.len() - measured, "job"))
            @if measured > 0 { " and " (value::count(measured, "measured point")) }
            ". "
            a href="report.html" { "The report" } " has the findings. Numbers have seven digits here; "
            code { "tribosweep export STUDY --all" } " writes all digits of all columns."
        }
        noscript { p.warning { "This page needs JavaScript. The report needs none." } }
        style { (PreEscaped(STYLE)) }
        div #explore {}
        script type="application/json" #data { (PreEscaped(DATA)) }
        script { (PreEscaped(ECHARTS)) }
        script { (PreEscaped(SCRIPT)) }
    };
    let page = html::page(&format!("{}: explore", report.title), None, &body);
    let (before, after) = page.split_once(DATA).unwrap_or((&page, ""));
    out.extend_from_slice(before.as_bytes());
    write_embedded(&data(report, pages), &mut *out)?;
    out.extend_from_slice(after.as_bytes());
    Ok(())
}

/// What the script reads.
#[derive(Serialize)]
struct Data<'a> {
    /// The number of rows.
    count: usize,
    columns: Vec<ColumnData<'a>>,
    /// The pages of jobs, by row.
    pages: BTreeMap<usize, &'a str>,
    /// Quantities that all jobs have in common.
    setup: Vec<SetupLine<'a>>,
    importance: Vec<Value>,
    /// Whether the axis of a parameter is known to be logarithmic or linear.
    log: &'a BTreeMap<String, bool>,
    start: Value,
}

#[derive(Serialize)]
struct ColumnData<'a> {
    name: &'a str,
    unit: &'a str,
    meaning: &'a str,
    kind: &'static str,
    #[serde(flatten)]
    values: Values,
}

#[derive(Serialize)]
struct SetupLine<'a> {
    name: &'a str,
    value: &'a str,
}

fn data<'a>(report: &Report<'a>, pages: &'a HashMap<String, String>) -> Data<'a> {
    let Report { rows, view, .. } = *report;
    let parameters = parameter_names(rows.iter().map(|row| &row.parameters));
    let given = parameters.clone().into_par_iter().filter_map(|name| {
        let values = Values::of(&rows.iter().map(|row| shortened(row.parameter(name))).collect::<Vec<_>>())?;
        let meaning = view.descriptions.get(name).map_or(name, String::as_str);
        Some(ColumnData { name, unit: name_and_unit(name).1, meaning, kind: "parameter", values })
    });
    let of_column = |own: &'static columns::ExportColumn| {
        let head = &own.column.head;
        let value = |row: &JobRow| match &*head.name {
            "job" if !row.is_measured() => row.job.chars().take(KEY).collect::<String>().into(),
            _ => shortened(own.value(row)),
        };
        let values = Values::of(&rows.iter().map(value).collect::<Vec<_>>())?;
        let (name, unit, meaning) = (&*head.name, &*head.unit, &*head.meaning);
        Some(ColumnData { name, unit, meaning, kind: own.group.name(), values })
    };
    let results: Vec<_> = columns::fixed().collect();
    let is_parameter = |own: &columns::ExportColumn| {
        own.group == columns::Group::Job && parameters.contains(&&*own.column.head.name)
    };
    let results = results.into_par_iter().filter(|own| !is_parameter(own));
    let mut columns: Vec<_> = given.collect();
    columns.extend(results.filter_map(of_column).collect::<Vec<_>>());
    let page = |(number, row): (usize, &JobRow)| Some((number, pages.get(&row.job)?.as_str()));
    let is_common = |line: &&SheetLine| !line.varies && !parameters.contains(&line.key);
    let lines = report.sheet.iter().flat_map(|sheet| &sheet.groups).flat_map(|group| &group.lines);
    Data {
        count: rows.len(),
        columns,
        pages: rows.iter().enumerate().filter_map(page).collect(),
        setup: lines
            .filter(is_common)
            .map(|line| SetupLine { name: &line.name, value: &line.value })
            .collect(),
        importance: importance(report),
        log: &view.is_log,
        start: json!({
            "x": view.x.as_deref().unwrap_or(OMEGA),
            "by": view.by.as_deref().unwrap_or(MU),
            "y": view.y.iter().map(|scalar| scalar.name).chain([MU_STAR.name]).next(),
        }),
    }
}

/// A number with few digits.
fn shortened(given: Value) -> Value {
    match given.as_f64() {
        Some(x) if given.is_f64() => value::significant_number(x, DIGITS),
        _ => given,
    }
}

/// For each quantity of the report, the indices of the parameters.
fn importance(report: &Report) -> Vec<Value> {
    if report.rows.len() > MOST_WEIGHED {
        return Vec::new();
    }
    let of: Vec<&'static Scalar> =
        [MU_STAR, FREQUENCY].into_iter().chain(report.view.y.iter().copied()).collect();
    let jobs: Vec<JobRow> = report.rows.iter().filter(|row| !row.is_measured()).cloned().collect();
    let found = sensitivities(&jobs, &of, report.view.is_morris);
    let of_quantity = |own: &sensitivity::Sensitivity| {
        let sensitivity::MainIndex { kind, indices, notes } = own.main_index()?;
        let bar = |(name, index): &(&str, sensitivity::Index)| json!({ "name": name, "value": index.value, "interval": index.interval });
        let is_shown = own.of != REGIME && indices.len() > 1;
        is_shown.then(|| {
            let bars: Vec<Value> = indices.iter().map(bar).collect();
            json!({ "of": own.of, "points": own.points, "kind": kind, "bars": bars, "notes": notes })
        })
    };
    found.iter().filter_map(of_quantity).collect()
}
