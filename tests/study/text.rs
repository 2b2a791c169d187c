//! Protects: which texts are studies, and where a text that is none is wrong.

use super::{assert_contains, parse, refusal};
use serde_json::json;
use tribosweep::study::{Study, json_value, renamed};

const COMMENTED: &str = r#"// The pin of the rig.
{
  "$schema": "../study.schema.json",
  /* softer
     than usual */
  "scene": { "pin": { "young_modulus_pa": 5e8, }, }, // half
  "description": "not a // comment, nor /* this */",
  "grid": { "mu": [0.3, /* no 0.35 */ 0.4,], },
}
"#;

/// Protects: comments, trailing commas and the place of the schema mean nothing, and comments in strings are text.
#[test]
fn comments_and_trailing_commas_mean_nothing() {
    let plain = r#"{ "description": "not a // comment, nor /* this */", "scene": { "pin": { "young_modulus_pa": 5e8 } },
        "grid": { "mu": [0.3, 0.4] } }"#;
    let (study, same) = (parse(COMMENTED), parse(plain));
    assert_eq!(study.expand("1").unwrap(), same.expand("1").unwrap());
    assert_eq!(study.description(), same.description());
    let value = json_value(COMMENTED, "x").unwrap();
    assert_eq!(value["grid"], json!({ "mu": [0.3, 0.4] }));
    // Some editors begin a file with a byte order mark.
    parse(&format!("\u{feff}{plain}"));
}

/// Protects: a study with another name keeps its comments.
#[test]
fn renaming_keeps_comments() {
    let text = COMMENTED.replace("{\n  \"$schema\"", "{\n  \"name\": \"a\", // the first\n  \"$schema\"");
    assert_eq!(parse(&text).name(), "a");
    assert_eq!(renamed(&text, "b"), text.replace("\"a\"", "\"b\""));
}

/// Protects: positions in messages are those in the text as written, behind comments too.
#[test]
fn positions_count_comments() {
    let text = COMMENTED.replace("0.4", "-0.4");
    assert_contains(&refusal(&text), &["studies/x.json:8:39: scene.contact.mu = -0.4: expected"]);
    let text = "/* é\n */ { \"grid\": { \"muu\": [1] } }";
    assert_contains(&refusal(text), &["studies/x.json:2:17: grid.muu"]);
}

/// Protects: a text that is not JSON is refused at the place where it goes wrong, with the reason.
#[test]
fn syntax_errors_have_place_and_reason() {
    for (text, expected) in [
        ("", "1:1: not valid JSON: the text is empty"),
        (" // nothing", "1:1: not valid JSON: the text is empty"),
        ("{\n  \"run\": {\n", "2:10: not valid JSON: no } closes this object"),
        ("{ \"grid\": { \"mu\": [1, 2 }", "1:25: not valid JSON: unexpected close brace"),
        ("{ \"grid\": { \"mu\": [1, 2", "1:19: not valid JSON: no ] closes this list"),
        ("{ \"run\": {}\n  \"scene\": {} }", "1:12: not valid JSON: expected a comma"),
        ("{ \"run\" {} }", "1:9: not valid JSON: expected colon"),
        ("{ run: {} }", "1:3: not valid JSON: expected a name in double quotes"),
        ("{ 'run': {} }", "1:3: not valid JSON: expected double quotes"),
        ("{ \"run\": {} } }", "1:15: not valid JSON: expected nothing after the end"),
        ("{ /* open }", "1:3: not valid JSON: no */ closes this comment"),
        ("{ \"run\": { \"limit_s\": .5 } }", "1:23: not valid JSON: leading or trailing decimal points"),
        ("{ \"run\": { \"limit_s\": +5 } }", "1:23: not valid JSON: unary plus"),
        ("{ \"run\": { \"limit_s\": NaN } }", "1:23: not valid JSON: unexpected word"),
        ("{ \"run\": { \"limit_s\": 1e999 } }", "1:23: not valid JSON: the number is too large for a double"),
        ("{ \"name\": \"a\tb\" }", "1:11: not valid JSON: expected a string without line breaks"),
        ("{,}", "1:2: not valid JSON: "),
        ("[1,,2]", "1:4: not valid JSON: "),
    ] {
        let expected = format!("studies/x.json:{expected}");
        let message = refusal(text);
        assert!(message.starts_with(&expected), "{text:?}: {message}, not {expected}");
    }
}

/// Protects: deep nesting is refused and does not exhaust the stack.
#[test]
fn deep_nesting_is_refused() {
    for depth in [129, 400, 100_000] {
        let text = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        assert_contains(&refusal(&text), &["not valid JSON: ", "nest"]);
    }
}

/// Protects: numbers are read to the last bit, as `serde_json` writes them.
#[test]
fn numbers_keep_their_bits() {
    for number in [0.1 + 0.2, 1.0 / 3.0, 5e-324, f64::MAX, -0.0] {
        let value = json_value(&json!([number]).to_string(), "x").unwrap();
        assert_eq!(value[0].as_f64().unwrap().to_bits(), f64::to_bits(number));
    }
}

/// Protects: a study from standard input needs a name, and the message says so.
#[test]
fn standard_input_has_no_name() {
    let error = Study::parse("{}", "<stdin>").unwrap_err().to_string();
    assert_contains(&error, &["<stdin>: name: expected a name", "add \"name\""]);
    assert_eq!(Study::parse(r#"{ "name": "a" }"#, "<stdin>").unwrap().name(), "a");
}
