//! The speed of the solver, and its lower bounds: `cargo bench`.
//!
//! It prints the peak performance of the machine, the cost of a node and step relative to it, and the
//! additional cost of each part of a scene. It also writes the numbers to `target/performance.json`, from
//! which `scripts/performance.py` makes its tables.
//!
//! A time is the median of Criterion's samples in the fastest of several rounds. One core is used.

mod cases;
mod machine;
mod timing;

use serde_json::json;

fn main() {
    // Cargo passes `--bench`. Another word selects a part: `cargo bench -- mesh`.
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
