//! What the analysis finds in known signals and in short runs.

mod batch;
mod decay;
mod extremes;
mod figures;
mod frequency;
mod identities;
mod interruption;
mod signals;
mod statistics;
mod steady;
