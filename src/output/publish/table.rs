//! Tables: columns with a name, a unit and a meaning, and their only writer as CSV, JSON lines, aligned text and Markdown.
//!
//! A [`Column`] says in one row what it is called, what it means, and how it is read from a line's subject. The header, the
//! cells, the command `columns` and the pages of columns come from the same list, and can thus never differ.

use super::value;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use std::io::{self, Write};
use std::sync::Arc;

/// What a column is called and what it means.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Head {
    /// Its name in the header, unique in its table.
    pub name: Cow<'static, str>,
    /// The unit of its numbers; empty for text and for numbers without a unit, and then null in JSON.
    #[serde(serialize_with = "null_if_empty")]
    pub unit: Cow<'static, str>,
    /// What its values mean.
    pub meaning: Cow<'static, str>,
}

fn null_if_empty<S: Serializer>(unit: &str, serializer: S) -> Result<S::Ok, S::Error> {
    if unit.is_empty() { serializer.serialize_none() } else { serializer.serialize_some(unit) }
}

/// A column of a table whose lines are about a `T`.
pub struct Column<T: ?Sized> {
    /// Its name, its unit and its meaning.
    pub head: Head,
    read: Read<T>,
}

enum Read<T: ?Sized> {
    Plain(fn(&T) -> Value),
    Made(Arc<dyn Fn(&T) -> Value + Send + Sync>),
}

impl<T: ?Sized> Clone for Read<T> {
    fn clone(&self) -> Self {
        match self {
            Self::Plain(read) => Self::Plain(*read),
            Self::Made(read) => Self::Made(Arc::clone(read)),
        }
    }
}

impl<T: ?Sized> Read<T> {
    fn value(&self, of: &T) -> Value {
        match self {
            Self::Plain(read) => read(of),
            Self::Made(read) => read(of),
        }
    }
}

impl<T: ?Sized> Clone for Column<T> {
    fn clone(&self) -> Self {
        Self { head: self.head.clone(), read: self.read.clone() }
    }
}

impl<T: ?Sized> std::fmt::Debug for Column<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Column").field("head", &self.head).finish_non_exhaustive()
    }
}

impl<T: ?Sized> Column<T> {
    /// A column of a fixed list.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        meaning: &'static str,
        read: fn(&T) -> Value,
    ) -> Self {
        let head =
            Head { name: Cow::Borrowed(name), unit: Cow::Borrowed(unit), meaning: Cow::Borrowed(meaning) };
        Self { head, read: Read::Plain(read) }
    }

    /// A column that depends on what a study varies.
    pub fn made(head: Head, read: impl Fn(&T) -> Value + Send + Sync + 'static) -> Self {
        Self { head, read: Read::Made(Arc::new(read)) }
    }

    /// Its value; null where there is none, and for a number that is not finite, because JSON has no such numbers.
    pub fn value(&self, of: &T) -> Value {
        self.read.value(of)
    }
}

impl<T> Column<T> {
    /// The same column in a table about `U`s that have a `T` each.
    pub fn within<U>(self, part: impl Fn(&U) -> &T + Send + Sync + 'static) -> Column<U>
    where
        T: 'static,
    {
        Column::made(self.head.clone(), move |of| self.value(part(of)))
    }

    /// The same column under another name.
    #[must_use]
    pub fn named(mut self, name: impl Into<Cow<'static, str>>) -> Self {
        self.head.name = name.into();
        self
    }
}

/// A column as a row of a list: its name, its unit, its meaning, and how it is read.
impl<T: ?Sized> From<(&'static str, &'static str, &'static str, fn(&T) -> Value)> for Column<T> {
    fn from(
        (name, unit, meaning, read): (&'static str, &'static str, &'static str, fn(&T) -> Value),
    ) -> Self {
        Self::new(name, unit, meaning, read)
    }
}

impl Head {
    /// A name that depends on what a study varies.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        unit: impl Into<Cow<'static, str>>,
        meaning: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self { name: name.into(), unit: unit.into(), meaning: meaning.into() }
    }
}

/// A table that is in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The name of its file without the ending.
    pub stem: Cow<'static, str>,
    /// Its columns.
    pub heads: Vec<Head>,
    /// Its lines; each has a value for every column.
    pub lines: Vec<Vec<Value>>,
}

impl Table {
    /// A line for each of the subjects.
    pub fn of<'a, T: ?Sized + 'a>(
        stem: impl Into<Cow<'static, str>>,
        columns: &[Column<T>],
        subjects: impl IntoIterator<Item = &'a T>,
    ) -> Self {
        let line = |of: &T| columns.iter().map(|column| column.value(of)).collect();
        Self {
            stem: stem.into(),
            heads: columns.iter().map(|column| column.head.clone()).collect(),
            lines: subjects.into_iter().map(line).collect(),
        }
    }

