//! The queue without a worker. The payloads and records of jobs are arbitrary strings here.

mod in_a_file;
mod lost;
mod migrate;
mod on_a_server;
mod open;
mod surroundings;
