//! Tests of the mechanics, whose time is that of the solver. They are one program, because each of them would compile the same code again.

mod analysis;
#[path = "support/random.rs"]
mod random;
mod verification;
