//! Indices as a page and as CSV.

use super::design::Design;
use super::types::{Index, Indices, REGIME, Sensitivity};
use crate::publish::markdown;
use crate::publish::page::{Block, Grid, Page, Section};
use crate::publish::table::{Column, FileColumns, Table};
use crate::publish::value::{self, count};
use crate::report::Scalar;
use crate::report::columns::any_quantity;

/// With fewer points, estimates say little.
const FEW_POINTS: usize = 100;

/// The indices as Markdown.
pub fn markdown(found: &[Sensitivity]) -> String {
    markdown::of_page(&Page { sections: found.iter().map(section).collect(), ..Page::default() })
}

/// The page of the indices.
pub fn page(found: &[Sensitivity], title: &str) -> Page {
    Page {
        title: format!("{title}: how much each parameter decides"),
        lead: vec![Block::text("All indices: `sensitivity.csv`; the points: `sensitivity_points.csv`.")],
        sections: found.iter().map(section).collect(),
        ..Page::default()
    }
}

/// The indices of a quantity.
fn section(one: &Sensitivity) -> Section {
    let is_regime = one.of == REGIME;
    let title = Scalar::find(&one.of).map_or_else(|| one.of.clone(), Scalar::title);
    let mut ranked: Vec<_> = one.parameters.iter().collect();
    let of = |index: &Option<Index>| index.as_ref().map_or(-1.0, |index| index.value);
    ranked.sort_by(|a, b| of(&b.pawn).total_cmp(&of(&a.pawn)).then(a.name.cmp(&b.name)));
    let is_morris = one.parameters.iter().any(|own| own.effects.is_some());
    let columns = shown(&one.design, is_regime, is_morris);
    let mut blocks = Vec::new();
    if columns.len() > 1 {
        let table = Table::of("sensitivity", &columns, ranked);
        blocks.push(Block::Table(Grid::of_table(&table).with_words()));
    }
    let notes = one.notes(true);
    if !notes.is_empty() {
        blocks.push(Block::list(notes));
    }
    Section::new(one.of.clone(), format!("{title}: {} points", one.points), blocks)
}

/// One index of all parameters.
pub(in crate::report) struct MainIndex<'a> {
    /// What it is called.
    pub kind: &'static str,
    /// Its values, by the names of the parameters that have one.
    pub indices: Vec<(&'a str, Index)>,
    /// What has to be known of them, in sentences.
    pub notes: Vec<String>,
}

impl Sensitivity {
    /// The index that says most. Returns `None` without any index.
    pub(in crate::report) fn main_index(&self) -> Option<MainIndex<'_>> {
        type Read = fn(&Indices) -> Option<Index>;
        let kinds: [(&str, Read, bool); 3] = [
            ("first-order index", |own| own.first_order, false),
            (if self.of == REGIME { "index of shares" } else { "PAWN index" }, |own| own.pawn, true),
            ("mean size of the elementary effects", |own| own.effects.map(|(index, _)| index), false),
        ];
        let of_kind = |index: Read| {
            let named = self.parameters.iter().filter_map(|own| Some((&*own.name, index(own)?)));
            named.collect::<Vec<_>>()
        };
        let mut found = kinds.into_iter().map(|(kind, index, has_chance)| (kind, of_kind(index), has_chance));
        let (kind, indices, has_chance) = found.find(|(_, indices, _)| !indices.is_empty())?;
        let without = self.parameters.iter().map(|own| &*own.name);
        let without = without.filter(|name| indices.iter().all(|(known, _)| known != name));
        let without = without.map(|name| format!("No {kind} of {name}."));
        let notes = self.notes(has_chance).into_iter().chain(without).collect();
        Some(MainIndex { kind, indices, notes })
    }

    /// What has to be known of the indices, in sentences. How large one is by chance is known of the last index alone.
    fn notes(&self, has_chance: bool) -> Vec<String> {
        let is_regime = self.of == REGIME;
        let what = if is_regime { "shares" } else { "PAWN" };
        let mut notes = Vec::new();
        match &self.design {
            Design::Grid(sizes) => {
                let sizes = sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(" × ");
                notes.push(format!("On this grid of {sizes} points, each of which counts the same, the indices have no sampling error."));
            }
            Design::Unknown(why) => {
                let first_order = if is_regime { "" } else { " and no first-order index" };
                notes.push(format!("No {what}{first_order}: {why}."));
            }
            Design::Sample => {}
        }
        if let Some(chance) = self.chance.filter(|_| has_chance) {
            let chance = value::fixed(chance, 2);
            notes.push(format!("A parameter without effect could have {what} of {chance}."));
        }
        if self.chance.is_some() && self.points < FEW_POINTS {
            let points = self.points;
            notes.push(format!("Only {points} points: the indices say little; give at least {FEW_POINTS}."));
        }
        if self.missing > 0 {
            let jobs = count(self.missing as u64, "job");
            notes.push(format!("{jobs} without a value here: no index says anything of these points."));
        }
        notes.extend(self.remarks.iter().cloned());
        notes
    }
}

