//! Friction coefficients between those of the grid, so that modes can be followed from one to the next.

/// The largest step of μ over which modes are followed.
const LARGEST_STEP: f64 = 0.05;

/// Decimals of the friction coefficients that are added.
const DECIMALS: f64 = 1.0e9;

/// A friction coefficient without the last digits of its computation.
pub(super) fn rounded(mu: f64) -> f64 {
    (mu * DECIMALS).round() / DECIMALS
}

/// The friction coefficients to add between those of the grid: equal steps, none larger than [`LARGEST_STEP`].
pub(super) fn ladder(on_grid: &[f64]) -> Vec<f64> {
    let mut sorted = on_grid.to_vec();
    sorted.sort_by(f64::total_cmp);
    let between = |pair: &[f64]| {
        let (low, width) = (pair[0], pair[1] - pair[0]);
        let steps = (width / LARGEST_STEP - 1.0e-9).ceil();
        (1..steps as u32).map(move |step| rounded(low + width * f64::from(step) / steps))
    };
    sorted.windows(2).flat_map(between).collect()
}

#[cfg(test)]
mod tests {
    use super::ladder;

    /// Protects: no step is larger than 0.05, and a grid that is fine enough gets no points.
    #[test]
    fn coarse_grids_are_filled() {
        assert_eq!(ladder(&[0.4, 0.2, 0.25]), [0.3, 0.35]);
        assert_eq!(ladder(&[0.1, 0.15, 0.2]), [0.0; 0]);
        assert_eq!(ladder(&[0.2, 0.32]), [0.24, 0.28]);
        assert_eq!(ladder(&[0.2]), [0.0; 0]);
    }
}
