//! The provenance of results: program, commit, machine, vector instructions, threads.

use crate::analysis::Build;
use crate::queue::Worker;
use fearless_simd::Level;

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
    let build = Build {
        program: "tribosweep".to_owned(),
        version: VERSION.to_owned(),
        commit: COMMIT.to_owned(),
        host: worker.host.clone(),
        cpu: cpu_model(),
        architecture: std::env::consts::ARCH.to_owned(),
        system: std::env::consts::OS.to_owned(),
        vectors: vectors(),
        threads: threads as u64,
        pid: worker.pid,
    };
    worker.provenance = serde_json::to_string(&build).expect("texts and whole numbers have a JSON form");
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
        let Build { version, commit, host, vectors, threads, .. } =
            serde_json::from_str(&worker(3).provenance).unwrap();
        assert_eq!((version.as_str(), threads), (VERSION, 3));
        let commit = commit.trim_end_matches("+modified");
        let is_hash = commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit());
        assert!(is_hash || commit == "unknown", "{commit}");
        assert!(
            !vectors.is_empty() && vectors.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'),
            "{vectors}"
        );
        assert!(!host.is_empty());
    }
}
