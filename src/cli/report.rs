//! `tribosweep report`: a study's page, tables and figures, once or again and again.

use super::error::CliError;
use super::output::{block_on, print, tell};
use super::work::listen;
use super::{origin, rows};
use crate::exit;
use crate::queue::{Counts, Location, Queue, Scope};
use crate::report::{self, Report};
use crate::worker::Interrupt;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
    #[command(flatten)]
    out: OutFolder,
    /// Look every so many seconds whether the study has changed, and write the report anew, until nothing is pending or
    /// running; until then the page loads itself anew.
    #[arg(long, value_name = "SECONDS", num_args = 0..=1, default_missing_value = "5",
          value_parser = clap::value_parser!(u32).range(1..=86_400))]
    watch: Option<u32>,
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
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    block_on(async {
        let mut queue = rows::open(db).await?;
        if let Some(interval_s) = args.watch {
            watch(&mut queue, &name, &args.out, interval_s).await?;
        } else {
            write(&mut queue, &name, &args.out, None).await?;
            print_page(&name, &args.out)?;
        }
        queue.close().await?;
        Ok(exit::SUCCESS)
    })
}

fn print_page(name: &str, out: &OutFolder) -> Result<(), CliError> {
    print(&format!("{}\n", out.of(name).join("report.html").display()))
}

/// Reads a study and writes its report.
async fn write(
    queue: &mut Queue,
    name: &str,
    out: &OutFolder,
    refresh_s: Option<u32>,
) -> Result<(), CliError> {
    let rows = rows::read(queue, name).await?;
    write_rows(queue, &rows, name, out, refresh_s).await
}

/// Writes the report of a study's rows.
pub async fn write_rows(
    queue: &mut Queue,
    rows: &[report::JobRow],
    name: &str,
    out: &OutFolder,
    refresh_s: Option<u32>,
) -> Result<(), CliError> {
    let origin = origin::read(queue, name).await?;
    let folder = out.of(name);
    let written_ms = queue.now_ms().await?;
    let report = Report { title: name, rows, provenance: origin.as_ref(), written_ms, refresh_s };
    report::write(&report, &folder)?;
    tell(format_args!("report written to {}", folder.display()));
    Ok(())
}

/// What is looked at to see whether a study has changed: reading its rows takes far longer.
#[derive(PartialEq)]
struct Seen {
    counts: Counts,
    starts: u64,
    submitted_ms: Option<i64>,
}

impl Seen {
    async fn now(queue: &mut Queue, name: &str) -> Result<Self, CliError> {
        Ok(Self {
            counts: queue.counts(&Scope::Study(name.to_owned())).await?,
            starts: queue.starts(name).await?,
            submitted_ms: queue.study(name).await?.map(|study| study.submitted_ms),
        })
    }

    fn is_over(&self) -> bool {
        self.counts.pending + self.counts.running == 0
    }
}

/// How long an interruption may go unnoticed.
const TICK: Duration = Duration::from_millis(100);

/// Writes the report whenever the study has changed, until it is finished or Ctrl-C.
async fn watch(queue: &mut Queue, name: &str, out: &OutFolder, interval_s: u32) -> Result<(), CliError> {
    let interrupt = Interrupt::default();
    let listener = tokio::spawn(listen(interrupt.clone(), "the report is not going to be written any more"));
    let mut last: Option<Seen> = None;
    loop {
        // Before the rows: what changes while they are read is seen the next time.
        let seen = Seen::now(queue, name).await?;
        let is_last = seen.is_over() || interrupt.is_raised();
        if is_last || last.as_ref() != Some(&seen) {
            write(queue, name, out, Some(interval_s).filter(|_| !is_last)).await?;
        }
        if last.is_none() {
            print_page(name, out)?;
        }
        if is_last {
            break;
        }
        last = Some(seen);
        // No future of the queue is dropped half-way: nothing but this wait ends early.
        let mut left = Duration::from_secs(interval_s.into());
        while !left.is_zero() && !interrupt.is_raised() {
            tokio::time::sleep(left.min(TICK)).await;
            left = left.saturating_sub(TICK);
        }
    }
    listener.abort();
    Ok(())
}

/// Creates the folder of a report, so that one that cannot be written is noticed before the work.
pub fn prepare(name: &str, out: &OutFolder) -> Result<(), CliError> {
    let folder = out.of(name);
    std::fs::create_dir_all(&folder)
        .map_err(|source| CliError::File { path: folder.display().to_string(), source })
}
