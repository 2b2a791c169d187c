//! A page that is one file. It loads nothing from the network or from other files, and is readable on a phone and on
//! paper.
//!
//! ```text
//! body (sections of figures, tables, lists) ──► page: shell + style.css + script.js ──► one text
//! ```
//!
//! All text goes through the template, which escapes it. Only drawings of this crate, the style sheet and the script are
//! inserted as they are. Without the script the browser shows the same tooltips after a delay.

mod data_uri;

use super::page::{self, Block, Grid, Page, Span, Text, Tile};
use super::value;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// The page may load nothing. The empty icon below keeps browsers from requesting one.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// A page of sections.
pub fn of_page(page: &Page) -> String {
    let body = html! {
        (blocks(&page.lead))
        @if page.sections.len() > 1 {
            (navigation(page.sections.iter().map(|section| (&*section.id, section.heading.as_str()))))
        }
        @for own in &page.sections { (section(&own.id, &own.heading, &blocks(&own.blocks))) }
        @if !page.foot.is_empty() { footer { (blocks(&page.foot)) } }
    };
    self::page(&page.title, page.refresh_s, &body)
}

/// Blocks below one another.
pub fn blocks(blocks: &[Block]) -> Markup {
    html! { @for own in blocks { (block(own)) } }
}

fn block(block: &Block) -> Markup {
    match block {
        Block::Heading(words) => html! { h3 { (words) } },
        Block::Text(text) => html! { p { (spans(text)) } },
        Block::Note(text) => html! { p.note { (spans(text)) } },
        Block::List(items) => {
            html! { @if !items.is_empty() { ul { @for item in items { li { (spans(item)) } } } } }
        }
        Block::Table(grid) => of_grid(grid),
        Block::Figures(figures) => match figures.as_slice() {
            [only] => of_figure(only),
            several => html! { div.drawings { @for own in several { (of_figure(own)) } } },
        },
        Block::Data(files) => html! {
            p {
                "Data:"
                @for (file, csv) in files {
                    @if let Some(csv) = csv { " " (download(file, csv)) }
                    @else { " " code { (file) } " (in the folder of this page)" }
                }
            }
        },
        Block::Tiles(own) => {
            let tile = |tile: &Tile| (tile.name.clone(), tile.value.clone(), tile.note.clone());
            let own: Vec<_> = own.iter().map(tile).collect();
            html! {
                dl.tiles {
                    @for (name, value, note) in &own {
                        div { dt { (name) } dd { strong { (value) } @if !note.is_empty() { small { (note) } } } }
                    }
                }
            }
        }
        Block::Warning(head, lines) => warning(&html! {
            strong { (spans(head)) }
            @if !lines.is_empty() { ul { @for line in lines { li { (spans(line)) } } } }
        }),
        Block::Fold(summary, own) => details(summary, &blocks(own)),
        Block::Code(text) => html! { pre { code { (text) } } },
    }
}

fn of_figure(own: &page::Figure) -> Markup {
    html! {
        figure {
            (PreEscaped(&own.svg))
            figcaption {
                (own.caption)
                @match &own.data {
                    Some((file, Some(csv))) => { " " (download(file, csv)) }
                    Some((file, None)) => { " Data: " code { (file) } "." }
                    None => {}
                }
            }
        }
    }
}

/// Whether most cells of a column are words. Numbers may have signs, errors and units.
fn is_of_words(grid: &Grid, column: usize) -> bool {
    let cells =
        grid.groups.iter().flat_map(|(_, lines)| lines).filter_map(|line| line.get(column)?.0.first());
    let (mut words, mut numbers) = (0, 0);
    for span in cells {
        match span {
            Span::Plain(text) | Span::Strong(text) | Span::Link(text, _) => {
                match text.trim_start_matches(['-', '−', '+', '<', '>', '≤', '≥', '±', ' ']).chars().next()
                {
                    Some(first) if first.is_ascii_digit() => numbers += 1,
                    Some(_) if text != value::MISSING => words += 1,
                    _ => {}
                }
            }
            _ => words += 1,
        }
    }
    words > numbers
}

