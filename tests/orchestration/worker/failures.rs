//! Jobs that fail, and workers that cannot work.

use tribosweep::queue::{FinishedOutcome, JobState, QueueError, Scope};
use tribosweep::spec::JobSpec;
use tribosweep::sweep::job_key;
use tribosweep::worker::{Interrupt, SilentProgress, WorkError, WorkOptions, work};

use super::{Recorder, job, row, several, solvable, spec, submit};
use crate::orchestration::support::{Sandbox, claim, counts, finish, of};

/// Protects: whatever is wrong with a job (its text, its values, its run), only that job fails, with the reason, which
/// the progress display receives; the sweep goes on to its end.
#[tokio::test]
async fn a_failed_job_stops_nothing() {
    let mut diverging = spec(0.2, 0.001);
    diverging.scene.load.force_n = 1e200;
    let mut infinite = spec(0.2, 0.001);
    infinite.scene.disk.omega_rpm = 1e300;
    let mut incompressible = spec(0.2, 0.001);
    incompressible.scene.pin.poisson_ratio = 0.5;
    let mut off_the_mesh = spec(0.2, 0.001);
    off_the_mesh.scene.clamp.width_m = 0.0025;
    // Values that overflow an energy, a time step or a buffer.
    let mut stiff = spec(0.2, 0.001);
    stiff.scene.pin.young_modulus_pa = 1e300;
    let mut nearly_incompressible = spec(0.2, 0.001);
    nearly_incompressible.scene.pin.poisson_ratio = 0.499_999_999_999_99;
    let mut overdamped = spec(0.2, 0.001);
    overdamped.numerics.beta_r_s = 1.0e3;
    let bad = [
        (solvable("stiff", &stiff), "scene.pin.young_modulus_pa"),
        (solvable("nearly incompressible", &nearly_incompressible), "run.limit_s"),
        (solvable("overdamped", &overdamped), "run.limit_s"),
        (job("text", "no job"), "unreadable job: "),
        (job("field", r#"{"scene":{"pins":{}}}"#), "unreadable job: unknown field `pins`"),
        (solvable("values", &incompressible), "scene.pin.poisson_ratio"),
        (solvable("mesh", &off_the_mesh), "scene.clamp.width_m"),
        (solvable("run", &diverging), "diverged at step"),
        (solvable("speed", &infinite), "scene.disk.omega_rpm"),
    ];
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let mut jobs: Vec<_> = bad.iter().map(|(job, _)| job.clone()).collect();
    jobs.extend(several(2, 0.001));
    submit(&mut queue, "study", jobs).await;

    let mut recorder = Recorder::new(|_| ());
    let summary = work(&mut queue, &Scope::All, WorkOptions::new(2), &Interrupt::default(), &mut recorder)
        .await
        .unwrap();
    assert_eq!(summary.counts, counts(0, 0, 2, 9));
    assert!(!summary.interrupted);
    for (job, expected) in &bad {
        let row = row(&mut queue, "study", &job.key).await;
        assert_eq!((row.state, row.attempt), (JobState::Failed, 1), "{row:?}");
        let error = row.error.unwrap();
        assert!(error.contains(expected), "{}: {error}", job.key);
        assert!(row.record.is_none());
        let told: Vec<_> = recorder.failures.iter().filter(|(key, _)| *key == job.key).collect();
        assert_eq!(told, [&(job.key.clone(), error)]);
    }
    assert_eq!(recorder.failures.len(), bad.len());
}

/// Protects: an unknown study is an error, not a sweep of nothing.
#[tokio::test]
async fn an_unknown_study_is_an_error() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let refused =
        work(&mut queue, &of("none"), WorkOptions::new(1), &Interrupt::default(), &mut SilentProgress).await;
    assert!(matches!(refused, Err(WorkError::Queue(QueueError::UnknownStudy { .. }))), "{refused:?}");
}

/// Protects: the result of another scene is never stored under a job's key. A job whose specification was changed fails, also if
/// the specification is a valid one.
#[tokio::test]
async fn a_changed_specification_is_refused() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let specs: Vec<JobSpec> = [0.2, 0.3, 0.4].map(|mu| spec(mu, 0.001)).into();
    let keys: Vec<String> = specs.iter().map(job_key).collect();
    let jobs = keys.iter().zip(&specs).map(|(key, spec)| solvable(key, spec)).collect();
    submit(&mut queue, "study", jobs).await;
    sandbox.run("UPDATE payloads SET payload = '{}' WHERE job_id = 1").await;
    sandbox
        .run("UPDATE payloads SET payload = (SELECT payload FROM payloads WHERE job_id = 3) WHERE job_id = 2")
        .await;
    let options = WorkOptions::new(1).checking(job_key);
    let summary =
        work(&mut queue, &Scope::All, options, &Interrupt::default(), &mut SilentProgress).await.unwrap();
    assert_eq!(summary.counts, counts(0, 0, 1, 2));
    assert_eq!(row(&mut queue, "study", &keys[2]).await.state, JobState::Done);
    for key in &keys[..2] {
        let error = row(&mut queue, "study", key).await.error.unwrap();
        assert!(error.contains("does not have the job's key"), "{error}");
    }
}

/// Protects: a job does not begin with a motion that was damaged. Its error names the job whose motion it is, and the command
/// that makes it again.
#[tokio::test]
async fn a_damaged_motion_is_refused() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    submit(&mut queue, "study", vec![job("parent", "{}")]).await;
    claim(&mut queue, Scope::All, 1).await;
    let outcome =
        FinishedOutcome::Done { record: "{}".into(), label: "end".into(), final_state: Some(vec![0; 48]) };
    assert!(finish(&mut queue, "parent", 1, outcome).await);
    let mut child = solvable("child", &spec(0.2, 0.001));
    child.parent = Some("parent".into());
    submit(&mut queue, "study", vec![job("parent", "{}"), child]).await;
    sandbox.run("UPDATE final_states SET bytes = zeroblob(56)").await;
    let options = WorkOptions::new(1);
    work(&mut queue, &Scope::All, options, &Interrupt::default(), &mut SilentProgress).await.unwrap();
    let error = row(&mut queue, "study", "child").await.error.unwrap();
    assert!(error.contains("in which job parent ended is damaged"), "{error}");
    assert!(error.contains("retry STUDY --unreadable"), "{error}");
}

/// Protects: a worker that is alone with jobs which it can never claim does not wait for them for ever.
#[tokio::test]
async fn jobs_that_cannot_be_claimed_are_an_error() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    submit(&mut queue, "study", vec![]).await;
    sandbox.run("INSERT INTO study_pending VALUES (1, 0, 1.0, 77, '')").await;
    let worked =
        work(&mut queue, &of("study"), WorkOptions::new(1), &Interrupt::default(), &mut SilentProgress).await;
    let error = worked.unwrap_err();
    assert!(matches!(error, WorkError::Queue(QueueError::Inconsistent(_))), "{error:?}");
}
