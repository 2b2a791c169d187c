//! Orchestration: what must hold of studies and jobs whatever is interrupted, repeated or done at once.

mod queue;
mod support;
mod worker;
