//! Jobs whose clamp has another width on the coarser mesh, so that the two meshes say nothing of each other.

use crate::analysis::ClampWidths;
use crate::spec::{JobSpec, Shape};
use crate::study::Job;
use serde::Serialize;
use std::collections::HashMap;

/// Jobs whose mesh error stays unknown because of their clamp.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherClamps {
    /// Their number.
    pub jobs: usize,
    /// Width \[m\] of the clamp on the mesh of the first of them.
    pub width_m: f64,
    /// Its width \[m\] on the coarser mesh; `None` if no coarser mesh fits.
    pub coarser_width_m: Option<f64>,
    /// Number of elements in x, y or z, with the axis, that has the same clamp on both meshes; `None` if none is near.
    pub elements: Option<(usize, char)>,
}

impl OtherClamps {
    /// Finds them.
    pub fn of<'a>(jobs: impl IntoIterator<Item = &'a Job>) -> Option<Self> {
        // Many jobs have the same pin and clamp.
        let mut known: HashMap<String, Option<ClampWidths>> = HashMap::new();
        let mut found: Option<Self> = None;
        for Job { spec, .. } in jobs {
            let coarser = spec.coarser_elements();
            if coarser.is_empty() {
                continue;
            }
            let key = format!(
                "{:?} {:?} {coarser:?} {}",
                spec.scene.pin,
                spec.scene.clamp,
                spec.accuracy.is_some()
            );
            let widths = *known.entry(key).or_insert_with(|| ClampWidths::of(spec));
            if let Some(ClampWidths { own_m, coarser_m }) = widths.filter(|widths| widths.differ()) {
                let first = || Self {
                    jobs: 0,
                    width_m: own_m,
                    coarser_width_m: coarser_m,
                    elements: better(spec, own_m),
                };
                found.get_or_insert_with(first).jobs += 1;
            }
        }
        found
    }
}

/// The next number of elements across the clamp with which it is the same on both meshes, and as near to what is asked for as on the mesh of
/// the job.
fn better(spec: &JobSpec, on_mesh_m: f64) -> Option<(usize, char)> {
    let axis = spec.scene.clamp.side.axis_across()?;
    let own = spec.scene.pin.own_elements()?;
    let is_same = |&elements: &usize| {
        let mut finer = spec.clone();
        let pin = &mut finer.scene.pin;
        pin.elements[axis] = elements;
        if pin.shape == Shape::Cylinder && axis < 2 {
            // Its elements across are as many in x as in y.
            pin.elements[1 - axis] = elements;
        }
        let off = |width_m: f64| (width_m - spec.scene.clamp.width_m).abs();
        let is_as_near = |widths: &ClampWidths| off(widths.own_m) <= off(on_mesh_m) + 1.0e-9;
        finer.check().is_ok()
            && ClampWidths::of(&finer).filter(is_as_near).is_some_and(|widths| !widths.differ())
    };
    Some(((own[axis] + 1..=2 * own[axis]).find(is_same)?, ['x', 'y', 'z'][axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Accuracy, Element, Start};

    fn job(elements: [usize; 3], width_m: f64, start: Start) -> Job {
        let mut spec = JobSpec::default();
        spec.scene.pin.size_m = [0.008, 0.010, 0.012];
        spec.scene.pin.elements = elements;
        spec.scene.clamp.width_m = width_m;
        spec.run.start = start;
        Job { key: String::new(), spec, parameters: Vec::new() }
    }

    /// Protects: who asks for a mesh error hears before the run that the clamp makes it unknown, and which mesh gives it.
    #[test]
    fn another_clamp_on_the_coarser_mesh_is_found() {
        let compared = |elements, width_m| job(elements, width_m, Start::Compared);
        let jobs =
            [compared([20, 25, 30], 0.002), compared([24, 25, 30], 0.002), compared([20, 25, 30], 0.002)];
        let found = OtherClamps::of(&jobs).unwrap();
        assert_eq!((found.jobs, found.elements), (2, Some((24, 'x'))), "{found:?}");
        let coarser_m = found.coarser_width_m.unwrap();
        assert!((found.width_m - 0.002).abs() < 1e-12 && (coarser_m - 0.0024).abs() < 1e-12, "{found:?}");
        assert_eq!(OtherClamps::of(&jobs[1..2]), None);
        // Who does not ask is not warned.
        assert_eq!(OtherClamps::of(&[job([20, 25, 30], 0.002, Start::Rest)]), None);
    }

    /// Protects: so does who asks for an accuracy, which has no coarser mesh then; and a clamp that no coarser mesh has at all.
    #[test]
    fn a_clamp_without_a_coarser_mesh_is_found() {
        let mut accurate = job([20, 25, 30], 0.002, Start::Nested);
        accurate.spec.accuracy = Some(Accuracy { mu_star: 0.01 });
        let found = OtherClamps::of([&accurate]).unwrap();
        assert_eq!((found.coarser_width_m, found.elements), (None, Some((24, 'x'))), "{found:?}");
        let narrow = OtherClamps::of(&[job([20, 25, 30], 0.0004, Start::Compared)]).unwrap();
        assert_eq!((narrow.coarser_width_m, narrow.elements), (None, Some((40, 'x'))), "{narrow:?}");
    }

    /// Protects: jobs that differ in what decides whether there is a coarser mesh do not take each other's answer, in either order; and a mesh is
    /// named only if it has the same clamp on both meshes.
    #[test]
    fn each_job_has_its_own_answer() {
        let full = job([20, 25, 30], 0.002, Start::Compared);
        let mut selective = full.clone();
        selective.spec.scene.pin.element = Element::Selective;
        for jobs in [[&full, &selective], [&selective, &full]] {
            assert_eq!(OtherClamps::of(jobs).map(|found| found.jobs), Some(1));
        }
        let mut round = job([10, 10, 30], 0.001, Start::Compared);
        let pin = &mut round.spec.scene.pin;
        (pin.shape, pin.diameter_m) = (Shape::Cylinder, Some(0.006));
        if let Some((elements, axis)) = OtherClamps::of([&round]).and_then(|found| found.elements) {
            assert_eq!(axis, 'x');
            round.spec.scene.pin.elements = [elements, elements, 30];
            assert_eq!(OtherClamps::of([&round]), None, "{elements}");
        }
    }
}
