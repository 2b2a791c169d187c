//! How fast the solver is, and how fast it could be: `cargo bench`.
//!
//! Prints what the machine can do, what a node and step cost against that, and what each part of a scene adds. The
//! numbers are also written to `target/performance.json`, from which `scripts/performance.py` makes its tables.
//!
//! Times are medians of Criterion's samples, the fastest of several rounds. One core is used.

mod cases;
mod machine;
mod timing;

use serde_json::json;

fn main() {
    // Cargo passes `--bench`; a word besides selects a part: `cargo bench -- mesh`.
    let only = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let wanted = |part: &str| only.as_deref().is_none_or(|only| part.starts_with(only));
    let mut found = serde_json::Map::new();
    if wanted("machine") || wanted("mesh") {
        let machine = machine::measure();
        machine.print();
        if wanted("mesh") {
            found.insert("meshes".into(), json!(cases::meshes(&machine)));
        }
        found.insert("machine".into(), json!(machine));
    }
    if wanted("pairs") {
        found.insert("pairs".into(), json!(cases::pairs()));
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/target/performance.json");
    let text = serde_json::to_string_pretty(&found).expect("numbers and words");
    std::fs::write(path, text).expect("the target folder can be written");
}
