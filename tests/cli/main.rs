//! The command as a user runs it: its output, its files, its exit codes, and the results after an interruption.

mod accuracy;
mod book;
mod calibrate;
mod commands;
mod comparison;
mod corners;
mod data;
mod determinism;
mod exit_codes;
mod forecast;
mod growing;
mod guards;
mod hostile;
mod inspect;
mod interruption;
#[path = "../support/mount.rs"]
mod mount;
mod nightly;
mod one_job;
mod points;
mod python;
#[path = "../support/random.rs"]
mod random;
#[path = "../support/report_files.rs"]
mod report_files;
mod server;
#[path = "../support/server.rs"]
mod server_database;
mod several;
mod shards;
mod sharing;
mod slurm;
mod stability;
mod streams;
mod support;
mod surroundings;
mod sweep;
mod texts;
#[path = "../support/tools.rs"]
mod tools;
mod upkeep;
#[path = "../support/walk.rs"]
mod walk;
mod watch;
