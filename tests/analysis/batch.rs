//! Jobs that are advanced together.

use crate::analysis::signals::coarse;
use std::collections::BTreeMap;
use std::sync::Mutex;
use strum::VariantArray;
use tribosweep_mechanics::analysis::batch::{Batch, Begun};
use tribosweep_mechanics::analysis::continuation::PinMotion;
use tribosweep_mechanics::analysis::{CoarseStart, JobRecord, Outcome, Unobserved, solve};
use tribosweep_mechanics::spec::{
    Accuracy, ClampSide, Continuation, DiskKind, FrictionLaw, JobSpec, MaterialLaw, MuOfSpeed, Plasticity,
    Precision, Region, Shape, StabilityMethod, Start, Strains, Table,
};

/// Turns between two interruptions of a job.
const PAUSES: [usize; 3] = [1, 5, 13];

/// Jobs of one model. They differ in everything that may differ: friction, speed, load, ramp, length, and
/// early stop.
fn jobs(disk: DiskKind, precision: Precision) -> Vec<JobSpec> {
    (0..11)
        .map(|i| {
            let mut job = coarse();
            job.scene.contact.mu = [0.4, 0.0, 0.55, 0.2][i % 4];
            job.scene.disk.omega_rpm = 1.0 + 9.0 * i as f64;
            job.scene.load.force_n = 30.0 / (1 + i % 3) as f64;
            job.scene.load.ramp_s = [5.0e-4, 0.0, 1.0e-3][i % 3];
            job.run.limit_s = 0.001 * (2 + i % 5) as f64 + 1.7e-5 * i as f64;
            job.run.stop_early = i % 2 == 0;
            job.scene.disk.kind = disk;
            job.numerics.precision = precision;
            match disk {
                DiskKind::Rigid => job.numerics.beta2 = 0.6,
                // The bits of a few elements are as hard to keep as those of many. The faster jobs pass edges.
                DiskKind::Elastic => {
                    job.scene.pin.elements = [3, 4, 3];
                    job.scene.clamp.width_m = 0.004;
                    job.scene.disk.ring.element_size_m = 0.012;
                    job.scene.disk.ring.coarse_element_size_m = 0.06;
                }
            }
            job
        })
        .collect()
}

/// Jobs that start from a limit cycle of a coarser mesh, or find none there, beside jobs that start from rest. Their detection is
/// so tolerant that most of them soon end as periodic.
fn nested_jobs(precision: Precision) -> Vec<JobSpec> {
    let mut jobs = jobs(DiskKind::Rigid, precision);
    for (i, job) in jobs.iter_mut().enumerate() {
        job.scene.pin.elements = [11, 12, 11];
        job.run.start = if i % 4 == 1 { Start::Rest } else { Start::Nested };
        job.run.limit_s = 0.002 + 1.0e-4 * i as f64;
        job.detection.cycles = 4;
        job.detection.tolerance = 0.3;
        job.detection.drift_tolerance = 0.2;
    }
    jobs
}

/// The record of a job that ran alone. Several tests compare with the same jobs, which need not run again.
fn record(job: &JobSpec) -> JobRecord {
    static KNOWN: Mutex<BTreeMap<String, JobRecord>> = Mutex::new(BTreeMap::new());
    let key = serde_json::to_string(job).unwrap();
    if let Some(known) = KNOWN.lock().unwrap().get(&key) {
        return known.clone();
    }
    let record = solve(job, &mut Unobserved).unwrap();
    KNOWN.lock().unwrap().insert(key, record.clone());
    record
}

fn alone(job: &JobSpec) -> String {
    serde_json::to_string(&record(job)).unwrap()
}

/// Protects: a job's record has the same bytes alone and beside others, in any lane. Jobs begin while others
/// are in the middle of their runs. They move to more lanes when others begin, and to fewer when others end.
#[test]
fn companions_change_nothing() {
    companions_change_nothing_in(&jobs(DiskKind::Rigid, Precision::Double));
}

/// Protects: the same in single precision, where a vector holds the nodes of twice as many lanes.
#[test]
fn companions_change_nothing_in_single_precision() {
    companions_change_nothing_in(&jobs(DiskKind::Rigid, Precision::Single));
}

