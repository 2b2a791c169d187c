//! The page to explore: all jobs with all results, as charts that the reader chooses, and as a table.
//!
//! The page is one file, which loads nothing. Charts are drawn by Apache ECharts, which is in the page; the report itself
//! needs no script. The data are columns of the export, so that names and meanings are the same everywhere.

use super::columns;
use super::input::Report;
use super::parameters::{MU, OMEGA, name_and_unit};
use super::row::JobRow;
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::sensitivity::{REGIME, sensitivities};
use crate::publish::{html, value};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};
use std::collections::HashMap;

/// The name of the page.
pub(super) const PAGE: &str = "explore.html";
/// The library that draws the charts: version 6.1.0, as published, under the Apache License 2.0.
const ECHARTS: &str = include_str!("echarts.min.js");
const SCRIPT: &str = include_str!("explore.js");
const STYLE: &str = include_str!("explore.css");
/// More jobs have no importance of parameters, because their intervals of confidence take long.
const MOST_WEIGHED: usize = 20_000;
/// Digits of a number. `jobs.csv` has all of them.
const DIGITS: usize = 7;

/// The page. `pages` has the addresses of the pages of some jobs.
pub(super) fn page(report: &Report, pages: &HashMap<String, String>) -> String {
    let data = data(report, pages).to_string().replace('<', "\\u003c");
    let body: Markup = html! {
        p {
            "All " (value::count(report.rows.len(), "job")) ". "
            a href="report.html" { "The report" } " has the findings; " a href="jobs.csv" { "jobs.csv" } " has all digits."
        }
        noscript { p.warning { "This page needs JavaScript. The report needs none." } }
        style { (PreEscaped(STYLE)) }
        div #explore {}
        script type="application/json" #data { (PreEscaped(data)) }
        script { (PreEscaped(ECHARTS)) }
        script { (PreEscaped(SCRIPT)) }
    };
    html::page(&format!("{}: explore", report.title), None, &body)
}

/// The columns of all jobs, what they mean, and what is known about the importance of the parameters.
fn data(report: &Report, pages: &HashMap<String, String>) -> Value {
    let rows = report.rows;
    let names = super::export::further_names(rows);
    let parameters: Vec<&str> = [OMEGA, MU].into_iter().chain(names).collect();
    let column = |name: &str, unit: &str, meaning: &str, kind: &str, of: &dyn Fn(&JobRow) -> Value| {
        let values: Vec<Value> = rows.iter().map(|row| shortened(of(row))).collect();
        // A column without values would only be in the way.
        values.iter().any(|value| !value.is_null()).then(
            || json!({ "name": name, "unit": unit, "meaning": meaning, "kind": kind, "values": values }),
        )
    };
    let given = parameters.iter().filter_map(|name| {
        let words = report.view.descriptions.get(*name).map_or(*name, String::as_str);
        column(name, name_and_unit(name).1, words, "parameter", &|row| row.parameter(name))
    });
    let results = columns::PLAIN
        .iter()
        .chain(&columns::FURTHER)
        .filter(|own| own.column.head.name != OMEGA && own.column.head.name != MU);
    let results = results.filter_map(|own| {
        let head = &own.column.head;
        column(&head.name, &head.unit, &head.meaning, own.group.name(), &|row| own.value(row))
    });
    let pages: Vec<Value> = rows.iter().map(|row| pages.get(&row.job).cloned().into()).collect();
    let start = json!({
        "x": report.view.x.as_deref().unwrap_or(OMEGA),
        "by": report.view.by.as_deref().unwrap_or(MU),
        "y": report.view.y.iter().map(|scalar| scalar.name).chain(["mu_star"]).next(),
    });
    json!({
        "columns": given.chain(results).collect::<Vec<_>>(),
        "pages": pages,
        "importance": importance(report),
        "start": start,
    })
}

/// A number with few digits.
fn shortened(given: Value) -> Value {
    match given.as_f64() {
        Some(x) if given.is_f64() => value::significant(x, DIGITS).parse::<f64>().map_or(given, Value::from),
        _ => given,
    }
}

/// For each quantity of the report, the indices of the parameters.
fn importance(report: &Report) -> Vec<Value> {
    if report.rows.len() > MOST_WEIGHED {
        return Vec::new();
    }
    let of: Vec<&'static Scalar> =
        [*MU_STAR, *FREQUENCY].into_iter().chain(report.view.y.iter().copied()).collect();
    let jobs: Vec<JobRow> = report.rows.iter().filter(|row| !row.is_measured()).cloned().collect();
    let found = sensitivities(&jobs, &of, false);
    let of_quantity = |own: &super::sensitivity::Sensitivity| {
        let bar = |indices: &super::sensitivity::Indices| {
            let index = indices.first_order.or(indices.pawn)?;
            let kind = if indices.first_order.is_some() { "first-order index" } else { "PAWN index" };
            Some(
                json!({ "name": indices.name, "value": index.value, "interval": index.interval, "kind": kind }),
            )
        };
        let bars: Vec<Value> = own.parameters.iter().filter_map(bar).collect();
        let is_shown = own.of != REGIME && bars.len() > 1;
        is_shown.then(|| json!({ "of": own.of, "points": own.points, "bars": bars }))
    };
    found.iter().filter_map(of_quantity).collect()
}
