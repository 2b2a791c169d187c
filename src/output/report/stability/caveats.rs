//! What a reader should know beside modes and thresholds, in sentences.

use crate::publish::value;
use crate::report::stability_point::StabilityPoint;

/// The highest frequency that people hear.
const HEARD_HZ: f64 = 20_000.0;

/// What is known above the frequencies up to which modes were looked for, in a sentence; none if nothing can grow there at any
/// point.
pub(in crate::report) fn above_band(points: &[StabilityPoint]) -> Option<String> {
    let open = points.iter().filter(|point| !point.stability.above_band.is_known());
    let bands: Vec<f64> = open.map(|point| point.stability.band_hz).collect();
    let (low, high) =
        bands.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &hz| (low.min(hz), high.max(hz)));
    let words = |hz: f64| value::quantity(hz, "Hz");
    let band = if words(low) == words(high) {
        words(low)
    } else {
        format!("{} (for some points {})", words(low), words(high))
    };
    (!bands.is_empty()).then(|| {
        let at = if bands.len() == points.len() {
            String::new()
        } else {
            format!(" at {} of {}", bands.len(), value::count(points.len() as u32, "point"))
        };
        let heard = if low >= HEARD_HZ { " (not audible)" } else { "" };
        format!(
            "Above {band}{heard} no modes were looked for{at}: a mode may grow there. Below it, all modes were looked for, and the fastest growing ones are kept."
        )
    })
}

/// That most nodes of the base do not touch the disk, in a sentence; none if at each point most of them do.
pub(in crate::report) fn small_contact(points: &[StabilityPoint]) -> Option<String> {
    let nodes = |point: &StabilityPoint| (point.stability.lifted_nodes, point.stability.contact_nodes);
    let small_contact = points.iter().map(nodes).filter(|(lifted, touching)| lifted > touching);
    let (least, all) = small_contact.clone().map(|(lifted, touching)| (touching, lifted + touching)).min()?;
    Some(format!(
        "At {} of {} most nodes of the base do not touch the disk (down to {least} of {all} do): there the shape of the base and the mesh decide.",
        small_contact.count(),
        value::count(points.len() as u32, "point")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{AboveBand, SlidingStability, UnknownError};
    use crate::report::parameters::Parameters;

    fn point(band_hz: f64, above_band: AboveBand, touching: usize, lifted: usize) -> StabilityPoint {
        let stability = SlidingStability {
            band_hz,
            above_band,
            contact_nodes: touching,
            lifted_nodes: lifted,
            ..SlidingStability::example()
        };
        let parameters = Parameters::new(1.0, 0.1, Vec::new());
        StabilityPoint {
            parameters,
            on_grid: true,
            stands_alone: Some(UnknownError::NoCoarserMesh),
            stability,
        }
    }

    /// Protects: where nobody looked is said, with the frequencies and the number of points; nothing is said where no mode can grow.
    #[test]
    fn what_nobody_looked_for_is_said() {
        let of = |bands: &[f64]| {
            let open = bands.iter().map(|&band_hz| point(band_hz, AboveBand::NotLookedAt, 9, 0));
            above_band(&open.collect::<Vec<_>>()).unwrap()
        };
        let all = "Above 50 kHz (not audible) no modes were looked for: a mode may grow there. Below it, all modes were looked for, and the fastest growing ones are kept.";
        assert_eq!(of(&[5.0e4, 5.0e4]), all);
        assert_eq!(of(&[1.0e4]), all.replace("50 kHz (not audible)", "10 kHz"));
        let two = of(&[5.0e4, 5.5e4]);
        assert!(two.starts_with("Above 50 kHz (for some points 55 kHz) (not audible) no modes"), "{two}");
        let known = point(5.0e4, AboveBand::Damped, 9, 0);
        let some = above_band(&[known.clone(), point(5.0e4, AboveBand::NotLookedAt, 9, 0)]).unwrap();
        assert!(some.contains("no modes were looked for at 1 of 2 points:"), "{some}");
        assert_eq!(above_band(&[known]), None);
    }

    /// Protects: a base of which few nodes touch is named, with the point at which the fewest do.
    #[test]
    fn a_small_contact_is_named() {
        let point = |touching, lifted| point(5.0e4, AboveBand::Damped, touching, lifted);
        let found = small_contact(&[point(9, 8), point(4, 12), point(3, 14)]).unwrap();
        let expected = "At 2 of 3 points most nodes of the base do not touch the disk (down to 3 of 17 do)";
        assert!(found.starts_with(expected), "{found}");
        assert_eq!(small_contact(&[point(9, 9), point(17, 0)]), None);
    }
}
