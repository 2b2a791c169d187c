//! Pages as data: sections of blocks, which are shown as HTML and as Markdown.
//!
//! ```text
//! Page { sections: [Section { heading, blocks }] } ──► html::of_page ──► one file for a browser
//!                                                  └──► markdown::of_page
//! ```
//!
//! Long lists and tables are cut in one place, [`limited`], which says where the rest is.

use super::table::Table;
use std::borrow::Cow;

/// A page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Its title.
    pub title: String,
    /// What comes before the links to sections.
    pub lead: Vec<Block>,
    /// The sections.
    pub sections: Vec<Section>,
    /// What comes at the end.
    pub foot: Vec<Block>,
    /// The page reloads itself every so many seconds.
    pub refresh_s: Option<u32>,
}

/// A part of a page with a heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Its name in addresses.
    pub id: Cow<'static, str>,
    /// Its heading.
    pub heading: String,
    /// What it has.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A heading below that of the section.
    Heading(String),
    /// A paragraph.
    Text(Text),
    /// A paragraph that stands back.
    Note(Text),
    /// A list.
    List(Vec<Text>),
    /// A table for readers.
    Table(Grid),
    /// Tables of data: the names of the files, and their contents if they fit into a page.
    Data(Vec<(String, Option<String>)>),
    /// Drawings; several stand beside one another where there is room.
    Figures(Vec<Figure>),
    /// The main numbers.
    Tiles(Vec<Tile>),
    /// Something that a reader must know first, with details.
    Warning(Text, Vec<Text>),
    /// Something that a reader can unfold. Paper shows it unfolded.
    Fold(String, Vec<Block>),
    /// A text as it is.
    Code(String),
}

/// A table for readers: lines of texts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Grid {
    /// The names of the columns.
    pub heads: Vec<String>,
    /// Lines under headings, which may be empty.
    pub groups: Vec<(String, Vec<Vec<Text>>)>,
    /// Whether cells are texts, which may be broken into lines. Otherwise they are numbers.
    pub has_words: bool,
    /// What is left out, in words; empty if nothing is.
    pub rest: String,
}

/// A drawing with its caption.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// The name of its file.
    pub file: String,
    /// The drawing as SVG.
    pub svg: String,
    /// What it shows.
    pub caption: String,
    /// A file of the data behind it, and its contents if they fit into a page.
    pub data: Option<(String, Option<String>)>,
}

/// A number with its name.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tile {
    /// What it is.
    pub name: String,
    /// The number.
    pub value: String,
    /// More about it; may be empty.
    pub note: String,
}

/// Words with marks.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Text(pub Vec<Span>);

/// A part of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Span {
    /// Words.
    Plain(String),
    /// Words that stand out.
    Strong(String),
    /// A name in files and commands.
    Code(String),
    /// A symbol; what follows a `_` is a subscript, up to the next sign.
    Symbol(String),
    /// Words that lead to an address.
    Link(String, String),
    /// A link that contains a file of data: its name and its contents.
    Download(String, String),
    /// The end of a line.
    Break,
}

impl From<&str> for Text {
    fn from(words: &str) -> Self {
        Self(vec![Span::Plain(words.to_owned())])
    }
}

impl From<String> for Text {
    fn from(words: String) -> Self {
        Self(vec![Span::Plain(words)])
    }
}

impl From<&String> for Text {
    fn from(words: &String) -> Self {
        words.as_str().into()
    }
}

impl From<Span> for Text {
    fn from(span: Span) -> Self {
        Self(vec![span])
    }
}

impl Text {
    /// The program's own words, in which names stand between backticks: ``see `jobs.csv` ``.
    pub fn marked(words: &str) -> Self {
        let parts = words.split('`').enumerate().filter(|(_, part)| !part.is_empty());
        let span = |(number, part): (usize, &str)| {
            if number % 2 == 0 { Span::Plain(part.to_owned()) } else { Span::Code(part.to_owned()) }
        };
        Self(parts.map(span).collect())
    }

