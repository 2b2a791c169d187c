//! What results are made with. It is stored with each of them.

use serde::{Deserialize, Serialize};

/// A program on a machine.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Build {
    /// The program's name.
    #[serde(default)]
    pub program: String,
    /// Version of the program.
    pub version: String,
    /// The commit it was built from; it ends with `+modified` if the sources differed from that commit.
    pub commit: String,
    /// The machine's name.
    pub host: String,
    /// The processor's name, if it is known.
    pub cpu: Option<String>,
    /// Processor architecture.
    pub architecture: String,
    /// Operating system.
    pub system: String,
    /// The widest vector instructions that the solver uses: `Avx2`, `Neon` …
    pub vectors: String,
    /// Number of threads.
    pub threads: u64,
    /// The process; 0 where all processes of this program on this machine are meant.
    #[serde(default)]
    pub pid: u32,
}

impl Build {
    /// Processor architecture and operating system in words.
    pub fn platform(&self) -> String {
        format!("{} {}", self.architecture, self.system)
    }
}
