//! Gives the program two facts about its own build: the commit, which is stored with every result, and a hash of the
//! sources, which differs between two builds of a modified commit.

use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::process::Command;

/// What the program is made of, seen from this package. A package of the registry has nothing but itself.
const SOURCES: [&str; 4] = ["../../Cargo.toml", "../../Cargo.lock", "../../migrations", "../../src"];
const OWN: [&str; 1] = ["."];

fn main() {
    // The commit changes when HEAD changes, or the branch that HEAD names. Modifications change the sources below.
    for name in ["HEAD", "packed-refs"] {
        watch(&["rev-parse", "--git-path", name]);
    }
    if let Some(branch) = git(&["symbolic-ref", "--quiet", "HEAD"]) {
        watch(&["rev-parse", "--git-path", &branch]);
    }
    let mut hasher = DefaultHasher::new();
    let sources: &[&str] = if Path::new("../../src/application/build.rs").exists() { &SOURCES } else { &OWN };
    for &path in sources {
        println!("cargo::rerun-if-changed={path}");
        hash(Path::new(path), &mut hasher);
    }
    println!("cargo::rustc-env=TRIBOSWEEP_SOURCES={:016x}", hasher.finish());
    let commit = git(&["rev-parse", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    let changed: Vec<&str> = ["status", "--porcelain", "--"].iter().chain(sources).copied().collect();
    let suffix = if git(&changed).is_some_and(|files| !files.is_empty()) { "+modified" } else { "" };
    println!("cargo::rustc-env=TRIBOSWEEP_COMMIT={commit}{suffix}");
    // `1.0.0 (abc1234, 2026-11-22)` with the day of the commit; without a repository the version alone.
    let version = env!("CARGO_PKG_VERSION");
    let built_from = git(&["log", "-1", "--abbrev=7", "--format=%h SUFFIX, %cs"])
        .map_or_else(String::new, |text| format!(" ({})", text.replace(" SUFFIX", suffix)));
    println!("cargo::rustc-env=TRIBOSWEEP_VERSION={version}{built_from}");
}

/// Adds a file to the hash, or all files below a folder in the order of their names.
fn hash(path: &Path, hasher: &mut DefaultHasher) {
    hasher.write(path.to_string_lossy().as_bytes());
    if let Ok(entries) = std::fs::read_dir(path) {
        let mut below: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        below.sort();
        for path in &below {
            hash(path, hasher);
        }
    } else if let Ok(content) = std::fs::read(path) {
        hasher.write(&content);
    }
}

/// The output of a git command; `None` if there is no git, or the sources are not in a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Rebuilds when the file that git names changes. A path that does not exist would make cargo rebuild every time.
fn watch(arguments: &[&str]) {
    if let Some(path) = git(arguments).filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
}
