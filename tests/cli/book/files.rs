//! The page of files, and the files that the examples write.

use std::collections::BTreeSet;

/// The names of files that a page has in the first column of its tables. Words in capitals stand for names.
pub fn documented(page: &str) -> Vec<&str> {
    let rows = page.lines().filter_map(|line| line.strip_prefix("| "));
    let first = rows.filter_map(|row| row.split(" | ").next());
    let names = first.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    names.filter(|name| !name.ends_with('/')).map(|name| name.rsplit('/').next().unwrap()).collect()
}

/// Whether a name is one of a pattern, in which a word of capitals stands for any text.
pub fn matches(pattern: &str, name: &str) -> bool {
    let is_capital = |c: char| c.is_ascii_uppercase();
    let Some(start) = pattern.find(is_capital) else { return pattern == name };
    let (fixed, rest) = pattern.split_at(start);
    let rest = rest.trim_start_matches(is_capital);
    let Some(name) = name.strip_prefix(fixed) else { return false };
    let ends = name.char_indices().map(|(at, c)| at + c.len_utf8());
    ends.into_iter().any(|end| matches(rest, &name[end..]))
}

/// Asserts that the page has every file that was written below a folder, and no other.
pub fn assert_documented(page: &str, written: &BTreeSet<String>) {
    let patterns = documented(page);
    assert!(patterns.len() > 50, "{patterns:?}");
    let names = || written.iter().map(|file| file.rsplit('/').next().unwrap());
    let unknown: Vec<&str> =
        names().filter(|name| !patterns.iter().any(|pattern| matches(pattern, name))).collect();
    assert!(unknown.is_empty(), "docs/files.md does not have {unknown:?}");
    let unused: Vec<&&str> =
        patterns.iter().filter(|pattern| !names().any(|name| matches(pattern, name))).collect();
    assert!(unused.is_empty(), "no example writes {unused:?} of docs/files.md");
}

/// Protects: names are compared with patterns as the page means them.
#[test]
fn patterns_are_matched() {
    let page = "| file | content |\n|---|---|\n| `a.svg`, `b/NAME_c.csv` | `d.md` |\n| `e/` | x |\n";
    assert_eq!(documented(page), ["a.svg", "NAME_c.csv"]);
    for (pattern, name, expected) in [
        ("a.svg", "a.svg", true),
        ("a.svg", "a.csv", false),
        ("NAME_c.csv", "x_y_c.csv", true),
        ("NAME_c.csv", "_c.csv", false),
        ("a-N.svg", "a-12.svg", true),
        ("a-N.svg", "b-1.svg", false),
    ] {
        assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
    }
}
