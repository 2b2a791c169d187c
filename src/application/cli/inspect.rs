//! `tribosweep inspect`: one job in detail, or several.

mod several;

use super::error::CliError;
use super::foreground;
use super::output::{log, print};
use super::show::text;
use crate::exit;
use crate::inspect::{self, Inspection, InspectionError, NodeSelector, Options, PageHeader, Trace};
use crate::publish::value;
use crate::queue::Location;
use crate::report::columns::Group;
use crate::report::{self, RowState, assignment};
use crate::solver;
use crate::study::{Origin, Parameter, Preset, Study, is_set_by_presets};
use crate::sweep::{self, SelectedJob};
use crate::worker::{self, Interrupt};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's file, or the name of one in the database.
    study: String,
    /// The job's key or its first characters; or NAME=VALUE for each parameter that differs from the study's scene.
    job: Vec<String>,
    /// Take mesh, time step and detection from a preset instead of the study.
    #[arg(long, value_name = "NAME", value_parser = foreground::parse_preset)]
    preset: Option<Preset>,
    /// A node of the contact face to show, by its name (front_centre, rear_centre, centre, inner_centre, outer_centre,
    /// front_inner, front_outer, rear_inner, rear_outer) or as X,Y in mm from the pin's axis; may be repeated. Default:
    /// front_centre and rear_centre.
    #[arg(long = "node", value_name = "NODE", value_parser = NodeSelector::parse, allow_hyphen_values = true)]
    nodes: Vec<NodeSelector>,
    /// Compare several jobs that differ in one parameter: normal and tangential stress at the nodes in one figure.
    #[arg(long, value_name = "NAME=VALUE,VALUE,…", value_parser = foreground::parse_setting)]
    overlay: Option<(String, String)>,
    /// Number of cycles to show.
    #[arg(long, value_name = "N", conflicts_with = "overlay", default_value_t = Options::default().cycles as u16,
          value_parser = clap::value_parser!(u16).range(Options::FEWEST_CYCLES as i64..=100))]
    cycles: u16,
    /// Number of instants of a cycle at which the whole pin is written for ParaView.
    #[arg(long, value_name = "N", conflicts_with = "overlay", default_value_t = Options::default().frames as u16,
          value_parser = clap::value_parser!(u16).range(Options::FEWEST_FRAMES as i64..=1000))]
    frames: u16,
    /// Inspect every job of the study, or those that have the given values NAME=VALUE.
    #[arg(long, conflicts_with_all = ["overlay", "preset"])]
    all: bool,
    /// Store the spectrum of the normal force alone, from one run of the job, without a page. The report draws the spectra
    /// of its jobs over the speed.
    #[arg(long, value_name = "WHAT", value_enum, conflicts_with_all = ["overlay", "nodes", "cycles", "frames"])]
    only: Option<Only>,
    /// Folder for the results; default: reports/STUDY/inspect/JOB, where the report finds them. With --all: the folder
    /// above those of the jobs.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// A part of an inspection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Only {
    /// The spectrum of the total normal contact force.
    Spectrum,
}

/// The name of the parameters of a job in messages.
const SETTINGS: &str = "NAME=VALUE";

/// Logs which grid parameters have the values of the study's scene.
fn log_scene_values(job: &SelectedJob) {
    let values = job.parameters.iter().filter(|(name, _)| job.from_scene.contains(&name.as_str()));
    let words: Vec<String> = values.map(|(name, value)| assignment(name, value)).collect();
    if !words.is_empty() {
        log(format_args!("from the study's scene: {}", words.join(", ")));
    }
}

/// Grids up to this size are searched for a job.
const SEARCHED: usize = 10_000;

/// Logs that the study does not have a job, which may be a mistake.
fn log_if_foreign(study: &Study, job: &SelectedJob) {
    if study.grid_size() <= SEARCHED
        && let Ok(jobs) = study.expand(solver::VERSION)
        && !jobs.iter().any(|own| own.key == job.key)
    {
        log(format_args!(
            "note: this point is not in the grid of {}; it is computed all the same",
            study.name()
        ));
    }
}

/// A study's name with the parameters of a job.
fn title(study: &Study, parameters: &[(String, Value)]) -> String {
    let words: Vec<String> = parameters.iter().map(|(name, value)| assignment(name, value)).collect();
    if words.is_empty() { study.name().to_owned() } else { format!("{}: {}", study.name(), words.join(", ")) }
}

/// Parameters as part of a file's name; empty without parameters.
fn slug(parameters: &[(String, Value)]) -> String {
    let parts = parameters.iter().map(|(name, value)| format!("{name}-{}", value::text(value)));
    value::file_name_part(&parts.collect::<Vec<_>>().join("_"))
}

/// The folder, or the one beside it with the job's key in its name if this one has the inspection of another job: a job of
/// another version of the study may have the same grid parameters.
fn beside_others(folder: PathBuf, key: &str) -> PathBuf {
    match inspect::key_of(&folder) {
        Some(other) if other != key => {
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            folder.with_file_name(format!("{name}_{}", &key[..KEY_LENGTH.min(key.len())]))
        }
        _ => folder,
    }
}

