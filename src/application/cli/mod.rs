//! The command line: arguments, messages and exit codes. Each subcommand has a file. Results go to standard output,
//! everything else to standard error. The work is done by [`sweep`](crate::sweep).

mod calibrate;
mod cancel;
mod columns;
mod completions;
mod diff;
mod display;
mod doctor;
mod document;
mod error;
mod export;
mod forecast;
mod foreground;
mod gc;
mod inspect;
mod man;
mod merge;
mod missing;
mod outlook;
mod output;
mod parameters;
mod pareto;
mod presets;
mod rename;
mod replace;
mod report;
mod retry;
mod rm;
mod rows;
mod run;
mod schema;
mod sensitivity;
mod show;
mod signals;
mod slurm;
mod solve;
mod stability;
mod status;
mod study_args;
mod submit;
mod unreadable;
mod validate;
mod warnings;
mod work;
mod workers;

use crate::exit;
use crate::queue::Location;
use clap::builder::{OsStringValueParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser, Subcommand};

/// The database of commands without `--db`.
const DEFAULT_DB: &str = "tribosweep.db";

/// Sweeps of explicit dynamic contact simulations of a pin-on-disk tribometer.
///
/// A study file describes a scene and a grid of parameters. `run` plans the jobs, solves them and writes a report.
#[derive(Debug, Parser)]
#[command(
    name = "tribosweep",
    version = env!("TRIBOSWEEP_VERSION"),
    max_term_width = 100,
    after_help = exit::help()
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// The database of studies, jobs and results: a file, or postgres://USER@HOST/DATABASE.
    #[arg(long, global = true, value_name = "PATH|URL", env = "TRIBOSWEEP_DB", hide_env_values = true,
          default_value = DEFAULT_DB, value_parser = OsStringValueParser::new().map(Location::parse))]
    db: Location,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Check a study file and all that a run needs, and say what its jobs take, without running it.
    Validate(validate::Args),
    /// Submit a study, run its jobs and write a report: the whole sweep in one command.
    Run(run::Args),
    /// Write the page, tables and figures of a study, or of several side by side.
    Report(report::Args),
    /// Compute the modes of steady sliding at every point of a study, and the thresholds at which one begins to grow.
    Stability(stability::Args),
    /// Find the values of free parameters that measured points do not rule out.
    Calibrate(calibrate::Args),
    /// Show how much each parameter of a study decides, from its own jobs.
    Sensitivity(sensitivity::Args),
    /// Compare jobs that differ in their numerics: error against run time.
    Pareto(pareto::Args),
    /// Run one job again and show it in detail: histories, cycles, snapshots, fields for ParaView.
    Inspect(inspect::Args),
    /// Solve one job in the foreground.
    Solve(solve::Args),
    /// Show the progress of the studies.
    Status(status::Args),
    /// Write one row per job of one, several or all studies as CSV or JSON lines.
    Export(export::Args),
    /// Show everything about a job: its inputs, its whole result, and how the result was obtained.
    Show(show::Args),
    /// Plan a study's jobs without running them.
    Submit(submit::Args),
    /// Run all pending jobs of the database.
    Work(work::Args),
    /// Write the scripts for a job array of a Slurm cluster, and submit them.
    Slurm(slurm::Args),
    /// Cancel the pending jobs of a study.
    Cancel(cancel::Args),
    /// Make failed and cancelled jobs of a study pending again, or those whose results cannot be read.
    Retry(retry::Args),
    /// Compare two studies: inputs that differ, and jobs that only one of them has.
    Diff(diff::Args),
    /// Give a study another name in the database.
    Rename(rename::Args),
    /// Print the file of a study in the database, as it was submitted.
    Document(document::Args),
    /// Remove a study; its results stay in the database until `gc`.
    Rm(rm::Args),
    /// Delete jobs that no study needs, with their results.
    Gc(gc::Args),
    /// Add the studies and results of other databases, for example shards, to the one that --db names.
    Merge(merge::Args),
    /// Copy one or all studies with their results from one database to another; each is a file or on a server.
    Copy(merge::CopyArgs),
    /// Check the database and its environment for problems.
    Doctor(doctor::Args),
    /// Show the accuracy presets with their settings and measured errors.
    Presets(presets::Args),
    /// Print the parameters that a grid and `--set` know, with units and meanings.
    Parameters(parameters::Args),
    /// Print the columns of the export with their units and meanings.
    Columns(columns::Args),
    /// Print the JSON schema of study files.
    Schema(schema::Args),
    /// Print a completion script for a shell.
    Completions(completions::Args),
    /// Write the manual pages of all commands to a folder.
    Man(man::Args),
}

