//! The shape of the crate: which module may use which, read from the sources, and the maps of the modules.

#[path = "support/walk.rs"]
mod walk;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The modules that each top-level module may use besides itself.
const MAY_USE: [(&str, &[&str]); 17] = [
    ("calibration", &[]),
    ("spec", &[]),
    ("units", &[]),
    ("random", &[]),
    ("exit", &[]),
    ("queue", &[]),
    ("solver", &["random", "spec", "units"]),
    ("stability", &["solver", "spec", "units"]),
    ("analysis", &["solver", "spec", "stability", "units"]),
    ("study", &["spec", "units"]),
    ("publish", &["units"]),
    ("inspect", &["analysis", "publish", "solver", "spec", "units"]),
    ("report", &["analysis", "publish", "random", "units"]),
    ("worker", &["analysis", "queue", "spec", "units"]),
    // Of `publish` it uses drawings and the error of `report`.
    (
        "sweep",
        &[
            "analysis",
            "calibration",
            "publish",
            "queue",
            "report",
            "solver",
            "spec",
            "study",
            "units",
            "worker",
        ],
    ),
    (
        "cli",
        &[
            "analysis", "exit", "inspect", "publish", "queue", "report", "solver", "spec", "study", "sweep",
            "units", "worker",
        ],
    ),
    ("main", &["cli"]),
];

/// The largest number of lines of a file.
const LONGEST: usize = 500;

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Members of the workspace that are made of several rooms.
const MEMBERS: [&str; 3] = ["application", "mechanics", "output"];

/// The source files below src: path relative to src, and text. The heads of members only list their rooms.
fn sources() -> Vec<(String, String)> {
    let files = walk::below(&src())
        .into_iter()
        .filter(|file| Path::new(file).extension().is_some_and(|extension| extension == "rs"))
        .filter(|file| !file.ends_with("/lib.rs") && !file.ends_with("/build.rs"));
    let with_text = files.map(|file| {
        let text = std::fs::read_to_string(src().join(&file)).unwrap();
        (file, text)
    });
    with_text.collect()
}

/// The path of a file in its crate, which the root package and the members of several rooms are.
fn in_crate(file: &str) -> &str {
    let of_member = MEMBERS.iter().find_map(|member| file.strip_prefix(member)?.strip_prefix('/'));
    of_member.unwrap_or(file)
}

/// The top-level module of a file.
fn top_module(file: &str) -> &str {
    let first = in_crate(file).split('/').next().unwrap();
    first.strip_suffix(".rs").unwrap_or(first)
}

/// The depth of a file's module below the root of the crate: `cli/mod.rs` 1, `cli/run.rs` 2.
fn depth(file: &str) -> usize {
    let file = in_crate(file);
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

/// Each file below src with another top-level module that it uses.
fn uses() -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (file, text) in sources() {
        let from = top_module(&file);
        // This file declares the modules, and its example uses them.
        if from == "lib" {
            continue;
        }
        // Other names at the root (a function, `super::*` in a test) are not modules.
        let is_other = |to: &String| to != from && MAY_USE.iter().any(|(name, _)| name == to);
        found.extend(used(&file, &text).into_iter().filter(is_other).map(|to| (file.clone(), to)));
    }
    found
}

/// The modules that a module may use.
fn may_use(module: &str) -> &'static [&'static str] {
    let rule = MAY_USE.into_iter().find(|(name, _)| *name == module);
    rule.unwrap_or_else(|| panic!("the module {module} has no rule")).1
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
    assert_eq!((depth("cli/mod.rs"), depth("cli/run.rs"), depth("mechanics/solver/body/mod.rs")), (1, 2, 2));
}

