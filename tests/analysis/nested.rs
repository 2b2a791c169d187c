//! Runs that start from a limit cycle of a coarser mesh.

use tribosweep_mechanics::analysis::nested::coarser;
use tribosweep_mechanics::analysis::{JobRecord, Outcome, UnknownError, Unobserved, solve};
use tribosweep_mechanics::spec::{Accuracy, JobSpec, Numerics, Start};

/// A scene that can be halved once.
fn scene() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [12, 12, 11];
    spec.scene.clamp.width_m = 0.002;
    spec.run.start = Start::Nested;
    // The regimes, decays and times of these tests are those of this damping.
    spec.numerics.beta_r_s = 5.0e-8;
    spec
}

fn run(spec: &JobSpec) -> JobRecord {
    solve(spec, &mut Unobserved).unwrap()
}

fn from_rest(spec: &JobSpec) -> JobRecord {
    let mut spec = spec.clone();
    spec.run.start = Start::Rest;
    run(&spec)
}

/// Protects: a coarser mesh has half of the elements in each direction, rounded up, and the same physics. There is none for a
/// start from rest, below six elements, and without a node row at the clamp's edge.
#[test]
fn a_coarser_mesh_is_that_of_the_job() {
    let mut spec = scene();
    spec.numerics = Numerics { time_step_s: Some(1.0e-8), safety_factor: 0.1, ..Numerics::default() };
    spec.run.stop_early = false;
    let mut expected = spec.clone();
    expected.scene.pin.elements = [6, 6, 6];
    expected.numerics = Numerics::default();
    expected.run.stop_early = true;
    assert_eq!(coarser(&spec), Some(expected));
    let of = |change: fn(&mut JobSpec)| {
        let mut spec = scene();
        change(&mut spec);
        coarser(&spec).map(|coarse| coarse.scene.pin.elements)
    };
    assert_eq!(of(|spec| spec.scene.pin.elements = [13, 23, 11]), Some([7, 12, 6]));
    assert_eq!(of(|spec| spec.scene.pin.elements[2] = 10), None);
    assert_eq!(of(|spec| spec.run.start = Start::Rest), None);
    // On elements of 2 mm the nearest node row is twice as far from the edge.
    assert_eq!(of(|spec| spec.scene.clamp.width_m = 0.001), None);
}

/// Protects: a start from the coarser mesh leads to the limit cycle that the start from rest reaches too, in less simulated
/// time, and its energies balance.
///
/// Both runs end when the figures of their cycles have spread by at most `tolerance`, so their means can differ by about as
/// much. The damping's work is a sample of every sixteenth step; the waves that the new mesh excites are damped within few
/// samples, so their energy, a small part of that put in, is not well balanced.
#[test]
fn a_nested_start_leads_to_the_same_limit_cycle() {
    let mut spec = scene();
    spec.scene.contact.mu = 0.4;
    spec.scene.disk.omega_rpm = 20.0;
    let (rest, nested) = (from_rest(&spec), run(&spec));
    assert_eq!((rest.outcome, nested.outcome), (Outcome::Periodic, Outcome::Periodic));
    let start = nested.start.as_ref().unwrap();
    assert!(start.is_used() && rest.start.is_none());
    assert_eq!(start.elements, [6, 6, 6]);
    assert!(start.simulated_s > 0.0 && start.mu_star.is_some() && start.frequency_hz.is_some());
    let tolerance = spec.detection.tolerance;
    let figures =
        |record: &JobRecord| [record.stick_share, record.slip_share, record.separated_share, record.mu_star];
    for (a, b) in figures(&rest).into_iter().zip(figures(&nested)) {
        assert!((a - b).abs() <= tolerance, "{:?} {:?}", figures(&rest), figures(&nested));
    }
    let [a, b] = [&rest, &nested].map(|record| record.frequency_hz.unwrap());
    assert!((a / b - 1.0).abs() <= tolerance, "{a} Hz and {b} Hz");
    assert!(nested.simulated_s < rest.simulated_s, "{} s and {} s", nested.simulated_s, rest.simulated_s);
    assert!(nested.energy_residual < 0.01, "{}", nested.energy_residual);
}

fn asks(elements: [usize; 3], mu_star: f64) -> JobSpec {
    let mut spec = scene();
    spec.scene.contact.mu = 0.4;
    spec.scene.disk.omega_rpm = 20.0;
    spec.scene.pin.elements = elements;
    spec.accuracy = Some(Accuracy { mu_star });
    spec
}

