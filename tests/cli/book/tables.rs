//! The pages of columns, and the tables in CSV that the examples write.

use std::collections::BTreeSet;

use super::files::matches;

/// The first column of the tables in a text: names of columns or of parameters.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|line| line.split('`').next())
}

/// Asserts that each column of each table is in its section of the page, or has the name of a column of the export or of a
/// parameter, which the other pages have; and that the page has no other column.
pub fn assert_documented<'a>(
    page: &str,
    common: [&str; 2],
    tables: impl Iterator<Item = (&'a str, &'a str)>,
) {
    let [columns, fields] = common;
    let grid = fields.split("\n## grid\n").nth(1).expect("the page of fields has the parameters");
    let of_jobs = page.split("\n## ").find(|section| section.starts_with("`jobs.csv`")).expect("a section");
    let common: BTreeSet<&str> = names(columns).chain(names(grid)).chain(names(of_jobs)).collect();
    assert!(common.contains("mu_star") && common.len() > 150, "{common:?}");
    // The files of each section, and those of its columns that no table has had yet.
    let mut sections: Vec<(Vec<&str>, BTreeSet<&str>, BTreeSet<&str>)> = Vec::new();
    for section in page.split("\n## ").skip(1) {
        let files = section.lines().next().unwrap().split('`').skip(1).step_by(2).collect();
        let own: BTreeSet<&str> = names(section).collect();
        sections.push((files, own.clone(), own));
    }
    let mut missing = BTreeSet::new();
    for (path, header) in tables {
        let file = path.rsplit('/').next().unwrap();
        // `mu=0.4` is a column for a value of a parameter.
        let columns = header.split(',').map(|name| name.trim_matches('"').split('=').next().unwrap());
        let mut unknown: BTreeSet<&str> = columns.collect();
        for (files, own, unused) in &mut sections {
            if files.iter().any(|pattern| matches(pattern, file)) {
                unused.retain(|name| !unknown.contains(name));
                unknown.retain(|name| !own.contains(name));
            }
        }
        missing.extend(unknown.difference(&common).map(|name| format!("{file}: {name}")));
    }
    assert!(missing.is_empty(), "docs/tables.md does not have {missing:?}");
    let unused: Vec<_> = sections.iter().filter(|(.., unused)| !unused.is_empty()).collect();
    assert!(unused.is_empty(), "no table of the examples has these columns of docs/tables.md: {unused:?}");
}
