//! `tribosweep gc`: drop what no study refers to.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::exit;
use crate::queue::Location;

/// Drops jobs that no study refers to, with their results, and says how many.
pub fn run(db: &Location) -> Result<u8, CliError> {
    let garbage = block_on(async {
        let mut queue = rows::open_to_change(db).await?;
        let garbage = queue.collect_garbage().await?;
        queue.close().await?;
        Ok(garbage)
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
