//! Tells the program which commit it was built from: part of what every result is stored with.

use std::path::Path;
use std::process::Command;

fn main() {
    // The commit changes with HEAD or with the branch it names, what is modified with the sources.
    for name in ["HEAD", "packed-refs"] {
        watch(&["rev-parse", "--git-path", name]);
    }
    if let Some(branch) = git(&["symbolic-ref", "--quiet", "HEAD"]) {
        watch(&["rev-parse", "--git-path", &branch]);
    }
    for path in ["build.rs", "Cargo.toml", "Cargo.lock", "migrations", "src"] {
        println!("cargo::rerun-if-changed={path}");
    }
    let commit = git(&["rev-parse", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    let changed =
        ["status", "--porcelain", "--", "build.rs", "Cargo.toml", "Cargo.lock", "migrations", "src"];
    let suffix = if git(&changed).is_some_and(|files| !files.is_empty()) { "+modified" } else { "" };
    println!("cargo::rustc-env=TRIBOSWEEP_COMMIT={commit}{suffix}");
}

/// What git answers; nothing if there is no git, or the sources are not in a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// A file that is not there would make every build a new one.
fn watch(arguments: &[&str]) {
    if let Some(path) = git(arguments).filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
}