/// Protects: the same on an elastic disk. Lanes of different speed have their pins at different places on it.
#[test]
fn companions_change_nothing_on_an_elastic_disk() {
    companions_change_nothing_in(&jobs(DiskKind::Elastic, Precision::Double));
}

/// Protects: the same if jobs first run on a coarser mesh, and come from there to their own mesh while others run on it.
#[test]
fn companions_change_nothing_after_a_coarser_mesh() {
    let jobs = nested_jobs(Precision::Double);
    companions_change_nothing_in(&jobs);
    let starts: Vec<_> = jobs.iter().map(|job| record(job).start).collect();
    let is_used = |start: &Option<CoarseStart>| start.as_ref().map(CoarseStart::is_used);
    for expected in [None, Some(false), Some(true)] {
        assert!(starts.iter().any(|start| is_used(start) == expected), "{expected:?} in {starts:?}");
    }
}

/// Protects: the same with every friction law. One of them carries a state from step to step, which lanes and checkpoints must keep, also
/// with an elastic disk.
#[test]
fn companions_and_interruptions_change_nothing_with_other_laws() {
    nothing_changes_with_laws(FrictionLaw::VARIANTS, &[(DiskKind::Rigid, Precision::Double)]);
    nothing_changes_with_laws(&[FrictionLaw::PrakashClifton], &[(DiskKind::Elastic, Precision::Double)]);
    nothing_changes_with_laws(&[FrictionLaw::StaticKinetic], &[(DiskKind::Rigid, Precision::Single)]);
}

/// Protects: the same with every law in both precisions and with an elastic disk.
#[test]
#[ignore = "every law with eleven jobs on an elastic disk"]
fn companions_and_interruptions_change_nothing_with_any_law() {
    let others = [(DiskKind::Rigid, Precision::Single), (DiskKind::Elastic, Precision::Double)];
    nothing_changes_with_laws(FrictionLaw::VARIANTS, &others);
}

fn nothing_changes_with_laws(laws: &[FrictionLaw], scenes: &[(DiskKind, Precision)]) {
    for law in laws {
        for &(disk, precision) in scenes {
            if precision == Precision::Single && *law == FrictionLaw::PrakashClifton {
                assert!(jobs(disk, precision).pop().is_some_and(|mut job| {
                    job.scene.contact.law = *law;
                    job.check().is_err()
                }));
                continue;
            }
            let mut jobs = jobs(disk, precision);
            for (i, job) in jobs.iter_mut().enumerate() {
                let contact = &mut job.scene.contact;
                contact.law = *law;
                contact.mu_static = Some([0.5, 0.1][i % 2]);
                contact.speed_m_s = Some([0.1, 0.2, 1.0][i % 3]);
                contact.slope_s_m = Some([0.0, 0.2][i % 2]);
                contact.length_m = Some([1.0e-6, 1.0e-5][i % 2]);
                contact.mu_of_speed =
                    MuOfSpeed(vec![[0.0, 0.5], [[0.01, 0.1][i % 2], 0.3], [1.0, [0.3, 0.4][i % 2]]]);
                job.run.limit_s = job.run.limit_s.min(0.0012);
            }
            companions_change_nothing_in(&jobs);
            resumed_jobs_have_the_same_bits(&jobs, &[2], &[1]);
        }
    }
}

/// Protects: the same with general meshes, whose nodes are in lines that do not fill their vectors, and with damping in proportion to the mass.
#[test]
fn companions_and_interruptions_change_nothing_on_general_meshes() {
    nothing_changes_on_general_meshes(&GENERAL[..2], 0.0015, &PAUSES[..1]);
}

/// Protects: the same in longer runs, also with fewer interruptions, of which each finds another step.
#[test]
#[ignore = "four kinds of general meshes, each run again for each interval"]
fn rarer_interruptions_change_nothing_on_general_meshes() {
    nothing_changes_on_general_meshes(&GENERAL, 0.003, &PAUSES);
}

/// The kinds of general meshes. The first two have all that the others have, but for single precision.
const GENERAL: [(DiskKind, Precision, Strains); 4] = [
    (DiskKind::Rigid, Precision::Double, Strains::Finite),
    (DiskKind::Elastic, Precision::Double, Strains::Small),
    (DiskKind::Rigid, Precision::Double, Strains::Small),
    (DiskKind::Rigid, Precision::Single, Strains::Small),
];

