//! Load on the queue: many processes that claim and finish jobs. The jobs compute nothing; they take no time, or they
//! sleep.
//!
//! ```text
//! scripts/postgres.sh start /tmp/server
//! cargo bench --bench queue -- --db postgres://tribosweep@127.0.0.1:PORT/postgres
//! ```
//!
//! For each number of processes, it prints the jobs and claims per second, the time of a claim, and the load of the
//! server: the processor time of all processes named `postgres`, so no other server should run. Payloads and records
//! have the size of real ones. `docs/postgresql.md` discusses the results.

use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use clap::Parser;
use tribosweep::queue::{
    Claim, ClaimedJob, Clock, Finished, FinishedOutcome, Location, NewJob, NewStudy, Queue, Scope, Worker,
};

#[derive(Debug, Parser)]
struct Args {
    /// The database: a file, or postgres://USER@HOST/DATABASE. The studies are not deleted afterwards.
    #[arg(long)]
    db: String,
    /// The number of jobs in each round.
    #[arg(long, default_value_t = 100_000)]
    jobs: usize,
    /// The numbers of processes; one round for each.
    #[arg(long, value_delimiter = ',', default_value = "1,2,8,32")]
    workers: Vec<usize>,
    /// Jobs that a process claims at a time.
    #[arg(long, default_value_t = 16)]
    claim: usize,
    /// How long a job takes, in seconds. A process runs all its claimed jobs at the same time.
    #[arg(long, default_value_t = 0.0)]
    job_s: f64,
    /// Claim from all jobs instead of those of the study.
    #[arg(long)]
    any: bool,
    /// Run as one of the processes, for the study of that name.
    #[arg(long, hide = true)]
    work: Option<String>,
    /// `cargo bench` passes this.
    #[arg(long, hide = true)]
    bench: bool,
}

/// The lengths of a real payload and a real record, in bytes.
const PAYLOAD: usize = 1_000;
const RECORD: usize = 1_500;

fn main() {
    let args = Args::parse();
    if args.work.is_some() {
        return block_on(work(&args));
    }
    println!("workers  jobs/s  claims/s  claim ms: median   95 %   99 %    max  server cores  server ms/job");
    let begun = std::process::id();
    for (number, &workers) in args.workers.iter().enumerate() {
        round(&args, workers, &format!("load {number} of {workers} by {begun}"));
    }
}

fn block_on<F: Future>(future: F) -> F::Output {
    tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap().block_on(future)
}

async fn open(args: &Args) -> Queue {
    let location = Location::parse(args.db.clone().into());
    Queue::open(location, Clock::OfDatabase).await.unwrap()
}

/// Measures one number of processes.
fn round(args: &Args, workers: usize, study: &str) {
    block_on(async {
        let jobs = (0..args.jobs).map(|index| NewJob {
            key: format!("{study}: {index}"),
            payload: "p".repeat(PAYLOAD),
            parameters: format!("[{index}]"),
            // Costs scattered over the study are the worst case.
            cost: (index * 7919 % 97) as f64,
            batch: String::new(),
            priority: None,
            parent: None,
        });
        let study =
            NewStudy { name: study.to_owned(), document: String::new(), jobs: jobs.collect(), grows: false };
        open(args).await.submit(&study).await.unwrap();
    });
    let (begun, cpu_s) = (Instant::now(), server_cpu_s());
    let processes: Vec<_> = (0..workers)
        .map(|_| {
            let mut process = Command::new(std::env::current_exe().unwrap());
            process.args(["--db", &args.db, "--work", study]);
            process.args(["--claim", &args.claim.to_string(), "--job-s", &args.job_s.to_string()]);
            if args.any {
                process.arg("--any");
            }
            process.stdout(Stdio::piped()).spawn().unwrap()
        })
        .collect();
    let mut claims_ms = Vec::new();
    let mut jobs = 0;
    for process in processes {
        let output = process.wait_with_output().unwrap();
        assert!(output.status.success());
        let (done, latencies): (usize, Vec<f64>) = serde_json::from_slice(&output.stdout).unwrap();
        jobs += done;
        claims_ms.extend(latencies);
    }
    let took_s = begun.elapsed().as_secs_f64();
    let busy_s = server_cpu_s() - cpu_s;
    assert_eq!(jobs, args.jobs, "every job is done once");
    claims_ms.sort_by(f64::total_cmp);
    let quantile = |part: f64| claims_ms[((claims_ms.len() - 1) as f64 * part) as usize];
    println!(
        "{workers:7}  {:6.0}  {:8.0}  {:16.2} {:6.2} {:6.2} {:6.1}  {:12.2}  {:13.3}",
        jobs as f64 / took_s,
        claims_ms.len() as f64 / took_s,
        quantile(0.5),
        quantile(0.95),
        quantile(0.99),
        quantile(1.0),
        busy_s / took_s,
        1e3 * busy_s / jobs as f64,
    );
}

/// Claims and finishes jobs until none is left. Prints their number and the time of each exchange.
async fn work(args: &Args) {
    let study = args.work.clone().unwrap();
    let mut queue = open(args).await;
    queue.register(&Worker::this_process(1, "load", "")).await.unwrap();
    let scope = if args.any { Scope::All } else { Scope::Study(study) };
    let claim = [Claim { scope, limit: args.claim, batch: None }];
    let (mut finished, mut done, mut claims_ms) = (Vec::new(), 0, Vec::new());
    loop {
        let begun = Instant::now();
        let exchanged = queue.exchange(&finished, &claim).await.unwrap();
        claims_ms.push(begun.elapsed().as_secs_f64() * 1e3);
        assert!(exchanged.refused.is_empty(), "{:?}", exchanged.refused);
        done += finished.len();
        let jobs = exchanged.claimed.into_iter().flatten();
        finished = jobs.map(|job| finish(job, args.job_s)).collect();
        if finished.is_empty() {
            break;
        }
        if args.job_s > 0.0 {
            tokio::time::sleep(Duration::from_secs_f64(args.job_s)).await;
        }
    }
    queue.unregister().await.unwrap();
    queue.close().await.unwrap();
    let report = serde_json::to_vec(&(done, claims_ms)).unwrap();
    std::io::stdout().write_all(&report).unwrap();
}

fn finish(job: ClaimedJob, wall_s: f64) -> Finished {
    let outcome =
        FinishedOutcome::Done { record: "r".repeat(RECORD), label: "periodic".to_owned(), final_state: None };
    Finished { key: job.key, attempt: job.attempt, outcome, wall_s }
}

/// The processor time of all processes of the server so far, including ended ones, in seconds.
fn server_cpu_s() -> f64 {
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let ticks: u64 = processes
        .filter_map(|process| std::fs::read_to_string(process.path().join("stat")).ok())
        .filter(|stat| stat.contains("(postgres)"))
        .filter_map(|stat| {
            // Fields 14 to 17: user and system time of the process, and of its children that have ended.
            let fields = stat.rsplit_once(')')?.1.to_owned();
            Some(
                fields
                    .split_ascii_whitespace()
                    .skip(11)
                    .take(4)
                    .filter_map(|it| it.parse::<u64>().ok())
                    .sum::<u64>(),
            )
        })
        .sum();
    // The kernel reports a hundred ticks per second to programs, whatever its internal rate is.
    ticks as f64 / 100.0
}
