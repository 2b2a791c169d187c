//! `tribosweep inspect`: one job looked into.

use super::error::CliError;
use super::output::{block_on, print, tell};
use super::{foreground, rows, solve};
use crate::exit;
use crate::inspect::{self, Inspection, InspectionError, NodeSelector, Options, PageHeader, Trace};
use crate::publish::value;
use crate::queue::Location;
use crate::report::assignment;
use crate::solver;
use crate::spec::JobSpec;
use crate::study::{Parameter, Preset, Study};
use crate::worker::{self, Interrupt};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's file, or the name of one in the database.
    study: String,
    /// The job's key, or the first characters of it; or NAME=VALUE for each parameter that is not to have the value of
    /// the study's scene.
    job: Vec<String>,
    /// Take mesh, time step and detection from a preset instead of the study.
    #[arg(long, value_name = "NAME", value_parser = foreground::parse_preset)]
    preset: Option<Preset>,
    /// A node of the contact face to follow, by its name (front_centre, rear_centre, centre, inner_centre, outer_centre,
    /// front_inner, front_outer, rear_inner, rear_outer) or as X,Y in mm from the pin's axis; may be repeated. Default:
    /// front_centre and rear_centre.
    #[arg(long = "node", value_name = "NODE", value_parser = NodeSelector::parse, allow_hyphen_values = true)]
    nodes: Vec<NodeSelector>,
    /// Lay several jobs over each other that differ in a parameter: normal and tangential stress at the nodes.
    #[arg(long, value_name = "NAME=VALUE,VALUE,…", value_parser = foreground::parse_setting)]
    overlay: Option<(String, String)>,
    /// Number of cycles to show.
    #[arg(long, value_name = "N", conflicts_with = "overlay", default_value_t = Options::default().cycles as u16,
          value_parser = clap::value_parser!(u16).range(Options::FEWEST_CYCLES as i64..=100))]
    cycles: u16,
    /// Number of times of a cycle at which the whole pin is written for ParaView.
    #[arg(long, value_name = "N", conflicts_with = "overlay", default_value_t = Options::default().frames as u16,
          value_parser = clap::value_parser!(u16).range(Options::FEWEST_FRAMES as i64..=1000))]
    frames: u16,
    /// Folder for what is found; default: reports/STUDY/JOB.
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,
}

/// What messages call the parameters of a job.
const GIVEN: &str = "NAME=VALUE";

/// A job with the parameters that tell it from others.
struct Picked {
    spec: JobSpec,
    parameters: Vec<(String, Value)>,
    /// Names of the parameters that nobody gave a value.
    own: Vec<&'static str>,
}

impl Picked {
    /// Says which values are those of the study's scene.
    fn tell_own(&self) {
        let own = self.parameters.iter().filter(|(name, _)| self.own.contains(&name.as_str()));
        let words: Vec<String> = own.map(|(name, value)| assignment(name, value)).collect();
        if !words.is_empty() {
            tell(format_args!("from the study's scene: {}", words.join(", ")));
        }
    }
}

/// A study with parameters in words.
fn title(study: &Study, parameters: &[(String, Value)]) -> String {
    let words: Vec<String> = parameters.iter().map(|(name, value)| assignment(name, value)).collect();
    if words.is_empty() { study.name().to_owned() } else { format!("{}: {}", study.name(), words.join(", ")) }
}

/// Parameters as a file's name, which may be empty.
fn slug(parameters: &[(String, Value)]) -> String {
    let parts = parameters.iter().map(|(name, value)| format!("{name}-{}", value::text(value)));
    value::file_name_part(&parts.collect::<Vec<_>>().join("_"))
}

/// Runs the job twice and writes what is found.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let study = study(&args.study, db)?;
    if args.overlay.is_some() {
        return overlay(args, &study);
    }
    let picked = pick(args, &study, &args.job)?;
    picked.tell_own();
    let places = args.places(&NodeSelector::DEFAULT);
    let options = Options { nodes: places, cycles: args.cycles.into(), frames: args.frames.into() };
    let preset = args.preset.map(Preset::name);
    let folder = args.out(&study, &[&slug(&picked.parameters), preset.unwrap_or("")]);
    let mut pace = Pace::new(&picked, foreground::interrupt());
    let inspection = match in_folder(&folder, || {
        Inspection::run(&picked.spec, &options, &mut |simulated_s| pace.go_on(simulated_s))
    })? {
        Ok(inspection) => inspection,
        Err(error) => return ended(error),
    };
    pace.bar.finish_and_clear();
    let shown = &inspection.survey.windows;
    if shown.has_cycles && shown.cycle_count < options.cycles {
        tell(format_args!("{} cycles are shown: there are no more like them", shown.cycle_count));
    }
    let of_preset = preset.map_or_else(String::new, |name| format!(", preset {name}"));
    let title = title(&study, &picked.parameters) + &of_preset;
    let header = PageHeader { title, made_with: worker::program() };
    inspect::write(&inspection, &folder, &header)?;
    tell(solve::as_text(&inspection.survey.record).trim_end());
    print(&format!("{}\n", folder.join(inspect::PAGE).display()))?;
    Ok(exit::SUCCESS)
}

