//! The pages of the book that teach: their studies and commands are taken from the text and run as a reader would.

use std::path::Path;
use std::process::Command;

use crate::support::{Folder, TRIBOSWEEP};

/// What a reader does with a part of a page.
#[derive(Debug, PartialEq)]
enum Step<'a> {
    /// Saves a text as a file.
    Save(&'a str, &'a str),
    /// Runs commands.
    Run(&'a str),
    /// Compares the output of the last commands with the page.
    Compare(&'a str),
}

/// The steps of a page: `json` after a line "Save this as `NAME`", `sh`, and `text` right after `sh`.
fn steps(page: &str) -> Vec<Step<'_>> {
    let parts: Vec<&str> = page.split("```").collect();
    let mut steps = Vec::new();
    let mut ran = false;
    for pair in parts.chunks(2).filter(|pair| pair.len() == 2) {
        let (before, block) = (pair[0], pair[1]);
        let (language, body) = block.split_once('\n').unwrap();
        let saved = before.rsplit_once("Save this as `").and_then(|(_, rest)| rest.split_once('`'));
        match language {
            "sh" => steps.push(Step::Run(body)),
            "text" if ran => steps.push(Step::Compare(body)),
            "json" => steps.extend(saved.map(|(name, _)| Step::Save(name, body))),
            _ => {}
        }
        ran = language == "sh";
    }
    steps
}

/// Runs the steps of a page in a folder that has the studies of the repository.
fn follow(name: &str, page: &str, expected_runs: usize) {
    let folder = Folder::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::os::unix::fs::symlink(root.join("studies"), folder.path("studies")).unwrap();
    let programs = Path::new(TRIBOSWEEP).parent().unwrap().display().to_string();
    let path = std::env::var("PATH").unwrap_or_default();
    let mut output = String::new();
    let mut runs = 0;
    for step in steps(page) {
        match step {
            Step::Save(file, text) => folder.write(file, text),
            Step::Run(commands) => {
                let done = Command::new("bash")
                    .args(["-euc", commands])
                    .current_dir(folder.path("."))
                    .env("PATH", format!("{programs}:{path}"))
                    .env("XDG_CACHE_HOME", env!("CARGO_TARGET_TMPDIR"))
                    .env_remove("TRIBOSWEEP_DB")
                    .output()
                    .unwrap();
                let [out, errors] = [done.stdout, done.stderr].map(|text| String::from_utf8(text).unwrap());
                assert!(done.status.success(), "{name}: {commands}{out}{errors}");
                output = out;
                runs += 1;
            }
            Step::Compare(text) => {
                assert!(output.contains(text), "{name} shows\n{text}the program\n{output}");
            }
        }
    }
    assert_eq!(runs, expected_runs, "{name}: blocks of commands");
}

/// Protects: the tests of the pages see what the pages have.
#[test]
fn steps_are_found() {
    let page = "Save this as `a.json`, and\nmore:\n\n```json\n{}\n```\n```sh\nrun\n```\nIt prints:\n\n```text\nx\n```\n```text\ny\n```\n```json\n1\n```\n";
    let expected = [Step::Save("a.json", "{}\n"), Step::Run("run\n"), Step::Compare("x\n")];
    assert_eq!(steps(page), expected);
}

/// Protects: every command of the first page of the tutorial works, and prints the table that the page shows.
#[test]
fn the_first_sweep() {
    follow("first_sweep.md", include_str!("../../docs/first_sweep.md"), 5);
}

/// Protects: every command of the page about one's own instrument works.
#[test]
fn your_own_tribometer() {
    follow("own_tribometer.md", include_str!("../../docs/own_tribometer.md"), 4);
}

/// Protects: every command of the page about squeal works.
#[test]
fn where_squeal_begins() {
    follow("squeal.md", include_str!("../../docs/squeal.md"), 4);
}

/// Protects: the commands about several workers, shards and copies work.
#[test]
fn long_sweeps() {
    follow("long_sweeps.md", include_str!("../../docs/long_sweeps.md"), 3);
}

/// Protects: every command of the page about inspections works.
#[test]
fn inspections() {
    follow("inspect.md", include_str!("../../docs/inspect.md"), 6);
}
