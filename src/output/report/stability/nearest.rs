//! Whether the modes explain a frequency at which a machine squeals.

use crate::analysis::ComplexMode;
use crate::publish::value::{quantity, significant};
use crate::report::parameters::assignments;
use crate::report::stability_point::StabilityPoint;

/// A computed frequency explains a measured one within this share of it: a limit cycle has not exactly the frequency of the mode that starts
/// it, and a scene never has exactly the stiffness of the machine.
pub(in crate::report) const NEAR: f64 = 0.1;

/// Whether a known mode near a frequency \[Hz\] grows at one of the points, in words; `None` without any mode.
pub fn nearest_in_words<'a>(
    points: impl IntoIterator<Item = &'a StabilityPoint>,
    near_hz: f64,
) -> Option<String> {
    let points: Vec<&StabilityPoint> = points.into_iter().collect();
    let away = |mode: &ComplexMode| (mode.frequency_hz - near_hz).abs();
    let is_near = |mode: &&ComplexMode| away(mode) <= NEAR * near_hz;
    let nearest = |only_growing: bool| {
        let modes =
            points.iter().flat_map(|point| point.stability.modes.iter().map(move |mode| (*point, mode)));
        let found = modes.filter(|(_, mode)| !only_growing || mode.grows());
        found.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)))
    };
    let any = nearest(false)?;
    // A vibration that grows faster hides the one that is looked for.
    let leading = points.iter().filter_map(|point| Some((*point, point.leading()?)));
    let fastest = leading.max_by(|(_, a), (_, b)| a.growth_rate_per_s.total_cmp(&b.growth_rate_per_s));
    let faster = fastest.filter(|(_, mode)| mode.grows() && !is_near(mode));
    let faster = faster.map(|found| format!("The fastest growing mode has {}.", in_words(found)));
    let some = |places: usize| match points.len() {
        1 => "the only point of the grid".to_owned(),
        of => format!("{places} of {of} points of the grid"),
    };
    let any_of = match points.len() {
        1 => "the only point of the grid".to_owned(),
        of => format!("any of {of} points of the grid"),
    };
    let near = format!("within {} % of {}", significant(100.0 * NEAR, 2), quantity(near_hz, "Hz"));
    if let Some(found) = nearest(true).filter(|(_, mode)| is_near(mode)) {
        let has =
            |point: &StabilityPoint| point.stability.modes.iter().any(|mode| is_near(&mode) && mode.grows());
        let places = points.iter().filter(|point| has(point)).count();
        let head =
            format!("A mode {near} grows at {}. The nearest one has {}.", some(places), in_words(found));
        return Some([Some(head), faster].into_iter().flatten().collect::<Vec<_>>().join(" "));
    }
    let band_hz = points.iter().map(|point| point.stability.band_hz).fold(0.0, f64::max);
    let advice = if near_hz * (1.0 - NEAR) > band_hz {
        Some(format!("Modes were looked for up to {} only.", quantity(band_hz, "Hz")))
    } else {
        (!is_near(&any.1))
            .then(|| "Look at what the scene leaves out, such as a holder that moves or rocks.".to_owned())
    };
    let head =
        format!("No known mode {near} grows at {any_of}. The nearest known mode has {}.", in_words(any));
    Some([Some(head), faster, advice].into_iter().flatten().collect::<Vec<_>>().join(" "))
}

fn in_words((point, mode): (&StabilityPoint, &ComplexMode)) -> String {
    let rate = mode.growth_rate_per_s.abs();
    let verb = if mode.grows() { "grows" } else { "decays" };
    let is_unsure = mode.growth_rate_mesh_error_per_s.is_some_and(|error| error >= rate);
    let doubt = match (mode.is_converged, is_unsure) {
        (false, _) => " (not converged)",
        (true, true) if mode.grows() => ", less than its mesh error: it may decay",
        (true, true) => ", less than its mesh error: it may grow",
        (true, false) => "",
    };
    let place = assignments(point.parameters.iter());
    let frequency = quantity(mode.frequency_hz, "Hz");
    format!("{frequency} at {place}, where it {verb} at {} 1/s{doubt}", significant(rate, 3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::SlidingStability;
    use crate::report::parameters::Parameters;

    fn point(mu: f64, modes: &[(f64, f64)]) -> StabilityPoint {
        let modes =
            modes.iter().map(|&(frequency_hz, growth)| ComplexMode::of(frequency_hz, growth)).collect();
        StabilityPoint {
            parameters: Parameters::new(20.0, mu, Vec::new()),
            on_grid: true,
            stands_alone: None,
            stability: SlidingStability { modes, ..SlidingStability::example() },
        }
    }

    /// Protects: a mode that grows near the frequency is named before a nearer one that decays; one that decays and one that is far away
    /// explain nothing.
    #[test]
    fn a_measured_frequency_is_explained_by_a_mode_that_grows() {
        let said = |points: &[StabilityPoint], near_hz| nearest_in_words(points, near_hz).unwrap();
        let points = [point(0.2, &[(11_000.0, -50.0)]), point(0.4, &[(11_500.0, 240.0), (30_000.0, 900.0)])];
        assert_eq!(
            said(&points, 11_000.0),
            "A mode within 10 % of 11 kHz grows at 1 of 2 points of the grid. The nearest one has 11.5 kHz at ω = 20 rpm, μ = 0.4, where it grows \
             at 240 1/s. The fastest growing mode has 30 kHz at ω = 20 rpm, μ = 0.4, where it grows at 900 1/s."
        );
        assert_eq!(
            said(&points[..1], 11_000.0),
            "No known mode within 10 % of 11 kHz grows at the only point of the grid. The nearest known mode has 11 kHz at ω = 20 rpm, μ = 0.2, \
             where it decays at 50 1/s."
        );
        assert!(
            said(&points, 20_000.0)
                .ends_with("Look at what the scene leaves out, such as a holder that moves or rocks.")
        );
        // The band of the points ends at 50 kHz.
        assert!(said(&points, 80_000.0).ends_with("Modes were looked for up to 50 kHz only."));
        assert_eq!(nearest_in_words(&[point(0.2, &[])], 11_000.0), None);
    }
}
