//! `tribosweep presets`: the accuracy presets with their measured errors.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::table::{Column, Table, listed};
use crate::publish::value;
use crate::spec::{JobSpec, Scene};
use crate::study::{Evidence, Preset, PresetEvidence};
use serde_json::{Value, json};
use std::fmt::Write;

/// Arguments of `presets`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print the settings and all measurements as JSON.
    #[arg(long)]
    json: bool,
}

/// Prints the presets.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let evidence = Evidence::measured();
    let text = if args.json {
        format!("{:#}\n", json!({ "presets": Preset::ALL.map(settings), "evidence": evidence }))
    } else {
        as_text(&evidence)
    };
    print(&text)?;
    Ok(exit::SUCCESS)
}

/// The settings of a preset, with its mesh for the reference scene.
fn settings(preset: Preset) -> Value {
    let scene = Scene::default();
    let job = preset.way(JobSpec::default());
    json!({
        "name": preset.name(),
        "elements_along_shortest_edge": preset.elements_along_shortest_edge(),
        "elements": preset.elements(&scene.pin, &scene.clamp),
        "safety_factor": preset.safety_factor(),
        "tolerance": preset.tolerance(),
        "drift_tolerance": preset.drift_tolerance(),
        "precision": job.numerics.precision,
        "start": job.run.start,
        "stability": job.stability,
    })
}

/// A preset with what was measured of it. A test ensures that every shipped preset has evidence.
type Measured<'a> = (Preset, Option<&'a PresetEvidence>);

fn columns<'a>() -> [Column<Measured<'a>>; 9] {
    [
        Column::new("preset", "", "", |(preset, _)| preset.name().into()),
        Column::new("elements", "", "", |(preset, _)| preset.elements_along_shortest_edge().into()),
        Column::new("safety", "", "", |(preset, _)| preset.safety_factor().into()),
        Column::new("tolerance", "", "", |(preset, _)| preset.tolerance().into()),
        Column::new("drift", "", "", |(preset, _)| preset.drift_tolerance().into()),
        Column::new("error of μ*", "", "", |(_, of)| of.map(|of| percent(of.mu_star_error)).into()),
        Column::new("error of f", "", "", |(_, of)| of.map(|of| percent(of.frequency_error)).into()),
        Column::new("error of shares", "", "", |(_, of)| {
            of.map(|of| format!("{:.3}", of.shares_error)).into()
        }),
        Column::new("cost", "", "", |(_, of)| of.map(|of| format!("{:.2}", of.relative_cost)).into()),
    ]
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn as_text(evidence: &Evidence) -> String {
    let measured = Preset::ALL.map(|preset| (preset, evidence.of(preset)));
    let mut text = Table::of("presets", &columns(), &measured).text();
    let reference = &evidence.reference;
    let [nx, ny, nz] = reference.elements;
    let speeds: Vec<String> = reference.cases.iter().map(|case| case.omega_rpm.to_string()).collect();
    let ways = listed(0, &Preset::ALL.map(way), None);
    let _ = write!(
        text,
        "\nOn a rigid disk with damping, jobs are solved so (no preset: precision double, start rest, stability simulate):\n{}\n\
         elements: along the pin's shortest edge; the other directions get elements of about the same size, and as\n\
         many more as the clamp needs to end at a node row. safety: time step as a fraction of the stability limit.\n\
         tolerance, drift: of the periodic state. cost: nodes × steps, standard = 1.\n\n\
         Errors: the largest at {} rpm, μ = {}, β_R = {}, {}.\n\
         Of μ*: from the limit of fine meshes, which is known to ± {:.1} % from\n\
         {}.\n\
         Of f and shares: from {nx} × {ny} × {nz} elements with a safety factor of {}.\n\
         Other scenes have other errors: compare two presets there.\n\
         Written by {} with solver version {}.\n",
        ways,
        speeds.join(", "),
        evidence.mu,
        value::quantity(evidence.beta_r_s, "s"),
        evidence.scene,
        100.0 * reference.mu_star_uncertainty,
        reference.mu_star_source,
        reference.safety_factor,
        evidence.written_by,
        evidence.solver_version,
    );
    text
}

/// The preset, and the way in which it solves jobs by the names of the parameters that change it.
fn way(preset: Preset) -> [String; 2] {
    let settings = settings(preset);
    let value = |name: &str| format!("{name} {}", settings[name].as_str().unwrap_or_default());
    [preset.name().to_owned(), ["precision", "start", "stability"].map(value).join(", ")]
}
