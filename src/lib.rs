//! **tribosweep**: what friction coefficient does a tribometer measure, and how does its contact squeal?
//!
//! Other Rust programs can run sweeps too. This example runs a small one from the study to the report:
//!
//! ```
//! # #[cfg(feature = "sweep")] {
//! use std::path::Path;
//! use tribosweep::sweep::{self, Plan, SweepError};
//! use tribosweep::worker::WorkOptions;
//!
//! const STUDY: &str = r#"{
//!     "scene": { "pin": { "elements": [3, 4, 3] }, "clamp": { "width_m": 0.004 } },
//!     "run": { "limit_s": 0.012 },
//!     "grid": { "mu": [0.2, 0.4] }
//! }"#;
//!
//! fn run(folder: &Path) -> Result<(), SweepError> {
//!     let plan = Plan::parse(STUDY, "tiny.json")?;
//!     sweep::block_on(async {
//!         let mut queue = sweep::open(folder.join("tiny.db")).await?;
//!         plan.submit(&mut queue).await?;
//!         let summary = sweep::work(&mut queue, plan.name(), WorkOptions::new(1)).await?;
//!         assert_eq!((summary.counts.done, summary.counts.failed), (2, 0));
//!         let rows = sweep::read_rows(&mut queue, plan.name()).await?;
//!         sweep::write_report(&mut queue, plan.name(), &rows, &folder.join("report")).await?;
//!         queue.close().await?;
//!         for row in &rows {
//!             // Stick phases make the measured coefficient μ* smaller than the local coefficient μ.
//!             let mu_star = row.record().map_or(f64::NAN, |record| record.mu_star);
//!             let mu = row.parameters.mu();
//!             assert!(0.5 * mu < mu_star && mu_star < 1.001 * mu, "{mu_star}");
//!         }
//!         Ok(())
//!     })
//! }
//!
//! let folder = tempfile::tempdir().unwrap();
//! run(folder.path()).unwrap();
//! assert!(folder.path().join("report/report.html").is_file());
//! # }
//! ```
//!
//! The map of the crate. Arrows point in one direction only:
//!
//! ```text
//! cli ──► sweep ──► worker ──► queue
//!  │        │          └─────► analysis ──► stability ──► solver ──► spec
//!  │        ├─────► report ──► publish, analysis::record
//!  │        ├─────► study ───► spec
//!  │        └─────► calibration
//!  └──────────────► inspect ─► publish, analysis, solver
//! ```
//!
//! * [`spec`] – the definition of a job: scene, numerics and run control as plain data with their physical limits.
//! * [`solver`] – explicit dynamics of the pin in unilateral frictional contact with the disk.
//! * [`stability`] – the linear stability of steady sliding: equilibrium and complex modes.
//! * [`analysis`] – the evaluation of a run: cycles, periodic state, decay, regime, μ*, identities.
//! * [`study`] – studies as data: parse, check, expand into jobs, key, schema.
//! * [`queue`] – jobs in a database, a SQLite file or a PostgreSQL server; payloads are opaque strings without mechanics.
//! * [`worker`] – dispatcher (database, progress) and executor (threads).
//! * [`publish`] – the parts of documents: values as text, drawings, pages, files that are replaced as a whole.
//! * [`inspect`] – one job run again and shown in detail: histories, cycles, snapshots, fields.
//! * [`report`] – page, tables, figures and CSV from records.
//! * [`calibration`] – history matching in plain numbers: what measured values leave of the ranges of parameters.
//! * [`sweep`] – the steps of a sweep from the study to the report, for the command line and for other programs.
//! * [`cli`] – the command line: arguments, messages and exit codes.
//!
//! # Features
//! All of them are on by default. Without any there are [`spec`], [`solver`], [`stability`], [`analysis`], [`study`] and
//! [`random`] and [`units`].
//!
//! * `queue` – [`queue`] and [`worker`].
//! * `postgres` – the queue on a PostgreSQL server too.
//! * `report` – [`publish`], [`report`] and [`inspect`].
//! * `sweep` – [`sweep`] and [`calibration`], with `queue` and `report`.
//! * `cli` – [`cli`] and the command, with `sweep`.

#[doc(inline)]
pub use tribosweep_application::*;
