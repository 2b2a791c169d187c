//! The command as a user runs it: its output, its files, its exit codes, and what an interruption may not
//! change.

mod accuracy;
mod commands;
mod determinism;
mod exit_codes;
mod interruption;
mod one_job;
mod several;
mod sharing;
mod streams;
mod support;
mod sweep;
mod upkeep;
