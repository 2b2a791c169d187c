//! One connection to one of the two databases, and statements for both.
//!
//! The databases differ here, in `sqlite`, in `postgres`, and in the few statements that are written in two dialects.

mod columns;
mod connection;
mod query;
mod statement;

pub(super) use columns::columns;
pub(super) use connection::Connection;
pub(super) use query::{Answer, Columns, Query, query};
pub(super) use statement::Statement;