    /// The names of its columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.heads.iter().map(|head| &*head.name)
    }

    /// Writes it in a format that programs read.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, format: Format, out: impl Write) -> io::Result<()> {
        let mut writer = TableWriter::new(format, &self.heads, out)?;
        self.lines.iter().try_for_each(|line| writer.line(line.iter().cloned()))?;
        writer.finish()?.flush()
    }

    /// It as CSV.
    ///
    /// # Panics
    /// Never: writing to memory cannot fail, and CSV of texts is text.
    pub fn csv(&self) -> String {
        let mut bytes = Vec::new();
        self.write(Format::Csv, &mut bytes).expect("memory takes everything");
        String::from_utf8(bytes).expect("cells are texts")
    }

    /// Its cells as a reader sees them: numbers with at most ten digits, and a sign where there is no value.
    pub fn cells(&self) -> Vec<Vec<String>> {
        let cell = |cell: &Value| match cell {
            Value::Null => value::MISSING.to_owned(),
            Value::Bool(is_true) => if *is_true { "yes" } else { "no" }.to_owned(),
            cell => value::rounded_text(cell),
        };
        self.lines.iter().map(|line| line.iter().map(cell).collect()).collect()
    }

    /// With at most so many significant digits in its numbers, for a reader.
    #[must_use]
    pub fn rounded(self, digits: usize) -> Self {
        self.rounded_from(0, digits)
    }

    /// The same without the first columns, which keep their digits: parameters are what somebody has chosen.
    #[must_use]
    pub fn rounded_from(mut self, first: usize, digits: usize) -> Self {
        let cells = self.lines.iter_mut().flat_map(|line| line.iter_mut().skip(first));
        for cell in cells.filter(|cell| cell.is_f64()) {
            *cell = cell.as_f64().map_or(Value::Null, |x| value::significant_number(x, digits));
        }
        self
    }

    /// The table without the columns that have one value in all lines, and each of these with its value if it has one, for a terminal that is not
    /// wide. A table of one line keeps all columns.
    #[must_use]
    pub fn without_constants(mut self) -> (Self, Vec<String>) {
        let cells = self.cells();
        let [first, others @ ..] = &cells[..] else { return (self, Vec::new()) };
        let is_constant: Vec<bool> = (0..self.heads.len())
            .map(|column| !others.is_empty() && others.iter().all(|line| line[column] == first[column]))
            .collect();
        let constant = self.names().zip(first).zip(&is_constant).filter(|(_, constant)| **constant);
        let known = constant.filter(|((_, cell), _)| *cell != value::MISSING);
        let named = known.map(|((name, cell), _)| format!("{name} {cell}")).collect();
        let heads = self.heads.into_iter().zip(&is_constant).filter(|(_, constant)| !**constant);
        self.heads = heads.map(|(head, _)| head).collect();
        for line in &mut self.lines {
            let cells =
                std::mem::take(line).into_iter().zip(&is_constant).filter(|(_, constant)| !**constant);
            *line = cells.map(|(cell, _)| cell).collect();
        }
        (self, named)
    }

    /// Aligned columns for a terminal: texts on the left side of their column, numbers on the right side.
    pub fn text(&self) -> String {
        let is_number = |column: usize| {
            let mut known =
                self.lines.iter().map(|line| &line[column]).filter(|value| !value.is_null()).peekable();
            known.peek().is_some() && known.all(Value::is_number)
        };
        let numbers: Vec<bool> = (0..self.heads.len()).map(is_number).collect();
        self.aligned(|column| numbers[column])
    }

    /// Aligned columns for a terminal, with the columns for which `is_right` is true on the right side.
    pub fn aligned(&self, is_right: impl Fn(usize) -> bool) -> String {
        let names: Vec<String> = self.names().map(str::to_owned).collect();
        aligned(&names, &self.cells(), is_right)
    }
}

