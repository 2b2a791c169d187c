//! Pages as Markdown that is readable as plain text too.

use super::page::{Block, Figure, Grid, Page, Span, Text, Tile};
use crate::units::{printable, printable_lines};
use std::fmt::Write;

/// Blocks below one another.
pub fn of_blocks(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        write_block(&mut text, block);
    }
    text
}

/// A page; a part of one has no title.
pub fn of_page(page: &Page) -> String {
    let mut text =
        if page.title.is_empty() { String::new() } else { format!("# {}\n\n", escape(&page.title)) };
    page.lead.iter().for_each(|block| write_block(&mut text, block));
    for section in &page.sections {
        let _ = write!(text, "## {}\n\n", escape(&section.heading));
        section.blocks.iter().for_each(|block| write_block(&mut text, block));
    }
    page.foot.iter().for_each(|block| write_block(&mut text, block));
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

fn write_block(out: &mut String, block: &Block) {
    match block {
        Block::Heading(words) => {
            let _ = write!(out, "### {}\n\n", escape(words));
        }
        Block::Text(text) | Block::Note(text) => {
            let _ = write!(out, "{}\n\n", spans(text));
        }
        Block::List(items) => write_list(out, items),
        Block::Table(grid) => write_grid(out, grid),
        Block::Figures(figures) => {
            for Figure { file, caption, data, .. } in figures {
                let caption = escape(caption);
                let _ = write!(out, "![{caption}]({file})\n\n{caption}");
                if let Some((data, _)) = data {
                    let _ = write!(out, " Data: [{data}]({data}).");
                }
                out.push_str("\n\n");
            }
        }
        Block::Data(files) => {
            let links: Vec<String> = files.iter().map(|(file, _)| format!("[{file}]({file})")).collect();
            let _ = write!(out, "Data: {}\n\n", links.join(", "));
        }
        Block::Tiles(tiles) => {
            let line = |tile: &Tile| {
                let note = if tile.note.is_empty() { String::new() } else { format!(" ({})", tile.note) };
                Text::from(format!("{}: {}{note}", tile.name, tile.value))
            };
            write_list(out, &tiles.iter().map(line).collect::<Vec<_>>());
        }
        Block::Warning(head, lines) => {
            let _ = write!(out, "**{}**\n\n", spans(head));
            write_list(out, lines);
        }
        Block::Fold(summary, blocks) => {
            let _ = write!(out, "{}:\n\n", escape(summary));
            for block in blocks {
                write_block(out, block);
            }
        }
        Block::Code(text) => {
            let text = printable_lines(text.trim_end());
            let fence = "`".repeat(longest_run(&text, '`').max(2) + 1);
            let _ = write!(out, "{fence}\n{text}\n{fence}\n\n");
        }
    }
}

fn write_list(out: &mut String, items: &[Text]) {
    for item in items {
        let _ = writeln!(out, "- {}", spans(item));
    }
    if !items.is_empty() {
        out.push('\n');
    }
}

fn write_grid(out: &mut String, grid: &Grid) {
    for (heading, lines) in &grid.groups {
        if !heading.is_empty() {
            let _ = write!(out, "### {}\n\n", escape(heading));
        }
        let lines: Vec<Vec<String>> = lines.iter().map(|line| line.iter().map(spans).collect()).collect();
        out.push_str(&table(&grid.heads, &lines, !grid.has_words));
        out.push('\n');
    }
    if !grid.rest.is_empty() {
        let _ = write!(out, "{}\n\n", spans(&Text::marked(&grid.rest)));
    }
}

/// A table whose columns are padded to equal width. Its cells are Markdown already.
pub fn table(heads: &[String], lines: &[Vec<String>], is_right: bool) -> String {
    let heads: Vec<String> = heads.iter().map(|cell| escape(cell)).collect();
    let widths: Vec<usize> = (0..heads.len())
        .map(|column| {
            let cells = std::iter::once(&heads).chain(lines).map(|line| line[column].chars().count());
            // `---:` is the shortest rule that states an alignment.
            cells.max().unwrap_or(0).max(4)
        })
        .collect();
    let pad = |cell: &String, width: usize| {
        if is_right { format!(" {cell:>width$} |") } else { format!(" {cell:<width$} |") }
    };
    let write_line = |line: &Vec<String>| {
        let cells: String = line.iter().zip(&widths).map(|(cell, &width)| pad(cell, width)).collect();
        format!("|{cells}\n")
    };
    let rule: String = widths
        .iter()
        .map(|&width| {
            let dashes = "-".repeat(width - 1);
            if is_right { format!(" {dashes}: |") } else { format!(" :{dashes} |") }
        })
        .collect();
    let body: String = lines.iter().map(write_line).collect();
    format!("{}|{rule}\n{body}", write_line(&heads))
}

fn spans(text: &Text) -> String {
    let span = |span: &Span| match span {
        Span::Plain(words) | Span::Symbol(words) => escape(words),
        Span::Strong(words) => format!("**{}**", escape(words)),
        Span::Code(words) => code(words),
        Span::Link(words, address) => format!("[{}]({address})", escape(words)),
        Span::Download(file, _) => format!("[{file}]({file})"),
        Span::Break => " ".to_owned(),
    };
    text.0.iter().map(span).collect()
}

/// Text on one line, escaped for a table or a heading.
pub fn escape(text: &str) -> String {
    // Large tables consist of numbers mostly: this is the fast path for them.
    if text.bytes().all(|c| c.is_ascii_alphanumeric() || matches!(c, b'.' | b'_' | b'~' | b'-' | b' ')) {
        return text.to_owned();
    }
    let line = one_line(text)
        .replace('\\', "\\\\")
        .replace('|', "\\|")
        .replace('<', "&lt;")
        .replace('*', "\\*")
        .replace('`', "\\`")
        // Without these a bracket is no link, and units in brackets stay readable.
        .replace("](", "\\](")
        .replace("][", "\\][");
    // Only at the beginning of a line such a bracket is the address of a link.
    let line = if line.starts_with('[') { line.replace("]:", "\\]:") } else { line };
    // Words beside another span keep their distance from it.
    format!(
        "{}{line}{}",
        if text.starts_with(' ') { " " } else { "" },
        if text.ends_with(' ') { " " } else { "" }
    )
}

/// Text as a span of code.
fn code(text: &str) -> String {
    format!("`{}`", one_line(text).replace('`', "'"))
}

/// Words with one space between them, and nothing that a terminal obeys.
fn one_line(text: &str) -> String {
    printable(&text.split_whitespace().collect::<Vec<_>>().join(" ")).into_owned()
}

/// The length of the longest run of a character.
fn longest_run(text: &str, of: char) -> usize {
    text.split(|c| c != of).map(str::len).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::publish::page::Section;

    /// Protects: every kind of block has its form, a long table says where the rest is, and no text of a user becomes markup.
    #[test]
    fn blocks_have_their_form() {
        let figure = Figure {
            file: "a.svg".to_owned(),
            caption: "μ* < 1".to_owned(),
            data: Some(("a.csv".to_owned(), None)),
            ..Figure::default()
        };
        let lines = (0..102).map(|i| vec![i.to_string(), "a|b".to_owned()]);
        let page = Page {
            title: "a * b".to_owned(),
            lead: vec![Block::Tiles(vec![Tile::new("jobs", "3", "all")])],
            sections: vec![Section::new(
                "s",
                "<b>",
                vec![
                    Block::text("see `jobs.csv` first"),
                    Block::figure(figure),
                    Block::Table(Grid::of(&["n", "what"], lines, "jobs.csv")),
                    Block::Warning("Check:".into(), vec!["one".into()]),
                ],
            )],
            ..Page::default()
        };
        let text = of_page(&page);
        for part in [
            "# a \\* b\n\n- jobs: 3 (all)\n\n## &lt;b>\n\nsee `jobs.csv` first\n",
            "![μ\\* &lt; 1](a.svg)\n\nμ\\* &lt; 1 Data: [a.csv](a.csv).\n",
            "|    n | what |\n| ---: | ---: |\n|    0 | a\\|b |\n",
            "|   99 | a\\|b |\n\n… and 2 more: see `jobs.csv`.\n",
            "**Check:**\n\n- one\n",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("| 100"));
    }

    /// Protects: a study from a stranger puts no links and no commands for terminals into a report.
    #[test]
    fn texts_are_no_links() {
        assert_eq!(escape("a [b](https://c.de) [f [Hz]"), "a [b\\](https://c.de) [f [Hz]");
        assert_eq!(escape("[a][b] [b]: c"), "[a\\][b] [b\\]: c");
        assert_eq!(escape("red \u{1b}[31m \u{202e}"), "red \\\\u{1b}[31m \\\\u{202e}");
        let code = of_blocks(&[Block::Code("```\n~~~~~~\n[a](b)\n````\n\u{1b}[31m".to_owned())]);
        assert_eq!(code, "`````\n```\n~~~~~~\n[a](b)\n````\n\\u{1b}[31m\n`````\n\n");
    }
}
