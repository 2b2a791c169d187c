//! **tribosweep**: what friction coefficient does a tribometer measure, and how does its contact squeal?
//!
//! The map of the crate. Arrows point one way only:
//!
//! ```text
//! cli ──► worker ──► queue
//!  │        └──────► analysis ──► solver ──► spec
//!  ├─────► report ─► (records: analysis::record)
//!  └─────► study ──► spec
//! ```
//!
//! * [`spec`] – what a job *is*: scene, numerics, run control as plain data with their physical limits.
//! * [`solver`] – explicit dynamics of the pin in unilateral frictional contact with the disk.
//! * [`analysis`] – what is found in a run: cycles, periodic state, decay, regime, μ*, identities.
//! * [`study`] – studies as data: parse, check, expand into jobs, key, schema.
//! * [`queue`] – jobs in `SQLite`; payloads are opaque strings, nothing of mechanics.
//! * [`worker`] – dispatcher (signals, database, progress) and executor (rayon).
//! * [`publish`] – what reports are made of: values as text, drawings, pages, folders.
//! * [`inspect`] – one job run again and looked into: histories, cycles, snapshots, fields.
//! * [`report`] – page, tables, figures and CSV from records.
//! * [`cli`] – one file a subcommand.

pub mod analysis;
pub mod cli;
pub mod exit;
pub mod inspect;
pub mod publish;
pub mod queue;
pub mod report;
pub mod solver;
pub mod spec;
pub mod study;
pub mod units;
pub mod worker;
