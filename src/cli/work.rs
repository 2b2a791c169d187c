//! `tribosweep work`: run the pending jobs of the database.

use super::display::Display;
use super::error::CliError;
use super::output::{block_on, tell};
use crate::exit;
use crate::queue::{Clock, Location, Queue, Scope, Settings, TakenBack};
use crate::worker::{self, Interrupt, WorkError, WorkOptions};
use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

/// Arguments of `work`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    checkpoints: Checkpoints,
    #[command(flatten)]
    retries: Retries,
    /// Stay when nothing is left to do, and end when no job has come for so long (60s, 5m, 2h), whatever others run,
    /// unless signs of life of one of them are missing; a server that does not answer is waited for from the start.
    /// Without it, end when all jobs have ended, those of other workers, too.
    #[arg(long = "idle-exit", value_name = "DURATION", value_parser = parse_duration)]
    idle_exit: Option<Duration>,
    /// How long this worker's jobs stay its own without a sign of life, where others cannot see its process (on other
    /// machines); it gives one eight times as often.
    #[arg(long, value_name = "DURATION", default_value = "2m", value_parser = parse_lease)]
    lease: Duration,
}

fn parse_lease(text: &str) -> Result<Duration, String> {
    let lease = parse_duration(text)?;
    if (Settings::SHORTEST_LEASE..=LONGEST_LEASE).contains(&lease) {
        return Ok(lease);
    }
    let [shortest, longest] = [Settings::SHORTEST_LEASE, LONGEST_LEASE].map(humantime::format_duration);
    Err(format!("a lease is between {shortest} and {longest}"))
}

/// Nobody waits longer for what was lost.
const LONGEST_LEASE: Duration = Duration::from_hours(24);

fn parse_duration(text: &str) -> Result<Duration, String> {
    humantime::parse_duration(text)
        .map_err(|error| format!("{error}; expected a duration such as 60s, 5m or 2h"))
}

/// The number of worker threads.
#[derive(Debug, clap::Args)]
pub struct Threads {
    /// Number of threads, each of which advances up to eight jobs together; default: the number of cores.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// How often the states of long jobs are kept.
#[derive(Debug, clap::Args)]
pub struct Checkpoints {
    /// Keep the state of every running job at this interval, so that after an interruption it goes on from there;
    /// jobs shorter than two intervals are not kept, 0 keeps none.
    #[arg(long = "checkpoint-every", value_name = "SECONDS", value_parser = parse_seconds,
          default_value_t = WorkOptions::CHECKPOINT_INTERVAL.as_secs_f64())]
    seconds: f64,
}

/// The shortest interval of checkpoints: making one takes some milliseconds.
const SHORTEST: Duration = Duration::from_millis(1);

fn parse_seconds(text: &str) -> Result<f64, String> {
    let is_interval = |seconds: f64| Duration::try_from_secs_f64(seconds).is_ok_and(|it| it >= SHORTEST);
    let seconds = text.parse().ok().filter(|&seconds| seconds == 0.0 || is_interval(seconds));
    seconds.ok_or_else(|| format!("expected a number of seconds, at least {}, or 0", SHORTEST.as_secs_f64()))
}

/// The number of threads unless another one is given.
pub fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Number of threads and checkpoints.
pub fn options(threads: &Threads, checkpoints: &Checkpoints) -> WorkOptions {
    WorkOptions {
        threads: threads.threads.map_or_else(all_cores, usize::from),
        checkpoint_interval: Some(Duration::from_secs_f64(checkpoints.seconds))
            .filter(|interval| !interval.is_zero()),
        idle_exit: None,
    }
}

/// How often a job is tried whose process died.
#[derive(Debug, clap::Args)]
pub struct Retries {
    /// A job whose process died so many times in a row has failed.
    #[arg(long = "max-crashes", value_name = "N", default_value_t = Settings::default().crash_limit,
          value_parser = clap::value_parser!(u32).range(1..))]
    max_crashes: u32,
}

impl Retries {
    /// What that is for the queue.
    pub fn settings(&self) -> Settings {
        Settings { crash_limit: self.max_crashes, ..Settings::default() }
    }
}

