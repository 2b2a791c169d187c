//! The queue on its own: jobs are strings here.

mod in_a_file;
mod lost;
mod migrate;
mod on_a_server;
mod open;
mod surroundings;