fn of_grid(grid: &Grid) -> Markup {
    let words: Vec<bool> = (0..grid.heads.len()).map(|column| is_of_words(grid, column)).collect();
    let class = |column: usize| words.get(column).is_some_and(|is_text| *is_text).then_some("text");
    let line = |cells: &[Text]| {
        html! {
            tr {
                @for (column, cell) in cells.iter().enumerate() {
                    @if column == 0 { th scope="row" { (spans(cell)) } } @else {
                        td class=[class(column)] { (spans(cell)) }
                    }
                }
            }
        }
    };
    html! {
        div.scroll.words[grid.has_words] tabindex="0" role="group" aria-label="table" {
            table {
                thead {
                    tr {
                        @for (column, head) in grid.heads.iter().enumerate() {
                            th class=[class(column)] scope="col" { (head.replace(" = ", "\u{a0}=\u{a0}")) }
                        }
                    }
                }
                @for (heading, lines) in &grid.groups {
                    tbody {
                        @if !heading.is_empty() {
                            tr.group { th scope="rowgroup" colspan=(grid.heads.len()) { (heading) } }
                        }
                        @for cells in lines { (line(cells)) }
                    }
                }
            }
        }
        @if !grid.rest.is_empty() { p.note { (spans(&Text::marked(&grid.rest))) } }
    }
}

fn spans(text: &Text) -> Markup {
    html! {
        @for span in &text.0 {
            @match span {
                Span::Plain(words) => (words),
                Span::Strong(words) => strong { (words) },
                Span::Code(words) => code { (words) },
                Span::Symbol(words) => i { (symbol(words)) },
                Span::Link(words, address) => a href=(address) { (words) },
                Span::Download(file, csv) => (download(file, csv)),
                Span::Break => br;,
            }
        }
    }
}

/// A symbol; what follows a `_` is a subscript, up to the next sign.
fn symbol(text: &str) -> Markup {
    let Some((before, after)) = text.split_once('_') else { return html! { (text) } };
    let end = after.find(|c: char| !c.is_alphanumeric()).unwrap_or(after.len());
    let (index, rest) = after.split_at(end);
    html! { (before) sub { (index) } (symbol(rest)) }
}

/// The whole page. `body` follows the title. The page reloads itself every `refresh_s` seconds, if that is given.
pub fn page(title: &str, refresh_s: Option<u32>, body: &Markup) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                @if let Some(seconds) = refresh_s {
                    meta http-equiv="refresh" content=(seconds);
                }
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    h1 { (title) }
                    (body)
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    markup.into_string()
}

/// Links to sections, given by id and heading.
pub fn navigation<'a>(sections: impl IntoIterator<Item = (&'a str, &'a str)>) -> Markup {
    html! {
        nav aria-label="Sections" {
            ul { @for (id, heading) in sections { li { a href={ "#" (id) } { (heading) } } } }
        }
    }
}

/// A section with an id, which links can use.
pub fn section(id: &str, heading: &str, content: &Markup) -> Markup {
    html! {
        section id=(id) {
            h2 { (heading) }
            (content)
        }
    }
}

/// A link that contains a CSV file.
pub fn download(file: &str, csv: &str) -> Markup {
    html! { a.download download=(file) href=(data_uri::csv(csv)) { (file) } }
}

/// The address of a file beside the page, from its relative path.
pub fn address(path: &str) -> String {
    data_uri::of_path(path)
}

/// A warning.
pub fn warning(content: &Markup) -> Markup {
    html! { div.warning role="note" { (content) } }
}

/// Content that the reader can unfold. Paper shows it unfolded.
pub fn details(summary: &str, content: &Markup) -> Markup {
    html! { details { summary { (summary) } (content) } }
}
