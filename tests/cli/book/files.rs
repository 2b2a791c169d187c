//! The page of files, and the files that the examples write.

use std::collections::BTreeMap;

/// The tables of the page by their headings: the paths of files from the folder that the section is about. Words in capitals
/// stand for names.
fn documented(page: &str) -> BTreeMap<&str, Vec<&str>> {
    let mut found = BTreeMap::new();
    for section in page.split("\n### ").skip(1) {
        let rows = section.lines().filter_map(|line| line.strip_prefix("| "));
        let first = rows.filter_map(|row| row.split(" | ").next());
        let names = first.flat_map(|cell| cell.split('`').skip(1).step_by(2));
        found.insert(section.lines().next().unwrap(), names.filter(|name| !name.ends_with('/')).collect());
    }
    found
}

/// The quantities of the reports in the examples, for which `QUANTITY` stands.
const QUANTITIES: [&str; 2] = ["n_over_f_max", "lift_max_m"];

/// Whether a path is one of a pattern, in which a word of capitals stands for a name.
pub fn matches(pattern: &str, path: &str) -> bool {
    let is_capital = |c: char| c.is_ascii_uppercase();
    let Some(start) = pattern.find(is_capital) else { return pattern == path };
    let (fixed, rest) = pattern.split_at(start);
    let Some(path) = path.strip_prefix(fixed) else { return false };
    if let Some(rest) = rest.strip_prefix("QUANTITY") {
        return QUANTITIES.iter().filter_map(|name| path.strip_prefix(name)).any(|path| matches(rest, path));
    }
    let rest = rest.trim_start_matches(is_capital);
    let names = path.char_indices().map(|(at, c)| (at + c.len_utf8(), c)).take_while(|(_, c)| *c != '/');
    names.into_iter().any(|(end, _)| matches(rest, &path[end..]))
}

/// The sections that a file belongs to, and its path from their folder.
fn sections(file: &str) -> (&'static [&'static str], &str) {
    let below = |folder: &str| {
        let (_, rest) = file.split_once(folder)?;
        rest.split_once('/').map(|(_, path)| path)
    };
    let (folder, path) = file.split_once('/').expect("a file below a folder");
    if let Some(path) = below("/inspect/") {
        (&["An inspection"], path)
    } else if folder.strip_suffix(".slurm").is_some() {
        path.strip_prefix("report/").map_or((&["A job array"], path), |path| (&["A report"], path))
    } else if let Some(path) = file.strip_prefix("reports/").and_then(|rest| rest.split_once('/')) {
        (&["A report", "Linear stability"], path.1)
    } else {
        (&["A report"], path)
    }
}

/// Asserts that the page has every file that was written below a folder, at its place, and no other.
pub fn assert_documented<'a>(page: &str, written: impl Iterator<Item = &'a String>) {
    let mut unused = documented(page);
    let patterns = unused.clone();
    // The examples do not look into the current folder, which has their own files, too.
    unused.remove("The current folder");
    let mut unknown = Vec::new();
    for file in written.filter(|file| file.contains('/')) {
        let (names, path) = sections(file);
        let is_known = names.iter().any(|name| patterns[name].iter().any(|pattern| matches(pattern, path)));
        if !is_known {
            unknown.push(file);
        }
        for name in names {
            unused.get_mut(name).expect("a section").retain(|pattern| !matches(pattern, path));
        }
    }
    assert!(unknown.is_empty(), "docs/reference.md does not have {unknown:?}");
    assert!(
        unused.values().all(Vec::is_empty),
        "no example writes these files of docs/reference.md: {unused:?}"
    );
}

/// Protects: files are compared with the page as it means them.
#[test]
fn patterns_are_matched() {
    let page = "# Files\n\n### One\n\n| file | content |\n|---|---|\n| `a.svg`, `b/NAME_c.csv` | `d.md` |\n| `e/` | x |\n\n### Two\n";
    assert_eq!(documented(page), [("One", vec!["a.svg", "b/NAME_c.csv"]), ("Two", vec![])].into());
    for (pattern, path, expected) in [
        ("a.svg", "a.svg", true),
        ("a.svg", "b/a.svg", false),
        ("b/NAME_c.csv", "b/x_y_c.csv", true),
        ("b/NAME_c.csv", "b/_c.csv", false),
        ("b/NAME_c.csv", "b/x/y_c.csv", false),
        ("a-N.svg", "a-12.svg", true),
        ("QUANTITY.svg", "lift_max_m.svg", true),
        ("QUANTITY.svg", "anything.svg", false),
    ] {
        assert_eq!(matches(pattern, path), expected, "{pattern} {path}");
    }
    for (file, section, path) in [
        ("reports/a/report.md", "A report", "report.md"),
        ("a.slurm/report/report.md", "A report", "report.md"),
        ("a.slurm/submit.sh", "A job array", "submit.sh"),
        ("reports/a/inspect/b/fields/c.vtu", "An inspection", "fields/c.vtu"),
        ("my-report/report.md", "A report", "report.md"),
    ] {
        let (names, own) = sections(file);
        assert!(names.contains(&section) && own == path, "{file}: {names:?} {own}");
    }
}
