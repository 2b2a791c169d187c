//! The symbols of inputs.

/// Parameters and their symbols; what follows a `_` is a subscript.
const SYMBOLS: [(&str, &str); 24] = [
    ("omega_rpm", "ω"),
    ("mu", "μ"),
    ("load_n", "F"),
    ("ramp_s", "t_F"),
    ("track_radius_m", "R"),
    ("disk_young_modulus_pa", "E_d"),
    ("disk_poisson_ratio", "ν_d"),
    ("disk_density_kg_m3", "ρ_d"),
    ("disk_inner_radius_m", "r_i"),
    ("disk_outer_radius_m", "r_o"),
    ("disk_thickness_m", "h_d"),
    ("young_modulus_pa", "E"),
    ("poisson_ratio", "ν"),
    ("density_kg_m3", "ρ"),
    ("nx", "n_x"),
    ("ny", "n_y"),
    ("nz", "n_z"),
    ("size_x_m", "l_x"),
    ("size_y_m", "l_y"),
    ("size_z_m", "h"),
    ("clamp_width_m", "w"),
    ("beta2", "β₂"),
    ("beta_r_s", "β_R"),
    ("time_step_s", "Δt"),
];

/// The symbol of a parameter; empty if it has none.
pub(super) fn of(name: &str) -> &'static str {
    SYMBOLS.iter().find(|(own, _)| *own == name).map_or("", |(_, symbol)| symbol)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Parameter;

    /// Protects: every symbol belongs to a parameter, and no two have the same one.
    #[test]
    fn symbols_belong_to_parameters() {
        for (number, (name, symbol)) in SYMBOLS.iter().enumerate() {
            assert!(Parameter::find(name).is_some(), "{name}");
            assert!(SYMBOLS[..number].iter().all(|(_, other)| other != symbol), "{symbol}");
        }
    }
}
