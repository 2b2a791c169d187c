use std::collections::BTreeMap;

use super::process;
use super::throughput::Throughput;

/// A process that runs jobs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Worker {
    /// The machine's name.
    pub host: String,
    /// Identifies this boot of the machine, if the system provides such an identifier.
    pub boot_id: Option<String>,
    /// The namespace in which the process number is valid, if the system has such namespaces.
    pub pid_namespace: Option<String>,
    /// The process number.
    pub pid: u32,
    /// When the process started, in clock ticks since the boot, if the system provides it.
    pub process_start: Option<i64>,
    /// How many jobs it runs at a time.
    pub threads: usize,
    /// The program's version.
    pub version: String,
    /// What its results are made with, in any form. It is stored with each result.
    pub provenance: String,
}

impl Worker {
    /// This process.
    pub fn this_process(threads: usize, version: &str, provenance: &str) -> Self {
        let pid = std::process::id();
        Self {
            host: process::host(),
            boot_id: process::boot_id(),
            pid_namespace: process::pid_namespace(),
            pid,
            process_start: process::start_tick(pid),
            threads,
            version: version.to_owned(),
            provenance: provenance.to_owned(),
        }
    }
}

/// What a queue knows about the worker that is registered with it.
#[derive(Debug, Clone)]
pub(super) struct Registration {
    /// The worker's number in the tables.
    pub id: i64,
    pub worker: Worker,
    /// The attempts that the worker has claimed and not finished: job keys and attempt numbers.
    pub held: BTreeMap<String, u32>,
    pub throughput: Throughput,
}
