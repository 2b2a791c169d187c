//! Drawings and a table of quantities.

use super::figure;
use crate::publish::sheet::{Sheet, SheetGroup};
use maud::{Markup, html};

const COLUMNS: [&str; 5] = ["symbol", "quantity", "value", "name in files", "from"];

/// The drawings beside each other, as far as there is room, and the table below them.
pub fn sheet(sheet: &Sheet) -> Markup {
    html! {
        div.drawings { @for drawing in &sheet.drawings { (figure(&drawing.svg, &drawing.caption, None)) } }
        div.scroll tabindex="0" role="group" aria-label="table" {
            table.quantities {
                thead { tr { @for heading in COLUMNS { th scope="col" { (heading) } } } }
                @for group in &sheet.groups { (body(group)) }
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

fn body(group: &SheetGroup) -> Markup {
    html! {
        tbody {
            tr.group { th scope="rowgroup" colspan=(COLUMNS.len()) { (group.heading) } }
            @for line in &group.lines {
                tr {
                    td.symbol { (symbol(line.symbol)) }
                    th scope="row" { (line.name) }
                    td { (line.value) }
                    td { @if !line.key.is_empty() { code { (line.key) } } }
                    td { (line.origin) }
                }
            }
        }
    }
}
