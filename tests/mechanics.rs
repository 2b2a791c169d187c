//! Tests of the mechanics. They are one program, because each of them would compile the solver's generic code again.

mod analysis;
#[path = "support/random.rs"]
mod random;
mod stress;
mod verification;