/// Creates a folder that results will go to, so that one that cannot be written is noticed before the work; without
/// results it is gone again, unless something is in it.
fn in_folder<T>(
    folder: &Path,
    work: impl FnOnce() -> Result<T, InspectionError>,
) -> Result<Result<T, InspectionError>, CliError> {
    let missing: Vec<&Path> = folder.ancestors().take_while(|ancestor| !ancestor.exists()).collect();
    let failed = |source| CliError::File { path: folder.display().to_string(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    // Who may enter a folder may not always write into it.
    try_to_write(folder).map_err(failed)?;
    let found = work();
    if found.is_err() {
        for folder in missing {
            // Not if there is anything in it.
            let _ = std::fs::remove_dir(folder);
        }
    }
    Ok(found)
}

/// Creates a file in a folder and removes it.
fn try_to_write(folder: &Path) -> std::io::Result<()> {
    let path = folder.join(format!(".inspect.{}.tmp", std::process::id()));
    std::fs::File::create(&path)?;
    std::fs::remove_file(&path)
}

/// The study in a file, or the one in the database as it was submitted.
fn study(study: &str, db: &Location) -> Result<Study, CliError> {
    let path = Path::new(study);
    if path.extension().is_some_and(|extension| extension == "json") {
        return Ok(Study::load(path)?);
    }
    let document = block_on(async {
        let mut queue = rows::open(db).await?;
        let found = queue.study(study).await?;
        // Asking for the counts of a study that is not there says which there are.
        queue.counts(&crate::queue::Scope::Study(study.to_owned())).await?;
        queue.close().await?;
        Ok(found)
    })?;
    document.map_or_else(
        || Err(CliError::Plan(format!("there is no study {study}"))),
        |found| Ok(Study::parse(&found.document, study)?),
    )
}

/// The job that is asked for: by its key, or by parameters.
fn pick(args: &Args, study: &Study, job: &[String]) -> Result<Picked, CliError> {
    if let [key] = job
        && !key.contains('=')
    {
        if args.preset.is_some() {
            return Err(CliError::Plan(
                "a job that is named by its key has its own mesh, time step and detection; give parameters with --preset"
                    .to_owned(),
            ));
        }
        return by_key(study, key);
    }
    let settings: Vec<(String, String)> = job
        .iter()
        .map(|text| foreground::parse_setting(text))
        .collect::<Result<_, _>>()
        .map_err(|error| CliError::Plan(format!("JOB: {error}, or one key")))?;
    let (spec, own) = study.single_on_base(GIVEN, args.preset, &settings)?;
    let names: Vec<&str> = study
        .axes()
        .map(|(parameter, _)| parameter.name)
        .chain(settings.iter().map(|(name, _)| name.as_str()))
        .collect();
    Ok(Picked { parameters: values(&spec, &names)?, spec, own })
}

fn by_key(study: &Study, key: &str) -> Result<Picked, CliError> {
    if key.is_empty() || Parameter::find(key).is_some() {
        let name = if key.is_empty() { "omega_rpm" } else { key };
        return Err(CliError::Plan(format!(
            "JOB: expected a job's key or NAME=VALUE, for example {name}=…; got `{key}`"
        )));
    }
    let jobs = study.expand(solver::VERSION)?;
    let mut found = jobs.into_iter().filter(|job| job.key.starts_with(key));
    match (found.next(), found.next()) {
        (Some(job), None) => Ok(Picked { spec: job.spec, parameters: job.parameters, own: Vec::new() }),
        (None, _) => Err(CliError::Plan(format!(
            "no job of {} has a key that begins with `{key}`; `tribosweep export` lists keys, and parameters do as well: \
             omega_rpm=7 mu=0.4",
            study.name()
        ))),
        (Some(one), Some(other)) => Err(CliError::Plan(format!(
            "several jobs of {} begin with `{key}`: {}, {}, …; give more of the key",
            study.name(),
            one.key,
            other.key
        ))),
    }
}

/// The values of parameters in a job, each once.
fn values(spec: &JobSpec, names: &[&str]) -> Result<Vec<(String, Value)>, CliError> {
    let job = serde_json::to_value(spec).map_err(|error| CliError::Unreadable(error.to_string()))?;
    let mut values: Vec<(String, Value)> = Vec::new();
    for name in names {
        if let Some(parameter) = Parameter::find(name)
            && !values.iter().any(|(known, _)| known == name)
        {
            let value = job.pointer(parameter.pointer).cloned().unwrap_or_default();
            values.push(((*name).to_owned(), value));
        }
    }
    Ok(values)
}

fn ended(error: InspectionError) -> Result<u8, CliError> {
    match error {
        InspectionError::Node(problem) => Err(CliError::Plan(format!("--node: {problem}"))),
        InspectionError::Job(error) => foreground::ended(error),
    }
}

/// Shows how far a run is, where stderr is a terminal, and hears the request to stop.
struct Pace {
    bar: ProgressBar,
    interrupt: Interrupt,
    last_s: f64,
    run: u32,
}

impl Pace {
    fn new(picked: &Picked, interrupt: Interrupt) -> Self {
        let bar = ProgressBar::new((picked.spec.run.limit_s * 1e6) as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        Self { bar, interrupt, last_s: 0.0, run: 1 }
    }

    fn go_on(&mut self, simulated_s: f64) -> ControlFlow<()> {
        if simulated_s < self.last_s {
            // The second run ends where the first did.
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
fn overlay(args: &Args, study: &Study) -> Result<u8, CliError> {
    let Some((name, list)) = &args.overlay else { return Ok(exit::SUCCESS) };
    let mut texts: Vec<&str> = Vec::new();
    for text in list.split(',').map(str::trim).filter(|text| !text.is_empty()) {
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    if texts.is_empty() {
        return Err(CliError::Plan(format!("--overlay {name}: expected values, for example {name}=2,4,6")));
    }
    if let Some(key) = args.job.iter().find(|text| !text.contains('=')) {
        return Err(CliError::Plan(format!("with --overlay expected NAME=VALUE, not the key `{key}`")));
    }
    let picked: Vec<Picked> = texts
        .iter()
        .map(|text| {
            let job: Vec<String> = args.job.iter().cloned().chain([format!("{name}={text}")]).collect();
            pick(args, study, &job)
        })
        .collect::<Result<_, _>>()?;
    picked[0].tell_own();
    let places = args.places(&NodeSelector::DEFAULT[..1]);
    let common: Vec<(String, Value)> =
        picked[0].parameters.iter().filter(|(own, _)| own != name).cloned().collect();
    let preset = args.preset.map_or("", Preset::name);
    let folder = args.out(study, &["overlay", name, &slug(&common), preset]);
    let interrupt = foreground::interrupt();
    let run = |picked: &Picked| {
        let label = picked.parameters.iter().find(|(own, _)| own == name);
        let label = label.map_or_else(String::new, |(name, value)| assignment(name, value));
        Trace::of_job(&label, &picked.spec, &places, &mut |_| {
            if interrupt.is_raised() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    };
    let traces = in_folder(&folder, || picked.par_iter().map(run).collect::<Result<Vec<Vec<Trace>>, _>>())?;
    let traces = match traces {
        Ok(traces) => traces,
        Err(error) => return ended(error),
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
    /// The nodes that are asked for, each once.
    fn places(&self, usual: &[NodeSelector]) -> Vec<NodeSelector> {
        let mut places: Vec<NodeSelector> = Vec::new();
        for place in if self.nodes.is_empty() { usual } else { &self.nodes } {
            if !places.contains(place) {
                places.push(place.clone());
            }
        }
        places
    }

    /// The folder that is asked for, or one of the study's with a name of these parts.
    fn out(&self, study: &Study, parts: &[&str]) -> PathBuf {
        let parts: Vec<&str> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
        let name = if parts.is_empty() { "job".to_owned() } else { value::file_name_part(&parts.join("_")) };
        self.folder.clone().unwrap_or_else(|| Path::new("reports").join(study.name()).join(name))
    }
}
