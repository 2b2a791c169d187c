//! The output: the parts of documents, and the reports and inspections that are made of them. It knows no databases and commands.

pub mod inspect;
pub mod publish;
pub mod report;

use tribosweep_mechanics::{analysis, random, solver, spec, units};
