//! What something was made with: drawings, and a table of quantities in groups.

use super::page::{Block, Figure, Grid, Span, Text};

/// Drawings and quantities.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sheet {
    /// The drawings.
    pub drawings: Vec<Drawing>,
    /// The quantities.
    pub groups: Vec<SheetGroup>,
}

/// A drawing of this crate.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Drawing {
    /// The name of its file without the ending.
    pub stem: &'static str,
    /// The drawing as SVG.
    pub svg: String,
    /// What it shows.
    pub caption: String,
}

/// Quantities under one heading.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SheetGroup {
    /// The heading.
    pub heading: &'static str,
    /// The quantities.
    pub lines: Vec<SheetLine>,
}

/// A quantity.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SheetLine {
    /// Its symbol; may be empty.
    pub symbol: &'static str,
    /// What it is.
    pub name: String,
    /// Its value with the unit, or its values.
    pub value: String,
    /// Its name in files and commands; may be empty.
    pub key: &'static str,
    /// Where the value comes from; may be empty.
    pub origin: &'static str,
    /// Whether it has several values, so that it is that of no single job.
    pub varies: bool,
}

const HEADS: [&str; 5] = ["symbol", "quantity", "value", "name in files", "from"];

impl Sheet {
    /// The drawings beside one another, as far as there is room, and the table of quantities below them.
    pub fn blocks(&self) -> Vec<Block> {
        let figure = |drawing: &Drawing| Figure {
            file: format!("{}.svg", drawing.stem),
            svg: drawing.svg.clone(),
            caption: drawing.caption.clone(),
            data: None,
        };
        let line = |line: &SheetLine| {
            let key = if line.key.is_empty() { Text::default() } else { Text::code(line.key) };
            let symbol = Span::Symbol(line.symbol.to_owned());
            vec![symbol.into(), (&line.name).into(), (&line.value).into(), key, line.origin.into()]
        };
        let group = |group: &SheetGroup| (group.heading.to_owned(), group.lines.iter().map(line).collect());
        let table = Grid {
            heads: HEADS.map(str::to_owned).into(),
            groups: self.groups.iter().map(group).collect(),
            has_words: true,
            rest: String::new(),
        };
        let figures = Block::Figures(self.drawings.iter().map(figure).collect());
        let figures = Some(figures).filter(|_| !self.drawings.is_empty());
        figures.into_iter().chain([Block::Table(table)]).collect()
    }
}