fn nothing_changes_on_general_meshes(
    kinds: &[(DiskKind, Precision, Strains)],
    limit_s: f64,
    pauses: &[usize],
) {
    for &(disk, precision, strains) in kinds {
        let mut jobs = jobs(disk, precision);
        for job in &mut jobs {
            let pin = &mut job.scene.pin;
            pin.strains = strains;
            if strains == Strains::Finite {
                job.numerics.beta2 = 0.5;
                // The peaks of the pressure yield, and what has yielded belongs to the state of a job.
                pin.material = MaterialLaw::J2;
                pin.plasticity = Some(Plasticity {
                    yield_stress_pa: Some(4.0e5),
                    kinematic_modulus_pa: Some(1.0e7),
                    ..Plasticity::default()
                });
            }
            pin.shape = Shape::Cylinder;
            pin.diameter_m = Some(0.012);
            pin.elements = [5, 5, 4];
            pin.tilt_x_deg = Some(0.01);
            pin.regions = vec![Region {
                above_m: Some(0.5 * pin.size_m[2]),
                group: None,
                young_modulus_pa: 2.0 * pin.young_modulus_pa,
                poisson_ratio: 0.2,
                density_kg_m3: pin.density_kg_m3,
                plasticity: (strains == Strains::Finite)
                    .then(|| Plasticity { yield_stress_pa: Some(3.0e5), ..Plasticity::default() }),
            }];
            job.scene.clamp.side = ClampSide::WholeTop;
            job.run.limit_s = job.run.limit_s.min(limit_s);
            if disk == DiskKind::Rigid {
                job.numerics.alpha_r_per_s = Some(1.0e3);
            }
        }
        companions_change_nothing_in(&jobs);
        resumed_jobs_have_the_same_bits(&jobs, &[2], pauses);
        let flow = record(&jobs[2]).plastic;
        assert_eq!(flow.is_some_and(|flow| flow.strain_max > 0.0), strains == Strains::Finite, "{flow:?}");
    }
}

/// Jobs of which two in three have a speed, a load or both that change in time.
fn programmed(precision: Precision) -> Vec<JobSpec> {
    let mut jobs = jobs(DiskKind::Rigid, precision);
    for (i, job) in jobs.iter_mut().enumerate().filter(|(i, _)| i % 3 != 1) {
        let scene = &mut job.scene;
        let (limit_s, omega, force) = (job.run.limit_s, scene.disk.omega_rpm, scene.load.force_n);
        if i % 3 == 0 {
            let up_and_down = vec![[0.0, 0.1 * omega], [0.5 * limit_s, omega], [limit_s, 0.0]];
            scene.program.omega_rpm = Some(Table(up_and_down));
        }
        if i % 2 == 0 || i % 3 == 2 {
            let step =
                vec![[0.3 * limit_s, force], [0.3 * limit_s, 0.4 * force], [0.9 * limit_s, 0.7 * force]];
            scene.program.force_n = Some(Table(step));
        }
        job.run.window_s = Some(limit_s / (5 + i) as f64);
        job.check().unwrap();
    }
    jobs
}

/// Protects: the same with speeds and loads that change in time, beside jobs without, in both precisions. A job that is resumed in the
/// middle of a ramp has the windows of an uninterrupted run.
#[test]
fn companions_and_interruptions_change_nothing_with_programs() {
    for precision in [Precision::Double, Precision::Single] {
        let jobs = programmed(precision);
        companions_change_nothing_in(&jobs);
        resumed_jobs_have_the_same_bits(&jobs, &[0, 2, 3], &PAUSES);
        let windows = |job: &JobSpec| record(job).windows.len();
        assert_eq!((windows(&jobs[0]), windows(&jobs[1]), windows(&jobs[3])), (5, 0, 8));
    }
}

