//! Any text as overrides (`name=value` lines) of a study with an open and a closed axis.

#![no_main]

#[allow(dead_code)]
#[path = "../checks.rs"]
mod checks;

use std::sync::OnceLock;
use tribosweep::study::Study;

static STUDY: OnceLock<Study> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let study = STUDY.get_or_init(|| {
        let text = r#"{ "name": "base", "scene": { "pin": { "elements": [1, 1, 1] } },
            "grid": { "mu": [0.2, 0.4], "clamp_side": ["whole_top"] } }"#;
        Study::parse(text, "base.json").expect("the base study is valid")
    });
    if let Ok(text) = std::str::from_utf8(bytes) {
        checks::check_overrides(study, text);
    }
});
