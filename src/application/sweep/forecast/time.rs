//! The time that jobs take, as a range.
//!
//! Two things are uncertain: how fast this machine is, and when the jobs end. Both are ranges of factors, and as independent
//! causes their widths add up like the sides of a right triangle.

use super::speed::Speed;
use crate::analysis::{Ending, Workload};
use crate::units::as_seconds;
use serde::Serialize;
use std::time::Duration;

/// A range for the time of a study.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TimeRange {
    /// If jobs end early and the machine is fast.
    #[serde(serialize_with = "as_seconds")]
    pub low: Duration,
    /// If jobs end late and the machine is slow.
    #[serde(serialize_with = "as_seconds")]
    pub high: Duration,
    /// If every job runs to its limit and the machine is slow.
    #[serde(serialize_with = "as_seconds")]
    pub limit: Duration,
    /// The longest job, alone, if it runs to its limit.
    #[serde(skip)]
    pub longest_job: Duration,
    /// The range of seconds of a thread per unit of a job's cost, from which workers predict their remaining time.
    #[serde(skip)]
    pub per_cost_s: [f64; 2],
}

/// Jobs that are left, added up: costs in node-steps.
#[derive(Debug, Default)]
pub struct Tasks {
    jobs: usize,
    early: f64,
    likely: f64,
    late: f64,
    limit: f64,
    /// The most expensive job: likely, and at its limit.
    longest: [f64; 2],
}

/// Times per node and step over those of other jobs: other meshes, numbers of lanes and contact states.
const OTHER_SCENES: [f64; 2] = [0.8, 1.4];

/// Time \[s\] that a sweep takes besides its jobs: to open and close the database, and to write the report.
const BESIDES_S: [f64; 2] = [0.02, 0.3];

/// Time \[s\] of a job in the database and in the report.
const ROW_S: [f64; 2] = [0.0, 0.003];

impl Tasks {
    /// Adds a job. `earliest` is its workload on the coarsest mesh on which it may end.
    pub fn add(&mut self, workload: &Workload, earliest: &Workload, ending: Ending) {
        let early = earliest.node_steps(ending.early_s);
        let [likely, late, limit] =
            [ending.likely_s, ending.late_s, ending.limit_s].map(|s| workload.node_steps(s));
        self.jobs += 1;
        self.early += early;
        self.likely += likely;
        self.late += late;
        self.limit += limit;
        self.longest = [self.longest[0].max(likely), self.longest[1].max(limit)];
    }

    /// The time on so many threads; `None` without jobs.
    pub fn time(&self, threads: usize, speed: Speed) -> Option<TimeRange> {
        if self.jobs == 0 {
            return None;
        }
        // A single job may end long before or after the mean; the means of many jobs scatter less.
        let scatter = 1.0 / (self.jobs as f64).sqrt();
        let early = self.early * (1.0 - 0.5 * scatter * (1.0 - self.early / self.limit));
        let late = self.late + (self.limit - self.late) * scatter;
        let [fastest, slowest] = speed_factors(speed);
        let middle_s = speed.middle_ns() * 1e-9;
        let [low, high] = [(early, fastest), (late, slowest)]
            .map(|(end, speed)| middle_s * combined(end / self.likely, speed) * self.likely);
        let longest_s = self.longest.map(|cost| cost * middle_s);
        // At the end threads are idle while the last jobs run.
        let busy = threads.min(self.jobs) as f64;
        let tail = 1.0 - 1.0 / busy;
        let time = |work_s: f64, longest_s: f64, besides: f64, row: f64| {
            duration((work_s / busy + tail * longest_s).max(longest_s) + besides + row * self.jobs as f64)
        };
        Some(TimeRange {
            low: time(low, 0.0, BESIDES_S[0], ROW_S[0]),
            high: time(high, longest_s[0], BESIDES_S[1], ROW_S[1]),
            limit: time(middle_s * self.limit * slowest, longest_s[1], BESIDES_S[1], ROW_S[1]),
            longest_job: duration(longest_s[1]),
            per_cost_s: [low / self.likely, high / self.likely],
        })
    }
}