/// Protects: modules depend on each other in one direction only: mechanics does not know studies, databases and terminals,
/// the queue does not know mechanics, only the command line uses `sweep`, and only the program uses the command line.
#[test]
fn modules_use_only_what_they_may() {
    let all: BTreeSet<String> = sources().iter().map(|(file, _)| top_module(file).to_owned()).collect();
    let ruled: BTreeSet<String> = MAY_USE.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(all.into_iter().filter(|name| name != "lib").collect::<BTreeSet<_>>(), ruled);
    let uses = uses();
    let wrong = uses.iter().filter(|(file, to)| !may_use(top_module(file)).contains(&to.as_str()));
    let wrong: Vec<_> = wrong.map(|(file, to)| format!("src/{file} uses {to}")).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let edges: BTreeSet<_> = uses.iter().map(|(file, to)| (top_module(file), to.as_str())).collect();
    // A scanner that finds nothing would pass the check above, so some dependencies must be found.
    for (from, to) in [
        ("analysis", "solver"),
        ("analysis", "stability"),
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
        assert!(edges.contains(&(from, to)), "{from} does not use {to}");
    }
}

/// Protects: a member of the workspace names no other member but those that it may use, so that the compiler holds these arrows. The
/// queue and the mechanics can be used alone.
#[test]
fn members_depend_on_few_others() {
    let of_application: &[_] = &["tribosweep-mechanics", "tribosweep-output", "tribosweep-queue"];
    for (member, may_use) in [
        ("mechanics", [].as_slice()),
        ("queue", &[]),
        ("output", &["tribosweep-mechanics"]),
        ("application", of_application),
    ] {
        let manifest = read(&format!("src/{member}/Cargo.toml"));
        let (_, dependencies) = manifest.split_once("[dependencies]\n").unwrap();
        let own = dependencies.lines().take_while(|line| !line.starts_with('['));
        let own = own
            .filter(|line| line.starts_with("tribosweep"))
            .map(|line| line.split(['.', ' ']).next().unwrap());
        assert_eq!(own.collect::<Vec<_>>(), may_use, "{member}");
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

/// A file of the repository.
fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The documentation of the crate at the head of lib.rs.
fn crate_page() -> String {
    let text = read("src/lib.rs");
    let lines = text.lines().filter_map(|line| line.strip_prefix("//!"));
    lines.map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned() + "\n").collect()
}

/// The names of the folders in a folder of the repository.
fn folders(of: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(of)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path()).filter(|path| path.is_dir());
    paths.map(|path| path.file_name().unwrap().to_str().unwrap().to_owned()).collect()
}

/// The public modules at the root of the crate, each with the feature that it needs; an empty name if it needs none.
fn public_modules() -> BTreeMap<String, String> {
    let text = read("src/application/lib.rs");
    let mut modules = BTreeMap::new();
    let mut feature = "";
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';')) {
            modules.insert(name.to_owned(), feature.to_owned());
        }
        // The rooms of a member of the workspace.
        let of_member = line.strip_prefix("pub use tribosweep_").and_then(|rest| rest.split_once("::"));
        for name in of_member.map_or_else(Vec::new, |(_, rooms)| heads(rooms)) {
            modules.insert(name, feature.to_owned());
        }
        let condition = line.strip_prefix("#[cfg(feature = \"").and_then(|rest| rest.strip_suffix("\")]"));
        feature = condition.unwrap_or_default();
    }
    modules
}

/// The names between backticks.
fn in_backticks(text: &str) -> BTreeSet<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The first drawing after a part of a page.
fn drawing<'a>(page: &'a str, after: &str) -> &'a str {
    let (_, rest) = page.split_once(after).unwrap_or_else(|| panic!("no {after:?}"));
    let (_, rest) = rest.split_once("```text\n").unwrap();
    rest.split_once("```").unwrap().0
}

