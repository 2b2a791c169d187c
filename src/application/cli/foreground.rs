//! The common part of the commands that solve jobs in the foreground.

use super::error::CliError;
use super::output::log;
use super::signals::raise_on_signal;
use crate::analysis::JobError;
use crate::exit;
use crate::solver::SolverError;
use crate::spec::Limit;
use crate::study::Preset;
use crate::worker::Interrupt;

/// Reads `NAME=VALUE`.
pub(crate) fn parse_setting(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE, for example omega_rpm=7".to_owned()),
    }
}

/// Reads an accuracy, 1% or 0.01, as a setting.
pub(crate) fn parse_accuracy(text: &str) -> Result<(String, String), String> {
    let share = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().map(|percent| percent / 100.0),
        None => text.trim().parse::<f64>(),
    };
    let share = share.map_err(|_| "expected a share of μ*, for example 1% or 0.01".to_owned())?;
    let limit = Limit::of("accuracy.mu_star").filter(|limit| !limit.holds(share));
    if let Some(limit) = limit {
        return Err(format!("expected {}", limit.expected(share)));
    }
    Ok(("accuracy_mu_star".to_owned(), share.to_string()))
}

/// Reads the name of a preset.
pub(crate) fn parse_preset(text: &str) -> Result<Preset, String> {
    let names = || Preset::ALL.map(Preset::name).join(", ");
    Preset::find(text).ok_or_else(|| format!("expected one of {}", names()))
}

/// An interrupt that Ctrl-C raises from now on.
pub(crate) fn interrupt() -> Interrupt {
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    std::thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        if let Ok(runtime) = runtime {
            runtime.block_on(raise_on_signal(raised, "stopping"));
        }
    });
    interrupt
}

/// The exit code of a job that ended without a record: for a failure of the job or an interruption. A job that was
/// refused is an error of the command.
pub(crate) fn exit_code(error: JobError) -> Result<u8, CliError> {
    match error {
        JobError::Interrupted => {
            log("interrupted");
            Ok(exit::WORK_LEFT)
        }
        JobError::Spec(violations) => Err(CliError::Refused(violations.to_string())),
        JobError::Solver(SolverError::Diverged { .. } | SolverError::ContactNotSolved { .. })
        | JobError::NotFinite { .. } => {
            log(format_args!("error: {error}"));
            Ok(exit::SOME_FAILED)
        }
        error => Err(CliError::Refused(error.to_string())),
    }
}
