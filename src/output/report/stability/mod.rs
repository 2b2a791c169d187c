//! The linear stability of steady sliding: where small vibrations about it grow, and which modes do.
//!
//! ```text
//! points ──► analysis (branches over μ, onsets, ranges, families over ω) ──► figures, table ──► write (a page of its own)
//!    └─────► contour (zero line of the leading growth rate) ───────► map, regime map
//!    └─────► verdict (what linear stability says about a job) ─────► regime map
//! ```

mod along;
mod analysis;
mod caveats;
mod contour;
mod nearest;
mod onsets;
mod ranges;
mod table;
mod verdict;
mod write;

pub use along::Along;
pub(super) use analysis::{Analysis, GroupModes, rows};
pub(super) use caveats::{above_band, small_contact};
pub(super) use contour::{Node, zero_line};
pub(super) use nearest::NEAR;
pub use nearest::nearest_in_words;
pub(super) use ranges::{Onset, Speed};
pub(super) use table::described;
pub use table::{MODE_NUMBER, ShownModes, modes_table, thresholds_table, unknown_errors};
pub(super) use verdict::{Verdict, Verdicts};
pub(super) use write::{Files, write_files};
pub use write::{PAGE, SHAPES, write_stability};
