//! Copying studies from one database into another.

use tribosweep::queue::{Absorbed, JobState, QueueError, Replace, Scope, Shard, StudyRow};

use crate::orchestration::support::{Sandbox, claim, counts, done, failed, finish, job, labelled, of, study};

on_both_databases! {
    a_copy_is_the_same,
    shards_make_up_the_whole,
    the_better_outcome_is_kept,
    a_copy_requests_its_jobs,
    a_different_study_of_the_same_name_is_refused,
}

/// The data of a row without the number of attempts: ordinal, key, state, record and error.
type Outcome<'a> = (u64, &'a str, JobState, Option<&'a str>, Option<&'a str>);

fn outcomes(rows: &[StudyRow]) -> Vec<Outcome<'_>> {
    let outcome = |row| -> Outcome<'_> {
        let &StudyRow { ordinal, ref key, state, ref record, ref error, .. } = row;
        (ordinal, key.as_str(), state, record.as_deref(), error.as_deref())
    };
    rows.iter().map(outcome).collect()
}

/// Protects: a study that is copied into either database and back is identical: rows, records, errors, times to the
/// last bit, attempts, notes, priorities and checkpoints. Running jobs are pending in the copy. A repeated copy changes
/// nothing.
async fn a_copy_is_the_same(sandbox: &Sandbox) {
    let (source, back) = (Sandbox::new(), Sandbox::new());
    source.clock.set(1_000);
    let mut from = source.open().await;
    let mut own = study("a", &["x", "y", "x", "z", "w", "v"]);
    own.jobs[1].priority = Some(7);
    own.jobs[3].batch = "b".into();
    from.submit(&own).await.unwrap();
    from.submit(&study("b", &["x", "other"])).await.unwrap();
    claim(&mut from, Scope::All, 1).await;
    assert!(finish(&mut from, "y", 1, labelled("record \u{e9} \"quoted\"\n", "periodic")).await);
    for attempt in [1, 2] {
        let claimed = claim(&mut from, Scope::All, 1).await;
        assert_eq!((claimed[0].key.as_str(), claimed[0].attempt), ("x", attempt));
        let outcome =
            if attempt == 1 { tribosweep::queue::FinishedOutcome::Released } else { failed("diverged") };
        assert!(finish(&mut from, "x", attempt, outcome).await);
    }
    let running = claim(&mut from, of("a"), 2).await;
    assert!(from.save_checkpoint(&running[0].key, 1, &[0, 255, 7]).await.unwrap());

    let mut to = sandbox.open().await;
    let absorbed = to.absorb(&mut from, None).await.unwrap();
    assert_eq!(absorbed, Absorbed { studies: 2, rows: 8, added: 6, ended: 2, open: 4 });
    let mut again = back.open().await;
    again.absorb(&mut to, Some("a")).await.unwrap();
    for target in [&mut to, &mut again] {
        for _ in 0..2 {
            let mut expected = from.rows("a").await.unwrap();
            for row in expected.iter_mut().filter(|row| row.state == JobState::Running) {
                row.state = JobState::Pending;
            }
            assert_eq!(target.rows("a").await.unwrap(), expected);
            assert_eq!(target.study("a").await.unwrap(), from.study("a").await.unwrap());
            for key in ["x", "y", "z"] {
                let mut there = from.jobs(key, 1).await.unwrap().remove(0);
                let here = target.jobs(key, 1).await.unwrap().remove(0);
                (there.state, there.studies) = (here.state, here.studies.clone());
                assert_eq!(here, there);
            }
            // A repeated copy adds nothing.
            let absorbed = target.absorb(&mut from, Some("a")).await.unwrap();
            assert_eq!((absorbed.added, absorbed.ended), (0, 0));
        }
    }
    let claimed = claim(&mut to, Scope::All, 9).await;
    let kept = claimed.iter().find(|job| job.key == running[0].key).unwrap();
    assert_eq!((kept.attempt, kept.checkpoint.as_deref()), (2, Some(&[0, 255, 7][..])));
    assert_eq!(kept.payload, format!("payload of {}", kept.key));
}