/// Protects: a job that asks for an accuracy ends on the first mesh whose own error is within it, never on the coarsest one, and has the
/// result of a job on this mesh. Otherwise it ends on the finest mesh and says that the accuracy is not reached.
#[test]
fn an_accuracy_ends_on_the_first_mesh_that_has_it() {
    let fixed = |elements: [usize; 3]| run(&JobSpec { accuracy: None, ..asks(elements, 0.2) });
    let middle = fixed([12; 3]);
    let error = middle.mesh_error().unwrap().mu_star / middle.mu_star;
    for (asked, elements, reached) in
        [(1.001 * error, [12; 3], true), (0.999 * error, [24; 3], true), (1.0e-4, [24; 3], false)]
    {
        let record = run(&asks([24; 3], asked));
        assert_eq!((record.elements, record.accuracy_reached), (Some(elements), Some(reached)), "{asked}");
        assert_eq!(JobRecord { accuracy_reached: None, ..record }, fixed(elements), "{asked}");
    }
    // One mesh alone says nothing of its error, however much is allowed.
    let coarsest = run(&asks([6; 3], 0.2));
    assert_eq!((coarsest.elements, coarsest.accuracy_reached), (Some([6; 3]), Some(false)));
    assert_eq!(coarsest.mesh_error(), Err(UnknownError::NoCoarserMesh));
    // Nor does it say that sliding is stable on finer ones, although the error of μ* is known there.
    let mut stable = JobSpec { accuracy: Some(Accuracy { mu_star: 0.2 }), ..scene() };
    stable.scene.pin.elements = [6; 3];
    stable.scene.contact.mu = 0.1;
    stable.run.limit_s = 0.009;
    let stable = run(&stable);
    assert_eq!((stable.outcome, stable.accuracy_reached), (Outcome::Decayed, Some(false)));
    assert!(stable.mesh_error().is_ok());
}

/// Protects: a mesh that does not halve to one with the clamp's row starts from two thirds of its elements, and a job that asks for an
/// accuracy never compares two widths of the clamp.
#[test]
fn every_mesh_has_the_row_of_the_clamp() {
    let mut spec = asks([36, 36, 36], 0.01);
    spec.scene.clamp.width_m = 0.001;
    let counts = |spec: &JobSpec| coarser(spec).map(|coarse| coarse.scene.pin.elements);
    assert_eq!(counts(&spec), Some([24; 3]), "18 elements of 12 mm have no row at 1 mm");
    let next = coarser(&spec).unwrap();
    assert_eq!(counts(&next), Some([12; 3]));
    assert_eq!(counts(&coarser(&next).unwrap()), None, "6 elements have no row at 1 mm");
}

/// Protects: without a limit cycle on the coarser mesh a job starts from rest, and apart from the note about that its record has
/// the same bits.
#[test]
fn without_a_limit_cycle_a_job_starts_from_rest() {
    let mut spec = scene();
    spec.scene.contact.mu = 0.1;
    spec.run.limit_s = 0.009;
    let outcome = |record: &JobRecord| record.start.as_ref().unwrap().outcome;
    let decayed = run(&spec);
    assert_eq!(outcome(&decayed), Some(Outcome::Decayed));
    assert_eq!(JobRecord { start: None, ..decayed }, from_rest(&spec));
    // Too short for any cycle.
    spec.run.limit_s = 0.0006;
    let short = run(&spec);
    assert_eq!(outcome(&short), Some(Outcome::NotPeriodic));
    assert_eq!(JobRecord { start: None, ..short }, from_rest(&spec));
}

/// Protects: a run that starts from rest after a run to compare with has the bits of one without, and knows the error of its mesh. This
/// also holds for scenes whose motion cannot be carried over.
#[test]
fn a_comparison_changes_nothing_but_what_is_known() {
    let mut plain = scene();
    plain.scene.contact.mu = 0.4;
    plain.scene.disk.omega_rpm = 20.0;
    plain.run.start = Start::Compared;
    let mut held = plain.clone();
    held.scene.holder.stiffness_y_n_m = Some(5.0e6);
    held.scene.holder.mass_kg = Some(0.005);
    held.scene.holder.damping_y_n_s_m = Some(50.0);
    held.run.limit_s = 0.02;
    for spec in [plain, held] {
        assert_eq!(spec.check(), Ok(()));
        let compared = run(&spec);
        let start = compared.start.clone().unwrap();
        assert!(!start.is_used() && start.only_compared && start.elements == [6, 6, 6], "{start:?}");
        let known = compared.mesh_error();
        assert!(!matches!(known, Err(UnknownError::NoCoarserMesh)), "{known:?}");
        let alone = from_rest(&spec);
        assert_eq!(alone.outcome, Outcome::Periodic);
        assert_eq!(alone.mesh_error(), Err(UnknownError::NoCoarserMesh));
        assert_eq!(JobRecord { start: None, ..compared }, alone);
    }
}

/// Protects: records of versions without such starts are read.
#[test]
fn records_without_a_start_are_read() {
    let mut spec = scene();
    spec.run.limit_s = 0.0006;
    let record = from_rest(&spec);
    let text = serde_json::to_string(&record).unwrap();
    assert!(!text.contains("\"start\""), "{text}");
    assert_eq!(serde_json::from_str::<JobRecord>(&text).unwrap(), record);
}
