//! A queue in a PostgreSQL database: a session that reconnects after its connection was lost.
//!
//! A network link can fail silently. Every wait for the server's answer is therefore limited; when the limit passes,
//! the connection is dropped, and the next request makes a new one. The new connection first makes the server end the
//! old session. Then the old session's last transaction is either committed or rolled back, and its locks are released.
//! (This needs a direct connection, or a pooler that keeps one session for each client.)

mod connect;
mod error;
mod examine;
mod open;
mod schema;
mod session;

pub(super) use open::{open, open_existing};
pub(super) use session::Session;
