//! Tests of the queue, the workers and the commands. They are one program: many of them wait for a process, a lock or a disk,
//! and others run meanwhile.

mod cli;
#[path = "support/mount.rs"]
mod mount;
mod orchestration;
#[path = "support/random.rs"]
mod random;
#[path = "support/report_files.rs"]
mod report_files;
#[path = "support/server.rs"]
mod server;
#[path = "support/tools.rs"]
mod tools;
#[path = "support/walk.rs"]
mod walk;