impl Cli {
    /// Reads the arguments of the process. Help, the version and errors end the process.
    pub fn from_arguments() -> Self {
        Self::try_parse().unwrap_or_else(|error| {
            let is_alone = std::env::args_os().len() <= 1;
            if is_alone && error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
                output::log(first_steps());
                std::process::exit(exit::ERROR.into());
            }
            with_suggestion(error).exit()
        })
    }
}

/// The commands that somebody needs first.
const FIRST: [&str; 5] = ["validate", "run", "report", "stability", "calibrate"];

/// What the program prints without arguments.
fn first_steps() -> String {
    let command = Cli::command();
    let about = |name: &str| {
        let own = command.find_subcommand(name).and_then(clap::Command::get_about);
        format!("  {name:<11}{}\n", own.map(ToString::to_string).unwrap_or_default())
    };
    format!(
        "{}.\n\nUsage: tribosweep COMMAND\n\nThe commands to begin with:\n{}\n\
         `tribosweep --help` lists all commands, and `tribosweep help COMMAND` describes one.",
        command.get_about().map(ToString::to_string).unwrap_or_default(),
        FIRST.map(about).concat()
    )
}

/// Most letters to change from a wrong name of a command to the one that is meant: `rnu`, `stauts`.
const MOST_CHANGES: usize = 2;

/// An unknown command with the one that it may mean, and an option with the commands that have it. The usual suggestions miss exchanged
/// letters in short names.
fn with_suggestion(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidArg) {
        let owners = commands_with(wrong);
        if !owners.is_empty() {
            let tip = format!("{wrong} is an option of {}", owners.join(", "));
            error.remove(ContextKind::SuggestedArg);
            error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
        }
    }
    let has_one = error.get(ContextKind::SuggestedSubcommand).is_some();
    if let Some(ContextValue::String(wrong)) = error.get(ContextKind::InvalidSubcommand)
        && !has_one
    {
        let command = Cli::command();
        let names = command.get_subcommands().map(clap::Command::get_name);
        let distance = |name: &&str| strsim::osa_distance(wrong, name);
        let nearest =
            names.min_by_key(distance).filter(|name| distance(name) <= MOST_CHANGES.min(wrong.len() / 2));
        if let Some(name) = nearest.map(str::to_owned) {
            error.insert(ContextKind::SuggestedSubcommand, ContextValue::Strings(vec![name]));
        }
    }
    error
}

/// The commands that have an option.
fn commands_with(option: &str) -> Vec<String> {
    let Some(long) = option.strip_prefix("--") else { return Vec::new() };
    let has_it = |own: &&clap::Command| own.get_arguments().any(|argument| argument.get_long() == Some(long));
    Cli::command().get_subcommands().filter(has_it).map(|own| format!("`{}`", own.get_name())).collect()
}

/// Runs the command and returns its exit code (see `exit`).
pub fn main(cli: Cli) -> u8 {
    let db = &cli.db;
    // A damaged database may be either of their two.
    let has_two = matches!(cli.command, Command::Merge(_) | Command::Copy(_));
    let result = match cli.command {
        Command::Validate(args) => validate::run(&args, db),
        Command::Run(args) => run::run(&args, db),
        Command::Report(args) => report::run(&args, db),
        Command::Stability(args) => stability::run(&args, db),
        Command::Calibrate(args) => calibrate::run(&args, db),
        Command::Sensitivity(args) => sensitivity::run(&args, db),
        Command::Pareto(args) => pareto::run(&args, db),
        Command::Inspect(args) => inspect::run(&args, db),
        Command::Solve(args) => solve::run(&args),
        Command::Status(args) => status::run(&args, db),
        Command::Export(args) => export::run(&args, db),
        Command::Show(args) => show::run(&args, db),
        Command::Submit(args) => submit::run(&args, db),
        Command::Work(args) => work::run(&args, db),
        Command::Slurm(args) => slurm::run(&args, db),
        Command::Cancel(args) => cancel::run(&args, db),
        Command::Retry(args) => retry::run(&args, db),
        Command::Diff(args) => diff::run(&args, db),
        Command::Rename(args) => rename::run(&args, db),
        Command::Document(args) => document::run(&args, db),
        Command::Rm(args) => rm::run(&args, db),
        Command::Gc(args) => gc::run(&args, db),
        Command::Merge(args) => merge::run(&args, db),
        Command::Copy(args) => merge::copy(&args, db),
        Command::Doctor(args) => doctor::run(&args, db),
        Command::Presets(args) => presets::run(&args),
        Command::Parameters(args) => parameters::run(&args),
        Command::Columns(args) => columns::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Completions(args) => completions::run(&args),
        Command::Man(args) => man::run(&args),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            output::log(format_args!("error: {error}"));
            let advice = if has_two { Vec::new() } else { missing::advice(&error, db) };
            for line in advice {
                output::log(format_args!("  help: {line}"));
            }
            exit::ERROR
        }
    }
}
