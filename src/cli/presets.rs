//! `tribosweep presets`: the accuracy presets with their measured errors.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::spec::{JobSpec, Scene};
use crate::study::{Evidence, Preset};
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

fn as_text(evidence: &Evidence) -> String {
    let mut text = String::from(
        "preset     elements  safety  tolerance  drift   error of μ*  error of f  error of shares  cost\n",
    );
    for preset in Preset::ALL {
        let _ = write!(
            text,
            "{:<11}{:<10}{:<8}{:<11}{:<8}",
            preset.name(),
            preset.elements_along_shortest_edge(),
            preset.safety_factor(),
            preset.tolerance(),
            preset.drift_tolerance(),
        );
        // A test ensures that every shipped preset has evidence.
        let _ = match evidence.of(preset) {
            Some(measured) => writeln!(
                text,
                "{:<13}{:<12}{:<17}{:.2}",
                format!("{:.1} %", 100.0 * measured.mu_star_error),
                format!("{:.1} %", 100.0 * measured.frequency_error),
                format!("{:.3}", measured.shares_error),
                measured.relative_cost,
            ),
            None => writeln!(text, "not measured"),
        };
    }
    let reference = &evidence.reference;
    let [nx, ny, nz] = reference.elements;
    let speeds: Vec<String> = reference.cases.iter().map(|case| case.omega_rpm.to_string()).collect();
    let ways: String = Preset::ALL.map(way).concat();
    let _ = write!(
        text,
        "\nOn a rigid disk with damping, jobs are solved so (no preset: precision double, start rest, stability simulate):\n{}\n\
         elements: along the pin's shortest edge; the other directions get elements of about the same size, and as\n\
         many more as the clamp needs to end at a node row. safety: time step as a fraction of the stability limit.\n\
         tolerance, drift: of the periodic state. cost: nodes × steps, standard = 1.\n\n\
         Errors: the largest at {} rpm, μ = {}, {}.\n\
         Of μ*: from the limit of fine meshes, which is known to ± {:.1} % from\n\
         {}.\n\
         Of f and shares: from {nx} × {ny} × {nz} elements with a safety factor of {}.\n\
         Other scenes have other errors: compare two presets there.\n\
         Written by {} with solver version {}.\n",
        ways,
        speeds.join(", "),
        evidence.mu,
        evidence.scene,
        100.0 * reference.mu_star_uncertainty,
        reference.mu_star_source,
        reference.safety_factor,
        evidence.written_by,
        evidence.solver_version,
    );
    text
}

/// A line with the way in which a preset solves jobs, by the names of the parameters that change it.
fn way(preset: Preset) -> String {
    let settings = settings(preset);
    let value = |name: &str| format!("{name} {}", settings[name].as_str().unwrap_or_default());
    let values = ["precision", "start", "stability"].map(value).join(", ");
    format!("{:<11}{values}\n", preset.name())
}
