//! The book: its examples are taken from the text and run as a reader would, and its page of files has what they write.
#![cfg(unix)]

mod files;
mod reader;
mod steps;
mod tables;

use std::panic::catch_unwind;
use std::path::Path;
use std::sync::Mutex;

/// The pages for users. Scripts write those of `docs/evidence`, and those of `docs/developers` are about building and testing.
fn docs(root: &Path) -> Vec<(String, String)> {
    let files = std::fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = files.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let with_text = pages.map(|path| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, std::fs::read_to_string(path).unwrap())
    });
    let mut all: Vec<_> = with_text.collect();
    all.sort();
    all
}

/// Protects: every study, command and program in the book works as it stands there, and prints what the page shows. The reference
/// has every file that they write, and no other, and every column of their tables.
#[test]
fn every_page_can_be_followed() {
    let is_example = |language: &str| ["sh", "json", "python"].contains(&language);
    let has_examples = |text: &str| steps::blocks(text).any(|block| is_example(block.language));
    let copy = reader::Copy::of_reader();
    let all = docs(&copy.root);
    let pages: Vec<_> = all.iter().filter(|(_, text)| has_examples(text)).collect();
    assert_eq!(pages.len(), 10, "a page without examples");
    let waiting = Mutex::new(pages.iter());
    let written = Mutex::new(Vec::new());
    let failed = Mutex::new(Vec::new());
    let is_whole = Mutex::new(true);
    let work = || {
        loop {
            let Some((name, page)) = waiting.lock().unwrap().next() else { break };
            let begun = std::time::Instant::now();
            let followed = catch_unwind(|| reader::follow(&copy, name, page));
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
        let (_, reference) = all.iter().find(|(own, _)| own == "reference.md").unwrap();
        let chapter = |name: &str| -> &str {
            let mut chapters = reference.split("\n## ");
            chapters.find(|chapter| chapter.lines().next() == Some(name)).expect("a chapter")
        };
        files::assert_documented(chapter("Files"), written.iter().map(|(file, _)| file));
        let tables = written.iter().filter_map(|(file, header)| Some((file.as_str(), header.as_deref()?)));
        tables::assert_documented(chapter("Other tables"), [chapter("Columns"), chapter("Fields")], tables);
    }
}
