//! What something was made with: drawings, and a table of quantities in groups.

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
}
