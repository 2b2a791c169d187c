//! The book: its examples are taken from the text and run as a reader would, and its page of files has what they write.
#![cfg(unix)]

mod files;
mod reader;
mod steps;
mod tables;

use std::panic::catch_unwind;
use std::path::Path;
use std::sync::Mutex;

/// Pages that the tests cannot follow, and why.
const NOT_FOLLOWED: [(&str, &str); 3] = [
    (
        "nightly.md",
        "its commands build the program; `.ci/run` runs the check, and the workflows run the wrong programs",
    ),
    ("reproduction.md", "`scripts/reproduction.py`, which writes the page, runs its commands"),
    ("stability.md", "its command runs tests; `scripts/stability.py` writes the page"),
];

fn docs() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let pages = files.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let with_text = pages.map(|path| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(path).unwrap())
    });
    let mut all: Vec<_> = with_text.collect();
    all.sort();
    all
}

/// Protects: every study, command and program in the book works as it stands there, and prints what the page shows. The page of files
/// has every file that they write, and no other; the pages of columns have every column of their tables.
#[test]
fn every_page_can_be_followed() {
    let is_example = |language: &str| ["sh", "json", "python"].contains(&language);
    let has_examples = |text: &str| steps::blocks(text).any(|block| is_example(block.language));
    let all = docs();
    let pages: Vec<_> = all.iter().filter(|(_, text)| has_examples(text)).collect();
    for (name, reason) in NOT_FOLLOWED {
        assert!(pages.iter().any(|(page, _)| page == name), "{name} has no examples: {reason}");
    }
    let followed = pages.iter().filter(|(name, _)| NOT_FOLLOWED.iter().all(|(other, _)| other != name));
    let waiting = Mutex::new(followed);
    let written = Mutex::new(Vec::new());
    let failed = Mutex::new(Vec::new());
    let is_whole = Mutex::new(true);
    let work = || {
        loop {
            let Some((name, page)) = waiting.lock().unwrap().next() else { break };
            let begun = std::time::Instant::now();
            let followed = catch_unwind(|| reader::follow(name, page));
            println!("{name}: {:.1} s", begun.elapsed().as_secs_f64());
            match followed {
                Ok(Some(files)) => written.lock().unwrap().extend(files),
                Ok(None) => *is_whole.lock().unwrap() = false,
                Err(_) => failed.lock().unwrap().push(name),
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    assert!(
        failed.lock().unwrap().is_empty(),
        "these pages cannot be followed: {failed:?}; the reasons are above"
    );
    // Without a server or Python, some files are missing.
    if *is_whole.lock().unwrap() {
        let written = written.lock().unwrap();
        let page = |name: &str| -> &str { &all.iter().find(|(own, _)| own == name).unwrap().1 };
        files::assert_documented(page("files.md"), written.iter().map(|(file, _)| file));
        let tables = written.iter().filter_map(|(file, header)| Some((file.as_str(), header.as_deref()?)));
        tables::assert_documented(page("tables.md"), [page("columns.md"), page("fields.md")], tables);
    }
}