/// Protects: the same if eigenvalues decide jobs after their run on the coarser mesh. Jobs that found a limit cycle there are
/// not judged, alone or beside others.
#[test]
fn companions_change_nothing_where_eigenvalues_decide() {
    let mut jobs = nested_jobs(Precision::Double);
    for job in jobs.iter_mut().skip(3).step_by(4) {
        job.scene.contact.mu = 0.0;
        job.run.stop_early = true;
    }
    for job in &mut jobs {
        job.stability = StabilityMethod::Eigenvalues;
    }
    companions_change_nothing_in(&jobs);
    let records: Vec<_> = jobs.iter().map(record).collect();
    let is_used = |record: &JobRecord| record.start.as_ref().map(CoarseStart::is_used);
    let is_decided = |record: &JobRecord| record.stability.as_ref().is_some_and(|modes| modes.decided);
    assert!(records.iter().any(|record| is_decided(record) && is_used(record) == Some(false)));
    for record in records.iter().filter(|record| is_used(record) == Some(true)) {
        assert_eq!(record.stability, None);
    }
}

/// Jobs that ask for an accuracy, of which some end on a coarser mesh than their finest one. Their detection is as tolerant as that of
/// [`nested_jobs`].
fn accurate_jobs(precision: Precision) -> Vec<JobSpec> {
    let mut jobs = nested_jobs(precision);
    for (i, job) in jobs.iter_mut().enumerate() {
        job.scene.pin.elements = [24, 28, 28];
        job.run.start = if i % 4 == 1 { Start::Rest } else { Start::Nested };
        job.run.stop_early = true;
        job.run.limit_s = 0.0012 + 1.0e-4 * i as f64;
        job.numerics.beta2 = 0.5;
        job.accuracy = Some(Accuracy { mu_star: [0.4, 1.0e-4][i % 2] });
    }
    jobs
}

/// Protects: a job that asks for an accuracy has the same bytes alone and beside others that end on other meshes, and after interruptions
/// on each of its meshes.
#[test]
fn companions_and_interruptions_change_nothing_where_an_accuracy_is_asked() {
    nothing_changes_where_an_accuracy_is_asked(Precision::Single, &PAUSES[..1]);
}

/// Protects: the same with fewer interruptions, of which each finds another step.
#[test]
#[ignore = "two jobs, each run again for each interval"]
fn rarer_interruptions_change_nothing_where_an_accuracy_is_asked() {
    nothing_changes_where_an_accuracy_is_asked(Precision::Single, &PAUSES[1..]);
}

/// Protects: the same in double precision.
#[test]
#[ignore = "the other precision takes the same paths"]
fn companions_and_interruptions_change_nothing_where_an_accuracy_is_asked_in_double_precision() {
    nothing_changes_where_an_accuracy_is_asked(Precision::Double, &PAUSES);
}

fn nothing_changes_where_an_accuracy_is_asked(precision: Precision, pauses: &[usize]) {
    let jobs = accurate_jobs(precision);
    let records: Vec<_> = jobs.iter().map(record).collect();
    for (elements, reached) in [([12, 14, 14], true), ([24, 28, 28], false)] {
        let is_such = |record: &&JobRecord| {
            (record.elements, record.accuracy_reached) == (Some(elements), Some(reached))
        };
        assert!(records.iter().any(|record| is_such(&record)), "{elements:?}, reached: {reached}");
    }
    companions_change_nothing_in(&jobs);
    resumed_jobs_have_the_same_bits(&jobs, &[0, 3], pauses);
}

/// Protects: the same with both, a coarser mesh and single precision.
#[test]
fn companions_change_nothing_after_a_coarser_mesh_in_single_precision() {
    companions_change_nothing_in(&nested_jobs(Precision::Single));
}

fn companions_change_nothing_in(jobs: &[JobSpec]) {
    let mut batch = Batch::new(&jobs[0]).unwrap();
    assert_eq!(batch.widest(), 8, "a small mesh");
    let mut found = BTreeMap::new();
    let mut waiting = jobs.iter().enumerate();
    let (mut turns, mut widths) = (0, std::collections::BTreeSet::new());
    while found.len() < jobs.len() {
        // Every third turn one more job begins, until all lanes are full. So the jobs begin at different
        // steps.
        if turns % 3 == 0 && batch.jobs() < batch.widest() {
            match waiting.next() {
                Some((ticket, job)) => {
                    if let Begun::Decided(record) = batch.begin(ticket as u64, job.clone()).unwrap() {
                        found.insert(ticket as u64, serde_json::to_string(&record).unwrap());
                    }
                }
                None => batch.narrow(),
            }
        }
        for ended in batch.advance() {
            found.insert(ended.ticket, serde_json::to_string(&ended.result.unwrap()).unwrap());
        }
        widths.insert(batch.jobs());
        turns += 1;
    }
    assert!((0..=8).all(|jobs| widths.contains(&jobs)), "every number of companions: {widths:?}");
    for (ticket, job) in jobs.iter().enumerate() {
        assert_eq!(found[&(ticket as u64)], alone(job), "job {ticket}");
    }
}

