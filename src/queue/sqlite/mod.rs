//! A queue in a `SQLite` file.

mod error;
mod examine;
mod filesystem;
mod lock;
mod open;
mod schema;
mod transaction;

pub(super) use error::classify;
pub(super) use examine::examine;
pub(super) use open::{check_new, is_writable, open, open_to_read, resolve};
pub(super) use transaction::{begin, commit, compact, roll_back, size};
