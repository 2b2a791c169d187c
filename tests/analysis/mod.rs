//! Tests of the analysis with known signals and in short runs.

mod batch;
mod decay;
mod extremes;
mod frequency;
mod holder;
mod identities;
mod interruption;
mod mesh_error;
mod nested;
mod on_elastic_disk;
mod signals;
mod similarity;
mod single;
mod stability;
mod statistics;
mod steady;
mod sums;
