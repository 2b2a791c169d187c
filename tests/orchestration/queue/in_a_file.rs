//! The tests that must pass with both databases, with a `SQLite` file.

const ENGINE: crate::support::Engine = crate::support::Engine::Sqlite;

#[path = "absorb.rs"]
mod absorb;
#[path = "claims.rs"]
mod claims;
#[path = "exchange.rs"]
mod exchange;
#[path = "outlook.rs"]
mod outlook;
#[path = "read.rs"]
mod read;
#[path = "recovery.rs"]
mod recovery;
#[path = "scale.rs"]
mod scale;
#[path = "submit.rs"]
mod submit;
