//! Reports from made-up records: what a reader or a program finds in the files.

mod export;
mod figure;
mod folder;
mod overview;
mod pareto;
mod svg;
mod synthetic;
mod tables;
mod trouble;
