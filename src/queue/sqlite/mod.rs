//! A queue in a `SQLite` file.

mod error;
mod examine;
mod file;
mod filesystem;
mod holder;
mod identity;
mod lock;
mod open;
mod schema;
mod transaction;

pub(super) use examine::{examine, integrity};
pub(super) use file::File;
pub(super) use open::{check_new, is_writable, open, open_to_read, resolve};
pub(super) use transaction::{begin, commit, compact, roll_back, size};
