//! Jobs whose clamp has another width on the coarser mesh, so that the two meshes say nothing of each other.

use crate::analysis::clamps_that_differ;
use crate::spec::JobSpec;
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
    /// Its width \[m\] on the coarser mesh.
    pub coarser_width_m: f64,
    /// Number of elements in x, y or z, with the axis, that has the same clamp on both meshes; `None` if none is near.
    pub elements: Option<(usize, char)>,
}

impl OtherClamps {
    /// Finds them.
    pub fn of(jobs: &[Job]) -> Option<Self> {
        // Many jobs have the same pin and clamp.
        let mut known: HashMap<String, Option<[f64; 2]>> = HashMap::new();
        let mut found: Option<Self> = None;
        for Job { spec, .. } in jobs {
            let (pin, clamp) = (&spec.scene.pin, &spec.scene.clamp);
            let way = (spec.run.start, spec.stability, spec.accuracy.is_some());
            let key = format!("{:?} {:?} {:?} {clamp:?} {way:?}", pin.elements, pin.size_m, pin.shape);
            let differ = known.entry(key).or_insert_with(|| clamps_that_differ(spec));
            if let &mut Some([width_m, coarser_width_m]) = differ {
                let first = || Self { jobs: 0, width_m, coarser_width_m, elements: better(spec) };
                found.get_or_insert_with(first).jobs += 1;
            }
        }
        found
    }
}

/// The next number of elements along the clamp's axis of which half have a row of nodes at the edge of the clamp.
fn better(spec: &JobSpec) -> Option<(usize, char)> {
    let pin = &spec.scene.pin;
    let axis = spec.scene.clamp.side.axis_across()?;
    let own = pin.own_elements()?[axis];
    let share = spec.scene.clamp.width_m / pin.extent_m()[axis];
    let has_row = |elements: &usize| {
        let rows = share * (elements / 2) as f64;
        elements.is_multiple_of(2) && rows >= 0.5 && (rows - rows.round()).abs() < 1.0e-6
    };
    Some(((own..=2 * own).find(has_row)?, ['x', 'y', 'z'][axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Start;

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
        assert!(
            (found.width_m - 0.002).abs() < 1e-12 && (found.coarser_width_m - 0.0024).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(OtherClamps::of(&jobs[1..2]), None);
        // The mesh that is named has an error.
        assert_eq!(OtherClamps::of(&[compared([24, 25, 30], 0.002)]), None);
        // Who does not ask is not warned.
        assert_eq!(OtherClamps::of(&[job([20, 25, 30], 0.002, Start::Rest)]), None);
    }
}
