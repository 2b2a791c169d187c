//! The queue on its own: jobs are strings here.

mod exchange;
mod open;
mod read;
mod recovery;
mod scale;
mod submit;
