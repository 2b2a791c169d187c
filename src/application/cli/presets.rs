//! `tribosweep presets`: the accuracy presets with their measured errors.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::table::{Column, Table, listed};
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
        "accuracy": preset.accuracy(),
        "precision": job.numerics.precision,
        "start": job.run.start,
        "stability": job.stability,
    })
}

/// A preset with what was measured of it; none if it asks for an accuracy.
type Measured<'a> = (Preset, Option<&'a PresetEvidence>);

fn columns<'a>() -> [Column<Measured<'a>>; 9] {
    [
        Column::new("preset", "", "", |(preset, _)| preset.name().into()),
        Column::new("elements", "", "", |(preset, _)| preset.elements_along_shortest_edge().into()),
        Column::new("safety", "", "", |(preset, _)| preset.safety_factor().into()),
        Column::new("tolerance", "", "", |(preset, _)| preset.tolerance().into()),
        Column::new("drift", "", "", |(preset, _)| preset.drift_tolerance().into()),
        Column::new("asked of μ*", "", "", |(preset, _)| {
            preset.accuracy().map(|asked| share(asked.mu_star)).into()
        }),
        Column::new("error of μ*", "", "", |(_, of)| {
            of.map(|of| format!("{}, {}", share(of.mu_star_median), share(of.mu_star_95))).into()
        }),
        Column::new("error of f", "", "", |(_, of)| {
            of.map(|of| format!("{}, {}", share(of.frequency_median), share(of.frequency_95))).into()
        }),
        Column::new("cost", "", "", |(_, of)| of.map(|of| format!("{:.2}", of.relative_cost)).into()),
    ]
}

fn share(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn as_text(evidence: &Evidence) -> String {
    let measured = Preset::ALL.map(|preset| (preset, evidence.of(preset)));
    let mut text = Table::of("presets", &columns(), &measured).text();
    let ways = listed(0, &Preset::ALL.map(way), None);
    let _ = write!(
        text,
        "\nOn a rigid disk with damping, jobs are solved so (no preset: precision double, start rest, stability simulate):\n{}\n\
         elements: along the pin's shortest edge; the other directions get elements of about the same size, and as\n\
         many more as the clamp needs to end at a node row. safety: time step as a fraction of the stability limit.\n\
         tolerance, drift: of the periodic state. asked: the job goes from mesh to mesh, up to that of the table, until its\n\
         own error of μ* is within this share. cost: nodes × steps, standard = 1.\n\n\
         Errors: the median, and what 95 % of limit cycles are within, against the limit of fine meshes in {} scenes\n\
         (docs/evidence/mesh_errors.md). They are not bounds for your scene: each result has its own, as mu_star_mesh_error.\n\
         Written by {}.\n",
        ways, evidence.scenes, evidence.written_by,
    );
    text
}

/// The preset, and the way in which it solves jobs by the names of the parameters that change it.
fn way(preset: Preset) -> [String; 2] {
    let settings = settings(preset);
    let value = |name: &str| format!("{name} {}", settings[name].as_str().unwrap_or_default());
    [preset.name().to_owned(), ["precision", "start", "stability"].map(value).join(", ")]
}
