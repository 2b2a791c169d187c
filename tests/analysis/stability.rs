//! Eigenvalues of steady sliding beside a run.

use super::signals::coarse;
use tribosweep_mechanics::analysis::lanes::{AnyLanes, one_lane};
use tribosweep_mechanics::analysis::nested::Beginning;
use tribosweep_mechanics::analysis::stability::{Verdict, judge};
use tribosweep_mechanics::analysis::{
    AboveBand, JobError, JobObserver, JobRecord, Noted, Outcome, SlidingStability, Structures, Unobserved,
    solve,
};
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::spec::{ClampSide, JobSpec, Precision, Shape, StabilityMethod};

fn short(method: StabilityMethod) -> JobSpec {
    let mut spec = JobSpec { stability: method, ..coarse() };
    spec.run.limit_s = 0.002;
    spec
}

/// Protects: who interrupts a search by sparse factors does not wait for its end, and the job is given back and has not failed.
#[test]
fn a_search_for_modes_is_interrupted() {
    let mut spec = short(StabilityMethod::Modes);
    // A tilted pin has sparse factors.
    spec.scene.pin.tilt_x_deg = Some(1.0e-12);
    (spec.scene.pin.elements, spec.scene.clamp.width_m) = ([3, 4, 3], 0.004);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let asked = |structures: &Structures| judge(&spec, &model, &Beginning::REST, structures);
    assert!(matches!(asked(&Structures::stopped_when(|| true)), Err(JobError::Interrupted)));
    assert!(matches!(asked(&Structures::stopped_when(|| false)), Ok(Verdict::Decided(_))));
}

/// Protects: a job that runs has its eigenvalues in its record, also if it is continued from a checkpoint by a program that
/// did not compute them. Nothing else in the record depends on them.
#[test]
fn a_checkpoint_carries_the_eigenvalues() {
    let spec = short(StabilityMethod::Simulate);
    let lane = || one_lane(Model::from_scene(&spec.scene, &spec.numerics).unwrap(), Precision::Double);
    let finish = |mut lanes: Box<dyn AnyLanes>| -> JobRecord {
        loop {
            if let Some(ended) = lanes.advance(&mut |_| {}).pop() {
                return ended.result.unwrap();
            }
        }
    };
    let mut lanes = lane();
    lanes.begin_from(0, 7, spec.clone(), Beginning::REST).unwrap();
    lanes.note(0, Noted { stability: SlidingStability::example(), grows: false });
    lanes.advance(&mut |_| {});
    let checkpoint = lanes.checkpoint(7).unwrap();
    let whole = finish(lanes);
    assert_eq!(whole.stability, Some(SlidingStability::example()));
    let mut other = lane();
    other.resume(0, 1, spec.clone(), &checkpoint).unwrap();
    assert_eq!(finish(other), whole);
    let plain = solve(&spec, &mut Unobserved).unwrap();
    assert_eq!(plain, JobRecord { stability: None, ..whole });
}

/// Protects: a job that must run to its limit runs, and so does one whose method is the run, with the same bits.
#[test]
fn some_jobs_always_run() {
    let mut records = Vec::new();
    for method in [StabilityMethod::Simulate, StabilityMethod::Eigenvalues] {
        let mut spec = short(method);
        spec.run.stop_early = false;
        let record = solve(&spec, &mut Unobserved).unwrap();
        assert!(record.steps > 0 && record.outcome == Outcome::NotPeriodic, "{record:?}");
        assert_eq!(record.stability, None);
        records.push(record);
    }
    assert_eq!(records[0], records[1]);
}

/// The outcome of a job of stable sliding whose eigenvalues are noted before its run.
fn outcome_with(precision: Precision, grows: bool) -> Outcome {
    let mut spec = coarse();
    spec.scene.contact.mu = 0.2;
    spec.numerics.precision = precision;
    spec.run.limit_s = 0.02;
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let mut lanes = one_lane(model, precision);
    lanes.begin_from(0, 1, spec, Beginning::REST).unwrap();
    lanes.note(0, Noted { stability: SlidingStability::example(), grows });
    loop {
        if let Some(ended) = lanes.advance(&mut |_| {}).pop() {
            return ended.result.unwrap().outcome;
        }
    }
}

/// Protects: where eigenvalues show a mode that grows by more than its error, a run in single precision is not believed to
/// decay, because its rounding hides a slow growth. A growth within the error does not count, and in double precision the
/// run decides.
#[test]
fn a_known_growth_is_not_hidden_by_rounding() {
    assert_eq!(outcome_with(Precision::Single, true), Outcome::NotPeriodic);
    assert_eq!(outcome_with(Precision::Single, false), Outcome::Decayed);
    assert_eq!(outcome_with(Precision::Double, true), Outcome::Decayed);
}

/// An observer that counts the steps that it needs.
struct Counting(u64);

impl JobObserver for Counting {
    fn step(&mut self, _: &tribosweep_mechanics::analysis::Moment<'_>) {
        self.0 += 1;
    }

    fn needs_run(&self) -> bool {
        true
    }
}

