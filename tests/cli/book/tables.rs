//! The pages of columns, and the tables in CSV that the examples write.

use std::collections::BTreeSet;

use super::files::matches;

/// The first column of the tables in a text: names of columns or of parameters.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|line| line.split('`').next())
}

/// The name that stands for columns of quantities.
const QUANTITY: &str = "QUANTITY";

/// A section of the page.
struct Section<'a> {
    /// The patterns of its files.
    files: Vec<&'a str>,
    own: BTreeSet<&'a str>,
    /// Those of its columns that no table has had yet.
    unused: BTreeSet<&'a str>,
}

impl<'a> Section<'a> {
    fn of(text: &'a str) -> Self {
        let files = text.lines().next().unwrap().split('`').skip(1).step_by(2).collect();
        let own: BTreeSet<&str> = names(text).collect();
        Self { files, unused: own.clone(), own }
    }
}

/// Asserts that each column of each table is in the section of its file, or is a parameter; and that the page has no other column. Tables
/// without a section have columns of the export.
pub fn assert_documented<'a>(
    page: &str,
    common: [&str; 2],
    tables: impl Iterator<Item = (&'a str, &'a str)>,
) {
    let [columns, fields] = common;
    let grid = fields.split("\n### grid\n").nth(1).expect("the page of fields has the parameters");
    let of_jobs = page.split("\n### ").find(|section| section.starts_with("`jobs.csv`")).expect("a section");
    let parameters: BTreeSet<&str> = names(grid).chain(names(of_jobs)).collect();
    let of_export: BTreeSet<&str> = names(columns).collect();
    assert!(of_export.contains("mu_star") && of_export.len() > 150, "{of_export:?}");
    let mut sections: Vec<Section> = page.split("\n### ").skip(1).map(Section::of).collect();
    let mut missing = BTreeSet::new();
    for (path, header) in tables {
        let file = path.rsplit('/').next().unwrap();
        // `mu=0.4` is a column for a value of a parameter.
        let columns = header.split(',').map(|name| name.trim_matches('"').split('=').next().unwrap());
        let all: BTreeSet<&str> = columns.collect();
        let mut unknown = all.clone();
        // The section of the export has columns that other tables have, too.
        let is_of_jobs = |section: &Section| section.files == ["jobs.csv"];
        let is_own = |section: &Section| section.files.iter().any(|pattern| matches(pattern, file));
        let mut is_of_export = !sections.iter().any(|section| is_own(section) && !is_of_jobs(section));
        for section in sections.iter_mut().filter(|section| is_own(section) || is_of_jobs(section)) {
            // `QUANTITY` is any column of the export.
            is_of_export |= is_own(section) && section.own.contains(QUANTITY);
            let is_used =
                |name: &&str| all.contains(name) || *name == QUANTITY && !unknown.is_disjoint(&of_export);
            section.unused.retain(|name| !is_used(name));
            // Columns of a threshold have the name of the parameter along which it is.
            let is_along = |name: &str| {
                parameters.iter().any(|own| {
                    let rest = name.strip_prefix(own).filter(|rest| rest.starts_with('_'));
                    rest.is_some_and(|rest| section.own.contains(format!("mu{rest}").as_str()))
                })
            };
            unknown.retain(|name| !section.own.contains(name) && !is_along(name));
        }
        unknown.retain(|name| !parameters.contains(name.strip_prefix("parameter_").unwrap_or(name)));
        unknown.retain(|name| !(is_of_export && of_export.contains(name)));
        missing.extend(unknown.iter().map(|name| format!("{file}: {name}")));
    }
    assert!(missing.is_empty(), "docs/reference.md does not have {missing:?}");
    let unused = sections.iter().filter(|section| !section.unused.is_empty());
    let unused: Vec<_> = unused.map(|section| (&section.files, &section.unused)).collect();
    assert!(unused.is_empty(), "no table of the examples has these columns of docs/reference.md: {unused:?}");
}
