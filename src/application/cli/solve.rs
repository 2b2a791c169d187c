//! `tribosweep solve`: one job in the foreground, with its history.

use super::error::CliError;
use super::foreground;
use super::output::{log, print, terminal_width, write_file};
use super::show::text;
use super::warnings;
use crate::analysis::{self, JobObserver, JobRecord, Moment};
use crate::exit;
use crate::report::RowState;
use crate::spec::JobSpec;
use crate::study::{Preset, Study};
use crate::sweep::{self, History};
use crate::worker::Interrupt;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Arguments of `solve`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study file that gives the scene, or - for standard input.
    study: PathBuf,
    /// Set a parameter of the grid or any other parameter; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = foreground::parse_setting)]
    settings: Vec<(String, String)>,
    /// Take mesh, time step and detection from a preset instead of the study; `--set` overrides the preset.
    #[arg(long, value_name = "NAME", value_parser = foreground::parse_preset)]
    preset: Option<Preset>,
    /// Ask for an error of μ* by the mesh, for example 1%: each job goes from mesh to mesh until it is reached, instead of the mesh of the
    /// study. `--set` can give the finest mesh.
    #[arg(long, value_name = "ERROR", value_parser = foreground::parse_accuracy, allow_hyphen_values = true)]
    accuracy: Option<(String, String)>,
    /// Write the time history as CSV: load, total normal and tangential forces (clamp_tangential_n at the
    /// clamp, contact_tangential_n and mu_eq at the contact), numbers of nodes in each state, and displacement,
    /// velocity, stress and state of the centres of the leading (front) and trailing (rear) edge.
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Keep every N-th step in the history.
    #[arg(long, value_name = "N", default_value = "1", requires = "history")]
    every: std::num::NonZeroU64,
    /// Print the whole record as JSON.
    #[arg(long)]
    json: bool,
}

/// Solves the job and prints it as `show` does; nothing is stored.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let study = Study::load(&args.study)?;
    let settings: Vec<_> = args.accuracy.iter().chain(&args.settings).cloned().collect();
    let spec = study.single_with_preset(args.preset, &settings)?;
    warnings::of_job(&study, &spec);
    let interrupt = foreground::interrupt();
    let mut recorder = Recorder {
        interrupt,
        history: args.history.as_ref().map(|_| History::new(args.every, &spec.scene.holder)),
    };
    let solved = analysis::solve(&spec, &mut recorder);
    // The history is also written if the run failed: it explains the failure.
    if let (Some(path), Some(history)) = (&args.history, recorder.history) {
        let text = history.into_csv().map_err(|source| CliError::file(path, source))?;
        write_file(path, &text)?;
        log(format_args!("history written to {}", path.display()));
    }
    match solved {
        Ok(record) => {
            print(&if args.json { as_json(&record)? } else { as_text(&spec, record) })?;
            Ok(exit::SUCCESS)
        }
        Err(error) => foreground::exit_code(error),
    }
}

/// Collects the history and checks for a request to stop.
struct Recorder {
    interrupt: Interrupt,
    history: Option<History>,
}

impl JobObserver for Recorder {
    fn step(&mut self, moment: &Moment<'_>) {
        if let Some(history) = &mut self.history {
            history.add(moment.sample);
        }
    }

    fn needs_run(&self) -> bool {
        self.history.is_some()
    }

    fn progress(&mut self, _: f64) -> ControlFlow<()> {
        if self.interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn as_json(record: &JobRecord) -> Result<String, CliError> {
    // The first field, by the name that it has in the export.
    Ok(serde_json::to_string_pretty(record)? + "\n")
}

fn as_text(spec: &JobSpec, record: JobRecord) -> String {
    let row = sweep::row_of_job(&sweep::job_key(spec), spec, RowState::Done(Box::new(record)));
    text::of_solved(spec, &row, terminal_width())
}
