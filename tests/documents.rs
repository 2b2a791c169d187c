//! The documents of the repository name only what exists, and everything that is beside the sources is named.

#[path = "support/walk.rs"]
mod walk;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use yaml_rust2::{Yaml, YamlLoader};

/// The folders whose files documents name by their path from the root of the repository.
const ROOTS: [&str; 8] = [".ci", "benches", "docs", "migrations", "scripts", "src", "studies", "tests"];

/// The documents about the sources, which name modules.
const ABOUT_SOURCES: [&str; 2] = ["ARCHITECTURE.md", "docs/developers/design.md"];

fn exists(path: &str) -> bool {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path).exists()
}

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The paths of all files below a folder from the root of the repository, without what Python leaves.
fn files(folder: &str) -> Vec<String> {
    let below = walk::below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let own = below.into_iter().filter(|file| !file.contains("__pycache__/"));
    own.map(|file| format!("{folder}/{file}")).collect()
}

/// Every document with its text.
fn documents() -> BTreeMap<String, String> {
    let below = ["docs", "scripts"].into_iter().flat_map(files);
    let pages = below.filter(|file| Path::new(file).extension().is_some_and(|extension| extension == "md"));
    let all = pages.chain(["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "SECURITY.md"].map(str::to_owned));
    let with_text = all.map(|file| {
        let text = read(&file);
        (file, text)
    });
    with_text.collect()
}

/// The text of a document without blocks of code.
fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// The path from the root of the repository to which a link in a document leads.
fn target(document: &str, link: &str) -> String {
    let mut parts: Vec<&str> = document.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        if part == ".." {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

/// The links of a document within the repository: the path of the file from the root, and the heading, which may be empty.
fn links(document: &str, text: &str) -> Vec<(String, String)> {
    let links = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap_or_default());
    let own = links.filter(|link| !link.contains("://"));
    let parts = own.map(|link| link.split_once('#').unwrap_or((link, "")));
    let resolved = parts.map(|(file, heading)| {
        let file = if file.is_empty() { document.to_owned() } else { target(document, file) };
        (file, heading.to_owned())
    });
    resolved.collect()
}

/// The names by which links find the headings of a page.
fn headings(text: &str) -> BTreeSet<String> {
    let prose = prose(text);
    let headings = prose.lines().filter_map(|line| line.strip_prefix('#'));
    let name = |heading: &str| -> String {
        let kept = heading.trim_start_matches('#').trim().chars();
        let kept = kept.filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
    };
    headings.map(name).collect()
}

/// Protects: a reader who follows a link finds the file and the heading.
#[test]
fn links_have_targets() {
    let text = "# One `two`, three\n[a](b.md), [c](../d.md#e-f)\n```\n# no heading\n```\n## Four-5\n[x](https://y) [z](#v)";
    let expected = [("docs/b.md", ""), ("d.md", "e-f"), ("docs/a.md", "v")];
    assert_eq!(links("docs/a.md", text), expected.map(|(file, name)| (file.to_owned(), name.to_owned())));
    assert_eq!(headings(text), BTreeSet::from(["four-5", "one-two-three"].map(str::to_owned)));

    let documents = documents();
    for (document, text) in &documents {
        for (file, heading) in links(document, text) {
            assert!(exists(&file), "{document} links {file}");
            let has_heading = || documents.get(&file).is_some_and(|page| headings(page).contains(&heading));
            assert!(heading.is_empty() || has_heading(), "{document} links {file}#{heading}");
        }
    }
}

/// The paths in a text that begin with one of the [`ROOTS`]. Patterns and names in capitals stand for other paths.
fn paths(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_-./*{},$".contains(c);
    let words = text.split(|c: char| !is_part(c)).map(|word| word.trim_end_matches(['.', ',']));
    let is_path = |word: &&str| {
        word.split_once('/').is_some_and(|(root, _)| ROOTS.contains(&root))
            && !word.contains(['*', '{', '$'])
            && !word.split('/').any(|part| !part.is_empty() && part.chars().all(|c| c.is_ascii_uppercase()))
    };
    words.filter(is_path).map(str::to_owned).collect()
}

/// Protects: the files and folders that documents and the scripts of the continuous integration name exist.
#[test]
fn paths_in_documents_exist() {
    let text = "See `src/lib.rs`, docs/NAME/a, src/*.rs and target/src/x. Run scripts/fuzz.sh.";
    assert_eq!(paths(text), BTreeSet::from(["scripts/fuzz.sh", "src/lib.rs"].map(str::to_owned)));
    let mut documents = documents();
    for script in [".ci/run", ".gitlab-ci.yml"] {
        documents.insert(script.to_owned(), read(script));
    }
    let mut found = BTreeSet::new();
    for (document, text) in documents {
        for path in paths(&text) {
            assert!(exists(&path), "{document} names {path}");
            found.insert(path);
        }
    }
    for known in [
        "studies/mini.json",
        "scripts/postgres.sh",
        ".ci/run",
        "tests/verification",
        "docs/developers/nightly.md",
    ] {
        assert!(found.contains(known), "{known} is not found");
    }
}

/// The sources by the path of their module.
fn modules() -> BTreeMap<Vec<String>, String> {
    let module = |file: &str| -> Option<Vec<String>> {
        let name = file.strip_prefix("src/")?.strip_suffix(".rs")?;
        Some(name.strip_suffix("/mod").unwrap_or(name).split('/').map(str::to_owned).collect())
    };
    files("src").iter().filter_map(|file| Some((module(file)?, read(file)))).collect()
}

/// Whether a source defines a function, a type, a constant or a public field of that name.
fn defines(text: &str, name: &str) -> bool {
    const BEFORE: [&str; 7] = ["const", "enum", "fn", "pub", "struct", "trait", "type"];
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
    let mut pairs = words.clone().zip(words.skip(1));
    pairs.any(|(before, word)| word == name && BEFORE.contains(&before))
}

/// Whether the sources have what a path of modules and names means. It may begin below the root: the longest beginning that
/// ends the path of a module is that module, and a file of it defines the other names. A path may also begin with a type.
fn is_in_sources(path: &str, modules: &BTreeMap<Vec<String>, String>) -> bool {
    let names: Vec<&str> = path.split("::").collect();
    let shortest = usize::from(!path.starts_with(char::is_uppercase));
    (shortest..=names.len()).rev().any(|count| {
        let (beginning, others) = names.split_at(count);
        let is_meant = |own: &[String]| own.len() >= count && own[own.len() - count..].iter().eq(beginning);
        let meant = modules.keys().filter(|own| is_meant(own));
        let mut files = meant.flat_map(|own| modules.iter().filter(move |(file, _)| file.starts_with(own)));
        files.any(|(_, text)| others.iter().all(|name| defines(text, name)))
    })
}

/// The paths that a path with braces stands for: `a/{b,c}.rs` is `a/b.rs` and `a/c.rs`.
fn expanded(path: &str) -> Vec<String> {
    match path.split_once('{').and_then(|(start, rest)| Some((start, rest.split_once('}')?))) {
        Some((start, (names, end))) => names.split(',').map(|name| format!("{start}{name}{end}")).collect(),
        None => vec![path.to_owned()],
    }
}

/// Protects: the modules, types and files that the documents about the sources name exist. In these documents the names of
/// files may begin at src, at a member or at the solver.
#[test]
fn modules_in_documents_exist() {
    let modules = modules();
    for (path, exists) in [
        ("interface::law", true),
        ("interface::lore", false),
        ("study::Study", true),
        ("study::Stud", false),
        ("Model::new", true),
        ("Model::old", false),
    ] {
        assert_eq!(is_in_sources(path, &modules), exists, "{path}");
    }
    assert_eq!(expanded("a/{b,c}.rs"), ["a/b.rs", "a/c.rs"]);
    for document in ABOUT_SOURCES {
        let text = prose(&read(document));
        let mut found = 0;
        for code in text.split('`').skip(1).step_by(2).filter(|code| !code.contains([' ', '*'])) {
            if code.contains("::") {
                assert!(is_in_sources(code, &modules), "{document} names {code}");
                found += 1;
            } else if code.contains('/') {
                for path in expanded(code) {
                    let places = [
                        "",
                        "src/",
                        "src/mechanics/",
                        "src/mechanics/solver/",
                        "src/output/",
                        "src/application/",
                    ]
                    .map(|folder| format!("{folder}{path}"));
                    assert!(places.iter().any(|place| exists(place)), "{document} names {path}");
                }
            }
        }
        assert!(found > 20, "{found} modules are found in {document}");
    }
}

/// Protects: no script, page or picture is left over. Each is named by a document, by the continuous integration or by another
/// script.
#[test]
fn everything_is_named() {
    let documents = documents();
    let linked: BTreeSet<String> =
        documents.iter().flat_map(|(document, text)| links(document, text)).map(|(file, _)| file).collect();
    // mdBook finds these two by their names.
    let book = ["docs/SUMMARY.md", "docs/book.toml"];
    for file in files("docs").iter().filter(|file| !book.contains(&file.as_str())) {
        assert!(linked.contains(file), "no page links {file}");
    }
    let mut texts: BTreeMap<String, String> = documents;
    for file in files("scripts").into_iter().chain([".ci/run", ".gitlab-ci.yml"].map(str::to_owned)) {
        let text = read(&file);
        texts.insert(file, text);
    }
    for script in files("scripts") {
        let name = script.strip_prefix("scripts/").unwrap();
        let in_a_folder = format!("/{name}");
        // A script in Python names another one without its ending.
        let module = name.strip_suffix(".py").unwrap_or_default();
        let imports = [format!("import {module}"), format!("from {module} import ")];
        let names = |text: &str| {
            let is_import = |line: &str| line == imports[0] || line.starts_with(&imports[1]);
            let words = text.split(|c: char| !c.is_ascii_alphanumeric() && !"_-./".contains(c));
            let mut words = words.map(|word| word.trim_end_matches('.'));
            words.any(|word| word == name || word.ends_with(&in_a_folder)) || text.lines().any(is_import)
        };
        let is_named = texts.iter().any(|(file, text)| *file != script && names(text));
        assert!(is_named, "nothing names {script}");
    }
}

/// Protects: the book has every page of the folder, each once.
#[test]
fn the_book_has_every_page() {
    let summary = read("docs/SUMMARY.md");
    let named: Vec<String> = links("docs/SUMMARY.md", &summary).into_iter().map(|(file, _)| file).collect();
    let is_page = |file: &String| {
        Path::new(file).extension().is_some_and(|extension| extension == "md") && file != "docs/SUMMARY.md"
    };
    let pages: BTreeSet<String> = files("docs").into_iter().filter(is_page).collect();
    assert_eq!(named.iter().cloned().collect::<BTreeSet<_>>(), pages);
    assert_eq!(named.len(), pages.len(), "a page is named twice");
}

/// Protects: the README fits on a page.
#[test]
fn the_readme_is_short() {
    let count = read("README.md").split_whitespace().count();
    assert!(count <= 600, "{count} words");
}

/// Protects: the example in the README is that of the page about Python, which the tests run.
#[test]
fn the_readme_has_an_example_that_is_run() {
    let blocks = |text: &str| -> Vec<String> {
        text.split("```python\n").skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
    };
    let (readme, page) = (blocks(&read("README.md")), blocks(&read("docs/python.md")));
    assert!(readme.len() == 1 && page.contains(&readme[0]), "{readme:?}");
}

/// Protects: a push is checked with the compiler that the repository names, and by `.ci/run`, on both hosts.
#[test]
fn pushes_run_the_check_with_the_pinned_compiler() {
    let value = |text: &str, key: &str| -> String {
        let line = text.lines().find_map(|line| line.trim().strip_prefix(key));
        line.unwrap_or_else(|| panic!("no {key}")).trim_matches([' ', '=', '"']).to_owned()
    };
    let version = value(&read("rust-toolchain.toml"), "channel");
    assert!(version.split('.').count() == 3, "{version} is no exact version");
    let manifest = read("Cargo.toml");
    let least = value(manifest.split_once("[workspace.package]").unwrap().1, "rust-version");
    assert!(version == least || version.starts_with(&format!("{least}.")), "{least} and {version}");
    let gitlab = read(".gitlab-ci.yml");
    assert_eq!(value(&gitlab, "image:"), format!("rust:{version}"));
    let [(_, check)] =
        gitlab.split("\n\n").filter_map(|part| part.split_once("\ncheck:\n")).collect::<Vec<_>>()[..]
    else {
        panic!("one job is named check")
    };
    let check = check.split("\nbook:").next().unwrap();
    for line in
        [r#"$CI_PIPELINE_SOURCE == "push""#, r#"$CI_PIPELINE_SOURCE == "merge_request_event""#, "- .ci/run"]
    {
        assert!(check.contains(line), "{line} in {check}");
    }
    let github = read("scripts/ci/github.yml");
    let compilers: BTreeSet<&str> = github
        .split("dtolnay/rust-toolchain@")
        .skip(1)
        .map(|rest| rest.split_whitespace().next().unwrap_or_default())
        .collect();
    assert_eq!(compilers, BTreeSet::from([&*version]));
    assert!(github.contains("  push:\n  pull_request:\n") && github.contains(".ci/run\n"), "{github}");
}

/// Protects: both hosts can read their files: the script of each job is a list of texts. An unquoted command with a colon is none.
#[test]
fn pipelines_can_be_read() {
    let parsed = |file: &str| {
        let mut documents =
            YamlLoader::load_from_str(&read(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        documents.pop().unwrap_or_else(|| panic!("{file} is empty"))
    };
    let gitlab = parsed(".gitlab-ci.yml");
    let scripts = gitlab.as_hash().unwrap().values().filter_map(|job| job["script"].as_vec());
    let of_gitlab: Vec<&Yaml> = scripts.flatten().collect();
    let github = parsed("scripts/ci/github.yml");
    let steps = github["jobs"].as_hash().unwrap().values().filter_map(|job| job["steps"].as_vec());
    let is_action = |step: &&Yaml| step["uses"].as_str().is_some();
    let of_github: Vec<&Yaml> =
        steps.flatten().filter(|step| !is_action(step)).map(|step| &step["run"]).collect();
    for commands in [of_gitlab, of_github] {
        assert!(commands.len() >= 10, "{commands:?}");
        for command in commands {
            assert!(command.as_str().is_some(), "{command:?}");
        }
    }
}
