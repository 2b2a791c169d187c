//! The queue on its own: jobs are strings here.

mod claims;
mod exchange;
mod migrate;
mod open;
mod outlook;
mod read;
mod recovery;
mod scale;
mod submit;
mod surroundings;
