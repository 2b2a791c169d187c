//! The output: the parts of documents, and the reports and inspections that are made of them. It knows no databases and commands.
//!
//! The rooms are the folders beside this one.

#[path = "../inspect/mod.rs"]
pub mod inspect;
#[path = "../publish/mod.rs"]
pub mod publish;
#[path = "../report/mod.rs"]
pub mod report;

use tribosweep_mechanics::{analysis, random, solver, spec, units};
