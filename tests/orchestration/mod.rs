//! Orchestration: the properties of studies and jobs that must hold under interruptions, repetitions and concurrency.

// The macro of the module is used below.
#[macro_use]
mod support;
mod queue;
mod worker;
