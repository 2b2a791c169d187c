//! A page that is one file: no network, no other files, readable on a phone and on paper.
//!
//! ```text
//! body (sections of figures, tables, lists) ──► page: shell + style.css + script.js ──► one text
//! ```
//!
//! Everything that comes from outside goes through the template, which escapes it; what does not is drawn here.
//! Without the script nothing is lost but the tooltip that is there at once: the browser's own shows the same text.

mod data_uri;

use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// What the page may load: nothing. A favicon is asked for unless there is one.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// The whole page. The body begins with what is below the title; with `refresh_s` it loads itself anew that often.
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

/// Links to the sections below, by their ids.
pub fn navigation<'a>(sections: impl IntoIterator<Item = (&'a str, &'a str)>) -> Markup {
    html! {
        nav aria-label="Sections" {
            ul { @for (id, heading) in sections { li { a href={ "#" (id) } { (heading) } } } }
        }
    }
}

/// A section that can be linked to.
pub fn section(id: &str, heading: &str, content: &Markup) -> Markup {
    html! {
        section id=(id) {
            h2 { (heading) }
            (content)
        }
    }
}

/// A drawing with its caption and the data behind it, as a file of that name to download.
///
/// The drawing is SVG made here: it goes into the page as it is.
pub fn figure(svg: &str, caption: &str, data: Option<(&str, &str)>) -> Markup {
    html! {
        figure {
            div.scroll tabindex="0" role="group" aria-label=(caption) { (PreEscaped(labelled(svg, caption))) }
            figcaption {
                (caption)
                @if let Some((file, csv)) = data { " " (download(file, csv)) }
            }
        }
    }
}

/// The drawing as one image with a name.
fn labelled(svg: &str, caption: &str) -> String {
    let label = html! { (caption) }.into_string().replace('"', "&quot;");
    svg.replacen("<svg ", &format!("<svg role=\"graphics-document\" aria-label=\"{label}\" "), 1)
}

/// A link that holds a CSV file.
pub fn download(file: &str, csv: &str) -> Markup {
    html! { a.download download=(file) href=(data_uri::csv(csv)) { (file) } }
}

/// A table in a box of its own, in which it scrolls where the page is narrow. The first cell of a line is its heading.
pub fn table(header: &[String], lines: &[Vec<Markup>]) -> Markup {
    html! {
        div.scroll tabindex="0" role="group" aria-label="table" {
            table {
                thead { tr { @for cell in header { th scope="col" { (cell) } } } }
                tbody {
                    @for line in lines {
                        tr {
                            @for (column, cell) in line.iter().enumerate() {
                                @if column == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A few numbers to begin with: what it is, the value, and a word about it that may be empty.
pub fn tiles(tiles: &[(&str, String, String)]) -> Markup {
    html! {
        dl.tiles {
            @for (name, value, note) in tiles {
                div {
                    dt { (name) }
                    dd { strong { (value) } @if !note.is_empty() { small { (note) } } }
                }
            }
        }
    }
}

/// What must not be overlooked.
pub fn warning(content: &Markup) -> Markup {
    html! { div.warning role="note" { (content) } }
}

/// What is shown when it is asked for, and on paper.
pub fn details(summary: &str, content: &Markup) -> Markup {
    html! { details { summary { (summary) } (content) } }
}
