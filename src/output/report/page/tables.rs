//! The tables of a quantity: one for each combination of the further parameters.

use super::Parts;
use crate::publish::page::{Block, Grid, Span, Text, limited};
use crate::publish::value;
use crate::report::layout::{Group, Layout, MAX_GROUPS};
use crate::report::tables::{self, Digits, Quantity};
use std::collections::HashMap;

/// Largest number of jobs in all of these together …
pub(super) const MAX_JOBS: usize = 4_000;
/// … unless only the first combination is shown, which may have more. Beyond this number it is not drawn either.
pub(super) const MAX_DRAWN: usize = 20_000;
/// Digits of a parameter of a drawn point. The file has all of them.
const DIGITS: usize = 4;

pub(super) fn what_is_left_out(layout: &Layout, shown: usize) -> String {
    let groups = &layout.groups;
    let jobs: usize = groups[shown..].iter().map(|group| group.jobs.len()).sum();
    if groups.len() == 1 {
        return format!("{jobs} jobs are too many for this page");
    }
    let more = if shown > 0 { "more " } else { "" };
    format!(
        "left out of this page: {} of parameters, {}",
        value::count(groups.len() - shown, &format!("{more}combination")),
        value::count(jobs, "job")
    )
}

pub(super) fn see_files(what: &str, files: &str) -> Block {
    Block::note(&format!("… {what}: see `{files}` in its folder."))
}

/// Number of groups that are shown in tables.
fn shown(layout: &Layout) -> usize {
    let mut jobs = 0;
    let fits = |(index, group): (usize, &Group)| {
        jobs += group.jobs.len();
        if index == 0 { jobs <= MAX_DRAWN } else { index < MAX_GROUPS && jobs <= MAX_JOBS }
    };
    layout.groups.iter().enumerate().map(fits).take_while(|fits| *fits).count()
}

/// The tables below a heading.
pub(super) fn below(parts: &Parts, quantity: Quantity) -> Vec<Block> {
    let heading = Block::Heading(heading(quantity));
    std::iter::once(heading).chain(blocks(parts.layouts.all, quantity, &parts.pages)).collect()
}

/// The tables below a fold.
pub(super) fn folded(parts: &Parts, quantity: Quantity) -> Vec<Block> {
    vec![Block::Fold(heading(quantity), blocks(parts.layouts.all, quantity, &parts.pages))]
}

fn heading(quantity: Quantity) -> String {
    format!("Table: {}", quantity.title())
}

/// The tables, what is the same in all jobs, and the meaning of marks. `pages` has the addresses of the pages of some jobs.
pub(in crate::report) fn blocks(
    layout: &Layout,
    quantity: Quantity,
    pages: &HashMap<String, String>,
) -> Vec<Block> {
    let file = format!("{}.csv", quantity.stem());
    let mut blocks = Vec::new();
    let constants = layout.constants_in_words();
    if !constants.is_empty() {
        blocks.push(Block::Text(format!("In all jobs: {constants}.").into()));
    }
    if layout.scattered.is_empty() {
        blocks.extend(of_groups(layout, quantity, pages, &file));
    } else {
        // Every point has values of its own for all that varies.
        let mut table = tables::table_with(layout, quantity, Digits::ByError);
        if let ([_], Some(head)) = (&layout.series[..], table.heads.last_mut()) {
            head.name = quantity.title();
        }
        blocks.push(Block::Table(Grid::of_table(&table.rounded(DIGITS))));
    }
    let mark = |(mark, meaning): (&str, &str)| match mark {
        "" => Text::from(meaning),
        mark => Text::code(mark).and(format!(" {meaning}")),
    };
    let marks: Vec<Text> = tables::legend(layout, quantity).into_iter().map(mark).collect();
    if !marks.is_empty() {
        blocks.push(Block::List(marks));
    }
    blocks
}

/// A table under a heading for each combination of the further parameters, as far as there is room.
fn of_groups(layout: &Layout, quantity: Quantity, pages: &HashMap<String, String>, file: &str) -> Vec<Block> {
    let shown = shown(layout);
    let mut rest = String::new();
    let group = |group: &Group| {
        let pages = cell_pages(pages, group);
        let line = |(number, (at, cells)): (usize, (_, Vec<String>))| {
            let cell = |(column, text): (usize, String)| match pages.get(&(number, column)) {
                Some(page) => Span::Link(text, (*page).to_owned()).into(),
                None => Text::from(text),
            };
            std::iter::once(Text::from(layout.axis_text(at)))
                .chain(cells.into_iter().enumerate().map(cell))
                .collect()
        };
        let lines = tables::lines(layout, group, quantity, Digits::ByError).enumerate().map(line);
        let (lines, more) = limited(lines, file);
        if !more.is_empty() {
            rest = more;
        }
        (group.caption(), lines)
    };
    let groups = layout.groups.iter().take(shown).map(group).collect();
    let has_words = quantity == Quantity::Regime;
    let heads = tables::header(layout);
    let mut blocks = vec![Block::Table(Grid { heads, groups, has_words, rest })];
    if shown < layout.groups.len() {
        blocks.push(see_files(&what_is_left_out(layout, shown), file));
    }
    blocks
}

/// The pages of the inspected jobs of a group by line and column of their cells.
fn cell_pages<'a>(pages: &'a HashMap<String, String>, group: &Group) -> HashMap<(usize, usize), &'a str> {
    let found = group
        .jobs
        .iter()
        .filter_map(|job| Some(((job.axis_index, job.series), pages.get(&job.row.job)?.as_str())));
    found.collect()
}
