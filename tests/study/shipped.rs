//! Protects: the studies that come with the package are valid and contain what their names say.

use std::path::PathBuf;
use tribosweep::spec::{ClampSide, DiskKind, JobSpec, Precision, Shape, StabilityMethod, Start};
use tribosweep::study::{Job, Study};

/// Every study in `studies/`.
pub fn files() -> Vec<PathBuf> {
    let mut files: Vec<_> =
        std::fs::read_dir("studies").unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    files
}

fn jobs(file: &str) -> Vec<Job> {
    Study::load(file.as_ref()).unwrap_or_else(|error| panic!("{error}")).expand("test").unwrap()
}

#[test]
fn all_are_valid_described_and_named_like_their_file() {
    let files = files();
    assert!(files.len() >= 3, "{files:?}");
    for file in files {
        let study = Study::load(&file).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(study.name(), file.file_stem().unwrap().to_str().unwrap());
        assert!(study.description().is_some_and(|text| text.len() > 20), "{}", file.display());
    }
}

#[test]
fn figure7_is_the_reference_scene_over_102_points() {
    let jobs = jobs("studies/figure7.json");
    let speeds =
        [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 15.0, 20.0, 35.0, 50.0, 75.0, 100.0];
    let expected: Vec<_> = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        .into_iter()
        .flat_map(|mu| speeds.map(|omega| reference(mu, omega)))
        .collect();
    assert_eq!(jobs.len(), 102);
    assert!(jobs.iter().map(|job| &job.spec).eq(&expected));
}

/// Spelled out, so that a change of the defaults does not silently change the figure.
fn reference(mu: f64, omega_rpm: f64) -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [24, 30, 20];
    spec.scene.clamp.side = ClampSide::InnerSide;
    spec.scene.clamp.width_m = 0.001;
    spec.scene.load.ramp_s = 5.0e-4;
    spec.numerics.beta_r_s = 2.75e-8;
    spec.numerics.precision = Precision::Single;
    spec.run.start = Start::Nested;
    spec.stability = StabilityMethod::Eigenvalues;
    spec.scene.contact.mu = mu;
    spec.scene.disk.omega_rpm = omega_rpm;
    spec
}

/// Protects: the elastic disk is compared with the rigid one at jobs that differ in nothing else but the way to solve them,
/// which an elastic disk does not have.
#[test]
fn figure7_elastic_has_jobs_of_figure7() {
    let slow = |mut spec: JobSpec| {
        spec.numerics.precision = Precision::Double;
        spec.run.start = Start::Rest;
        spec.stability = StabilityMethod::Simulate;
        spec
    };
    let rigid: Vec<JobSpec> = jobs("studies/figure7.json").into_iter().map(|job| slow(job.spec)).collect();
    let elastic = jobs("studies/figure7-elastic.json");
    assert_eq!(elastic.len(), 12);
    for job in elastic {
        let disk = &job.spec.scene.disk;
        assert_eq!(
            (disk.kind, disk.ring.young_modulus_pa, disk.ring.density_kg_m3),
            (DiskKind::Elastic, 2.1e11, 7800.0)
        );
        let mut on_rigid = job.spec.clone();
        on_rigid.scene.disk.kind = DiskKind::Rigid;
        on_rigid.scene.disk.ring = JobSpec::default().scene.disk.ring;
        assert!(rigid.contains(&on_rigid), "{on_rigid:?}");
        assert_eq!(on_rigid.scene.contact.mu, 0.4);
    }
}

#[test]
fn mini_is_small() {
    let jobs = jobs("studies/mini.json");
    let points: Vec<_> =
        jobs.iter().map(|j| (j.spec.scene.contact.mu, j.spec.scene.disk.omega_rpm)).collect();
    let expected: Vec<_> =
        [0.2, 0.4].into_iter().flat_map(|mu| [2.0, 7.0, 35.0].map(|omega| (mu, omega))).collect();
    assert_eq!(points, expected);
    for job in jobs {
        assert_eq!(job.spec.scene.pin.elements, [6, 8, 5]);
        assert_eq!(job.spec.scene.clamp.width_m, 0.002);
    }
}

