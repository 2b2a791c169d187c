//! The shape of the crate: which module may use which, read from the sources.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The modules that each top-level module may use besides itself.
const MAY_USE: [(&str, &[&str]); 14] = [
    ("spec", &[]),
    ("units", &[]),
    ("exit", &[]),
    ("queue", &[]),
    ("solver", &["spec", "units"]),
    ("analysis", &["solver", "spec", "units"]),
    ("study", &["spec"]),
    ("publish", &["units"]),
    ("inspect", &["analysis", "publish", "solver", "spec", "units"]),
    ("report", &["analysis", "publish"]),
    ("worker", &["analysis", "queue", "spec", "units"]),
    // Of `publish` it uses the error of `report`.
    ("sweep", &["analysis", "publish", "queue", "report", "solver", "spec", "study", "worker"]),
    (
        "cli",
        &[
            "analysis", "exit", "inspect", "publish", "queue", "report", "solver", "spec", "study", "sweep",
            "worker",
        ],
    ),
    ("main", &["cli"]),
];

/// The largest number of lines of a file.
const LONGEST: usize = 500;

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The source files below src: path relative to src, and text.
fn sources() -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![src()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(src()).unwrap().to_str().unwrap().replace('\\', "/");
                found.push((name, std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

/// The top-level module of a file.
fn top_module(file: &str) -> &str {
    let first = file.split('/').next().unwrap();
    first.strip_suffix(".rs").unwrap_or(first)
}

/// The depth of a file's module below the root of the crate: `cli/mod.rs` 1, `cli/run.rs` 2.
fn depth(file: &str) -> usize {
    file.strip_suffix("/mod.rs").unwrap_or(file).split('/').count()
}

/// The first names of the rest of a path: `a::b` gives a, `{a::x, b}` gives a and b.
fn heads(rest: &str) -> Vec<String> {
    let head =
        |text: &str| text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(group) = rest.strip_prefix('{') else { return vec![head(rest)] };
    let mut entries = vec![String::new()];
    let mut nesting = 1;
    for c in group.chars() {
        match c {
            '{' => nesting += 1,
            '}' => nesting -= 1,
            ',' if nesting == 1 => {
                entries.push(String::new());
                continue;
            }
            _ => {}
        }
        if nesting == 0 {
            break;
        }
        entries.last_mut().unwrap().push(c);
    }
    entries.iter().map(|entry| head(entry)).filter(|name| !name.is_empty()).collect()
}

/// The top-level modules that the code of a file names with `crate::`, the crate's name or enough `super::`. Comments may
/// name any module.
fn used(file: &str, text: &str) -> BTreeSet<String> {
    let code: Vec<_> = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
    let code = code.join("\n");
    let mut names = BTreeSet::new();
    let root = "super::".repeat(depth(file));
    for prefix in ["crate::", "tribosweep::", &root] {
        for (at, _) in code.match_indices(prefix) {
            // This is part of a longer word or path, or a `super` in a module inside the file.
            let before = code[..at].chars().next_back().unwrap_or('\n');
            let indented = code[..at].lines().next_back().is_some_and(|line| line.starts_with(' '));
            if before.is_alphanumeric() || before == '_' || before == ':' || (prefix == root && indented) {
                continue;
            }
            names.extend(heads(&code[at + prefix.len()..]));
        }
    }
    names
}

/// Protects: the scanner finds every form in which code names a module. Otherwise the tests below could not fail.
#[test]
fn the_scanner_finds_modules() {
    let text = "use crate::queue::{Claim, Counts};\nuse crate::{exit, study::{self, Study}, units};\n\
                // crate::comment\nfn f() { crate::solver::solve(); }\nuse super::super::report;\n\
                use super::sibling;\nuse tribosweep::cli;\npub(crate) fn g() {}\n";
    let names: Vec<_> = used("cli/run.rs", text).into_iter().collect();
    assert_eq!(names, ["cli", "exit", "queue", "report", "solver", "study", "units"]);
    assert_eq!(used("units.rs", "use super::spec;\n").into_iter().collect::<Vec<_>>(), ["spec"]);
    let nested = "mod tests {\n    use super::*;\n}\n";
    assert_eq!(used("units.rs", nested), BTreeSet::new());
    assert_eq!((depth("cli/mod.rs"), depth("cli/run.rs"), depth("solver/body/mod.rs")), (1, 2, 2));
}

/// Protects: modules depend on each other in one direction only: mechanics does not know studies, databases and terminals,
/// the queue does not know mechanics, only the command line uses `sweep`, and only the program uses the command line.
#[test]
fn modules_use_only_what_they_may() {
    let rules: BTreeMap<_, _> = MAY_USE.into_iter().collect();
    let mut edges = BTreeSet::new();
    let mut wrong = Vec::new();
    for (file, text) in sources() {
        let from = top_module(&file);
        if from == "lib" {
            continue;
        }
        let allowed = rules.get(from).unwrap_or_else(|| panic!("src/{file}: the module has no rule"));
        for to in used(&file, &text) {
            // Other names at the root (a function, `super::*` in a test) are not modules.
            if to != from && rules.contains_key(to.as_str()) {
                edges.insert((from.to_owned(), to.clone()));
                if !allowed.contains(&to.as_str()) {
                    wrong.push(format!("src/{file} uses {to}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // A scanner that finds nothing would pass the check above, so some dependencies must be found.
    for (from, to) in [
        ("analysis", "solver"),
        ("cli", "inspect"),
        ("cli", "sweep"),
        ("cli", "worker"),
        ("main", "cli"),
        ("report", "analysis"),
        ("solver", "spec"),
        ("study", "spec"),
        ("sweep", "queue"),
        ("sweep", "report"),
        ("sweep", "study"),
        ("sweep", "worker"),
        ("worker", "analysis"),
        ("worker", "queue"),
    ] {
        assert!(edges.contains(&(from.to_owned(), to.to_owned())), "{from} does not use {to}");
    }
}

/// Protects: the queue depends on no other module and contains no terms of mechanics, so that other programs can use it.
#[test]
fn the_queue_stands_alone() {
    for (file, text) in sources().iter().filter(|(file, _)| top_module(file) == "queue") {
        assert_eq!(used(file, text).into_iter().filter(|name| name != "queue").collect::<Vec<_>>(), [""; 0]);
        for word in ["friction", "omega", "JobSpec", "nalgebra"] {
            assert!(!text.contains(word), "src/{file} contains {word}");
        }
    }
}

/// Protects: the map in lib.rs is correct: every module in it exists and is public, and it has every folder of src.
#[test]
fn the_map_is_true() {
    let text = std::fs::read_to_string(src().join("lib.rs")).unwrap();
    let named: BTreeSet<_> = text
        .lines()
        .filter_map(|line| line.strip_prefix("//! * [`"))
        .map(|rest| rest.split('`').next().unwrap().to_owned())
        .collect();
    assert!(named.len() >= 8, "{named:?}");
    for name in &named {
        let exists =
            src().join(name).join("mod.rs").is_file() || src().join(name).with_extension("rs").is_file();
        assert!(exists, "the map names {name}");
        assert!(text.contains(&format!("\npub mod {name};\n")), "{name} is not public");
    }
    let folders: BTreeSet<_> = std::fs::read_dir(src())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .map(|path| path.file_name().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(named, folders);
}

/// Protects: files are short enough to be read as a whole.
#[test]
fn no_file_is_long() {
    let long: Vec<_> = sources()
        .into_iter()
        .map(|(file, text)| (text.lines().count(), file))
        .filter(|(lines, _)| *lines > LONGEST)
        .collect();
    assert!(long.is_empty(), "longer than {LONGEST} lines: {long:?}");
}

/// Protects: other programs can use `publish` too, because nothing of it speaks of mechanics or of jobs.
#[test]
fn publish_speaks_of_no_mechanics() {
    for (file, text) in sources().iter().filter(|(file, _)| top_module(file) == "publish") {
        for word in ["friction", "omega", "\"mu\"", "rpm", "stick", "slip", "JobSpec", "JobRecord"] {
            assert!(!text.contains(word), "src/{file} speaks of {word}");
        }
    }
}

/// Protects: other programs can use `sweep` without the crates behind it: no file of it names their types.
#[test]
fn sweep_hides_other_crates() {
    for (file, text) in sources().iter().filter(|(file, _)| top_module(file) == "sweep") {
        for name in ["sqlx", "plotters", "maud", "clap", "rayon::Thread"] {
            assert!(!text.contains(name), "src/{file} contains {name}");
        }
    }
}

/// All paths of a `use` tree: `a::{b, c::d}` gives a::b and a::c::d.
fn paths(tree: &str) -> Vec<Vec<String>> {
    let tree = tree.trim();
    if let Some(group) = tree.strip_prefix('{').and_then(|rest| rest.strip_suffix('}')) {
        let mut nesting = 0;
        let parts = group.split(|c: char| {
            nesting += i32::from(c == '{') - i32::from(c == '}');
            c == ',' && nesting == 0
        });
        return parts.filter(|part| !part.trim().is_empty()).flat_map(paths).collect();
    }
    let name = |text: &str| text.split(" as ").next().unwrap_or_default().trim().to_owned();
    match tree.split_once("::") {
        None => vec![vec![name(tree)]],
        Some((head, rest)) => paths(rest).into_iter().map(|path| [vec![name(head)], path].concat()).collect(),
    }
}

/// The modules that the private `use` declarations of a module name. A `pub use` only passes a name on, and tests may use
/// anything.
fn dependencies(module: &[String], text: &str, modules: &BTreeSet<Vec<String>>) -> BTreeSet<Vec<String>> {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    let declarations = code.split("\nuse ").skip(1).map(|rest| rest.split(';').next().unwrap_or_default());
    let mut found = BTreeSet::new();
    for path in declarations.flat_map(paths) {
        let supers = path.iter().take_while(|name| *name == "super").count();
        let base = match path[0].as_str() {
            "crate" => Vec::new(),
            "super" => module[..module.len() - supers].to_vec(),
            _ => module.to_vec(),
        };
        let mut target = [base, path[usize::from(path[0] == "crate").max(supers)..].to_vec()].concat();
        while !target.is_empty() && !modules.contains(&target) {
            target.pop();
        }
        if !target.is_empty() && target != module {
            found.insert(target);
        }
    }
    found
}

/// Protects: every file can be understood with the files that it uses, because no files use each other in a circle.
#[test]
fn no_files_use_each_other_in_a_circle() {
    assert_eq!(paths("a::{b, c::{d as e, f}}").concat().concat(), "abacdacf");
    let module = |file: &str| -> Vec<String> {
        let name = file.strip_suffix(".rs").unwrap();
        name.strip_suffix("/mod").unwrap_or(name).split('/').map(str::to_owned).collect()
    };
    let sources = sources();
    let modules: BTreeSet<_> = sources.iter().map(|(file, _)| module(file)).collect();
    let mut uses: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = sources
        .iter()
        .map(|(file, text)| (module(file), dependencies(&module(file), text, &modules)))
        .filter(|(module, _)| module.last().is_some_and(|name| name != "tests" && name != "lib"))
        .collect();
    assert!(uses.values().map(BTreeSet::len).sum::<usize>() > 500, "the declarations are found");
    // Files that use no remaining file are taken away until only circles and what leads to them remain.
    loop {
        let remaining: BTreeSet<_> = uses.keys().cloned().collect();
        let before = remaining.len();
        uses.retain(|_, targets| targets.iter().any(|target| remaining.contains(target)));
        if uses.len() == before {
            break;
        }
    }
    let left: Vec<_> = uses.keys().map(|module| module.join("::")).collect();
    assert!(left.is_empty(), "these are in a circle, or use files that are: {}", left.join(", "));
}
