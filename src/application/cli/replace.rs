//! Submitting a study whose name the database may have: what changes is said, and a study loses results only if the user
//! wants it.

use super::error::CliError;
use super::output::log;
use crate::publish::value;
use crate::queue::{Queue, QueueError, Replace, Replaced, Submitted};
use crate::sweep::{Plan, Submission, SweepError};
use std::io::{self, IsTerminal, Write};

/// Whether a study of the same name may be replaced.
#[derive(Debug, clap::Args)]
pub(crate) struct Replacement {
    /// Replace a study of the same name even if the new one lacks finished jobs of the old one. Their results stay in the
    /// database until `gc`.
    #[arg(long = "replace")]
    pub(crate) is_wanted: bool,
}

impl Replacement {
    /// What a submission may do.
    pub(crate) fn policy(&self) -> Replace {
        if self.is_wanted { Replace::Always } else { Replace::KeepingResults }
    }
}

/// Submits the plan and logs what changes in a study that is replaced. If results would go out of view without
/// `--replace`, the user of a terminal is asked, and otherwise the study is refused.
pub(crate) async fn submit(
    plan: &Plan,
    mut submission: Submission,
    queue: &mut Queue,
) -> Result<Submitted, CliError> {
    loop {
        match plan.submit_with(queue, &submission).await {
            Ok(submitted) => {
                // What the user was asked about need not be said again.
                if let (Some(replaced), Replace::KeepingResults | Replace::Always) =
                    (&submitted.replaced, &submission.replace)
                {
                    log_changes(plan, replaced);
                }
                return Ok(submitted);
            }
            Err(SweepError::Queue(QueueError::ResultsWouldBeDropped { name, replaced })) => {
                log_changes(plan, &replaced);
                if !is_confirmed() {
                    return Err(QueueError::ResultsWouldBeDropped { name, replaced }.into());
                }
                // Another process may replace the study before this one does: then the user is asked again.
                submission.replace = Replace::Document(replaced.document);
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// Logs what a submission would change in a study of the same name, and refuses what [`submit`] would refuse. It asks
/// nobody, and changes nothing.
pub(crate) fn check(
    plan: &Plan,
    replacement: &Replacement,
    replaced: Option<Replaced>,
) -> Result<(), CliError> {
    let Some(replaced) = replaced else { return Ok(()) };
    log_changes(plan, &replaced);
    if replaced.dropped_done == 0 || replacement.is_wanted {
        return Ok(());
    }
    let (name, replaced) = (plan.name().to_owned(), Box::new(replaced));
    Err(QueueError::ResultsWouldBeDropped { name, replaced }.into())
}

/// Says how a study changes. If its jobs stay the same, there is nothing to say.
fn log_changes(plan: &Plan, replaced: &Replaced) {
    let Replaced { kept, new, dropped, dropped_done, cancelled, .. } = replaced;
    if new + dropped == 0 {
        return;
    }
    log(format_args!("{}: the database has a study of this name; what changes:", plan.name()));
    match plan.difference_from(replaced) {
        Ok(difference) if difference.inputs.is_empty() => {
            log(
                "  no input takes other values: the combinations, the way in which the study grows, the shard or the version of the program differ",
            );
        }
        Ok(difference) => difference.inputs.iter().for_each(|input| log(format!("  {}", input.in_words()))),
        Err(_) => log("  this version cannot read the old study, so the inputs are not compared"),
    }
    let with_results =
        if *dropped > 0 { format!(", {dropped_done} of them with results") } else { String::new() };
    let pending = match cancelled {
        0 => String::new(),
        1 => "; 1 pending job is cancelled".to_owned(),
        _ => format!("; {} are cancelled", value::count(*cancelled, "pending job")),
    };
    log(format_args!(
        "  {} kept, {new} new, {dropped} dropped{with_results}{pending}",
        value::count(*kept, "job")
    ));
}

/// Asks on a terminal. Elsewhere nobody can answer.
fn is_confirmed() -> bool {
    if !(io::stdin().is_terminal() && io::stderr().is_terminal()) {
        return false;
    }
    let _ =
        write!(io::stderr(), "Replace it? The results stay in the database until `tribosweep gc`. [y/N] ");
    let mut answer = String::new();
    let is_read = io::stdin().read_line(&mut answer).is_ok();
    is_read && matches!(answer.trim().to_lowercase().as_str(), "y" | "yes")
}
