//! The time that jobs take, as a range.
//!
//! Two things are uncertain: how fast this machine is, and when the jobs end. Both are ranges of factors, and as independent
//! causes their widths add up like the sides of a right triangle.

use super::speed::{Kind, Speed};
use crate::analysis::{Ending, Workload};
use std::collections::BTreeMap;
use std::time::Duration;

/// A range for the time of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeRange {
    /// If jobs end early and the machine is fast.
    pub low: Duration,
    /// If jobs end late and the machine is slow.
    pub high: Duration,
    /// If every job runs to its limit and the machine is slow.
    pub limit: Duration,
    /// The longest job, alone, if it runs to its limit.
    pub longest_job: Duration,
    /// The range of seconds of a thread per unit of a job's cost, from which workers predict their remaining time.
    pub per_cost_s: [f64; 2],
}

/// Jobs that are left, added up.
#[derive(Debug, Default)]
pub struct Tasks {
    jobs: usize,
    by_kind: BTreeMap<Kind, Sum>,
}

/// Costs in node-steps.
#[derive(Debug, Default)]
struct Sum {
    early: f64,
    likely: f64,
    late: f64,
    limit: f64,
    /// The most expensive job: likely, and at its limit.
    longest: [f64; 2],
}

/// Times per node and step over those of the scene that is measured: other meshes, numbers of lanes and contact states.
const OTHER_SCENES: [f64; 2] = [0.8, 1.4];

/// Time \[s\] that a sweep takes besides its jobs: to open and close the database, and to write the report.
const BESIDES_S: [f64; 2] = [0.02, 0.3];

/// Time \[s\] of a job in the database and in the report.
const ROW_S: [f64; 2] = [0.0, 0.003];

impl Tasks {
    /// Adds a job.
    pub fn add(&mut self, workload: &Workload, ending: Ending) {
        let sum = self.by_kind.entry(Kind::of(workload)).or_default();
        let [early, likely, late, limit] =
            [ending.early_s, ending.likely_s, ending.late_s, ending.limit_s].map(|s| workload.node_steps(s));
        self.jobs += 1;
        sum.early += early;
        sum.likely += likely;
        sum.late += late;
        sum.limit += limit;
        sum.longest = [sum.longest[0].max(likely), sum.longest[1].max(limit)];
    }

    /// Whether all jobs together are likely to take less than so many seconds on a slow machine.
    pub fn is_shorter_than(&self, seconds: f64, threads: usize) -> bool {
        let likely: f64 = self.by_kind.values().map(|sum| sum.likely).sum();
        likely * Speed::TYPICAL.slow_ns * 1e-9 / (threads as f64) < seconds
    }

    /// The time on so many threads; `None` without jobs.
    pub fn time(&self, threads: usize, speed: impl Fn(Kind) -> Speed) -> Option<TimeRange> {
        if self.jobs == 0 {
            return None;
        }
        // A single job may end long before or after the mean; the means of many jobs scatter less.
        let scatter = 1.0 / (self.jobs as f64).sqrt();
        let busy = threads.min(self.jobs) as f64;
        let (mut seconds, mut cost, mut longest_s) = ([0.0; 4], 0.0, [0.0_f64; 2]);
        for (&kind, sum) in &self.by_kind {
            let speed = speed(kind);
            let middle = speed.middle_ns() * 1e-9;
            let fastest = OTHER_SCENES[0] * speed.fast_ns * 1e-9 / middle;
            let slowest = OTHER_SCENES[1] * speed.slow_ns * 1e-9 / middle;
            let early = sum.early * (1.0 - 0.5 * scatter * (1.0 - sum.early / sum.limit));
            let late = sum.late + (sum.limit - sum.late) * scatter;
            let low = sum.likely * combined(early / sum.likely, fastest);
            let high = sum.likely * combined(late / sum.likely, slowest);
            for (total, part) in seconds.iter_mut().zip([low, sum.likely, high, sum.limit * slowest]) {
                *total += part * middle;
            }
            cost += sum.likely;
            for (longest, here) in longest_s.iter_mut().zip(sum.longest) {
                *longest = longest.max(here * middle);
            }
        }
        let [low, _, high, limit] = seconds.map(|seconds| seconds / busy);
        // At the end threads are idle while the last jobs run.
        let tail = 1.0 - 1.0 / busy;
        let time = |work: f64, longest: f64, besides: f64, row: f64| {
            duration((work + tail * longest).max(longest) + besides + row * self.jobs as f64)
        };
        Some(TimeRange {
            low: time(low, 0.0, BESIDES_S[0], ROW_S[0]),
            high: time(high, longest_s[0], BESIDES_S[1], ROW_S[1]),
            limit: time(limit, longest_s[1], BESIDES_S[1], ROW_S[1]),
            longest_job: duration(longest_s[1]),
            per_cost_s: [seconds[0] / cost, seconds[2] / cost],
        })
    }
}

