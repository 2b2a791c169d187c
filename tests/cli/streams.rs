//! Only results go to standard output. A reader that closes its pipe early is not an error.

use std::process::{Command, Stdio};

use serde_json::json;

use crate::cli::support::{Folder, TRIBOSWEEP, diverging, small, stderr, stdout};

fn folder() -> Folder {
    Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })))
}

/// Protects: commands without a result print nothing, and commands with a result print nothing else, so that both streams
/// can be piped.
#[test]
fn results_and_messages_have_different_streams() {
    let folder = folder();
    for (command, has_result, has_messages) in [
        ("submit mine.json", false, true),
        ("work", false, true),
        ("status", true, false),
        ("status mine --json", true, false),
        ("export mine", true, false),
        ("report mine", true, true),
        ("run mine.json", true, true),
        ("solve mine.json --set mu=0.2", true, false),
        ("validate mine.json", true, false),
        ("schema", true, false),
        ("presets", true, false),
        ("completions bash", true, false),
    ] {
        let end = folder.command(command).assert().code(0);
        assert_eq!(!stdout(&end).is_empty(), has_result, "{command}: {}", stdout(&end));
        assert_eq!(!stderr(&end).is_empty(), has_messages, "{command}: {}", stderr(&end));
    }
    let failed = folder.command("export other").assert().code(2);
    assert_eq!(stdout(&failed), "");
    assert!(stderr(&failed).starts_with("error: "), "{}", stderr(&failed));
}

/// Protects: `tribosweep … | head` succeeds, even if the reader closes the pipe before the first byte.
#[test]
fn a_closed_pipe_is_not_an_error() {
    let folder = folder();
    for command in
        ["run mine.json", "export mine", "export mine --format json", "status", "schema", "completions zsh"]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut process = Command::new(TRIBOSWEEP);
        process.current_dir(folder.path("")).env_remove("TRIBOSWEEP_DB").args(command.split(' '));
        let output = process.stdout(writer).stderr(Stdio::piped()).output().unwrap();
        let messages = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{command}: {messages}");
        assert!(!messages.contains("error") && !messages.contains("panic"), "{command}: {messages}");
    }
}

/// Protects: a closed pipe does not turn a failure into a success.
#[test]
fn a_closed_pipe_hides_no_failure() {
    let folder = Folder::with("bad", &diverging(&[0.2]));
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut process = Command::new(TRIBOSWEEP);
    process.current_dir(folder.path("")).args(["--db", "mine.db", "run", "bad.json"]);
    let output = process.stdout(writer).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8(output.stderr).unwrap());
}

/// Protects: a sweep runs to its end even if its standard error is closed.
#[test]
fn a_sweep_needs_no_standard_error() {
    let folder = folder();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut process = Command::new(TRIBOSWEEP);
    process.current_dir(folder.path("")).args(["--db", "mine.db", "run", "mine.json"]);
    let output = process.stderr(writer).stdout(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8(output.stdout).unwrap().starts_with("# "));
}
