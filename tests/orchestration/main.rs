//! Orchestration: what must hold of studies and jobs whatever is interrupted, repeated or done at once.

#[path = "../support/mount.rs"]
mod mount;
mod queue;
#[path = "../support/server.rs"]
mod server;
mod support;
mod worker;
