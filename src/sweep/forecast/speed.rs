//! How fast this machine advances jobs: measured in a few hundred milliseconds, and kept in the user's cache folder.

use crate::analysis::batch::Batch;
use crate::analysis::{JobError, Workload};
use crate::publish::write_atomically;
use crate::spec::{DiskKind, JobSpec, StabilityMethod};
use crate::worker;
use etcetera::BaseStrategy;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Barrier;
use std::time::{Duration, Instant, SystemTime};

/// What is measured: jobs of different kinds take different times per node and step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Rigid disk, fields that fit into the caches.
    Rigid,
    /// Rigid disk, fields that do not fit into the caches.
    Large,
    /// Elastic disk.
    Elastic,
}

/// The time per node and step of a thread, while all threads are busy, as a range: the more other processes disturb the
/// measurement, the wider it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Speed {
    /// Of the fastest tenth of the measurement \[ns\].
    pub fast_ns: f64,
    /// Slower than the mean \[ns\] by half as much, in orders of magnitude, as the mean is slower than the fastest tenth.
    pub slow_ns: f64,
}

/// Meshes with more nodes do not fit into the caches of ordinary processors.
const LARGE_NODES: usize = 100_000;

/// How long a kind is measured, besides the time to build its model.
const MEASURED: Duration = Duration::from_millis(250);

/// The least number of samples of a measurement.
const LEAST_SAMPLES: usize = 3;

/// A measurement is used for so long: the load of the machine changes.
const VALID: Duration = Duration::from_hours(24);

impl Kind {
    /// The kind of a workload.
    pub fn of(workload: &Workload) -> Self {
        match workload {
            Workload { disk_nodes: 1.., .. } => Self::Elastic,
            Workload { pin_nodes, .. } if *pin_nodes > LARGE_NODES => Self::Large,
            _ => Self::Rigid,
        }
    }

    /// A job of the kind that runs longer than the measurement, and how many of them a thread advances together.
    fn scene(self) -> (JobSpec, usize) {
        let mut spec = JobSpec::default();
        spec.run.stop_early = false;
        spec.run.limit_s = 0.3;
        let jobs = match self {
            Self::Rigid => 8,
            Self::Large => {
                spec.scene.pin.elements = [48, 60, 40];
                1
            }
            Self::Elastic => {
                spec.scene.disk.kind = DiskKind::Elastic;
                spec.scene.disk.ring.element_size_m = 0.005;
                4
            }
        };
        (spec, jobs)
    }
}

impl Speed {
    /// What ordinary machines reach, without a measurement.
    pub const TYPICAL: Self = Self { fast_ns: 3.0, slow_ns: 12.0 };

    /// The speed in the middle of the range \[ns\].
    pub fn middle_ns(&self) -> f64 {
        (self.fast_ns * self.slow_ns).sqrt()
    }

    /// The speed of this machine with so many busy threads: from the cache, or measured now.
    pub fn here(kind: Kind, threads: usize) -> Self {
        Self::cached(kind, threads).unwrap_or_else(|| {
            let Ok(speed) = Self::measure(kind, threads) else { return Self::TYPICAL };
            Cache::add(Entry { kind, threads, speed, machine: worker::machine(), measured_s: now_s() });
            speed
        })
    }

    /// The speed from the cache, if it was measured lately.
    pub fn cached(kind: Kind, threads: usize) -> Option<Self> {
        let machine = worker::machine();
        let is_same = |entry: &&Entry| {
            entry.kind == kind && entry.threads == threads && entry.machine == machine && entry.is_valid()
        };
        Cache::read().entries.iter().find(is_same).map(|entry| entry.speed)
    }

    /// Advances jobs on all threads.
    fn measure(kind: Kind, threads: usize) -> Result<Self, JobError> {
        let (spec, jobs) = kind.scene();
        let barrier = Barrier::new(threads);
        let samples: Result<Vec<Vec<f64>>, JobError> = std::thread::scope(|scope| {
            let running: Vec<_> =
                (0..threads).map(|_| scope.spawn(|| samples(&spec, jobs, &barrier))).collect();
            let ended = running.into_iter().map(|thread| thread.join().unwrap_or_else(|_| Ok(Vec::new())));
            ended.collect()
        });
        let mut all = samples?.concat();
        all.sort_by(f64::total_cmp);
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        Ok(match all.get(all.len() / 10) {
            Some(&fast_ns) if fast_ns > 0.0 => {
                let mean = mean.max(fast_ns);
                Self { fast_ns, slow_ns: mean * (mean / fast_ns).sqrt() }
            }
            _ => Self::TYPICAL,
        })
    }
}

