//! `tribosweep gc`: delete the jobs that no study needs.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::Location;
use crate::sweep;

/// Deletes the jobs that no study needs, with their results, and prints how many they were.
pub(crate) fn run(db: &Location) -> Result<u8, CliError> {
    let garbage = sweep::block_on(async {
        let mut queue = sweep::open_to_change(db.clone()).await?;
        let garbage = queue.collect_garbage().await?;
        queue.close().await?;
        Ok::<_, CliError>(garbage)
    })?;
    print(&format!(
        "dropped {} jobs, {} results and {} ended workers; the database is {:.1} MB smaller\n",
        garbage.jobs,
        garbage.results,
        garbage.workers,
        garbage.bytes as f64 / 1e6
    ))?;
    Ok(exit::SUCCESS)
}
