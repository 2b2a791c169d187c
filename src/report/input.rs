//! What a report is written from.

use super::provenance::Provenance;
use super::row::JobRow;

/// What a report is written from.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// Its title: the study's name.
    pub title: &'a str,
    /// The study's jobs.
    pub rows: &'a [JobRow],
    /// Where they come from, if that is known.
    pub provenance: Option<&'a Provenance>,
    /// When it is written, in milliseconds since 1970-01-01 UTC.
    pub written_ms: i64,
    /// After how many seconds the page reloads itself; none for a page that is not going to be written again.
    pub refresh_s: Option<u32>,
}
