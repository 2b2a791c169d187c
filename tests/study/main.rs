//! Studies as data: what is refused and with which message, what a grid expands into, what a key means.

mod calibrate;
mod changes;
mod damping;
mod derive;
mod expansion;
mod friction_table;
mod height_map;
mod keys;
mod mesh_files;
mod mini_schema;
mod mutations;
mod plausibility;
mod presets;
#[path = "../support/random.rs"]
mod random;
mod refusals;
mod samples;
mod schema;
mod shipped;
mod single;
mod stability;
mod text;
mod time_defaults;

use tribosweep::study::{Study, StudyError};

/// The study in `text`, read as if from `studies/x.json`.
fn parse(text: &str) -> Study {
    Study::parse(text, "studies/x.json").unwrap_or_else(|error| panic!("refused:\n{error}\n{text}"))
}

/// The message with which `text` is refused.
fn refusal(text: &str) -> String {
    match Study::parse(text, "studies/x.json") {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => message(&error),
    }
}

fn message(error: &StudyError) -> String {
    error.to_string()
}

/// Asserts that `text` contains every one of `parts`.
fn assert_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
}