/// Number of characters of a key that tell jobs apart.
const KEY_LENGTH: usize = 8;

/// Runs the job twice and writes the results.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let study = sweep::block_on(sweep::load_study(&args.study, db))?;
    if args.overlay.is_some() {
        return overlay(args, &study, db);
    }
    if args.all {
        return several::run(args, &study);
    }
    let job = select(args, &study, &args.job, db)?;
    log_scene_values(&job);
    // A key names a job that the database has, also one of an earlier version or of a plan's wave.
    if args.job.iter().all(|word| word.contains('=')) {
        log_if_foreign(&study, &job);
    }
    let folder = args.out(&study, &[&slug(&job.parameters), args.preset.map_or("", Preset::name)]);
    let folder = if args.folder.is_none() { beside_others(folder, &job.key) } else { folder };
    if args.only == Some(Only::Spectrum) {
        return several::spectrum(job, folder);
    }
    let mut progress = ProgressDisplay::new(&job, foreground::interrupt());
    match inspect_job(args, &study, &job, &folder, &options(args), &mut progress)? {
        Ok(()) => Ok(exit::SUCCESS),
        Err(error) => exit_code(error),
    }
}

/// What is recorded of a job.
fn options(args: &Args) -> Options {
    let nodes = args.places(&NodeSelector::DEFAULT);
    Options { nodes, cycles: args.cycles.into(), frames: args.frames.into() }
}

/// Inspects a job, writes the results, and prints the path of the page.
fn inspect_job(
    args: &Args,
    study: &Study,
    job: &SelectedJob,
    folder: &Path,
    options: &Options,
    progress: &mut ProgressDisplay,
) -> Result<Result<(), InspectionError>, CliError> {
    let inspection = match in_folder(folder, || {
        Inspection::run(&job.spec, options, &mut |simulated_s| progress.update(simulated_s))
    })? {
        Ok(inspection) => inspection,
        Err(error) => return Ok(Err(error)),
    };
    progress.bar.finish_and_clear();
    let shown = &inspection.survey.windows;
    if shown.has_cycles && shown.cycle_count < options.cycles {
        log(format_args!("{} cycles are shown: the run has no more of the same kind", shown.cycle_count));
    }
    let of_preset = args.preset.map_or_else(String::new, |preset| format!(", preset {}", preset.name()));
    let title = title(study, &job.parameters) + &of_preset;
    let header = PageHeader {
        title,
        made_with: worker::program(),
        key: job.key.clone(),
        sheet: sweep::sheet_of_job(&job.spec, |parameter| origin(args, study, job, parameter)),
    };
    inspect::write(&inspection, folder, &header)?;
    let done = RowState::Done(Box::new(inspection.survey.record.clone()));
    let row = sweep::row_of_job(&job.key, &job.spec, done);
    log(text::of_result(&row, &[Group::Result, Group::Contact], None).trim());
    print(&format!("{}\n", folder.join(inspect::PAGE).display()))?;
    Ok(Ok(()))
}

/// Where the value of a parameter of a job comes from, in a word.
fn origin(args: &Args, study: &Study, job: &SelectedJob, parameter: &Parameter) -> &'static str {
    let is_set =
        |(name, _): &(String, Value)| name == parameter.name && !job.from_scene.contains(&name.as_str());
    if job.parameters.iter().any(is_set) {
        return "job";
    }
    match study.origin(parameter) {
        _ if args.preset.is_some() && is_set_by_presets(parameter) => Origin::Preset.name(),
        // The grid was not asked for a value.
        Origin::Grid => Origin::Study.name(),
        other => other.name(),
    }
}

/// Creates the folder of the results before the work, so that an error is noticed early. If the work fails, the folders
/// that were created are removed, unless they hold files.
fn in_folder<T>(
    folder: &Path,
    work: impl FnOnce() -> Result<T, InspectionError>,
) -> Result<Result<T, InspectionError>, CliError> {
    let missing: Vec<&Path> = folder.ancestors().take_while(|ancestor| !ancestor.exists()).collect();
    let failed = |source| CliError::file(folder, source);
    std::fs::create_dir_all(folder).map_err(failed)?;
    // A folder that exists may be read-only.
    tempfile::tempfile_in(folder).map_err(failed)?;
    let result = work();
    if result.is_err() {
        for folder in missing {
            // This fails if the folder holds files, which is intended.
            let _ = std::fs::remove_dir(folder);
        }
    }
    Ok(result)
}

/// The requested job of a study: by its key, or by parameters.
fn select(args: &Args, study: &Study, job: &[String], db: &Location) -> Result<SelectedJob, CliError> {
    if let [key] = job
        && !key.contains('=')
    {
        if args.preset.is_some() {
            return Err(CliError::Usage(
                "a job that is named by its key has its own mesh, time step and detection; give parameters with --preset"
                    .to_owned(),
            ));
        }
        if key.is_empty() || Parameter::find(key).is_some() {
            let name = if key.is_empty() { "omega_rpm" } else { key };
            return Err(CliError::Usage(format!(
                "JOB: expected a job's key or NAME=VALUE, for example {name}=…; got `{key}`"
            )));
        }
        return Ok(sweep::block_on(sweep::select_by_key(study, &args.study, db, key))?);
    }
    Ok(sweep::select_by_parameters(study, SETTINGS, args.preset, &settings(job)?)?)
}

