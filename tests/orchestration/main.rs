//! Orchestration: the properties of studies and jobs that must hold under interruptions, repetitions and concurrency.

#[path = "../support/mount.rs"]
mod mount;
#[path = "../support/random.rs"]
mod random;
#[path = "../support/server.rs"]
mod server;
// The macro of the module is used below.
#[macro_use]
mod support;
mod queue;
#[path = "../support/tools.rs"]
mod tools;
mod worker;