/// The fast and the slow end of a speed over its middle, for scenes that may be others.
fn speed_factors(speed: Speed) -> [f64; 2] {
    let [fast, slow] = OTHER_SCENES;
    [fast * speed.fast_ns / speed.middle_ns(), slow * speed.slow_ns / speed.middle_ns()]
}

/// Means of a study's jobs, as [`Ending`] has them, over the likely mean.
const OTHER_ENDS: [f64; 2] = [0.55, 1.7];

/// The range of seconds of a thread per unit of cost, for workers that do not know the study.
pub fn per_cost_s(speed: Speed) -> [f64; 2] {
    let [low, high] = OTHER_ENDS;
    let [fastest, slowest] = speed_factors(speed);
    [combined(low, fastest), combined(high, slowest)].map(|factor| factor * speed.middle_ns() * 1e-9)
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
    use crate::analysis::earliest_end;
    use crate::spec::{Accuracy, JobSpec};

    const SPEED: Speed = Speed { fast_ns: 4.0, slow_ns: 6.0, jobs: 20 };

    fn tasks(jobs: usize, change: fn(&mut JobSpec)) -> Tasks {
        let mut spec = JobSpec::default();
        change(&mut spec);
        let workload = Workload::estimate(&spec).unwrap();
        let mut tasks = Tasks::default();
        for _ in 0..jobs {
            let earliest = earliest_end(&spec).map(|spec| Workload::estimate(&spec).unwrap());
            tasks.add(&workload, earliest.as_ref().unwrap_or(&workload), Ending::of(&spec));
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
            let range = tasks.time(1, SPEED).unwrap();
            let [low, high, limit] = seconds(&range);
            let likely = tasks.likely * SPEED.middle_ns() * 1e-9;
            assert!(low < likely && likely < high && high < limit, "{low} {likely} {high} {limit}");
            high / low
        };
        assert!(width(1) > 1.5 * width(100));
        assert_eq!(Tasks::default().time(2, SPEED), None);
    }

    /// Protects: if every job runs to its limit, only the speed is uncertain.
    #[test]
    fn runs_of_known_length_depend_on_the_speed_alone() {
        let tasks = tasks(100, |spec| spec.run.stop_early = false);
        let [low, high, limit] = seconds(&tasks.time(1, SPEED).unwrap());
        let expected = 1.4 * 6.0 / (0.8 * 4.0);
        assert!((high / low / expected - 1.0).abs() < 0.02, "{}", high / low);
        assert!((high / limit - 1.0).abs() < 1.0e-9, "{high} {limit}");
    }

    /// Protects: docs/evidence/speed.md says how wide a forecast is before jobs have finished in the database, and how wide afterwards.
    #[test]
    fn the_width_is_the_documented_one() {
        let factor = |speed: Speed| {
            let [low, high, _] = seconds(&tasks(100, |_| ()).time(1, speed).unwrap());
            high / low
        };
        let (first, later) = (factor(Speed::TYPICAL), factor(SPEED));
        assert!((9.5..11.5).contains(&first) && (4.5..5.6).contains(&later), "{first} {later}");
    }

    /// Protects: the range of jobs that ask for an accuracy begins where all of them end on the first mesh that can prove it. Its elements
    /// are twice as large in each direction, and a step is at least twice as long.
    #[test]
    fn an_accuracy_may_be_reached_early() {
        let fine = tasks(10, |spec| spec.scene.pin.elements = [48, 60, 40]);
        let asked = tasks(10, |spec| {
            spec.scene.pin.elements = [48, 60, 40];
            spec.accuracy = Some(Accuracy { mu_star: 0.01 });
        });
        assert!(asked.early < fine.early / 14.0 && asked.likely == fine.likely);
    }

    /// Protects: threads share many jobs, and a single job gains nothing from a second thread.
    #[test]
    fn threads_share_jobs() {
        let high = |jobs, threads| seconds(&tasks(jobs, |_| ()).time(threads, SPEED).unwrap())[1];
        assert!(high(1000, 4) < 0.27 * high(1000, 1));
        assert_eq!(high(1, 4), high(1, 1));
    }
}
