//! Reports from synthetic records: what a reader or a program finds in the files.

mod axes;
mod browser;
mod charts;
#[path = "../support/browser.rs"]
mod chromium;
mod columns;
mod comparison;
mod cycles;
mod explore;
mod export;
mod figure;
mod folder;
mod html;
mod maps;
mod overview;
mod pareto;
mod planes;
mod points;
mod programs;
#[path = "../support/random.rs"]
mod random;
#[path = "../support/report_files.rs"]
mod report_files;
mod stability;
mod svg;
mod synthetic;
mod tables;
mod texts;
#[path = "../support/tools.rs"]
mod tools;
mod trouble;
