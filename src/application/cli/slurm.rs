//! `tribosweep slurm`: a study as a job array of a Slurm cluster.

mod args;
mod scripts;
mod settings;

pub(crate) use args::Args;

use super::error::CliError;
use super::output::{log, print, write_file};
use super::warnings;
use crate::exit;
use crate::queue::Location;
use crate::study::StudyText;
use scripts::Scripts;
use settings::Database;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Writes the scripts, and submits them with `--submit`.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let database = Database::of(db)?;
    let plan = args.study.plan()?;
    let name = plan.name();
    let grows = plan.study().growth().is_any();
    if grows && !database.is_shared() {
        return Err(CliError::Usage(
            "a study with `refine`, `continue` or `calibrate` needs one database for all workers: give that of a server with --db postgres://…"
                .to_owned(),
        ));
    }
    if !grows && args.workers as usize > plan.jobs().len() {
        return Err(CliError::Usage(format!(
            "the study has fewer jobs than {} workers; give at most --workers {}",
            args.workers,
            plan.jobs().len()
        )));
    }
    let folder = args.folder.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.slurm")));
    // The array reads the study later, and on other machines.
    let is_own = args.study.is_changed() || StudyText::is_stdin(&args.study.file);
    let study = if is_own { folder.join("study.json") } else { args.study.file.clone() };
    let scripts = Scripts::new(args, &study, name, &database, &folder)?;
    warnings::of_study(plan.study());
    scripts.write()?;
    if is_own {
        write_file(&study, plan.document().as_bytes())?;
    }
    if args.submit {
        return submit(&scripts.submit());
    }
    log(format_args!("scripts written to {}; submit them with", folder.display()));
    print(&format!("{}\n", folder.join(scripts::SUBMIT).display()))?;
    Ok(exit::SUCCESS)
}

/// Runs the script, which prints what it does and submits everything or nothing.
fn submit(script: &Path) -> Result<u8, CliError> {
    let failed = |source| CliError::file(script, source);
    let status = Command::new("bash").arg(script).status().map_err(failed)?;
    if status.success() {
        return Ok(exit::SUCCESS);
    }
    Err(CliError::Refused(format!(
        "{} ended with {}; the lines above say why",
        script.display(),
        status.code().map_or_else(|| status.to_string(), |code| format!("code {code}"))
    )))
}
