//! `tribosweep pareto`: error against run time.

use super::error::CliError;
use super::output::{block_on, print, tell};
use super::report::OutFolder;
use super::rows;
use crate::exit;
use crate::queue::Location;
use crate::report::pareto;

/// Arguments of `pareto`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Names or files of the studies; several are compared as one.
    #[arg(required = true)]
    studies: Vec<String>,
    #[command(flatten)]
    out: OutFolder,
}

/// Compares the finished jobs, prints the tables and writes the files.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let names = args.studies.iter().map(|study| rows::study_name(study)).collect::<Result<Vec<_>, _>>()?;
    let rows = block_on(async {
        let mut queue = rows::open(db).await?;
        let mut all = Vec::new();
        for name in &names {
            all.extend(rows::read(&mut queue, name).await?);
        }
        queue.close().await?;
        Ok(all)
    })?;
    let title = names.join(", ");
    let comparison = pareto::compare(&rows).map_err(|error| CliError::Plan(format!("{title}: {error}")))?;
    print(&pareto::markdown(&comparison))?;
    let folder = args.out.of(&names[0]);
    pareto::write(&comparison, &folder, &title)?;
    tell(format_args!("comparison written to {}", folder.display()));
    Ok(exit::SUCCESS)
}
