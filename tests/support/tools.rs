//! Tests that need another program, a server or a right, on a machine that lacks it.

use std::io::Write as _;

/// With 1, a test fails if its tool is missing. Otherwise the test is skipped, and the output of the run names it.
const REQUIRED: &str = "TRIBOSWEEP_REQUIRE_TOOLS";

/// With `mount`, tests that mount a file system are skipped although tools are required: no package gives this right.
const LEFT_OUT: &str = "TRIBOSWEEP_LEAVE_OUT";

/// Says that the running test is skipped because it may not mount a file system.
///
/// # Panics
/// If the tools are required, and this one is not left out.
#[allow(dead_code, reason = "not every package of tests mounts")]
pub fn missing_mount() {
    let (problem, remedy) =
        ("mounting a file system is refused", "run the tests as root with the right to mount");
    match std::env::var(LEFT_OUT) {
        Ok(left_out) if left_out == "mount" => skip(problem, remedy),
        _ => missing(problem, remedy),
    }
}

/// Says that the running test is skipped because of `problem`, and how to run it.
///
/// # Panics
/// If the tools are required.
pub fn missing(problem: &str, remedy: &str) {
    let is_required = std::env::var(REQUIRED).is_ok_and(|value| !["", "0"].contains(&value.as_str()));
    assert!(!is_required, "{problem}, and {REQUIRED} is set: {remedy}");
    skip(problem, remedy);
}

/// Says that the running test is skipped.
fn skip(problem: &str, remedy: &str) {
    // The harness names the thread of a test like the test. With a single thread it prints the name itself.
    let thread = std::thread::current();
    let test = thread.name().filter(|name| *name != "main").unwrap_or("this test");
    // Not `eprintln!`: the harness hides what the printing macros print in tests that pass.
    let _ = writeln!(std::io::stderr(), "skipped {test}: {problem} ({remedy})");
}