/// Protects: a job that is saved at an audit and continues in another batch, in another lane beside others,
/// gives the bytes of an uninterrupted run, also after several such interruptions. Its analysis (cycles,
/// decay monitor, averages) continues, too.
#[test]
fn a_resumed_job_has_the_same_bits() {
    let jobs = observed(DiskKind::Rigid, Precision::Double);
    resumed_jobs_have_the_same_bits(&jobs, &[0, 2, 3, 7], &PAUSES);
    assert!(alone(&jobs[3]).contains("decayed"), "the watch for a decay was among it");
}

/// Protects: the same in single precision. Checkpoints hold f64, in which every f32 is exact.
#[test]
fn a_resumed_job_in_single_precision_has_the_same_bits() {
    resumed_jobs_have_the_same_bits(&observed(DiskKind::Rigid, Precision::Single), &[0, 2, 3, 7], &PAUSES);
}

/// Protects: the same on an elastic disk, whose state is part of the checkpoint.
#[test]
fn a_resumed_job_on_an_elastic_disk_has_the_same_bits() {
    let jobs = observed(DiskKind::Elastic, Precision::Double);
    resumed_jobs_have_the_same_bits(&jobs, &[0, 3], &PAUSES[1..2]);
    assert!(alone(&jobs[3]).contains("decayed"), "the watch for a decay was among it");
}

/// Protects: the same for more jobs that are interrupted more often.
#[test]
#[ignore = "twelve jobs on an elastic disk, each interrupted up to forty times"]
fn more_resumed_jobs_on_an_elastic_disk_have_the_same_bits() {
    resumed_jobs_have_the_same_bits(&observed(DiskKind::Elastic, Precision::Double), &[0, 2, 3, 7], &PAUSES);
}

/// Protects: the same if the job is on a coarser mesh, or has come from there; also if that mesh is reached from one that is
/// still coarser.
#[test]
fn a_resumed_job_after_coarser_meshes_has_the_same_bits() {
    let mut jobs = nested_jobs(Precision::Double);
    resumed_jobs_have_the_same_bits(&jobs, &[0, 3], &PAUSES);
    for job in &mut jobs {
        job.scene.pin.elements = [21, 21, 21];
        job.numerics.beta2 = 0.5;
    }
    resumed_jobs_have_the_same_bits(&jobs, &[2], &PAUSES);
}

/// Jobs of which one is found stable after an observation that is interrupted.
fn observed(disk: DiskKind, precision: Precision) -> Vec<JobSpec> {
    let mut jobs = jobs(disk, precision);
    jobs[3].detection.decay_observation_s = 0.0026;
    jobs[3].run.limit_s = 0.012;
    jobs[3].scene.contact.mu = 0.2;
    jobs
}

/// Interrupts the jobs `resumed` after each of `pauses` turns.
fn resumed_jobs_have_the_same_bits(jobs: &[JobSpec], resumed: &[usize], pauses: &[usize]) {
    for &job in resumed {
        let mut records = Vec::new();
        for &pause in pauses {
            let mut batch = Batch::new(&jobs[job]).unwrap();
            batch.begin(1, jobs[job].clone()).unwrap();
            let (mut resumed, mut turns) = (0, 0);
            let record = loop {
                let ended = batch.advance().into_iter().find(|ended| ended.ticket == 1);
                if let Some(ended) = ended {
                    break serde_json::to_string(&ended.result.unwrap()).unwrap();
                }
                turns += 1;
                if turns % pause == 0 && resumed < 40 {
                    let kept = batch.checkpoint(1).unwrap();
                    batch = Batch::new(&jobs[job]).unwrap();
                    // The companion is at another step, and the job is in another lane than before.
                    if resumed % 2 == 0 {
                        batch.begin(9, jobs[1].clone()).unwrap();
                        batch.advance();
                    }
                    batch.resume(1, jobs[job].clone(), &kept).unwrap();
                    assert_eq!(batch.checkpoint(1).unwrap(), kept, "what was kept is what is there");
                    resumed += 1;
                }
            };
            assert!(resumed > 2, "job {job} was resumed {resumed} times");
            records.push(record);
        }
        let whole = alone(&jobs[job]);
        assert!(records.iter().all(|record| *record == whole), "job {job}");
    }
}