/// Means of a study's jobs, as [`Ending`] has them, over the likely mean.
const OTHER_ENDS: [f64; 2] = [0.55, 1.7];

/// The range of seconds of a thread per unit of cost, for workers that do not know the study.
pub fn per_cost_s(speed: Speed) -> [f64; 2] {
    let [low, high] = OTHER_ENDS;
    let middle = speed.middle_ns();
    [
        combined(low, OTHER_SCENES[0] * speed.fast_ns / middle),
        combined(high, OTHER_SCENES[1] * speed.slow_ns / middle),
    ]
    .map(|factor| factor * middle * 1e-9)
}

/// The factor of two independent factors, both below 1 or both above.
fn combined(one: f64, other: f64) -> f64 {
    let size = one.ln().hypot(other.ln());
    (if one.min(other) < 1.0 { -size } else { size }).exp()
}

/// At most a hundred years.
fn duration(seconds: f64) -> Duration {
    Duration::from_secs_f64(seconds.clamp(0.0, 3.2e9))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::JobSpec;

    const SPEED: Speed = Speed { fast_ns: 4.0, slow_ns: 6.0 };

    fn tasks(jobs: usize, change: fn(&mut JobSpec)) -> Tasks {
        let mut spec = JobSpec::default();
        change(&mut spec);
        let workload = Workload::estimate(&spec).unwrap();
        let mut tasks = Tasks::default();
        for _ in 0..jobs {
            tasks.add(&workload, Ending::of(&spec));
        }
        tasks
    }

    fn seconds(range: &TimeRange) -> [f64; 3] {
        [range.low, range.high, range.limit].map(|time| time.as_secs_f64())
    }

    /// Protects: the range contains the likely time, more jobs make it relatively narrower, and no job takes longer than its
    /// limit.
    #[test]
    fn the_range_contains_the_likely_time() {
        let width = |jobs: usize| {
            let tasks = tasks(jobs, |_| ());
            let range = tasks.time(1, |_| SPEED).unwrap();
            let [low, high, limit] = seconds(&range);
            let likely = tasks.by_kind[&Kind::Rigid].likely * SPEED.middle_ns() * 1e-9;
            assert!(low < likely && likely < high && high < limit, "{low} {likely} {high} {limit}");
            high / low
        };
        assert!(width(1) > 1.5 * width(100));
        assert_eq!(Tasks::default().time(2, |_| SPEED), None);
    }

    /// Protects: if every job runs to its limit, only the speed is uncertain.
    #[test]
    fn runs_of_known_length_depend_on_the_speed_alone() {
        let tasks = tasks(100, |spec| spec.run.stop_early = false);
        let [low, high, limit] = seconds(&tasks.time(1, |_| SPEED).unwrap());
        let expected = 1.4 * 6.0 / (0.8 * 4.0);
        assert!((high / low / expected - 1.0).abs() < 0.02, "{}", high / low);
        assert!((high / limit - 1.0).abs() < 1.0e-9, "{high} {limit}");
    }

    /// Protects: threads share many jobs, and a single job gains nothing from a second thread.
    #[test]
    fn threads_share_jobs() {
        let high = |jobs, threads| seconds(&tasks(jobs, |_| ()).time(threads, |_| SPEED).unwrap())[1];
        assert!(high(1000, 4) < 0.27 * high(1000, 1));
        assert_eq!(high(1, 4), high(1, 1));
    }
}