/// Aligned columns, two spaces apart, below their names. Cells of the columns for which `is_right` is true are on the right side.
pub fn aligned(names: &[String], lines: &[Vec<String>], is_right: impl Fn(usize) -> bool) -> String {
    let lines: Vec<&[String]> = std::iter::once(names).chain(lines.iter().map(Vec::as_slice)).collect();
    let widths = widths(&lines);
    let padded = |line: &&[String]| {
        let cells = line.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if is_right(column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    lines.iter().map(padded).collect()
}

/// The narrowest last column of [`listed`]: below it, lines are not broken.
const NARROWEST: usize = 24;

/// Lines without a head whose cells stand below each other, indented by `indent`. On a terminal of `width` characters the last cells are
/// broken between words.
pub fn listed<L: AsRef<[String]>>(indent: usize, lines: &[L], width: Option<usize>) -> String {
    let lines: Vec<&[String]> = lines.iter().map(AsRef::as_ref).collect();
    let widths = widths(&lines);
    let Some(before) = widths.len().checked_sub(1) else { return String::new() };
    let start = indent + widths[..before].iter().map(|width| width + 2).sum::<usize>();
    let width = width.map(|width| width.saturating_sub(start)).filter(|width| *width >= NARROWEST);
    let written = |line: &&[String]| {
        let cells = line[..before].iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}  "));
        let last = broken(&line[before], width.unwrap_or(usize::MAX), start);
        format!("{}\n", format!("{}{}{last}", " ".repeat(indent), cells.collect::<String>()).trim_end())
    };
    lines.iter().map(written).collect()
}

/// The width of each column.
fn widths(lines: &[&[String]]) -> Vec<usize> {
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    (0..lines.first().map_or(0, |line| line.len())).map(width).collect()
}

/// Words in lines of at most `width` characters, of which all but the first are indented.
fn broken(words: &str, width: usize, indent: usize) -> String {
    let mut text = String::new();
    let mut used = 0;
    for (number, word) in words.split(' ').enumerate() {
        let length = word.chars().count();
        if number > 0 && used + 1 + length > width {
            text.push('\n');
            text += &" ".repeat(indent);
            used = 0;
        } else if number > 0 {
            text.push(' ');
            used += 1;
        }
        text += word;
        used += length;
    }
    text
}

/// What a page of columns says about files: their columns, whatever a study varies.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FileColumns {
    /// The files; a word in capitals stands for a name.
    pub files: Vec<String>,
    /// What their lines are, in Markdown.
    pub lines: &'static str,
    /// The columns that they always have.
    #[serde(rename = "columns")]
    pub heads: Vec<Head>,
}

impl FileColumns {
    /// The columns of a list.
    pub fn new<'a, T: ?Sized + 'a>(
        files: &[&str],
        lines: &'static str,
        columns: impl IntoIterator<Item = &'a Column<T>>,
    ) -> Self {
        let heads = columns.into_iter().map(|column| column.head.clone()).collect();
        Self { files: files.iter().map(|&file| file.to_owned()).collect(), lines, heads }
    }
}

/// A format that programs read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values with a header; cells without a value are empty.
    Csv,
    /// A JSON object in each line; cells without a value are null.
    JsonLines,
}

/// Writes a table line by line, so that a large one need not be in memory.
pub struct TableWriter<W: Write> {
    names: Vec<Cow<'static, str>>,
    lines: Lines<W>,
}

enum Lines<W: Write> {
    Csv(Box<::csv::Writer<W>>),
    Json(W),
}

impl<W: Write> TableWriter<W> {
    /// Begins a table; CSV gets its header.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(format: Format, heads: &[Head], out: W) -> io::Result<Self> {
        let names: Vec<_> = heads.iter().map(|head| head.name.clone()).collect();
        let lines = match format {
            Format::Csv => {
                let mut writer = ::csv::Writer::from_writer(out);
                writer.write_record(names.iter().map(|name| name.as_bytes())).map_err(io_error)?;
                Lines::Csv(Box::new(writer))
            }
            Format::JsonLines => Lines::Json(out),
        };
        Ok(Self { names, lines })
    }

    /// Writes a line; `cells` has a value for every column.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn line(&mut self, cells: impl IntoIterator<Item = Value>) -> io::Result<()> {
        match &mut self.lines {
            Lines::Csv(writer) => {
                writer.write_record(cells.into_iter().map(|cell| value::text(&cell))).map_err(io_error)
            }
            Lines::Json(out) => {
                let mut line = serde_json::Serializer::new(&mut *out);
                let mut map = line.serialize_map(Some(self.names.len()))?;
                for (name, cell) in self.names.iter().zip(cells) {
                    map.serialize_entry(name, &cell)?;
                }
                map.end()?;
                out.write_all(b"\n")
            }
        }
    }

    /// Writes what is still buffered, and gives back what it was written to.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<W> {
        match self.lines {
            Lines::Csv(writer) => writer.into_inner().map_err(::csv::IntoInnerError::into_error),
            Lines::Json(mut out) => out.flush().map(|()| out),
        }
    }
}

