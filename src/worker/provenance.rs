//! The provenance of results: program, commit, machine, vector instructions, threads.

use crate::queue::Worker;
use fearless_simd::Level;
use serde_json::json;

/// The program's version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The commit that the program was built from: `unknown` without a repository, with `+modified` if the sources differed.
const COMMIT: &str = env!("TRIBOSWEEP_COMMIT");

/// A hash of the sources that the program was built from. Programs with different hashes are different programs,
/// whatever their commits.
pub(super) const SOURCES: &str = env!("TRIBOSWEEP_SOURCES");

/// Name, version and commit of this program, for people.
pub fn program() -> String {
    format!("tribosweep {VERSION}, commit {COMMIT}")
}

/// This process as a worker, with the provenance of its results as JSON.
pub fn worker(threads: usize) -> Worker {
    let mut worker = Worker::this_process(threads, VERSION, "");
    let provenance = json!({
        "program": "tribosweep",
        "version": VERSION,
        "commit": COMMIT,
        "host": worker.host,
        "cpu": cpu_model(),
        "architecture": std::env::consts::ARCH,
        "system": std::env::consts::OS,
        "vectors": vectors(),
        "threads": threads,
        "pid": worker.pid,
    });
    worker.provenance = provenance.to_string();
    worker
}

/// The processor's name, if the system provides it.
fn cpu_model() -> Option<String> {
    let processors = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = processors.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// The widest vector instructions that the solver finds and uses: `Avx2`, `Neon` …
fn vectors() -> String {
    let level = format!("{:?}", Level::new());
    // The solver has no code of its own for SSE4.2 (`solver::simd`).
    level.split('(').next().unwrap_or(&level).replace("Sse4_2", "Sse2")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the provenance names version, commit, threads, host and the bare name of the vector instructions.
    #[test]
    fn provenance_is_complete() {
        let provenance: serde_json::Value = serde_json::from_str(&worker(3).provenance).unwrap();
        assert_eq!(
            (provenance["version"].as_str(), provenance["threads"].as_u64()),
            (Some(VERSION), Some(3))
        );
        let commit = provenance["commit"].as_str().unwrap().trim_end_matches("+modified").to_owned();
        let is_hash = commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit());
        assert!(is_hash || commit == "unknown", "{commit}");
        let vectors = provenance["vectors"].as_str().unwrap();
        assert!(
            !vectors.is_empty() && vectors.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'),
            "{vectors}"
        );
        assert!(!provenance["host"].as_str().unwrap().is_empty());
    }
}
