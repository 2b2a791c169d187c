//! Tests that need another program, a server or a right, on a machine that lacks it.

use std::io::Write as _;

/// With 1, a test fails if its tool is missing. Otherwise the test is skipped, and the output of the run names it.
const REQUIRED: &str = "TRIBOSWEEP_REQUIRE_TOOLS";

/// Says that the running test is skipped because of `problem`, and how to run it.
///
/// # Panics
/// If the tools are required.
pub fn missing(problem: &str, remedy: &str) {
    let is_required = std::env::var(REQUIRED).is_ok_and(|value| !["", "0"].contains(&value.as_str()));
    assert!(!is_required, "{problem}, and {REQUIRED} is set: {remedy}");
    // The harness names the thread of a test like the test. With a single thread it prints the name itself.
    let thread = std::thread::current();
    let test = thread.name().filter(|name| *name != "main").unwrap_or("this test");
    // Not `eprintln!`: the harness hides what the printing macros print in tests that pass.
    let _ = writeln!(std::io::stderr(), "skipped {test}: {problem} ({remedy})");
}