/// The arrows of a drawing: from which name to which. An arrow begins beside a name, or below it on a line that goes
/// downwards, and may lead to several names.
fn arrows(drawing: &str) -> BTreeSet<(String, String)> {
    let rows: Vec<Vec<char>> = drawing.lines().map(|line| line.chars().collect()).collect();
    let is_part = |c: &char| c.is_ascii_lowercase() || *c == '_';
    let name_at = |row: &[char], column: usize| -> String {
        let start = row[..column].iter().rposition(|c| !is_part(c)).map_or(0, |before| before + 1);
        row[start..].iter().take_while(|c| is_part(c)).collect()
    };
    let mut found = BTreeSet::new();
    for (number, row) in rows.iter().enumerate() {
        for head in (0..row.len()).filter(|&column| row[column] == '►') {
            let tail = row[..head].iter().rposition(|&c| c != '─').unwrap();
            let from = if row[tail] == ' ' {
                name_at(row, tail - 1)
            } else {
                let above = rows[..number].iter().rfind(|row| row.get(tail).is_some_and(is_part));
                name_at(above.unwrap(), tail)
            };
            let rest: String = row[head + 1..].iter().collect();
            for to in rest.split('─').next().unwrap_or_default().split(',') {
                found.insert((from.clone(), to.trim().chars().take_while(is_part).collect()));
            }
        }
    }
    found
}

/// The cells of the table with this header.
fn table(page: &str, header: &str) -> Vec<Vec<String>> {
    let (_, rest) = page.split_once(header).unwrap_or_else(|| panic!("no {header:?}"));
    // The first line is the rule below the header.
    let lines = rest.lines().skip(1).take_while(|line| line.starts_with('|'));
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    lines.map(cells).collect()
}

fn is_description(text: &str) -> bool {
    text.split_whitespace().count() >= 4
}

const ABOVE_THE_DRAWING: &str = "The map of the crate.";

/// Protects: arrows are read from a drawing as a reader sees them. Otherwise the tests below could not fail.
#[test]
fn arrows_are_found() {
    let drawing = "cli ──► sweep ──► a, b (parts)\n │        └─────► c ─► d\n └──────────────► e::f\n";
    let expected =
        [("c", "d"), ("cli", "e"), ("cli", "sweep"), ("sweep", "a"), ("sweep", "b"), ("sweep", "c")];
    let expected = expected.map(|(from, to)| (from.to_owned(), to.to_owned()));
    assert_eq!(arrows(drawing), BTreeSet::from(expected));
}

/// Protects: the map in lib.rs is true. It describes every folder of src and links every public module. Every folder is in
/// the drawing, whose arrows are uses that exist and are allowed.
#[test]
fn the_map_is_true() {
    let page = crate_page();
    let entries = page.lines().filter_map(|line| line.strip_prefix("* [`")?.split_once("`] – "));
    let entries: BTreeMap<&str, &str> = entries.collect();
    let named: BTreeSet<String> = entries.keys().map(|&name| name.to_owned()).collect();
    // The Python module is no room of the library: it calls the program. The package of tests has no sources.
    let is_room = |name: &String| !MEMBERS.iter().chain(&["python", "tests"]).any(|other| name == other);
    let of_members = MEMBERS.iter().flat_map(|member| folders(&format!("src/{member}")));
    let rooms: BTreeSet<String> = folders("src").into_iter().filter(is_room).chain(of_members).collect();
    assert_eq!(named, rooms);
    for (name, text) in entries {
        assert!(is_description(text), "{name}: {text}");
    }
    let modules = public_modules();
    assert!(named.iter().all(|name| modules.contains_key(name)), "{modules:?}");
    for module in modules.keys() {
        assert!(page.contains(&format!("[`{module}`]")), "{module} is not linked");
    }
    let uses = uses();
    let arrows = arrows(drawing(&page, ABOVE_THE_DRAWING));
    for (from, to) in &arrows {
        assert!(may_use(from).contains(&to.as_str()), "{from} may not use {to}");
        assert!(uses.iter().any(|(file, used)| top_module(file) == from && used == to), "{from}, {to}");
    }
    let drawn: BTreeSet<String> = arrows.into_iter().flat_map(|(from, to)| [from, to]).collect();
    assert_eq!(drawn, named);
}