/// The settings of a job.
fn settings(job: &[String]) -> Result<Vec<(String, String)>, CliError> {
    let settings = job.iter().map(|text| foreground::parse_setting(text)).collect::<Result<_, _>>();
    settings.map_err(|error| CliError::Usage(format!("JOB: {error}, or one key")))
}

fn exit_code(error: InspectionError) -> Result<u8, CliError> {
    match error {
        InspectionError::Node(problem) => Err(CliError::Usage(format!("--node: {problem}"))),
        InspectionError::Job(error) => foreground::exit_code(error),
    }
}

/// Shows the progress of the two runs if standard error is a terminal, and checks for a request to stop.
struct ProgressDisplay {
    bar: ProgressBar,
    interrupt: Interrupt,
    last_s: f64,
    run: u32,
}

impl ProgressDisplay {
    fn new(job: &SelectedJob, interrupt: Interrupt) -> Self {
        let bar = ProgressBar::new((job.spec.run.limit_s * 1e6) as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        Self { bar, interrupt, last_s: 0.0, run: 1 }
    }

    fn update(&mut self, simulated_s: f64) -> ControlFlow<()> {
        if simulated_s < self.last_s {
            // The second run ends at the same time as the first one.
            self.run = 2;
            self.bar.set_length((self.last_s * 1e6) as u64);
        }
        self.last_s = simulated_s;
        self.bar.set_position((simulated_s * 1e6) as u64);
        self.bar.set_message(format!("run {} of 2: {:.2} ms", self.run, simulated_s * 1e3));
        if self.interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Runs the jobs of an overlay on all cores and writes a figure for each node.
fn overlay(args: &Args, study: &Study, db: &Location) -> Result<u8, CliError> {
    let Some((name, list)) = &args.overlay else { return Ok(exit::SUCCESS) };
    let mut texts: Vec<&str> = Vec::new();
    for text in list.split(',').map(str::trim).filter(|text| !text.is_empty()) {
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    if texts.is_empty() {
        return Err(CliError::Usage(format!("--overlay {name}: expected values, for example {name}=2,4,6")));
    }
    if let Some(key) = args.job.iter().find(|text| !text.contains('=')) {
        return Err(CliError::Usage(format!("with --overlay expected NAME=VALUE, not the key `{key}`")));
    }
    let jobs: Vec<SelectedJob> = texts
        .iter()
        .map(|text| {
            let job: Vec<String> = args.job.iter().cloned().chain([format!("{name}={text}")]).collect();
            select(args, study, &job, db)
        })
        .collect::<Result<_, _>>()?;
    log_scene_values(&jobs[0]);
    let places = args.places(&NodeSelector::DEFAULT[..1]);
    let common: Vec<(String, Value)> =
        jobs[0].parameters.iter().filter(|(own, _)| own != name).cloned().collect();
    let preset = args.preset.map_or("", Preset::name);
    let folder = args.out(study, &["overlay", name, &slug(&common), preset]);
    let interrupt = foreground::interrupt();
    let run = |job: &SelectedJob| {
        let label = job.parameters.iter().find(|(own, _)| own == name);
        let label = label.map_or_else(String::new, |(name, value)| assignment(name, value));
        Trace::of_job(&label, &job.spec, &places, &mut |_| {
            if interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    };
    let traces = in_folder(&folder, || jobs.par_iter().map(run).collect::<Result<Vec<Vec<Trace>>, _>>())?;
    let traces = match traces {
        Ok(traces) => traces,
        Err(error) => return exit_code(error),
    };
    let title = title(study, &common);
    for node in 0..places.len() {
        let of_node: Vec<Trace> = traces.iter().map(|of_job| of_job[node].clone()).collect();
        for file in inspect::write_overlay(&title, &of_node, &folder)? {
            print(&format!("{}\n", file.display()))?;
        }
    }
    Ok(exit::SUCCESS)
}

impl Args {
    /// The requested nodes or, without a request, the usual ones; each once.
    fn places(&self, usual: &[NodeSelector]) -> Vec<NodeSelector> {
        let mut places: Vec<NodeSelector> = Vec::new();
        for place in if self.nodes.is_empty() { usual } else { &self.nodes } {
            if !places.contains(place) {
                places.push(place.clone());
            }
        }
        places
    }

    /// The requested folder, or a folder below the study's with a name made of `parts`.
    fn out(&self, study: &Study, parts: &[&str]) -> PathBuf {
        let parts: Vec<&str> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
        let name = if parts.is_empty() { "job".to_owned() } else { value::file_name_part(&parts.join("_")) };
        self.folder.clone().unwrap_or_else(|| self.folder_of(study).join(name))
    }

    /// The requested folder, or the folder of the study's inspections, where its report finds them.
    fn folder_of(&self, study: &Study) -> PathBuf {
        let usual = || Path::new("reports").join(study.name()).join(report::INSPECTIONS);
        self.folder.clone().unwrap_or_else(usual)
    }
}
