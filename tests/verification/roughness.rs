//! B20 A rough base, from a spectrum and from measured heights.
//!
//! * **From a spectrum** it is a function of the position alone. So on a mesh of twice as many elements the gaps of the common
//!   nodes differ by one number, which is the height of the lowest node.
//! * **From a map** whose points are the nodes it is that map. The heights of a sine wave give the gaps of the wave base.

use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::spec::{Base, HeightMap, JobSpec, Roughness};

const RMS_M: f64 = 1.0e-6;

fn model(base: Base, elements: [usize; 3]) -> Model {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = elements;
    spec.scene.pin.base = base;
    spec.check().unwrap();
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// Protects: a rough base is the same surface on every mesh, and its lowest node touches.
#[test]
fn a_rough_base_is_the_same_on_every_mesh() {
    let base = Base {
        roughness: Some(Roughness {
            rms_m: RMS_M,
            seed: 5,
            hurst: 0.8,
            longest_m: Some(0.015),
            shortest_m: Some(0.0041),
        }),
        ..Base::default()
    };
    let [coarse, fine] = [[12, 15, 10], [24, 30, 10]].map(|elements| model(base.clone(), elements));
    let mut evidence = Evidence::new(
        "B20",
        "gap of a rough base at the nodes of two meshes, without the lowest [m]",
        "the same surface on both meshes",
    );
    let mut heights_m = Vec::new();
    let mut shift_m = None;
    for node in coarse.slaves() {
        let near = |[x, y]: [f64; 2]| {
            (x - node.position_m[0]).abs() < 1.0e-9 && (y - node.position_m[1]).abs() < 1.0e-9
        };
        let same = fine.slaves().iter().find(|other| near(other.position_m)).unwrap();
        let shift_m = *shift_m.get_or_insert(same.initial_gap_m - node.initial_gap_m);
        evidence.found(
            "12 × 15 and 24 × 30 elements",
            same.initial_gap_m - shift_m,
            node.initial_gap_m,
            RMS_M,
        );
        heights_m.push(node.initial_gap_m);
    }
    // A hundred roundings of a position, over the shortest wavelength, and of the sum of some 500 waves.
    evidence.judge_exact(1.0e4);
    assert!(heights_m.contains(&0.0), "the lowest node touches");
    let mean_m = heights_m.iter().sum::<f64>() / heights_m.len() as f64;
    let squared: f64 = heights_m.iter().map(|height| (height - mean_m).powi(2)).sum();
    let rms_m = (squared / heights_m.len() as f64).sqrt();
    // The base is as long as the longest wave, so it has only a part of the variance.
    assert!(rms_m > 0.3 * RMS_M && rms_m < 2.0 * RMS_M, "{rms_m:e}");
}

/// Protects: the place, the directions and the sign of a map.
#[test]
fn a_map_of_a_wave_is_the_wave() {
    let elements = [12, 15, 10];
    let wave = |direction| Base {
        wave_height_m: Some(2.0e-6),
        wave_length_m: Some(0.006),
        wave_direction_deg: Some(direction),
        ..Base::default()
    };
    let mut evidence = Evidence::new("B20", "gap of a map of a wave [m]", "a (1 + sin(2πs/λ)) at the nodes");
    for direction in [0.0_f64, 30.0, 90.0] {
        let exact = model(wave(direction), elements);
        let spacing_m = 0.001;
        let (sin, cos) = direction.to_radians().sin_cos();
        // A map that is larger than the base by a row on all sides. A point of the base that stands out has a small gap.
        let height =
            |x: f64, y: f64| -2.0e-6 * (1.0 + (std::f64::consts::TAU * (x * cos + y * sin) / 0.006).sin());
        let row = |j: i32| {
            (-7..=7).map(|i| height(f64::from(i) * spacing_m, f64::from(j) * spacing_m + 0.0005)).collect()
        };
        let heights_m = (-9..=8).map(row).collect();
        let map = HeightMap { file: None, spacing_m, heights_m };
        let found = model(Base { height_map: Some(map), ..Base::default() }, elements);
        for (found, exact) in found.slaves().iter().zip(exact.slaves()) {
            evidence.found(format!("{direction}°"), found.initial_gap_m, exact.initial_gap_m, 2.0e-6);
        }
    }
    evidence.judge_exact(1.0e3);
}
