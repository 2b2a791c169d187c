//! Which files of a folder can be those of a report that an older version wrote.
//!
//! A report lists its files in its folder. Older versions did not, and a name alone does not tell whose a file is. Names are
//! taken for those of a report only if that report could have made them, and if the folder has the page of a report.

use std::path::Path;

/// What older versions wrote once for each combination of the further parameters, with `-NAME-VALUE` in the name.
const FIGURES: [&str; 5] = ["figure7", "frequency", "regime_map", "frequency_map", "shares"];
/// What older versions wrote under one name only.
const DATA: [&str; 2] = ["figure7.svg", "figure7.csv"];

/// The parameters of these versions.
const PARAMETERS: [&str; 42] = [
    "load_n",
    "ramp_s",
    "track_radius_m",
    "disk_kind",
    "disk_young_modulus_pa",
    "disk_poisson_ratio",
    "disk_density_kg_m3",
    "disk_inner_radius_m",
    "disk_outer_radius_m",
    "disk_thickness_m",
    "disk_element_size_m",
    "disk_coarse_element_size_m",
    "track_arc_deg",
    "target",
    "disk_clock",
    "young_modulus_pa",
    "poisson_ratio",
    "density_kg_m3",
    "elements",
    "nx",
    "ny",
    "nz",
    "size_x_m",
    "size_y_m",
    "size_z_m",
    "clamp_side",
    "clamp_width_m",
    "top",
    "beta2",
    "beta_r_s",
    "safety_factor",
    "time_step_s",
    "limit_s",
    "stop_early",
    "average_last_fraction",
    "cycles",
    "tolerance",
    "drift_tolerance",
    "regime_threshold",
    "decay_observation_s",
    "omega_rpm",
    "mu",
];

/// Whether a file can be one of an older version's report. `name` is the file's name in the folder `of_report`.
pub(super) fn could_be_of_a_report(name: &str, of_report: &Path) -> bool {
    let is_report =
        || ["report.md", "report.html", "jobs.csv"].iter().all(|own| of_report.join(own).is_file());
    (DATA.contains(&name) || is_figure_of_a_combination(name)) && is_report()
}

/// Whether a name is that of a figure with a parameter: `shares-clamp_side-inner_side.svg`, but not `shares-new.svg`.
fn is_figure_of_a_combination(name: &str) -> bool {
    let combination = |stem: &&str| name.strip_prefix(*stem)?.strip_prefix('-')?.strip_suffix(".svg");
    FIGURES.iter().find_map(combination).is_some_and(|words| {
        let parameter = words.split_once('-').map(|(parameter, _)| parameter);
        parameter.is_some_and(|parameter| PARAMETERS.contains(&parameter))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: only names that a report could have made are taken for those of a report.
    #[test]
    fn names_of_others_are_not_taken() {
        for name in
            ["shares-clamp_side-inner_side.svg", "figure7-beta2-0.5.svg", "regime_map-nx-12-nz-4-2.svg"]
        {
            assert!(is_figure_of_a_combination(name), "{name}");
        }
        for name in [
            "shares-new.svg",
            "shares-new-plot.svg",
            "shares.svg",
            "figure7-beta2-0.5.pdf",
            "my-shares-nx-2.svg",
        ] {
            assert!(!is_figure_of_a_combination(name), "{name}");
        }
        let folder = tempfile::tempdir().unwrap();
        assert!(!could_be_of_a_report("figure7.svg", folder.path()), "there is no report");
    }
}
