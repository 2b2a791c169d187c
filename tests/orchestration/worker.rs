//! The worker on a queue of real jobs.

mod failures;
mod interrupts;
mod locked;
mod observed;

use serde_json::json;
use tribosweep::queue::{Counts, NewJob, NewStudy, Queue, StudyRow};
use tribosweep::spec::JobSpec;
use tribosweep::worker::{Progress, Snapshot};

/// A job on a mesh of 36 elements that simulates `limit_s`, some milliseconds of work for each.
fn spec(mu: f64, limit_s: f64) -> JobSpec {
    let spec = json!({
        "scene": {
            "pin": { "elements": [3, 4, 3] },
            "clamp": { "width_m": 0.004 },
            "contact": { "mu": mu },
        },
        "run": { "limit_s": limit_s, "stop_early": false },
    });
    serde_json::from_value(spec).unwrap()
}

fn job(key: &str, payload: &str) -> NewJob {
    NewJob {
        key: key.into(),
        payload: payload.into(),
        parameters: "{}".into(),
        cost: 1.0,
        batch: String::new(),
        priority: None,
        parent: None,
    }
}

fn solvable(key: &str, spec: &JobSpec) -> NewJob {
    job(key, &serde_json::to_string(spec).unwrap())
}

/// `count` different jobs, named a, b, c …
fn several(count: u8, limit_s: f64) -> Vec<NewJob> {
    let key = |i: u8| char::from(b'a' + i).to_string();
    (0..count).map(|i| solvable(&key(i), &spec(0.1 + 0.05 * f64::from(i), limit_s))).collect()
}

async fn submit(queue: &mut Queue, name: &str, jobs: Vec<NewJob>) {
    queue.submit(&NewStudy { name: name.into(), document: String::new(), jobs, grows: false }).await.unwrap();
}

async fn row(queue: &mut Queue, study: &str, key: &str) -> StudyRow {
    queue.rows(study).await.unwrap().into_iter().find(|row| row.key == key).unwrap()
}

/// Records all progress, and calls `react` with each snapshot.
struct Recorder<F: FnMut(&Snapshot)> {
    snapshots: Vec<Snapshot>,
    failures: Vec<(String, String)>,
    stopped: Vec<Snapshot>,
    react: F,
}

impl<F: FnMut(&Snapshot)> Recorder<F> {
    fn new(react: F) -> Self {
        Self { snapshots: Vec::new(), failures: Vec::new(), stopped: Vec::new(), react }
    }

    fn counts(&self) -> impl Iterator<Item = Counts> {
        self.snapshots.iter().chain(&self.stopped).map(|snapshot| snapshot.counts)
    }
}

impl<F: FnMut(&Snapshot)> Progress for Recorder<F> {
    fn update(&mut self, snapshot: &Snapshot) {
        assert!(self.stopped.is_empty(), "an update after the end");
        self.snapshots.push(snapshot.clone());
        (self.react)(snapshot);
    }

    fn failed(&mut self, key: &str, error: &str) {
        self.failures.push((key.to_owned(), error.to_owned()));
    }

    fn stopped(&mut self, snapshot: &Snapshot) {
        self.stopped.push(snapshot.clone());
    }
}
