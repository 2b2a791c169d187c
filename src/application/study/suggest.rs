//! Suggestions for misspelt names.

use crate::units::name_and_unit;

/// Least similarity (Jaro–Winkler) of a suggestion; less similar names mislead more often than they help.
const LEAST_SIMILARITY: f64 = 0.75;

/// What people call a quantity, in small letters, and the names that it can have: that of the parameter and that of the field.
#[rustfmt::skip]
const ALIASES: &[(&[&str], &[&str])] = &[
    (&["e", "e_pa", "e_gpa", "e_mpa", "modulus", "youngs_modulus", "young", "elastic_modulus"], &["young_modulus_pa"]),
    (&["nu", "ν", "poisson", "poissons_ratio"], &["poisson_ratio"]),
    (&["rho", "ρ", "density"], &["density_kg_m3"]),
    (&["f", "f_n", "force", "load", "normal_force", "fn", "normal_load"], &["load_n", "force_n"]),
    (&["omega", "ω", "rpm", "speed", "speed_rpm", "n_rpm", "rotation_speed"], &["omega_rpm"]),
    (&["v", "v_m_s", "speed_m_s", "velocity", "velocity_m_s", "sliding_speed", "sliding_speed_m_s", "sliding_velocity"], &["sliding_speed_m_s", "omega_rpm"]),
    (&["r", "r_m", "radius", "radius_m", "track_radius", "wear_track_radius"], &["track_radius_m"]),
    (&["d", "d_m", "diameter", "pin_diameter"], &["diameter_m"]),
    (&["μ", "friction", "friction_coefficient", "cof", "mu_k", "mu_kinetic", "mu_d"], &["mu"]),
    (&["mu_s", "μ_s", "μs", "mus"], &["mu_static"]),
    (&["law"], &["friction_law", "law"]),
    (&["eta", "η"], &["loss_factor"]),
    (&["zeta", "ζ", "damping"], &["damping_ratio", "ratio"]),
    (&["zeta_holder", "holder_zeta", "holder_ratio"], &["holder_damping_ratio", "holder_ratio"]),
    (&["beta_r", "β_r", "beta"], &["beta_r_s"]),
    (&["dt", "time_step", "timestep"], &["time_step_s"]),
    (&["mesh"], &["elements"]),
    (&["height", "height_m", "length_z_m", "lz", "l_z"], &["size_z_m", "size_m"]),
    (&["length", "length_m", "ly", "l_y"], &["size_y_m", "size_m"]),
    (&["width", "width_m", "lx", "l_x"], &["size_x_m", "size_m"]),
    (&["size"], &["size_m", "size_x_m"]),
    (&["clamp_width", "clamp"], &["clamp_width_m", "clamp_side"]),
    (&["mass", "m", "mass_kg", "holder_mass"], &["holder_mass_kg", "mass_kg"]),
    // Of the three directions this is the one in which friction pulls.
    (&["holder_stiffness", "stiffness", "k", "holder_stiffness_n_m", "stiffness_n_m"], &["holder_stiffness_y_n_m", "stiffness_y_n_m"]),
    (&["holder_damping", "c", "holder_damping_n_s_m", "damping_n_s_m"], &["holder_damping_y_n_s_m", "damping_y_n_s_m"]),
];

/// Similarity from which on a name is taken for a misspelt one rather than for a name of something else.
const MISSPELT: f64 = 0.9;

/// The candidate that `wrong` means: one that people call so, or the most similar one, if it is similar enough.
///
/// A candidate is a name with the spellings by which it is recognised.
pub(super) fn nearest<'a>(
    wrong: &str,
    candidates: impl IntoIterator<Item = (&'a str, Vec<String>)>,
) -> Option<&'a str> {
    most_similar(wrong, candidates, LEAST_SIMILARITY)
}

