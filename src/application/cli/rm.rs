//! `tribosweep rm`: remove a study.

use super::error::CliError;
use super::output::{log, print};
use crate::exit;
use crate::publish::value::count;
use crate::queue::{Location, Removed};
use crate::sweep::{self, Purpose};

/// Arguments of `rm`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
    /// Only print what would be removed.
    #[arg(long)]
    dry_run: bool,
}

/// Removes the study.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    if args.dry_run {
        let removed = sweep::with_queue(db, Purpose::Read, async |queue| {
            Ok::<_, CliError>(queue.preview_removal(&name).await?)
        })?;
        print(&format!("{name}: `rm` would remove {}; nothing has been changed\n", in_words(&removed)))?;
        return Ok(exit::SUCCESS);
    }
    let removed =
        sweep::with_queue(db, Purpose::Change, async |queue| Ok::<_, CliError>(queue.remove(&name).await?))?;
    log(format_args!(
        "{name}: removed {}; results stay in the database until `tribosweep gc`",
        in_words(&removed)
    ));
    Ok(exit::SUCCESS)
}

/// What a removal comprises.
fn in_words(&Removed { rows, jobs, done, shared_done, cancelled }: &Removed) -> String {
    format!(
        "{} of {} (results that no study has any more: {}; results that other studies have too: {shared_done}; pending jobs \
         cancelled: {cancelled})",
        count(rows, "row"),
        count(jobs, "job"),
        done - shared_done
    )
}