/// The I/O error behind a CSV error, so that a caller can recognise a closed pipe.
fn io_error(error: ::csv::Error) -> io::Error {
    match error.into_kind() {
        ::csv::ErrorKind::Io(source) => source,
        other => io::Error::other(format!("{other:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Mode {
        name: &'static str,
        rate: Option<f64>,
    }

    const COLUMNS: [Column<Mode>; 2] = [
        Column::new("mode", "", "name of the mode", |mode| mode.name.into()),
        Column::new("rate", "1/s", "growth rate", |mode| mode.rate.into()),
    ];

    fn table() -> Table {
        let modes = [Mode { name: "first, \"fast\"", rate: Some(0.1 + 0.2) }, Mode { name: "b", rate: None }];
        Table::of("modes", &COLUMNS, &modes)
    }

    /// Protects: a column that says the same in all lines is said once, and every cell of the others stays in its column. One line is no
    /// comparison.
    #[test]
    fn what_does_not_vary_is_said_once() {
        let head = |name: &'static str| Head::new(name, "", "");
        let heads = vec![head("a"), head("b"), head("c"), head("d")];
        let line = |b: u32, d: Value| vec![Value::from(1), Value::from(b), Value::Null, d];
        let lines = vec![line(1, true.into()), line(2, false.into()), line(3, true.into())];
        let table = Table { stem: "x".into(), heads, lines };
        let (varying, constant) = table.clone().without_constants();
        assert_eq!(varying.names().collect::<Vec<_>>(), ["b", "d"]);
        assert_eq!(varying.cells(), [["1", "yes"], ["2", "no"], ["3", "yes"]]);
        assert_eq!(constant, ["a 1"]);
        let one = Table { lines: table.lines[..1].to_vec(), ..table };
        assert_eq!(one.clone().without_constants(), (one, Vec::new()));
    }

    /// Protects: header and cells come from the same columns in every format, texts are quoted, a number reads back as the same
    /// number, and a value that is missing is an empty cell or null.
    #[test]
    fn formats_have_the_same_cells() {
        let table = table();
        assert_eq!(table.csv(), "mode,rate\n\"first, \"\"fast\"\"\",0.30000000000000004\nb,\n");
        let mut json = Vec::new();
        table.write(Format::JsonLines, &mut json).unwrap();
        let lines: Vec<Value> = String::from_utf8(json)
            .unwrap()
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        assert_eq!(lines[0]["rate"].as_f64(), Some(0.1 + 0.2));
        assert_eq!(lines[1], serde_json::json!({ "mode": "b", "rate": null }));
        assert_eq!(table.text(), "mode           rate\nfirst, \"fast\"   0.3\nb                 –\n");
    }

    /// Protects: every number and every text is read back as it was.
    #[test]
    fn cells_read_back_exactly() {
        let numbers = [0.1 + 0.2, 1.0 / 3.0, 2.5e-7, 1.234_567_890_123_456_7e-300, 6.02e23, -1e-5, 0.0];
        let text = "first line, with \"quotes\"\nsecond line; a comma, and a\r\nthird";
        let lines = numbers.map(|x| vec![x.into(), text.into()]).to_vec();
        let heads = ["x", "text"].map(|name| Head::new(name, "", "")).to_vec();
        let csv = Table { stem: "numbers".into(), heads, lines }.csv();
        let mut reader = ::csv::Reader::from_reader(csv.as_bytes());
        for (x, line) in numbers.iter().zip(reader.records()) {
            let line = line.unwrap();
            assert_eq!((line[0].parse().ok(), &line[1]), (Some(*x), text));
            assert!(line[0].len() <= 24, "{} is not the shortest form", &line[0]);
        }
    }

    /// Protects: cells stand below each other; long ones are broken between words within the terminal and keep all words.
    #[test]
    fn cells_are_aligned_and_broken() {
        let cell = |text: &str| text.to_owned();
        let long = "one two three four five six seven eight";
        let cells = [[cell("μ"), cell("0.4"), cell(long)], [cell("load"), cell("30 N"), cell("")]];
        let text = listed(1, &cells, None);
        assert_eq!(text, format!(" μ     0.4   {long}\n load  30 N\n"));
        let text = listed(1, &cells, Some(40));
        let expected = " μ     0.4   one two three four five six\n             seven eight\n load  30 N\n";
        assert_eq!(text, expected);
        assert!(text.lines().all(|line| line.chars().count() <= 40), "{text}");
        assert_eq!(listed(1, &cells, Some(30)).lines().count(), 2, "too narrow to break");
    }
}