/// Works through all pending jobs, and stays for more if that is wanted.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    block_on(async {
        let settings = args.retries.settings().with_lease(args.lease);
        let options = WorkOptions { idle_exit: args.idle_exit, ..options(&args.threads, &args.checkpoints) };
        interruptible(async |interrupt| {
            let mut queue = if options.idle_exit.is_none() {
                Queue::open_existing(db.clone(), Clock::OfDatabase, settings).await?
            } else if let Some(queue) = worker::open(db, settings, interrupt, &mut Display::new()).await? {
                queue
            } else {
                return Ok(exit::WORK_LEFT);
            };
            let code = work_until(interrupt, &mut queue, &Scope::All, options).await?;
            queue.close().await?;
            Ok(code)
        })
        .await
    })
}

/// Works through the pending jobs of `scope` until they are done or Ctrl-C, and says what is to be said of it; returns the
/// exit code.
pub async fn work(queue: &mut Queue, scope: &Scope, options: WorkOptions) -> Result<u8, CliError> {
    interruptible(async |interrupt| work_until(interrupt, queue, scope, options).await).await
}

async fn interruptible(work: impl AsyncFnOnce(&Interrupt) -> Result<u8, CliError>) -> Result<u8, CliError> {
    let interrupt = Interrupt::default();
    let listener = tokio::spawn(listen(interrupt.clone(), "stopping; running jobs go back to the queue"));
    let worked = work(&interrupt).await;
    listener.abort();
    worked
}

async fn work_until(
    interrupt: &Interrupt,
    queue: &mut Queue,
    scope: &Scope,
    options: WorkOptions,
) -> Result<u8, CliError> {
    let summary = match worker::work(queue, scope, options, interrupt, &mut Display::new()).await {
        Err(WorkError::Queue(error)) if interrupt.is_raised() && error.is_transient() => {
            tell(error);
            return Ok(exit::WORK_LEFT);
        }
        worked => worked?,
    };
    let TakenBack { pending, failed } = summary.taken_back;
    if pending > 0 {
        tell(format_args!("{pending} jobs left running by an interrupted process were taken back"));
    }
    if failed > 0 {
        tell(format_args!("{failed} jobs have failed because their process died again and again"));
    }
    let counts = summary.counts;
    let is_cancelled = counts.cancelled > 0 && *scope != Scope::All;
    if is_cancelled {
        tell(format_args!("{} jobs were cancelled meanwhile", counts.cancelled));
    }
    if counts.running > 0 && !summary.interrupted && counts.pending == 0 {
        tell(format_args!("nothing is left to do here; other workers run {} jobs", counts.running));
    } else if counts.pending + counts.running > 0 || is_cancelled {
        tell("interrupted; the same command continues where it stopped");
        return Ok(exit::WORK_LEFT);
    }
    Ok(if counts.failed > 0 { exit::SOME_FAILED } else { exit::SUCCESS })
}

/// One stop may arrive as several signals, to the process and to its group.
const ONE_STOP: Duration = Duration::from_secs(1);

/// The first signal asks the worker to stop, another one a moment later ends the process at once.
pub async fn listen(interrupt: Interrupt, message: &str) {
    stop_signal().await;
    tell(format_args!("{message} (once more to stop at once)"));
    interrupt.raise();
    let asked = Instant::now();
    while asked.elapsed() < ONE_STOP {
        stop_signal().await;
    }
    std::process::exit(i32::from(exit::WORK_LEFT));
}

/// Waits for Ctrl-C or, on Unix, SIGTERM.
#[cfg(unix)]
async fn stop_signal() {
    use tokio::signal::unix::{SignalKind, signal};
    match signal(SignalKind::terminate()) {
        Ok(mut terminate) => {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = terminate.recv() => {}
            }
        }
        Err(_) => drop(tokio::signal::ctrl_c().await),
    }
}

/// Waits for Ctrl-C.
#[cfg(not(unix))]
async fn stop_signal() {
    drop(tokio::signal::ctrl_c().await);
}
