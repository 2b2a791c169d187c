//! Lines of JSON for `scripts/stability.py`, if it asks for them.

use serde_json::Value;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

/// Appends `lines` to `<name>.jsonl` in the folder `TRIBOSWEEP_STRESS_SUMMARY`, if there is one.
pub fn write(name: &str, lines: &[Value]) {
    let Ok(folder) = std::env::var("TRIBOSWEEP_STRESS_SUMMARY") else { return };
    let path = Path::new(&folder).join(format!("{name}.jsonl"));
    let mut text = String::new();
    for line in lines {
        text.push_str(&line.to_string());
        text.push('\n');
    }
    let file = OpenOptions::new().create(true).append(true).open(&path);
    file.and_then(|mut file| file.write_all(text.as_bytes()))
        .unwrap_or_else(|error| panic!("TRIBOSWEEP_STRESS_SUMMARY: {}: {error}", path.display()));
}
