//! Tests of the analysis with known signals and in short runs.

mod batch;
mod decay;
mod extremes;
mod figures;
mod frequency;
mod identities;
mod interruption;
mod on_elastic_disk;
mod signals;
mod statistics;
mod steady;