#[test]
fn clamps_has_every_clamp_of_the_top_face() {
    let jobs = jobs("studies/clamps.json");
    let expected: Vec<_> = ClampSide::ALL
        .iter()
        .filter(|side| **side != ClampSide::Collet)
        .flat_map(|&side| [2.0, 6.0, 7.0, 12.0, 35.0].map(|omega| (side, omega)))
        .collect();
    let found: Vec<_> = jobs.iter().map(|j| (j.spec.scene.clamp.side, j.spec.scene.disk.omega_rpm)).collect();
    assert_eq!(found, expected);
    assert!(jobs.iter().all(|job| job.spec.scene.contact.mu == 0.4 && job.spec.scene.clamp.width_m == 0.001));
}

/// A clamp's width means a node row: on each mesh there is one at that distance from the edge.
#[test]
fn every_clamp_ends_at_a_node_row() {
    for file in files() {
        for job in jobs(file.to_str().unwrap()) {
            let (pin, clamp) = (&job.spec.scene.pin, &job.spec.scene.clamp);
            // A cylinder has rows of nodes at many distances, and a mesh from a file has its own clamp.
            if pin.shape != Shape::Block {
                continue;
            }
            let Some(axis) = clamp.side.axis_across() else { continue };
            let rows = clamp.width_m / (pin.size_m[axis] / pin.elements[axis] as f64);
            assert!((rows - rows.round()).abs() < 1.0e-9, "{}: {rows} rows", file.display());
        }
    }
}

/// Protects: the studies of errors vary numerics only. So their jobs are one physical case per speed, and mesh_convergence
/// has both damping times on every mesh.
#[test]
fn studies_of_errors_vary_numerics_only() {
    for (file, cases, count) in [
        ("studies/work_precision.json", 1, 30),
        ("studies/work_precision_damping.json", 1, 8),
        ("studies/work_precision_detection.json", 1, 16),
        ("studies/mesh_convergence.json", 4, 40),
        ("studies/mesh_convergence_reference.json", 4, 16),
    ] {
        let mut scenes: Vec<_> = jobs(file)
            .into_iter()
            .map(|mut job| {
                job.spec.scene.pin.elements = [1, 1, 1];
                format!("{:?}", job.spec.scene)
            })
            .collect();
        assert_eq!(scenes.len(), count, "{file}");
        scenes.sort();
        scenes.dedup();
        assert_eq!(scenes.len(), cases, "{file}");
    }
}

/// Protects: the three studies of work and precision share their scene, because they are compared as one.
#[test]
fn the_studies_of_work_and_precision_share_their_scene() {
    let scene = |file: &str| {
        let mut scene = jobs(file)[0].spec.scene.clone();
        scene.pin.elements = [1, 1, 1];
        scene
    };
    let first = scene("studies/work_precision.json");
    assert_eq!(scene("studies/work_precision_damping.json"), first);
    assert_eq!(scene("studies/work_precision_detection.json"), first);
}

/// Protects: the run-up and run-down lasts as long as its program, and stands for its largest speed.
#[test]
fn run_up_down_goes_up_and_down() {
    let jobs = jobs("studies/run_up_down.json");
    assert_eq!(jobs.iter().map(|job| job.spec.scene.contact.mu).collect::<Vec<_>>(), [0.2, 0.3, 0.4]);
    for job in jobs {
        let omega = job.spec.scene.program.omega_rpm.as_ref().unwrap();
        for (time_s, exact) in [(0.0, 1.0), (0.055, 25.5), (0.105, 50.0), (0.155, 25.5), (0.205, 1.0)] {
            assert!((omega.at(time_s) - exact).abs() < 1.0e-9, "{} rpm at {time_s} s", omega.at(time_s));
        }
        assert_eq!((job.spec.run.limit_s, job.spec.scene.disk.omega_rpm), (0.205, 50.0));
        assert!(job.spec.run.limit_s / job.spec.window_length_s() > 50.0);
    }
}
