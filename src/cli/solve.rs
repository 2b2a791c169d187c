//! `tribosweep solve`: one job in the foreground, with its history.

use super::error::CliError;
use super::foreground;
use super::output::{log, print, write_file};
use super::warnings;
use crate::analysis::program::{Hysteresis, Leading};
use crate::analysis::{self, AboveBand, ElasticDisk, JobObserver, JobRecord, Moment, SlidingStability};
use crate::exit;
use crate::publish::value::quantity;
use crate::spec::{FrictionLaw, JobSpec, Scene, Shape};
use crate::study::{Preset, Study};
use crate::sweep::History;
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

/// Solves the job and prints its figures; nothing is stored.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let study = Study::load(&args.study)?;
    let spec = study.single_with_preset(args.preset, &args.settings)?;
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
            print(&if args.json { as_json(&record)? } else { job_line(&spec) + &as_text(&record) })?;
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

/// The most important inputs of a job.
fn job_line(spec: &JobSpec) -> String {
    let Scene { pin, disk, contact, load, holder, .. } = &spec.scene;
    let mesh = match pin.shape {
        Shape::Mesh => pin.mesh_words(),
        Shape::Block | Shape::Cylinder => {
            let [nx, ny, nz] = pin.elements;
            format!("{nx} × {ny} × {nz} elements")
        }
    };
    let law = if contact.law == FrictionLaw::Coulomb {
        String::new()
    } else {
        format!(", friction law {}", contact.law.name())
    };
    let changes = !spec.scene.program.is_constant();
    let others = [
        (!pin.is_plain_block(), ", not an upright block of one material"),
        (changes, ", a speed or a load that changes in time (the largest is given)"),
        (!pin.base.is_flat(), ", a base that is not flat"),
        (contact.layer().is_some(), ", a contact layer"),
        (!disk.is_plane(), ", a disk that is not plane"),
        (!holder.is_ideal(), ", a holder that moves"),
    ];
    let others: String = others.into_iter().filter_map(|(holds, words)| holds.then_some(words)).collect();
    format!(
        "job                    ω = {}, μ = {}, F = {}, E = {}, {mesh}{law}{others}\n",
        quantity(disk.omega_rpm, "rpm"),
        quantity(contact.mu, ""),
        quantity(load.force_n, "N"),
        quantity(pin.young_modulus_pa, "Pa"),
    )
}

/// The most important figures of a record.
pub(crate) fn as_text(record: &JobRecord) -> String {
    let frequency =
        record.frequency_hz.map_or_else(|| "none".to_owned(), |frequency| format!("{frequency:.1} Hz"));
    let growth = record
        .growth_rate_per_s
        .map_or_else(String::new, |rate| format!("growth rate            {rate:.0} 1/s\n"));
    let disk = record.disk.as_ref().map_or_else(String::new, disk_lines);
    let end = match record.steps {
        0 => "without a run".to_owned(),
        steps => {
            format!(
                "after {:.3} ms ({steps} steps of {:.4e} s)",
                record.simulated_s * 1e3,
                record.time_step_s
            )
        }
    };
    let hysteresis = Hysteresis::of(&record.windows).map_or_else(String::new, |found| {
        let unit = if Leading::of(&record.windows) == Leading::Omega { "rpm" } else { "N" };
        let windows = record.windows.len();
        format!(
            "hysteresis             {:.5} at {:.4} {unit}, of {windows} windows\n",
            found.difference, found.at
        )
    });
    let sliding = record.stability.as_ref().map_or_else(String::new, sliding_lines);
    format!(
        "status                 {} {}\n\
         regime                 {}\n\
         mu*                    {:.5} ± {:.5} (at the contact {:.5})\n\
         frequency              {frequency}\n\
         {growth}\
         stick, slip, separated {:.3}, {:.3}, {:.3}\n\
         N/F                    {:.3} to {:.3}\n\
         largest normal stress  {:.4} MPa\n\
         largest slip speed     {:.1} mm/s\n\
         residuals              energy {:.1e}, identities {:.1e}\n\
         {hysteresis}{sliding}{disk}",
        record.outcome.name(),
        end,
        record.regime.name(),
        record.mu_star,
        record.mu_star_se,
        record.mu_star_contact,
        record.stick_share,
        record.slip_share,
        record.separated_share,
        record.n_over_f_min,
        record.n_over_f_max,
        record.sigma_n_max_pa * 1e-6,
        record.slip_speed_max_m_s * 1e3,
        record.energy_residual,
        record.identity_residual(),
    )
}

/// Who decided the status, and the leading mode of steady sliding.
fn sliding_lines(stability: &SlidingStability) -> String {
    let decided = if stability.decided { "the eigenvalues, without a run" } else { "the run" };
    let leading = stability.modes.first().map_or_else(String::new, |mode| {
        format!(
            "leading mode           {:.1} Hz, growth rate {:.1} 1/s, ζ = {:.2e}\n",
            mode.frequency_hz, mode.growth_rate_per_s, mode.damping_ratio
        )
    });
    let above = match stability.above_band {
        AboveBand::Nothing => "all modes of the mesh".to_owned(),
        AboveBand::Damped => format!("up to {:.1} Hz; above, damping wins", stability.band_hz),
        AboveBand::CoarserRun => {
            format!("up to {:.1} Hz; above, by a run on a coarser mesh that decayed", stability.band_hz)
        }
        AboveBand::NotLookedAt => format!("up to {:.1} Hz; not above", stability.band_hz),
    };
    format!("decided by             {decided}\n{leading}looked for modes       {above}\n")
}

/// The mesh of the elastic disk and the convergence of its contact solves.
fn disk_lines(disk: &ElasticDisk) -> String {
    let [columns, rows, layers] = disk.elements;
    let [along, across, down] = disk.track_element_m.map(|edge| edge * 1e3);
    format!(
        "disk                   {columns} × {rows} × {layers} elements in θ, r and z, {along:.2} × {across:.2} × {down:.2} mm \
         under the track, at most {:.1} mm elsewhere; {} to a step\n\
         contact solves         {:.1} sweeps, at most {:.0}; residual {:.0e} of the largest force\n",
        disk.longest_edge_m * 1e3,
        match disk.stages {
            1 => "one stage".to_owned(),
            stages => format!("{stages} stages"),
        },
        disk.sweeps_mean,
        disk.sweeps_max,
        disk.residual_max,
    )
}