/// Protects: the shards of a study are disjoint, and together they are the whole study in its order. After a merge,
/// each job has the result from its shard.
async fn shards_make_up_the_whole(sandbox: &Sandbox) {
    let whole = study("a", &["j0", "j1", "j2", "j3", "j4", "j5", "j6"]);
    let mut merged = sandbox.open().await;
    for index in 0..3 {
        let part = Sandbox::new();
        let mut queue = part.open().await;
        let submitted =
            queue.submit_shard(&whole, Shard { index, of: 3 }, &Replace::KeepingResults).await.unwrap();
        assert_eq!((submitted.rows, submitted.added), ([3, 2, 2][index as usize], [3, 2, 2][index as usize]));
        let rows = queue.rows("a").await.unwrap();
        assert!(rows.iter().all(|row| row.ordinal % 3 == index), "{rows:?}");
        // Submitting the shard again does not change it.
        let again = queue.submit_shard(&whole, Shard { index, of: 3 }, &Replace::KeepingResults).await;
        assert_eq!(again.unwrap().added, 0);
        assert_eq!(queue.rows("a").await.unwrap(), rows);
        for job in claim(&mut queue, Scope::All, 9).await {
            assert!(finish(&mut queue, &job.key, 1, done(&format!("record of {}", job.key))).await);
        }
        merged.absorb(&mut queue, None).await.unwrap();
    }
    assert_eq!(merged.counts(&of("a")).await.unwrap(), counts(0, 0, 7, 0));
    let rows = merged.rows("a").await.unwrap();
    for (place, row) in (0..).zip(&rows) {
        let key = format!("j{place}");
        assert_eq!((row.ordinal, &row.key), (place, &key));
        assert_eq!(row.record, Some(format!("record of {key}")));
    }
}

/// Protects: the better of two outcomes is kept, whichever database it is in, and jobs that are running here do not
/// change.
async fn the_better_outcome_is_kept(sandbox: &Sandbox) {
    let source = Sandbox::new();
    let (mut here, mut there) = (sandbox.open().await, source.open().await);
    let keys =
        ["done, failed", "failed, done", "pending, failed", "running, done", "done, done", "new, done"];
    here.submit(&study("a", &keys[..5])).await.unwrap();
    let mut of_there = study("a", &keys);
    of_there.document = "document of a".into();
    there.submit(&of_there).await.unwrap();
    for (queue, place, record) in [(&mut here, 0, "here"), (&mut there, 1, "there")] {
        for job in claim(queue, Scope::All, 9).await {
            match job.key.split(", ").nth(place).unwrap() {
                _ if job.key.starts_with("new") && place == 0 => {}
                "done" => assert!(finish(queue, &job.key, 1, done(record)).await),
                "failed" => assert!(finish(queue, &job.key, 1, failed(record)).await),
                "pending" => {
                    let unstarted = tribosweep::queue::FinishedOutcome::Unstarted;
                    assert!(finish(queue, &job.key, 1, unstarted).await);
                }
                _ => {}
            }
        }
    }
    let absorbed = here.absorb(&mut there, None).await.unwrap();
    assert_eq!(absorbed, Absorbed { studies: 1, rows: 6, added: 1, ended: 3, open: 1 });
    let rows = here.rows("a").await.unwrap();
    let expected = [
        (0, keys[0], JobState::Done, Some("here"), None),
        (1, keys[1], JobState::Done, Some("there"), None),
        (2, keys[2], JobState::Failed, None, Some("there")),
        (3, keys[3], JobState::Running, None, None),
        (4, keys[4], JobState::Done, Some("here"), None),
        (5, keys[5], JobState::Done, Some("there"), None),
    ];
    assert_eq!(outcomes(&rows), expected);
    assert_eq!(rows[1].attempt, 2, "the failed attempt here came before");
    assert!(
        finish(&mut here, keys[3], 1, done("here")).await,
        "the job belonged to this worker all the time"
    );
}

/// Protects: a copied study requests its jobs: jobs that were cancelled here become pending.
async fn a_copy_requests_its_jobs(sandbox: &Sandbox) {
    let source = Sandbox::new();
    let (mut here, mut there) = (sandbox.open().await, source.open().await);
    here.submit(&study("a", &["x", "y"])).await.unwrap();
    here.remove("a").await.unwrap();
    there.submit(&study("a", &["x", "y"])).await.unwrap();
    assert_eq!(here.absorb(&mut there, None).await.unwrap().open, 2);
    assert_eq!(here.counts(&of("a")).await.unwrap(), counts(2, 0, 0, 0));
    assert_eq!(claim(&mut here, of("a"), 9).await.len(), 2);
}

/// Protects: a different study of the same name is refused before anything is written.
async fn a_different_study_of_the_same_name_is_refused(sandbox: &Sandbox) {
    let source = Sandbox::new();
    let (mut here, mut there) = (sandbox.open().await, source.open().await);
    here.submit(&study("b", &["x"])).await.unwrap();
    there.submit(&study("a", &["y"])).await.unwrap();
    let mut other = study("b", &["z"]);
    other.document = "another one".into();
    other.jobs.push(job("w", 2.0));
    there.submit(&other).await.unwrap();
    let error = here.absorb(&mut there, None).await.unwrap_err();
    assert!(matches!(&error, QueueError::OtherStudy { name } if name == "b"), "{error:?}");
    assert_eq!(here.studies().await.unwrap().len(), 1);
    assert_eq!(here.counts(&Scope::All).await.unwrap(), counts(1, 0, 0, 0));
    let error = here.absorb(&mut there, Some("c")).await.unwrap_err();
    assert!(matches!(error, QueueError::UnknownStudy { .. }), "{error:?}");
}