/// Protects: an observer that needs the run sees it also where eigenvalues would spare it. The figures of the run are those
/// of a job that always runs.
#[test]
fn an_observer_can_need_the_run() {
    let mut spec = JobSpec { stability: StabilityMethod::Eigenvalues, ..coarse() };
    spec.scene.contact.mu = 0.1;
    spec.numerics.beta_r_s = 4.0e-6;
    let decided = solve(&spec, &mut Unobserved).unwrap();
    assert!(decided.steps == 0 && decided.stability.as_ref().is_some_and(|modes| modes.decided));
    let mut counting = Counting(0);
    let observed = solve(&spec, &mut counting).unwrap();
    assert!(observed.steps > 0 && counting.0 == observed.steps);
    assert!(observed.stability.as_ref().is_some_and(|modes| !modes.decided));
    let simulated =
        solve(&JobSpec { stability: StabilityMethod::Simulate, ..spec }, &mut Unobserved).unwrap();
    assert_eq!(JobRecord { stability: None, ..observed }, simulated);
}

/// Protects: eigenvalues spare no run if nobody looked above their band and nothing proves that no mode grows there. With eighty times the
/// damping of the reference scene it is proved: the bound is γ/(2πβ), and γ is 0.69 at this μ, and a mesh whose modes are all looked for needs no proof.
#[test]
fn a_band_that_nobody_looked_beyond_decides_nothing() {
    let of = |beta_r_s: f64, elements: [usize; 3]| {
        let mut spec = JobSpec { stability: StabilityMethod::Eigenvalues, ..coarse() };
        spec.scene.contact.mu = 0.1;
        spec.scene.pin.elements = elements;
        spec.scene.clamp.width_m = 0.012 / elements[0] as f64;
        spec.numerics.beta_r_s = beta_r_s;
        spec.run.limit_s = 0.002;
        let record = solve(&spec, &mut Unobserved).unwrap();
        let stability = record.stability.unwrap();
        (stability.decided, stability.above_band, stability.damped_above_hz.is_some())
    };
    assert_eq!(of(5.0e-8, [6, 8, 5]), (false, AboveBand::NotLookedAt, false));
    assert_eq!(of(4.0e-6, [6, 8, 5]), (true, AboveBand::Damped, true));
    assert_eq!(of(5.0e-8, [3, 4, 3]), (true, AboveBand::Nothing, false));
}

/// Protects: a cylinder that squeals above the usual band is not called stable: the search goes on until it finds the mode, and says
/// how far it went. On this mesh it reaches the highest mode, and without friction it finds that none grows.
#[test]
fn a_cylinder_that_squeals_high_is_unstable() {
    let of = |mu: f64| {
        let mut spec = JobSpec { stability: StabilityMethod::Modes, ..JobSpec::default() };
        spec.scene.pin.shape = Shape::Cylinder;
        spec.scene.pin.diameter_m = Some(0.012);
        spec.scene.pin.size_m = [0.012, 0.012, 0.010];
        spec.scene.pin.elements = [4, 4, 3];
        spec.scene.clamp.side = ClampSide::WholeTop;
        spec.scene.contact.mu = mu;
        spec.numerics.beta_r_s = 0.0;
        solve(&spec, &mut Unobserved).unwrap()
    };
    let record = of(0.6);
    let stability = record.stability.as_ref().unwrap();
    assert_eq!((record.outcome, stability.above_band), (Outcome::Unstable, AboveBand::Nothing));
    let usual_hz = 2.5 * 392.0 / 0.04;
    assert!(
        stability.modes[0].frequency_hz > usual_hz && stability.band_hz > 2.0 * usual_hz,
        "{stability:?}"
    );
}

/// Protects: where damping wins below the band that was searched, the band stays as it is, and the decaying modes in it are found: a cylinder
/// in a collet at little friction is stable, and says what decays. A band that ended where damping wins had no mode, and counted as unstable.
#[test]
fn damping_that_wins_early_hides_no_modes() {
    let mut spec = JobSpec { stability: StabilityMethod::Modes, ..JobSpec::default() };
    let pin = &mut spec.scene.pin;
    (pin.shape, pin.diameter_m, pin.size_m, pin.elements) =
        (Shape::Cylinder, Some(0.008), [0.008, 0.008, 0.018], [4, 4, 6]);
    (pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3) = (2.8e9, 0.35, 1410.0);
    (spec.scene.clamp.side, spec.scene.clamp.width_m) = (ClampSide::Collet, 0.006);
    (spec.scene.disk.omega_rpm, spec.scene.disk.track_radius_m) = (500.0, 0.06);
    spec.numerics.beta_r_s = 8.0e-7;
    for mu in [0.001, 0.01] {
        spec.scene.contact.mu = mu;
        let record = solve(&spec, &mut Unobserved).unwrap();
        let stability = record.stability.as_ref().unwrap();
        assert_eq!(record.outcome, Outcome::Decayed, "μ = {mu}");
        assert_eq!(stability.above_band, AboveBand::Damped, "μ = {mu}");
        assert!(stability.modes.len() >= 4, "μ = {mu}: {:?}", stability.modes);
    }
}
