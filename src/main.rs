//! The `tribosweep` command.
fn main() {}
