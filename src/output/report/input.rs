//! What a report is written from.

use super::growth::Findings;
use super::provenance::Provenance;
use super::row::JobRow;
use super::stability::Along;
use super::stability_point::StabilityPoint;
use super::view::View;
use crate::publish::Sheet;

/// What a report is written from.
#[derive(Debug, Clone, Copy, Default)]
pub struct Report<'a> {
    /// Its title: the study's name.
    pub title: &'a str,
    /// What the study is for, in its author's words.
    pub description: Option<&'a str>,
    /// The study's jobs.
    pub rows: &'a [JobRow],
    /// How they are laid out.
    pub view: &'a View,
    /// What was simulated: drawings and all inputs, if they are known.
    pub sheet: Option<&'a Sheet>,
    /// Where they come from, if that is known.
    pub provenance: Option<&'a Provenance>,
    /// What is doubtful about the study's inputs, each in words.
    pub warnings: &'a [String],
    /// What its jobs cost more than they would have to, each in words. Results are not in doubt.
    pub remarks: &'a [String],
    /// The complex modes of steady sliding at the grid points of one study and between them; empty if they were not computed.
    pub stability: &'a [StabilityPoint],
    /// What the thresholds of these modes are thresholds of.
    pub along: &'a Along,
    /// What the only study found that grows; none for other studies.
    pub findings: Option<&'a Findings>,
    /// The jobs of a study that varies what could bring the first study nearer to the others, and its name; none if there is no such
    /// study.
    pub sensitivity: Option<(&'a str, &'a [JobRow])>,
    /// When it is written, in milliseconds since 1970-01-01 UTC.
    pub written_ms: i64,
    /// After how many seconds the page reloads itself; none for a page that is not going to be written again.
    pub refresh_s: Option<u32>,
}
