//! Orchestration: the properties of studies and jobs that must hold under interruptions, repetitions and concurrency.

#[path = "../support/mount.rs"]
mod mount;
mod queue;
#[path = "../support/random.rs"]
mod random;
#[path = "../support/server.rs"]
mod server;
mod support;
mod worker;
