//! `tribosweep gc`: delete the jobs that no study needs.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::value::{count, significant};
use crate::queue::{Garbage, Location};
use crate::sweep::{self, Purpose};

/// Arguments of `gc`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only print what would be deleted.
    #[arg(long)]
    dry_run: bool,
}

/// Deletes the jobs that no study needs, with their results, and prints how many they were.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let purpose = if args.dry_run { Purpose::Read } else { Purpose::Change };
    let garbage = sweep::with_queue(db, purpose, async |queue| {
        let garbage =
            if args.dry_run { queue.preview_garbage().await } else { queue.collect_garbage().await };
        Ok::<_, CliError>(garbage?)
    })?;
    let megabytes = significant(garbage.bytes as f64 / 1e6, 2);
    let what = in_words(&garbage);
    print(&if args.dry_run {
        format!("`gc` would drop {what}, with {megabytes} MB of data; nothing has been changed\n")
    } else {
        format!("dropped {what}; the database is {megabytes} MB smaller\n")
    })?;
    Ok(exit::SUCCESS)
}

fn in_words(garbage: &Garbage) -> String {
    format!(
        "{}, {} and {}",
        count(garbage.jobs, "job"),
        count(garbage.results, "result"),
        count(garbage.workers, "ended worker")
    )
}
