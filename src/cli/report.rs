//! `tribosweep report`: a study's tables and figures.

use super::error::CliError;
use super::output::{block_on, print, tell};
use super::rows;
use crate::exit;
use crate::report::{self, Row};
use std::path::{Path, PathBuf};

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
    #[command(flatten)]
    out: OutFolder,
}

/// Where a report goes.
#[derive(Debug, clap::Args)]
pub struct OutFolder {
    /// Folder for the report; default: reports/STUDY.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

impl OutFolder {
    /// The folder for the study called `name`.
    pub fn of(&self, name: &str) -> PathBuf {
        self.folder.clone().unwrap_or_else(|| Path::new("reports").join(name))
    }
}

/// Writes the report and prints the path of its page.
pub fn run(args: &Args, db: &Path) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    block_on(async {
        let mut queue = rows::open(db).await?;
        let rows = rows::read(&mut queue, &name).await?;
        queue.close().await?;
        write(&rows, &name, &args.out)?;
        print(&format!("{}\n", args.out.of(&name).join("report.md").display()))?;
        Ok(exit::SUCCESS)
    })
}

/// Writes the report of a study's rows.
pub fn write(rows: &[Row], name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    report::write(rows, &folder, name)?;
    tell(format_args!("report written to {}", folder.display()));
    Ok(())
}

/// Creates the folder of a report, so that one that cannot be written is noticed before the work.
pub fn prepare(name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    std::fs::create_dir_all(&folder)
        .map_err(|source| CliError::File { path: folder.display().to_string(), source })
}
