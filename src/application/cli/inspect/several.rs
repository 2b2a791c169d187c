//! `tribosweep inspect --all`: several jobs of a study, or their spectra alone.

use super::{
    Args, KEY_LENGTH, Only, ProgressDisplay, SETTINGS, beside_others, exit_code, inspect_job, options,
    settings, slug, title,
};
use crate::analysis::JobError;
use crate::cli::error::CliError;
use crate::cli::foreground;
use crate::cli::output::{log, print};
use crate::exit;
use crate::inspect::{self, JobSpectrum};
use crate::study::Study;
use crate::sweep::{self, SelectedJob};
use crate::worker::Interrupt;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::collections::HashSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Inspects the jobs of a study that have the given parameters, and prints the path of each result.
pub(super) fn run(args: &Args, study: &Study) -> Result<u8, CliError> {
    if args.job.iter().any(|text| !text.contains('=')) {
        return Err(CliError::Usage(
            "with --all expected NAME=VALUE, which selects jobs of the study, and no key".to_owned(),
        ));
    }
    let jobs = sweep::select_all(study, SETTINGS, &settings(&args.job)?)?;
    if jobs.is_empty() {
        return Err(CliError::Usage(format!(
            "no job of {} has {}; `tribosweep export` lists its jobs",
            study.name(),
            args.job.join(" ")
        )));
    }
    let folders = folders(&args.folder_of(study), &jobs);
    let interrupt = foreground::interrupt();
    if args.only == Some(Only::Spectrum) {
        spectra(&jobs, &folders, &interrupt)
    } else {
        pages(args, study, &jobs, &folders, &interrupt)
    }
}

/// A folder for each job, named by its parameters. Jobs whose parameters make the same name have their keys in it.
fn folders(parent: &Path, jobs: &[SelectedJob]) -> Vec<PathBuf> {
    let mut taken = HashSet::new();
    let folder = |job: &SelectedJob| {
        let slug = slug(&job.parameters);
        let name = if slug.is_empty() { "job".to_owned() } else { slug };
        let is_new = taken.insert(name.to_lowercase());
        if is_new {
            beside_others(parent.join(name), &job.key)
        } else {
            parent.join(format!("{name}_{}", &job.key[..KEY_LENGTH.min(job.key.len())]))
        }
    };
    jobs.iter().map(folder).collect()
}

/// The pages of the jobs, one after the other. A job that fails does not stop the others.
fn pages(
    args: &Args,
    study: &Study,
    jobs: &[SelectedJob],
    folders: &[PathBuf],
    interrupt: &Interrupt,
) -> Result<u8, CliError> {
    let mut code = exit::SUCCESS;
    for (number, (job, folder)) in jobs.iter().zip(folders).enumerate() {
        log(format_args!("{} of {}: {}", number + 1, jobs.len(), title(study, &job.parameters)));
        let mut progress = ProgressDisplay::new(job, interrupt.clone());
        match inspect_job(args, study, job, folder, &options(args), &mut progress)? {
            Ok(()) => {}
            Err(error) => code = exit_code(error)?,
        }
        if interrupt.is_raised() {
            return Ok(exit::WORK_LEFT);
        }
    }
    Ok(code)
}

/// The spectra of the jobs, on all cores. Jobs whose folder has a spectrum are left out.
fn spectra(jobs: &[SelectedJob], folders: &[PathBuf], interrupt: &Interrupt) -> Result<u8, CliError> {
    let missing: Vec<(&SelectedJob, &PathBuf)> =
        jobs.iter().zip(folders).filter(|(job, folder)| !inspect::has_spectrum(folder, &job.key)).collect();
    if missing.len() < jobs.len() {
        let (stored, all) = (jobs.len() - missing.len(), jobs.len());
        log(format_args!("{stored} of {all} spectra are stored already"));
    }
    let run = |(job, folder): &(&SelectedJob, &PathBuf)| -> Result<Option<JobError>, CliError> {
        let found = JobSpectrum::of_job(&job.spec, &mut |_| {
            if interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        match found {
            Ok(spectrum) => {
                spectrum.write(&job.spec, &job.key, folder)?;
                print(&format!("{}\n", folder.display()))?;
                Ok(None)
            }
            Err(error) => Ok(Some(error)),
        }
    };
    let ended: Vec<Option<JobError>> = missing.par_iter().map(run).collect::<Result<_, _>>()?;
    if interrupt.is_raised() {
        return foreground::exit_code(JobError::Interrupted);
    }
    let mut code = exit::SUCCESS;
    for error in ended.into_iter().flatten() {
        code = foreground::exit_code(error)?;
    }
    Ok(code)
}

/// The spectrum of one job.
pub(super) fn spectrum(job: SelectedJob, folder: PathBuf) -> Result<u8, CliError> {
    spectra(&[job], &[folder], &foreground::interrupt())
}
