//! Grids whose jobs repeat each other.
//!
//! On a rigid disk the equations are linear in the displacement but for two cones: contact (gap and pressure ≥ 0) and
//! friction. Both remain what they are when displacements, forces and speeds are multiplied by one factor. So a job with
//! s F and s ω has s times the displacements, stresses and speeds of the job with F and ω, and the same μ*, frequency,
//! shares and N/F. Likewise a job with a E, a ρ and a F has the same displacements and a times the stresses. Together: with
//! all else equal, results depend on ω E/F and on ρ/E alone.

use super::Warning;
use crate::spec::{DiskKind, JobSpec, Strains};
use crate::study::definition::Study;
use crate::study::error::Problem;
use crate::study::validate::assignments;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The parameters that the two groups join.
const JOINED: [&str; 4] = ["omega_rpm", "load_n", "young_modulus_pa", "density_kg_m3"];

/// ω E/F and ρ/E, rounded so that equal ones are equal whatever the order of their operations.
fn groups(spec: &JobSpec) -> [String; 2] {
    let (scene, pin) = (&spec.scene, &spec.scene.pin);
    let speed = scene.disk.omega_rpm * pin.young_modulus_pa / scene.load.force_n;
    [speed, pin.density_kg_m3 / pin.young_modulus_pa].map(|group| format!("{group:.9e}"))
}

/// Whether the equations are those above. Gaps are lengths, some friction laws have a speed or a length, a holder has a
/// mass and a stiffness of its own, and the values of a program are no parameters.
fn has_similarity(spec: &JobSpec) -> bool {
    let scene = &spec.scene;
    let has_scale = scene.contact.law.coefficients().any(|coefficient| !coefficient.is_ratio);
    let is_flat = scene.pin.has_plane_base() && scene.disk.is_plane();
    let has_scale = has_scale || scene.contact.layer().is_some() || !scene.program.is_constant();
    let is_linear = scene.pin.strains == Strains::Small;
    scene.disk.kind == DiskKind::Rigid && is_linear && !has_scale && is_flat && scene.holder.is_ideal()
}

impl Study {
    /// A warning if jobs on a rigid disk repeat others.
    pub(super) fn repetition(&self) -> Option<Warning> {
        let axes = &self.grid.axes;
        let is_joined = |position: usize| JOINED.contains(&axes[position].parameter.name);
        let (joined, others): (Vec<usize>, Vec<usize>) = (0..axes.len()).partition(|at| is_joined(*at));
        if joined.len() < 2 {
            return None;
        }
        let mut first_of: HashMap<(usize, Vec<usize>, [String; 2]), usize> = HashMap::new();
        let mut repeated = 0;
        let mut example = None;
        for (point, spec) in self.specs.iter().enumerate() {
            if !has_similarity(spec) {
                continue;
            }
            let (sample, indices) = self.grid.place_of(point);
            let others = others.iter().map(|&position| indices[position]).collect();
            match first_of.entry((sample, others, groups(spec))) {
                Entry::Occupied(first) => {
                    repeated += 1;
                    example.get_or_insert((*first.get(), point));
                }
                Entry::Vacant(entry) => _ = entry.insert(point),
            }
        }
        let (first, second) = example?;
        let names: Vec<&str> = joined.iter().map(|&position| axes[position].parameter.name).collect();
        let (on, scaled) = if names.iter().all(|name| JOINED[..2].contains(name)) {
            ("ω/F", "stresses, displacements and speeds are in proportion to F")
        } else {
            ("ω E/F and ρ/E", "stresses are in proportion to F")
        };
        let [first, second] = [first, second].map(|point| assignments(&self.grid.parameters_at(point)));
        let axis = &axes[*joined.last()?];
        let problem = Problem {
            field: format!("grid.{}", names.join(" × ")),
            value: None,
            ..self.source.problem_with_name(
                &axis.path(),
                format!(
                    "{repeated} of {} jobs repeat others, because results on a rigid disk depend on {on} alone",
                    self.grid_size()
                ),
            )
        }
        .with_help(format!("{second} repeats {first}: μ*, frequency, shares and N/F are equal, and {scaled}"))
        .with_help("vary one of them, or values that are not in proportion");
        Some(Warning::new("repetition", repeated, problem))
    }
}