/// The columns of a parameter for readers.
fn shown(design: &Design, is_regime: bool, is_morris: bool) -> Vec<Column<Indices>> {
    let parameter = Column::new("parameter", "", "", |own: &Indices| own.name.as_str().into());
    let first = Column::new("first order", "", "", |own: &Indices| in_words(own.first_order).into());
    let total = Column::new("total", "", "", |own: &Indices| in_words(own.total).into());
    let pawn = Column::new("PAWN", "", "", |own: &Indices| in_words(own.pawn).into());
    let shares = Column::new("shares", "", "", |own: &Indices| in_words(own.pawn).into());
    let size = Column::new("mean size of effects", "", "", |own: &Indices| {
        let number = |number: f64| value::significant(number, 3);
        let size = |(Index { value, interval }, _)| match interval {
            Some([low, high]) => format!("{} ({} … {})", number(value), number(low), number(high)),
            None => number(value),
        };
        own.effects.map(size).into()
    });
    let deviation = Column::new("their deviation", "", "", |own: &Indices| {
        own.effects.map(|(_, deviation)| value::significant_number(deviation, 3)).into()
    });
    match (design, is_regime) {
        _ if is_morris => vec![parameter, size, deviation],
        (Design::Unknown(_), _) => vec![parameter],
        (_, true) => vec![parameter, shares],
        (Design::Grid(_), false) => vec![parameter, first, total, pawn],
        (Design::Sample, false) => vec![parameter, first, pawn],
    }
}

/// An index with its interval; none if there is no index.
fn in_words(index: Option<Index>) -> Option<String> {
    index.map(|Index { value, interval }| match interval {
        Some(interval) => {
            let [low, high] = interval.map(|bound| value::fixed(bound, 2));
            format!("{} ({low} … {high})", value::fixed(value, 2))
        }
        None => value::fixed(value, 3),
    })
}

/// An index of a parameter.
#[derive(Clone, Copy)]
struct Line<'a> {
    of: &'a Sensitivity,
    parameter: &'a str,
    kind: &'static str,
    index: Index,
}

#[rustfmt::skip]
fn columns<'a>() -> [Column<Line<'a>>; 8] {
    [
        Column::new("quantity", "", "quantity, or regime", |line| line.of.of.as_str().into()),
        Column::new("points", "", "jobs that count", |line| line.of.points.into()),
        Column::new("parameter", "", "parameter", |line| line.parameter.into()),
        Column::new("index", "", "which index: first_order, total, pawn, shares, effects_mean_size or effects_deviation", |line| line.kind.into()),
        Column::new("value", "", "its value; that of an elementary effect in the unit of the quantity", |line| line.index.value.into()),
        Column::new("low", "", "5 % of the resamples are below; empty on a full grid", |line| line.index.interval.map(|[low, _]| low).into()),
        Column::new("high", "", "95 % of the resamples are below; empty on a full grid", |line| line.index.interval.map(|[_, high]| high).into()),
        Column::new("by_chance", "", "how large the index can be by chance; empty on a full grid", |line| line.of.chance.filter(|_| matches!(line.kind, PAWN | SHARES)).into()),
    ]
}

const PAWN: &str = "pawn";
const SHARES: &str = "shares";

/// The indices: quantity, points, parameter, index, its value and its interval.
pub fn indices_table(found: &[Sensitivity]) -> Table {
    fn of_parameter<'a>(of: &'a Sensitivity, own: &'a Indices) -> impl Iterator<Item = Line<'a>> {
        let Indices { name, first_order, total, pawn, effects } = own;
        let deviation = effects.map(|(_, deviation)| Index { value: deviation, interval: None });
        let all = [
            ("first_order", *first_order),
            ("total", *total),
            (if of.of == REGIME { SHARES } else { PAWN }, *pawn),
            ("effects_mean_size", effects.map(|(index, _)| index)),
            ("effects_deviation", deviation),
        ];
        all.into_iter()
            .filter_map(move |(kind, index)| Some(Line { of, parameter: name, kind, index: index? }))
    }
    let lines = found.iter().flat_map(|of| of.parameters.iter().flat_map(move |own| of_parameter(of, own)));
    Table::of("sensitivity", &columns(), &lines.collect::<Vec<_>>())
}

/// The columns, for the page of columns.
pub(in crate::report) fn described() -> [FileColumns; 2] {
    let points = "A line is a job that has ended, with the parameters that vary and the quantities. A parameter that is a name has numbers \
                  from 0.";
    [
        FileColumns::new(
            &["sensitivity.csv"],
            "A line is an [index](report.md#which-parameter-decides) of a parameter.",
            &columns(),
        ),
        FileColumns {
            heads: vec![any_quantity()],
            ..FileColumns::new::<Line>(&["sensitivity_points.csv"], points, [])
        },
    ]
}