/// The times per node and step and job \[ns\] of one thread.
fn samples(spec: &JobSpec, jobs: usize, all: &Barrier) -> Result<Vec<f64>, JobError> {
    let batch = Batch::new(spec);
    // Every thread waits for the others, also if it has failed.
    all.wait();
    let mut batch = batch?;
    let workload = batch.workload();
    for ticket in 0..jobs {
        let mut spec = spec.clone();
        // Steps are measured.
        spec.stability = StabilityMethod::Simulate;
        spec.scene.disk.omega_rpm = 1.0 + 3.0 * ticket as f64;
        batch.begin(ticket as u64, spec)?;
    }
    // The first steps fetch the fields into the caches.
    batch.advance();
    let simulated = |batch: &Batch| batch.simulated().first().map_or(0.0, |(_, seconds)| *seconds);
    let mut samples = Vec::new();
    let begun = Instant::now();
    let mut before_s = simulated(&batch);
    while samples.len() < LEAST_SAMPLES || begun.elapsed() < MEASURED {
        let from = Instant::now();
        batch.advance();
        let after_s = simulated(&batch);
        let node_steps = workload.node_steps(after_s - before_s) * jobs as f64;
        samples.push(from.elapsed().as_secs_f64() * 1e9 / node_steps);
        before_s = after_s;
    }
    Ok(samples)
}

/// The measurements in the user's cache folder.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Cache {
    entries: Vec<Entry>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Entry {
    kind: Kind,
    threads: usize,
    machine: String,
    /// When it was measured, in seconds since 1970-01-01 UTC.
    measured_s: u64,
    #[serde(flatten)]
    speed: Speed,
}

impl Entry {
    fn is_valid(&self) -> bool {
        let age_s = now_s().saturating_sub(self.measured_s);
        let Speed { fast_ns, slow_ns } = self.speed;
        age_s < VALID.as_secs() && fast_ns > 0.0 && fast_ns <= slow_ns && slow_ns.is_finite()
    }
}

fn now_s() -> u64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

impl Cache {
    fn path() -> Option<PathBuf> {
        Some(etcetera::choose_base_strategy().ok()?.cache_dir().join("tribosweep").join("speed.json"))
    }

    /// Nothing if there is no cache, or if it cannot be read.
    fn read() -> Self {
        let text = Self::path().and_then(|path| std::fs::read_to_string(path).ok());
        text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
    }

    /// Adds a measurement in place of outdated ones. A cache that cannot be written is no error: the next command measures
    /// again.
    fn add(entry: Entry) {
        let mut cache = Self::read();
        cache.entries.retain(|old| {
            old.is_valid()
                && (old.kind, old.threads, &old.machine) != (entry.kind, entry.threads, &entry.machine)
        });
        cache.entries.push(entry);
        let (Some(path), Ok(text)) = (Self::path(), serde_json::to_vec_pretty(&cache)) else { return };
        if let Some(folder) = path.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        let _ = write_atomically(&path, |out| out.write_all(&text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a measurement gives a finite range of positive times.
    #[test]
    fn a_measurement_gives_a_range() {
        let Speed { fast_ns, slow_ns } = Speed::measure(Kind::Rigid, 2).unwrap();
        assert!(fast_ns > 0.0 && fast_ns <= slow_ns && slow_ns.is_finite(), "{fast_ns} {slow_ns}");
    }

    /// Protects: an entry survives its file, and an old one or one that makes no sense is not used.
    #[test]
    fn entries_are_read_back_and_grow_old() {
        let entry = |measured_s, fast_ns| Entry {
            kind: Kind::Large,
            threads: 3,
            machine: "here".into(),
            measured_s,
            speed: Speed { fast_ns, slow_ns: 9.0 },
        };
        let text = serde_json::to_string(&entry(now_s(), 4.5)).unwrap();
        let read: Entry = serde_json::from_str(&text).unwrap();
        assert_eq!(
            (read.kind, read.threads, read.speed),
            (Kind::Large, 3, Speed { fast_ns: 4.5, slow_ns: 9.0 })
        );
        assert!(read.is_valid());
        assert!(!entry(now_s() - VALID.as_secs(), 4.5).is_valid());
        assert!(!entry(now_s(), 10.0).is_valid());
    }

    /// Protects: the jobs that are measured are accepted by the solver, and are of their kind.
    #[test]
    fn the_measured_jobs_are_of_their_kind() {
        for kind in [Kind::Rigid, Kind::Large, Kind::Elastic] {
            let (spec, jobs) = kind.scene();
            spec.check().unwrap();
            let workload = Workload::estimate(&spec).unwrap();
            assert_eq!(Kind::of(&workload), kind);
            assert!(jobs <= workload.widest());
        }
    }
}
