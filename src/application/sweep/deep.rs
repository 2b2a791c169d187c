//! Reading all that a database has: results, specifications, final motions and checkpoints.

use super::error::SweepError;
use super::rows::{for_each_stored, read_record, report_row};
use super::work::job_key;
use crate::queue::{Finding, Integrity, Pages, Queue, Rows, StudyRow};
use crate::spec::JobSpec;
use std::collections::{BTreeSet, HashSet};
use std::fmt::Write;

/// Keys that a finding lists.
const MOST_LISTED: usize = 5;

/// Some keys out of many.
#[derive(Debug, Default)]
struct Keys {
    first: Vec<String>,
    count: u64,
}

impl Keys {
    fn add(&mut self, key: &str) {
        self.count += 1;
        if self.first.len() < MOST_LISTED {
            self.first.push(if key.is_empty() { "a job that is missing" } else { key }.to_owned());
        }
    }

    fn in_words(&self) -> String {
        let more = if self.count > self.first.len() as u64 { ", …" } else { "" };
        format!("{} ({}{more})", self.count, self.first.join(", "))
    }
}

/// What to do about results that cannot be read.
const RUN_AGAIN: &str = "; `tribosweep retry STUDY --unreadable` runs these jobs again";

/// Reads everything that the database has, and says what is damaged. (`queue::examine` checks tables and references.)
///
/// # Errors
/// If the database cannot be read at all; a page that cannot be read is a finding.
pub async fn examine_deeply(queue: &mut Queue) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (subject, found) in [
        ("results", results(queue).await),
        ("specifications", specifications(queue).await),
        ("parameters", parameters(queue).await),
        ("motions", motions(queue).await),
        ("checkpoints", checkpoints(queue).await),
    ] {
        let (text, is_problem) = found.unwrap_or_else(|error| (error.to_string(), true));
        findings.push(Finding { subject, text, is_problem });
    }
    findings
}

/// A text, and whether it is a problem.
type Found = Result<(String, bool), SweepError>;

async fn results(queue: &mut Queue) -> Found {
    let (mut read, mut without, mut damaged, mut unreadable) =
        (0_u64, 0_u64, Keys::default(), Keys::default());
    let mut pages = Pages::of_results();
    while let Some(page) = queue.next_page(&mut pages).await? {
        for result in page {
            read += 1;
            without += u64::from(result.integrity == Integrity::WithoutDigest);
            if result.integrity == Integrity::Damaged {
                damaged.add(&result.key);
            } else if result.record.is_some_and(|record| read_record(&record).is_err()) {
                unreadable.add(&result.key);
            }
        }
    }
    let mut text = format!("{read} read");
    if without > 0 {
        let _ = write!(text, ", {without} without a digest (an earlier version stored them)");
    }
    for (keys, what) in [(&damaged, "damaged"), (&unreadable, "of another version or damaged")] {
        if keys.count > 0 {
            let _ = write!(text, ", {what}: {}", keys.in_words());
        }
    }
    let is_problem = damaged.count + unreadable.count > 0;
    Ok((if is_problem { text + RUN_AGAIN } else { text }, is_problem))
}

