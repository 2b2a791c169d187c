//! Advice for a study file that does not exist, and for a database that cannot be used.

use super::error::CliError;
use crate::queue::{Location, QueueError};
use crate::study::{StudyError, is_study_name};
use crate::sweep::{self, Purpose, SweepError};
use crate::worker::WorkError;
use std::io::ErrorKind;
use std::path::Path;

/// The database of a command whose error is one of a database that does not say which; none for other errors.
fn unnamed_database(error: &CliError, db: &Location) -> Option<String> {
    let (CliError::Queue(error)
    | CliError::Work(WorkError::Queue(error))
    | CliError::Sweep(SweepError::Queue(error) | SweepError::Work(WorkError::Queue(error)))) = error
    else {
        return None;
    };
    let is_unnamed =
        matches!(error, QueueError::Damaged(_) | QueueError::Inconsistent(_) | QueueError::Database(_));
    is_unnamed.then(|| format!("the database is {db}"))
}

/// What the user may have meant, if the error is a missing study file, and which database is damaged. `db` is the only database of the
/// command.
pub(crate) fn advice(error: &CliError, db: &Location) -> Vec<String> {
    if let Some(line) = unnamed_database(error, db) {
        return vec![line];
    }
    let (CliError::Study(study) | CliError::Sweep(SweepError::Study(study))) = error else {
        return Vec::new();
    };
    match study {
        StudyError::Read { file, reason } if reason.kind() == ErrorKind::NotFound => of_file(file, db),
        _ => Vec::new(),
    }
}

fn of_file(file: &str, db: &Location) -> Vec<String> {
    let mut lines = Vec::new();
    let with_ending = format!("{file}.json");
    if Path::new(&with_ending).is_file() {
        lines.push(format!("did you mean {with_ending}?"));
    }
    let name = file.strip_suffix(".json").unwrap_or(file);
    if is_study_name(name) && has_study(name, db) {
        lines.push(format!(
            "the database {db} has a study {name}: `tribosweep work` runs its pending jobs, `tribosweep report {name}` \
             writes its report, `tribosweep document {name} > {name}.json` writes its file"
        ));
    }
    if lines.is_empty() {
        lines.push("expected the path of a study file, which ends in .json".to_owned());
    }
    lines
}

/// Whether the database has a study of that name; not if it cannot be read.
fn has_study(name: &str, db: &Location) -> bool {
    let found = sweep::with_queue(db, Purpose::Read, async |queue| {
        let found = queue.study(name).await?.is_some();
        Ok::<_, CliError>(found)
    });
    found.unwrap_or(false)
}
