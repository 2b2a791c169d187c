//! `tribosweep work`: run the pending jobs of a database.

use super::display::Display;
use super::error::CliError;
use super::forecast;
use super::output::log;
use super::signals::raise_on_signal;
use crate::exit;
use crate::publish::value::count;
use crate::queue::{Clock, Location, Queue, Scope, Settings, TakenBack};
use crate::sweep::{self, Forecast, Plan};
use crate::worker::{self, Interrupt, WorkError, WorkOptions};
use std::sync::Once;
use std::time::Duration;

/// Arguments of `work`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    checkpoints: Checkpoints,
    #[command(flatten)]
    retries: Retries,
    /// Exit when no job has come for this long (60s, 5m, 2h), even if other workers are still running jobs, unless one of
    /// them has missed a heartbeat. At the start, wait for a server that does not answer. Default: exit when all jobs have
    /// ended, including those of other workers.
    #[arg(long = "idle-exit", value_name = "DURATION", value_parser = parse_duration)]
    idle_exit: Option<Duration>,
    /// How long other machines wait for a heartbeat of this worker before they take its jobs back. The worker sends eight
    /// heartbeats in this time.
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

/// The jobs of a lost worker are taken back within this time.
const LONGEST_LEASE: Duration = Duration::from_hours(24);

fn parse_duration(text: &str) -> Result<Duration, String> {
    humantime::parse_duration(text)
        .map_err(|error| format!("{error}; expected a duration such as 60s, 5m or 2h"))
}

/// More threads per core are taken for a mistake.
const MOST_PER_CORE: usize = 8;

/// The number of worker threads.
#[derive(Debug, clap::Args)]
pub(crate) struct Threads {
    /// Number of threads, each of which advances up to eight jobs together; default: the number of cores.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl Threads {
    /// Their number.
    pub(crate) fn number(&self) -> usize {
        static SAID: Once = Once::new();
        let cores = sweep::available_threads();
        let number = self.threads.map_or(cores, usize::from);
        if number > MOST_PER_CORE * cores {
            SAID.call_once(|| {
                log(format_args!(
                    "warning: --threads {number}: this machine has {}; more threads make nothing faster and take more memory",
                    count(cores as u64, "core")
                ));
            });
        }
        number
    }
}

/// How often the states of long jobs are stored.
#[derive(Debug, clap::Args)]
pub(crate) struct Checkpoints {
    /// Store the state of every running job at this interval, so that after an interruption the job continues from there.
    /// The state of a job that takes less than two intervals is not stored; 0 stores none.
    #[arg(long = "checkpoint-every", value_name = "SECONDS", value_parser = parse_seconds,
          default_value_t = WorkOptions::CHECKPOINT_INTERVAL.as_secs_f64())]
    seconds: f64,
}

/// The shortest interval of checkpoints: writing one takes some milliseconds.
const SHORTEST_INTERVAL: Duration = Duration::from_millis(1);

fn parse_seconds(text: &str) -> Result<f64, String> {
    let is_interval =
        |seconds: f64| Duration::try_from_secs_f64(seconds).is_ok_and(|it| it >= SHORTEST_INTERVAL);
    let seconds = text.parse().ok().filter(|&seconds| seconds == 0.0 || is_interval(seconds));
    seconds.ok_or_else(|| {
        format!("expected a number of seconds, at least {}, or 0", SHORTEST_INTERVAL.as_secs_f64())
    })
}

impl Checkpoints {
    fn interval(&self) -> Option<Duration> {
        Some(Duration::from_secs_f64(self.seconds)).filter(|interval| !interval.is_zero())
    }
}

/// The options of a worker without an idle exit; it stores no states of jobs without `checkpoints`.
pub(crate) fn options(threads: &Threads, checkpoints: Option<&Checkpoints>) -> WorkOptions {
    WorkOptions {
        checkpoint_interval: checkpoints.and_then(Checkpoints::interval),
        job_key: Some(sweep::job_key),
        planner: Some(sweep::PLANNER),
        ..WorkOptions::new(threads.number())
    }
}

/// How often a job is tried again after its process died.
#[derive(Debug, clap::Args)]
pub(crate) struct Retries {
    /// A job has failed when its process has died this many times in a row.
    #[arg(long = "max-crashes", value_name = "N", default_value_t = Settings::default().crash_limit,
          value_parser = clap::value_parser!(u32).range(1..))]
    max_crashes: u32,
}

impl Retries {
    /// The settings of the queue.
    pub(crate) fn settings(&self) -> Settings {
        Settings { crash_limit: self.max_crashes, ..Settings::default() }
    }
}