/// Keys of another version of the solver cannot be computed here. All jobs of a study are of one version: if some have their
/// keys, the others were changed.
async fn specifications(queue: &mut Queue) -> Found {
    let (mut read, mut unreadable, mut others) = (0_u64, Keys::default(), HashSet::new());
    let mut pages = Pages::of_payloads();
    while let Some(page) = queue.next_page(&mut pages).await? {
        for job in page {
            read += 1;
            match job.payload.as_deref().map(serde_json::from_str::<JobSpec>) {
                Some(Ok(spec)) if job_key(&spec) == job.key => {}
                Some(Ok(_)) => _ = others.insert(job.key),
                _ => unreadable.add(&job.key),
            }
        }
    }
    let mut changed = Keys::default();
    let mut of_others = 0;
    if !others.is_empty() {
        let mut of_studies = HashSet::new();
        for study in queue.studies().await? {
            let mut keys = BTreeSet::new();
            let mut pages = queue.pages_of_rows(&study.name, Rows::All).await?;
            while let Some(page) = queue.next_page(&mut pages).await? {
                keys.extend(page.into_iter().map(|row| row.key));
            }
            let strange = keys.iter().filter(|key| others.contains(*key)).count();
            if strange < keys.len() {
                for key in keys.iter().filter(|key| others.contains(*key)) {
                    changed.add(key);
                }
            } else {
                of_others += strange;
            }
            of_studies.extend(keys);
        }
        of_others += others.iter().filter(|key| !of_studies.contains(*key)).count();
    }
    let mut text = format!("{read} read");
    if of_others > 0 {
        let _ = write!(
            text,
            ", {of_others} of another version of the solver, so that their keys cannot be checked"
        );
    }
    for (keys, what) in [
        (&unreadable, "missing, damaged or of another version"),
        (&changed, "changed, so that they are not those of their keys"),
    ] {
        if keys.count > 0 {
            let _ = write!(text, ", {what}: {}", keys.in_words());
        }
    }
    let is_problem = unreadable.count + changed.count > 0;
    let advice = "; submit the studies again, then `tribosweep retry` them";
    Ok((if is_problem { text + advice } else { text }, is_problem))
}

async fn parameters(queue: &mut Queue) -> Found {
    let (mut read, mut damaged) = (0_u64, Vec::new());
    for study in queue.studies().await? {
        let mut wrong = 0_u64;
        for_each_stored(queue, &study.name, |stored| {
            read += 1;
            wrong += u64::from(stored.is_err());
        })
        .await?;
        if wrong > 0 {
            damaged.push(format!("{wrong} of {}", study.name));
        }
    }
    if damaged.is_empty() {
        return Ok((format!("{read} rows read"), false));
    }
    let damaged = damaged.join(", ");
    Ok((
        format!("{read} rows read, damaged: {damaged}; submit these studies again, which writes them anew"),
        true,
    ))
}

async fn motions(queue: &mut Queue) -> Found {
    let (mut read, mut without, mut damaged) = (0_u64, 0_u64, Keys::default());
    let mut pages = Pages::of_final_states();
    while let Some(page) = queue.next_page(&mut pages).await? {
        for state in page {
            read += 1;
            match state.integrity {
                Integrity::Intact => {}
                Integrity::WithoutDigest => without += 1,
                Integrity::Damaged => damaged.add(&state.key),
            }
        }
    }
    let mut text = format!("{read} read");
    if without > 0 {
        let _ = write!(text, ", {without} without a digest (an earlier version stored them)");
    }
    if damaged.count > 0 {
        let _ = write!(text, ", damaged: {}{RUN_AGAIN}", damaged.in_words());
    }
    Ok((text, damaged.count > 0))
}

async fn checkpoints(queue: &mut Queue) -> Found {
    let read = queue.all_pages(Pages::of_checkpoints()).await?.len();
    Ok((format!("{read} read; their jobs check them, and begin anew if they are damaged"), false))
}

/// The keys of the jobs of a study that have to be run again: their result cannot be read, or their final motion is damaged.
///
/// # Errors
/// If the database has no such study or cannot be read.
pub async fn unreadable_jobs(queue: &mut Queue, study: &str) -> Result<Vec<String>, SweepError> {
    let mut damaged = HashSet::new();
    let mut pages = Pages::of_final_states();
    while let Some(page) = queue.next_page(&mut pages).await? {
        let found = page.into_iter().filter(|state| state.integrity == Integrity::Damaged);
        damaged.extend(found.map(|state| state.key));
    }
    let mut keys = Vec::new();
    let mut seen = HashSet::new();
    let mut is_wanted = |row: &StudyRow| {
        let is_unreadable = report_row(study, row).is_ok_and(|row| row.unreadable().is_some());
        (is_unreadable || damaged.contains(&row.key)) && seen.insert(row.key.clone())
    };
    let mut pages = queue.pages_of_rows(study, Rows::All).await?;
    while let Some(page) = queue.next_page(&mut pages).await? {
        keys.extend(page.into_iter().filter(&mut is_wanted).map(|row| row.key));
    }
    Ok(keys)
}