/// Protects: a checkpoint of another model is refused, and the batch can still run the job from its
/// beginning.
#[test]
fn a_foreign_checkpoint_is_refused() {
    let job = coarse();
    let mut finer = job.clone();
    finer.scene.pin.elements[0] += 1;
    let mut other = Batch::new(&finer).unwrap();
    other.begin(1, finer).unwrap();
    other.advance();
    let kept = other.checkpoint(1).unwrap();
    assert!(other.checkpoint(2).is_none(), "no such job");
    let mut batch = Batch::new(&job).unwrap();
    for bytes in [&kept[..], &kept[..kept.len() / 2], b""] {
        batch.resume(1, job.clone(), bytes).unwrap_err();
        assert_eq!(batch.jobs(), 0);
    }
    batch.begin(1, job.clone()).unwrap();
    let mut ended = Vec::new();
    while ended.is_empty() {
        ended = batch.advance();
    }
    assert_eq!(serde_json::to_string(&ended.remove(0).result.unwrap()).unwrap(), alone(&job));
}

/// Protects: a checkpoint on the coarser mesh is refused for a job that starts from rest.
#[test]
fn a_checkpoint_of_another_start_is_refused() {
    let nested = nested_jobs(Precision::Double).remove(0);
    let mut rest = nested.clone();
    rest.run.start = Start::Rest;
    let mut batch = Batch::new(&nested).unwrap();
    batch.begin(1, nested).unwrap();
    batch.advance();
    let kept = batch.checkpoint(1).unwrap();
    batch.resume(2, rest, &kept).unwrap_err();
    assert_eq!(batch.jobs(), 1);
}

/// Protects: a job that is refused at its beginning ends with the same error as alone, and its lane is free
/// for another job.
#[test]
fn a_refused_job_leaves_its_lane_free() {
    let good = coarse();
    let mut endless = good.clone();
    endless.run.limit_s = 100.0;
    let mut batch = Batch::new(&good).unwrap();
    let refused = batch.begin(1, endless.clone()).unwrap_err().to_string();
    assert_eq!(refused, solve(&endless, &mut Unobserved).unwrap_err().to_string());
    batch.begin(2, good.clone()).unwrap();
    let mut ended = Vec::new();
    while ended.is_empty() {
        ended = batch.advance();
    }
    let ended = ended.remove(0);
    assert_eq!((ended.ticket, serde_json::to_string(&ended.result.unwrap()).unwrap()), (2, alone(&good)));
}

/// Protects: a batch accepts the jobs of its own model and no others.
#[test]
fn jobs_of_other_models_are_not_taken() {
    let job = coarse();
    let batch = Batch::new(&job).unwrap();
    let changed = |change: fn(&mut JobSpec)| {
        let mut other = job.clone();
        change(&mut other);
        batch.takes(&other)
    };
    assert!(changed(|job| job.scene.contact.mu = 0.1));
    assert!(changed(|job| job.detection.tolerance = 0.02));
    assert!(!changed(|job| job.scene.pin.density_kg_m3 = 2400.0));
    assert!(!changed(|job| job.scene.disk.track_radius_m = 0.08));
    assert!(!changed(|job| job.scene.clamp.width_m *= 0.9));
    assert!(!changed(|job| job.numerics.beta_r_s = 0.0));
    assert!(!changed(|job| job.numerics.precision = Precision::Single));
}

