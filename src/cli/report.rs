//! `tribosweep report`: the page, tables and figures of a study, once or whenever the study changes.

use super::error::CliError;
use super::output::{log, print};
use super::signals::raise_on_signal;
use crate::exit;
use crate::queue::{Location, Queue};
use crate::report;
use crate::sweep::{self, Revision};
use crate::worker::Interrupt;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
    #[command(flatten)]
    out: OutFolder,
    /// Check every so many seconds whether the study has changed, and then write the report again, until no job is
    /// pending or running. Until then an open page reloads itself.
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, default_missing_value = "5",
          value_parser = clap::value_parser!(u32).range(1..=86_400))]
    watch: Option<u32>,
}

/// The folder of a report.
#[derive(Debug, clap::Args)]
pub(crate) struct OutFolder {
    /// Folder for the report; default: reports/STUDY.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

impl OutFolder {
    /// The folder for the study called `name`.
    pub(crate) fn of(&self, name: &str) -> PathBuf {
        self.folder.clone().unwrap_or_else(|| Path::new("reports").join(name))
    }
}

/// Writes the report and prints the path of its page.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    sweep::block_on(async {
        let mut queue = sweep::open_to_read(db.clone()).await?;
        if let Some(interval_s) = args.watch {
            watch(&mut queue, &name, &args.out, interval_s).await?;
        } else {
            read_and_write(&mut queue, &name, &args.out, None).await?;
            print_page(&name, &args.out)?;
        }
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

fn print_page(name: &str, out: &OutFolder) -> Result<(), CliError> {
    print(&format!("{}\n", out.of(name).join("report.html").display()))
}

async fn read_and_write(
    queue: &mut Queue,
    name: &str,
    out: &OutFolder,
    refresh_s: Option<u32>,
) -> Result<(), CliError> {
    let rows = sweep::read_rows(queue, name).await?;
    write(queue, &rows, name, out, refresh_s).await
}

/// Writes the report of a study's rows and logs where it is.
pub(crate) async fn write(
    queue: &mut Queue,
    rows: &[report::JobRow],
    name: &str,
    out: &OutFolder,
    refresh_s: Option<u32>,
) -> Result<(), CliError> {
    let folder = out.of(name);
    sweep::write_refreshing_report(queue, name, rows, &folder, refresh_s).await?;
    log(format_args!("report written to {}", folder.display()));
    Ok(())
}

/// The longest time between a signal and the reaction to it.
const TICK: Duration = Duration::from_millis(100);

/// Writes the report whenever the study has changed, until the study is finished or a signal asks to stop.
async fn watch(queue: &mut Queue, name: &str, out: &OutFolder, interval_s: u32) -> Result<(), CliError> {
    let interrupt = Interrupt::default();
    let listener =
        tokio::spawn(raise_on_signal(interrupt.clone(), "the report will not be updated any more"));
    let mut last: Option<Revision> = None;
    loop {
        // The revision is read before the rows: a change in between leads to another report.
        let revision = Revision::read(queue, name).await?;
        let is_last = revision.is_finished() || interrupt.is_raised();
        if is_last || last.as_ref() != Some(&revision) {
            read_and_write(queue, name, out, Some(interval_s).filter(|_| !is_last)).await?;
        }
        if last.is_none() {
            print_page(name, out)?;
        }
        if is_last {
            break;
        }
        last = Some(revision);
        // Only this wait ends early: a future of the queue must not be dropped before it is complete.
        let mut left = Duration::from_secs(interval_s.into());
        while !left.is_zero() && !interrupt.is_raised() {
            tokio::time::sleep(left.min(TICK)).await;
            left = left.saturating_sub(TICK);
        }
    }
    listener.abort();
    Ok(())
}

/// Creates the folder of a report, so that an error is noticed before the work.
pub(crate) fn create_folder(name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    std::fs::create_dir_all(&folder).map_err(|source| CliError::file(&folder, source))
}