    /// A name in files and commands.
    pub fn code(name: impl Into<String>) -> Self {
        Span::Code(name.into()).into()
    }

    /// Words that stand out.
    pub fn strong(words: impl Into<String>) -> Self {
        Span::Strong(words.into()).into()
    }

    /// With another part at its end.
    #[must_use]
    pub fn and(mut self, more: impl Into<Self>) -> Self {
        self.0.extend(more.into().0);
        self
    }

    /// The words without marks.
    pub fn words(&self) -> String {
        let word = |span: &Span| match span {
            Span::Plain(words)
            | Span::Strong(words)
            | Span::Code(words)
            | Span::Symbol(words)
            | Span::Link(words, _)
            | Span::Download(words, _) => words.clone(),
            Span::Break => " ".to_owned(),
        };
        self.0.iter().map(word).collect()
    }
}

/// Longer data is beside a page and not in it \[byte\].
pub const MOST_DATA: usize = 1_000_000;

/// Most lines of a list or of a table on a page.
pub const MOST_LINES: usize = 100;

/// The first [`MOST_LINES`] of the items, and words that say how many there are more and which file has them; empty if there
/// are no more.
pub fn limited<T>(items: impl IntoIterator<Item = T>, file: &str) -> (Vec<T>, String) {
    let mut items = items.into_iter();
    let shown: Vec<T> = items.by_ref().take(MOST_LINES).collect();
    let more = items.count();
    (shown, if more > 0 { format!("… and {more} more: see `{file}`.") } else { String::new() })
}

impl Page {
    /// The drawings of its sections, folded ones left out.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        blocks.flat_map(|block| if let Block::Figures(figures) = block { figures.as_slice() } else { &[] })
    }
}

impl Section {
    /// A section.
    pub fn new(id: impl Into<Cow<'static, str>>, heading: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self { id: id.into(), heading: heading.into(), blocks }
    }
}

impl Block {
    /// A paragraph of the program's own words, with names between backticks.
    pub fn text(words: &str) -> Self {
        Self::Text(Text::marked(words))
    }

    /// A paragraph of the program's own words that stands back.
    pub fn note(words: &str) -> Self {
        Self::Note(Text::marked(words))
    }

    /// A list of sentences.
    pub fn list<T: Into<Text>>(items: impl IntoIterator<Item = T>) -> Self {
        Self::List(items.into_iter().map(Into::into).collect())
    }

    /// A drawing.
    pub fn figure(figure: Figure) -> Self {
        Self::Figures(vec![figure])
    }
}

impl Grid {
    /// The first lines of a table; `file` has all of them.
    pub fn of<T: Into<Text>>(heads: &[&str], lines: impl IntoIterator<Item = Vec<T>>, file: &str) -> Self {
        let (lines, rest) = limited(lines, file);
        let lines = lines.into_iter().map(|line| line.into_iter().map(Into::into).collect()).collect();
        let heads = heads.iter().map(|&head| head.to_owned()).collect();
        Self { heads, groups: vec![(String::new(), lines)], has_words: false, rest }
    }

    /// The first lines of a table that programs read too.
    pub fn of_table(table: &Table) -> Self {
        let heads: Vec<&str> = table.names().collect();
        Self::of(&heads, table.cells(), &format!("{}.csv", table.stem))
    }

    /// With cells that may be broken into lines.
    #[must_use]
    pub fn with_words(mut self) -> Self {
        self.has_words = true;
        self
    }

    /// Whether it has no lines.
    pub fn is_empty(&self) -> bool {
        self.groups.iter().all(|(_, lines)| lines.is_empty())
    }
}

impl Tile {
    /// A number with its name and more about it.
    pub fn new(name: &str, value: impl Into<String>, note: impl Into<String>) -> Self {
        Self { name: name.to_owned(), value: value.into(), note: note.into() }
    }
}