/// Runs all pending jobs, and waits for more with an idle exit.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    sweep::block_on(async {
        let settings = args.retries.settings().with_lease(args.lease);
        let options = options(&args.threads, Some(&args.checkpoints));
        interruptible(async |interrupt| {
            let queue = if args.idle_exit.is_none() {
                Queue::open_existing(db.clone(), Clock::OfDatabase, settings).await?
            } else if let Some(queue) = worker::open(db, settings, interrupt, &mut Display::new()).await? {
                queue
            } else {
                return Ok(exit::WORK_LEFT);
            };
            sweep::with_open(queue, async |queue| {
                let expected_s_per_cost = sweep::expected_s_per_cost(queue).await?;
                let options = WorkOptions { idle_exit: args.idle_exit, expected_s_per_cost, ..options };
                work_and_log(interrupt, queue, &Scope::All, options).await
            })
            .await
        })
        .await
    })
}

/// Runs the jobs of a plan that was submitted until they have ended or a signal asks to stop, says before how long it takes, logs what
/// happened, and returns the exit code.
pub(crate) async fn work_on(
    plan: &Plan,
    mut options: WorkOptions,
    queue: &mut Queue,
) -> Result<u8, CliError> {
    let forecast = Forecast::new(plan, Some(&mut *queue), options.threads).await?;
    forecast::announce(&forecast);
    if let Some(time) = forecast.time {
        options.expected_s_per_cost = time.per_cost_s;
    }
    let scope = Scope::Study(plan.name().to_owned());
    interruptible(async |interrupt| work_and_log(interrupt, queue, &scope, options).await).await
}

/// Runs `work` with an interrupt that a signal raises.
async fn interruptible(work: impl AsyncFnOnce(&Interrupt) -> Result<u8, CliError>) -> Result<u8, CliError> {
    let interrupt = Interrupt::default();
    let listener =
        tokio::spawn(raise_on_signal(interrupt.clone(), "stopping; running jobs go back to the queue"));
    let worked = work(&interrupt).await;
    listener.abort();
    worked
}

/// Says how many jobs of processes that died have become pending or have failed, if there were any.
pub(crate) fn log_taken_back(TakenBack { pending, failed }: TakenBack) {
    if pending > 0 {
        let (jobs, were) = (count(pending, "job"), if pending == 1 { "was" } else { "were" });
        log(format_args!("{jobs} left running by an interrupted process {were} taken back"));
    }
    if failed > 0 {
        let (jobs, has) = (count(failed, "job"), if failed == 1 { "has" } else { "have" });
        log(format_args!("{jobs} {has} failed because the process died several times in a row"));
    }
}

async fn work_and_log(
    interrupt: &Interrupt,
    queue: &mut Queue,
    scope: &Scope,
    options: WorkOptions,
) -> Result<u8, CliError> {
    let summary = match worker::work(queue, scope, options, interrupt, &mut Display::new()).await {
        Err(WorkError::Queue(error)) if interrupt.is_raised() && error.is_transient() => {
            log(error);
            return Ok(exit::WORK_LEFT);
        }
        worked => worked?,
    };
    log_taken_back(summary.taken_back);
    let may_grow = queue.open_jobs(scope).await.is_ok_and(|open| open.has_plans);
    let counts = summary.counts;
    let is_cancelled = counts.cancelled > 0 && *scope != Scope::All;
    if is_cancelled {
        let were = if counts.cancelled == 1 { "was" } else { "were" };
        log(format_args!("{} {were} cancelled in the meantime", count(counts.cancelled, "job")));
    }
    let stopped = if counts.running > 0 { queue.stopped_workers().await? } else { Vec::new() };
    for advice in &stopped {
        log(advice);
    }
    if !stopped.is_empty() && !summary.interrupted {
        log("jobs are left that nobody runs; do what is said above, and run the same command again");
        return Ok(exit::WORK_LEFT);
    }
    if counts.running > 0 && !summary.interrupted && counts.pending == 0 {
        log(format_args!(
            "no job is left for this worker; other workers are running {}",
            count(counts.running, "job")
        ));
    } else if counts.pending > 0 && !summary.interrupted && !is_cancelled {
        log(format_args!(
            "{} pending, but the database gave this worker no more. If they were submitted a moment ago, run the same command again. \
             Otherwise an index of the database is damaged: `tribosweep doctor --deep` says which",
            if counts.pending == 1 { "1 job is".to_owned() } else { format!("{} jobs are", counts.pending) }
        ));
        return Ok(exit::WORK_LEFT);
    } else if counts.pending + counts.running > 0 || is_cancelled || may_grow && summary.interrupted {
        log("interrupted; run the same command again to continue");
        return Ok(exit::WORK_LEFT);
    }
    Ok(if counts.failed > 0 { exit::SOME_FAILED } else { exit::SUCCESS })
}