fn most_similar<'a>(
    wrong: &str,
    candidates: impl IntoIterator<Item = (&'a str, Vec<String>)>,
    least: f64,
) -> Option<&'a str> {
    // The sign of micro looks like the Greek letter.
    let wrong = wrong.to_lowercase().replace('µ', "μ");
    let candidates: Vec<_> = candidates.into_iter().collect();
    let meant = ALIASES.iter().filter(|(aliases, _)| aliases.contains(&wrong.as_str()));
    let known = |meant: &&str| candidates.iter().find(|(name, _)| name == meant).map(|(name, _)| *name);
    if let Some(name) = meant.flat_map(|(_, names)| *names).find_map(known) {
        return Some(name);
    }
    candidates
        .iter()
        .map(|(name, spellings)| {
            let score = |spelling: &String| strsim::jaro_winkler(&wrong, &spelling.to_lowercase());
            (*name, spellings.iter().map(score).fold(0.0, f64::max))
        })
        .filter(|(_, score)| *score >= least)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(name, _)| name)
}

/// The name that `wrong` means: one that people call so, or the most similar one, if it is similar enough.
pub fn nearest_name<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest(wrong, names.into_iter().map(|name| (name, vec![name.to_owned()])))
}

/// As [`nearest_name`], but only if `wrong` is hardly a name of something else.
pub fn misspelt_name<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    most_similar(wrong, names.into_iter().map(|name| (name, vec![name.to_owned()])), MISSPELT)
}

/// The question whether `wrong` means a name, with the unit of that name if `wrong` has the same words with another one.
pub(super) fn question(wrong: &str, meant: &str) -> String {
    let (words, unit) = name_and_unit(meant);
    let other = wrong.strip_prefix(words).and_then(|rest| rest.strip_prefix('_'));
    let factor = if other == Some("rad_s") && unit == "rpm" { " (1 rad/s = 9.549 rpm)" } else { "" };
    match other {
        Some(_) if !unit.is_empty() => format!("did you mean `{meant}`? It is in {unit}{factor}"),
        _ => format!("did you mean `{meant}`?"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::PARAMETERS;

    /// Protects: symbols and everyday words lead to the parameter that they mean, and not to one with similar letters.
    #[test]
    fn symbols_lead_to_parameters() {
        let names = || PARAMETERS.iter().map(|parameter| parameter.name);
        for (wrong, right) in [
            ("E", "young_modulus_pa"),
            ("nu", "poisson_ratio"),
            ("radius", "track_radius_m"),
            ("force", "load_n"),
            ("omega", "omega_rpm"),
            ("rpm", "omega_rpm"),
            ("speed", "omega_rpm"),
            ("R", "track_radius_m"),
            ("rho", "density_kg_m3"),
            ("holder_stiffness", "holder_stiffness_y_n_m"),
            ("height_m", "size_z_m"),
            // A misspelt name is still found by its letters.
            ("omega_rmp", "omega_rpm"),
            ("\u{b5}", "mu"),
            ("young_modulus", "young_modulus_pa"),
        ] {
            assert_eq!(nearest_name(wrong, names()), Some(right), "{wrong}");
        }
        // Among other names, an alias means nothing.
        assert_eq!(nearest_name("E", ["run", "work"]), None);
    }

    /// Protects: a name with another unit is answered with the unit of the name that exists, and a misspelt name is not.
    #[test]
    fn another_unit_is_named() {
        for (wrong, meant, words) in [
            ("omega_rad_s", "omega_rpm", "did you mean `omega_rpm`? It is in rpm (1 rad/s = 9.549 rpm)"),
            ("young_modulus_gpa", "young_modulus_pa", "did you mean `young_modulus_pa`? It is in Pa"),
            ("size_z_mm", "size_z_m", "did you mean `size_z_m`? It is in m"),
            ("omega", "omega_rpm", "did you mean `omega_rpm`?"),
            ("omga_rpm", "omega_rpm", "did you mean `omega_rpm`?"),
            ("mu_k", "mu", "did you mean `mu`?"),
        ] {
            assert_eq!(question(wrong, meant), words);
        }
        assert_eq!(format!("{:.3}", 1.0 / crate::units::rad_per_s_from_rpm(1.0)), "9.549");
    }

    /// Protects: every alias leads to a name that exists, and no alias is a name itself or stands twice.
    #[test]
    fn aliases_lead_to_names() {
        let names: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
        let mut seen = std::collections::HashSet::new();
        for (aliases, of) in ALIASES {
            assert!(of.iter().any(|name| names.contains(name)), "{of:?}");
            for alias in *aliases {
                assert!(!names.contains(alias) && seen.insert(alias), "{alias}");
                assert_eq!(alias.to_lowercase(), **alias);
            }
        }
    }
}