/// Protects: the page of lib.rs says which modules there are with which feature, and it has every feature.
#[test]
fn the_map_has_the_features() {
    let page = crate_page();
    let linked = |text: &str| -> BTreeSet<String> {
        text.split("[`").skip(1).filter_map(|rest| Some(rest.split_once('`')?.0.to_owned())).collect()
    };
    let (_, without) = page.split_once("Without any there are ").unwrap();
    let mut told = BTreeMap::from([(String::new(), linked(without.split('.').next().unwrap_or_default()))]);
    for (feature, text) in page.lines().filter_map(|line| line.strip_prefix("* `")?.split_once("` – ")) {
        told.insert(feature.to_owned(), linked(text));
    }
    let manifest = read("Cargo.toml");
    let (_, features) = manifest.split_once("[features]\n").unwrap();
    let lines = features.lines().take_while(|line| !line.starts_with('['));
    let features = lines.filter_map(|line| Some(line.split_once(" = [")?.0));
    let features = features.filter(|feature| *feature != "default");
    let mut expected: BTreeMap<String, BTreeSet<String>> =
        features.map(|feature| (feature.to_owned(), BTreeSet::new())).collect();
    for (module, feature) in public_modules() {
        expected.entry(feature).or_default().insert(module);
    }
    assert_eq!(told, expected);
}

/// Protects: ARCHITECTURE.md has the same rooms as the sources, each with a description. They may use there what they may
/// use here, and the drawing has the same arrows as that of lib.rs. The rooms of the solver and the folders of the tests
/// exist, and none is missing.
#[test]
fn the_rooms_are_those_of_the_document() {
    let page = read("ARCHITECTURE.md");
    assert_eq!(arrows(drawing(&page, "## Rooms\n")), arrows(drawing(&crate_page(), ABOVE_THE_DRAWING)));

    let rooms: BTreeSet<String> = public_modules().into_keys().collect();
    let mut told = BTreeSet::new();
    for row in table(&page, "| room | what it is for | may use |\n") {
        let [room, text, uses] = row.as_slice() else { panic!("{row:?}") };
        let room = room.trim_matches('`');
        assert!(is_description(text), "{room}: {text}");
        let mut allowed = in_backticks(uses);
        if uses.starts_with("all but ") {
            allowed.insert(room.to_owned());
            allowed = &rooms - &allowed;
        }
        // A private file at the root is no room.
        let expected = may_use(room).iter().map(|&name| name.to_owned()).filter(|name| rooms.contains(name));
        assert_eq!(allowed, expected.collect::<BTreeSet<_>>(), "{room}");
        told.insert(room.to_owned());
    }
    assert_eq!(told, rooms);

    let mut told = BTreeSet::new();
    for row in table(&page, "| room | what is in it |\n") {
        assert!(is_description(&row[1]), "{row:?}");
        told.append(&mut in_backticks(&row[0]));
    }
    assert!(told.is_superset(&folders("src/mechanics/solver")), "{told:?}");
    for room in told {
        let path = src().join("mechanics/solver").join(&room);
        assert!(path.is_dir() || path.with_extension("rs").is_file(), "{room}");
    }

    let mut told = BTreeSet::new();
    for row in table(&page, "| folder | what it protects |\n") {
        assert!(is_description(&row[1]), "{row:?}");
        told.append(&mut in_backticks(&row[0]));
    }
    // What several test programs share protects nothing by itself.
    let tests = folders("tests").into_iter().filter(|name| name != "support");
    let single = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")).unwrap();
    let single = single.map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let single = single.map(|path| path.file_name().unwrap().to_str().unwrap().to_owned());
    let expected: BTreeSet<_> = tests.chain(single).map(|name| format!("tests/{name}")).collect();
    assert_eq!(told, expected);
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
            // The root of the module's own crate, which may be a member of several rooms.
            "crate" => {
                module[..1].iter().filter(|first| MEMBERS.contains(&first.as_str())).cloned().collect()
            }
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
    assert!(
        uses.values().map(BTreeSet::len).sum::<usize>() > 1500,
        "the declarations are found, also those from the root of a member"
    );
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
