//! The queue without a worker. The payloads and records of jobs are arbitrary strings here.

mod absorb;
mod claims;
mod displaced;
mod exchange;
mod guards;
mod integrity;
mod lost;
mod migrate;
mod open;
mod outlook;
mod plans;
mod read;
mod recovery;
mod scale;
mod submit;
mod surroundings;
