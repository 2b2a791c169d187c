//! The queue, which knows no mechanics: its payloads are texts.

#[path = "mod.rs"]
pub mod queue;