/// Runs a job that may continue the motion of another one, with an interruption after each `pause` turns. Returns its record and its last
/// motion.
fn run_after(job: &JobSpec, parent: Option<PinMotion>, pause: usize) -> (JobRecord, PinMotion) {
    let mut batch = Batch::new(job).unwrap();
    batch.begin_after(1, job.clone(), parent).unwrap();
    let mut turns = 0;
    loop {
        if let Some(ended) = batch.advance().pop() {
            return (ended.result.unwrap(), ended.motion.unwrap());
        }
        turns += 1;
        if turns % pause == 0 {
            let kept = batch.checkpoint(1).unwrap();
            batch = Batch::new(job).unwrap();
            batch.resume(1, job.clone(), &kept).unwrap();
        }
    }
}

/// Protects: a job that continues another one can have a run from rest on a coarser mesh beside it. That changes neither its result nor its
/// last motion, gives a value to compare with, and can be interrupted.
#[test]
fn a_job_that_continues_another_can_be_compared() {
    let mut root = coarse();
    root.scene.pin.elements = [10, 10, 10];
    root.scene.contact.mu = 0.5;
    root.detection.cycles = 4;
    root.detection.tolerance = 0.3;
    root.detection.drift_tolerance = 0.2;
    root.continuation = Some(Box::new(Continuation::ROOT));
    let (_, motion) = run_after(&root, None, usize::MAX);
    let mut child = root.clone();
    child.scene.disk.omega_rpm *= 1.2;
    child.continuation =
        Some(Box::new(Continuation { parent: Some("key".to_owned()), ..Continuation::ROOT }));
    let (alone, end) = run_after(&child, Some(motion.clone()), usize::MAX);
    child.run.start = Start::Compared;
    let (compared, same_end) = run_after(&child, Some(motion.clone()), usize::MAX);
    assert_eq!((compared.mu_star, compared.frequency_hz), (alone.mu_star, alone.frequency_hz));
    assert_eq!(same_end, end);
    let start = compared.start.clone().expect("a coarser run");
    assert!(!start.is_used() && start.mu_star.is_some(), "{start:?}");
    for pause in [1, 7] {
        let (again, _) = run_after(&child, Some(motion.clone()), pause);
        assert_eq!(serde_json::to_string(&again).unwrap(), serde_json::to_string(&compared).unwrap());
    }
}

/// Protects: a job that continues a limit cycle begins in it: it is periodic long before the run from rest was, in the same limit cycle.
/// Interruptions change no bit of it. Without the motion that it continues it is refused.
#[test]
fn a_job_continues_the_limit_cycle_of_another() {
    let mut root = coarse();
    root.scene.contact.mu = 0.5;
    root.scene.disk.omega_rpm = 7.0;
    root.run.limit_s = 0.1;
    root.continuation = Some(Box::new(Continuation::ROOT));
    let run = run_after;
    let (first, motion) = run(&root, None, usize::MAX);
    assert_eq!(first.outcome, Outcome::Periodic);
    let mut child = root.clone();
    child.continuation =
        Some(Box::new(Continuation { parent: Some("key".to_owned()), ..Continuation::ROOT }));
    let (second, end) = run(&child, Some(motion.clone()), usize::MAX);
    assert_eq!(second.outcome, Outcome::Periodic);
    assert!(second.simulated_s < 0.7 * first.simulated_s, "{} {}", second.simulated_s, first.simulated_s);
    // Both are within what the detection leaves open.
    let tolerance = root.detection.tolerance;
    assert!((second.mu_star / first.mu_star - 1.0).abs() < tolerance);
    assert!((second.frequency_hz.unwrap() / first.frequency_hz.unwrap() - 1.0).abs() < tolerance);
    for pause in [1, 7] {
        let (again, same_end) = run(&child, Some(motion.clone()), pause);
        assert_eq!(serde_json::to_string(&again).unwrap(), serde_json::to_string(&second).unwrap());
        assert_eq!(same_end, end);
    }
    child.continuation.as_mut().unwrap().kick_m_s = 0.5;
    let (kicked, _) = run(&child, Some(motion), usize::MAX);
    assert_ne!(kicked.simulated_s, second.simulated_s, "a kick is felt");
    let mut batch = Batch::new(&child).unwrap();
    let refused = batch.begin(1, child.clone()).unwrap_err();
    assert!(refused.to_string().contains("continues the job key"), "{refused}");
    let other = PinMotion { u_m: vec![0.0; 3], velocity_m_s: vec![0.0; 3] };
    assert!(batch.begin_after(1, child, Some(other)).is_err(), "a motion of another mesh");
}
