//! Submitting, resubmitting and sharing.

use tribosweep::queue::{Counts, QueueError, Replaced, Scope, Submitted};

use crate::orchestration::support::{Sandbox, claim, counts, done, failed, finish, job, of, study};

on_both_databases! {
    submitting_twice_adds_nothing,
    studies_share_jobs,
    an_edited_study_is_replaced,
    a_job_may_repeat_in_a_study,
    strings_are_opaque,
    a_cost_is_a_finite_number,
}

/// Protects: a repeated submission costs no simulation and loses no result.
async fn submitting_twice_adds_nothing(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let study = study("a", &["x", "y", "z"]);
    let first = queue.submit(&study).await.unwrap();
    let expected = Submitted {
        replaced: None,
        rows: 3,
        jobs: 3,
        added: 3,
        already_known: 0,
        already_done: 0,
        already_failed: 0,
    };
    assert_eq!(first, expected);
    claim(&mut queue, Scope::All, 2).await;
    assert!(finish(&mut queue, "x", 1, done("record of x")).await);
    assert!(finish(&mut queue, "y", 1, failed("diverged")).await);

    let second = queue.submit(&study).await.unwrap();
    let expected = Submitted {
        replaced: Some(Replaced {
            document: "document of a".into(),
            parameters: Some("parameters of x".into()),
            kept: 3,
            new: 0,
            dropped: 0,
            dropped_done: 0,
            cancelled: 0,
        }),
        added: 0,
        already_known: 3,
        already_done: 1,
        already_failed: 1,
        ..expected
    };
    assert_eq!(second, expected);
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(1, 0, 1, 1));
    assert_eq!(queue.rows("a").await.unwrap()[0].record.as_deref(), Some("record of x"));
}

/// Protects: two studies that request the same job share it and its result, each with its own parameters.
async fn studies_share_jobs(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    let mut other = study("b", &["y", "z"]);
    other.jobs[0].parameters = "y as b calls it".into();
    let submitted = queue.submit(&other).await.unwrap();
    assert_eq!((submitted.added, submitted.already_known), (1, 1));
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(3, 0, 0, 0));

    let claimed = claim(&mut queue, of("b"), 1).await;
    assert_eq!(claimed[0].key, "y");
    assert!(finish(&mut queue, "y", 1, done("record of y")).await);
    let (a, b) = (queue.rows("a").await.unwrap(), queue.rows("b").await.unwrap());
    assert_eq!(a[1].record.as_deref(), Some("record of y"));
    assert_eq!(b[0].record.as_deref(), Some("record of y"));
    assert_eq!((a[1].parameters.as_str(), b[0].parameters.as_str()), ("parameters of y", "y as b calls it"));
}

/// Protects: an edited study has exactly its new document and rows. A job that it no longer contains keeps its result,
/// and the result is available again when a later edit contains the job.
async fn an_edited_study_is_replaced(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    sandbox.clock.set(1_000);
    queue.submit(&study("a", &["x", "y", "z"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, done("record of x")).await);

    sandbox.clock.set(2_000);
    let mut edited = study("a", &["w", "z"]);
    edited.document = "edited".into();
    let submitted = queue.submit(&edited).await.unwrap();
    assert_eq!((submitted.jobs, submitted.added, submitted.already_known), (2, 1, 1));
    let replaced = submitted.replaced.unwrap();
    assert_eq!((replaced.document.as_str(), replaced.kept, replaced.new), ("document of a", 1, 1));
    assert_eq!((replaced.dropped, replaced.dropped_done), (2, 1));
    assert_eq!(replaced.cancelled, 1, "no study requests y");
    let document = queue.study("a").await.unwrap().unwrap();
    assert_eq!((document.document.as_str(), document.submitted_ms), ("edited", 2_000));
    let rows = queue.rows("a").await.unwrap();
    let rows: Vec<_> = rows.iter().map(|row| (row.ordinal, row.key.as_str())).collect();
    assert_eq!(rows, [(0, "w"), (1, "z")]);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), Counts { cancelled: 1, ..counts(2, 0, 1, 0) });

    let submitted = queue.submit(&study("a", &["x", "y"])).await.unwrap();
    assert_eq!((submitted.added, submitted.already_done), (0, 1));
    assert_eq!(submitted.replaced.unwrap().cancelled, 2);
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(1, 0, 1, 0), "y is requested again");
}

/// Protects: two grid points with the identical job are two rows and one simulation.
async fn a_job_may_repeat_in_a_study(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut repeated = study("a", &["x", "y", "x"]);
    repeated.jobs[2].parameters = "x again".into();
    let submitted = queue.submit(&repeated).await.unwrap();
    assert_eq!((submitted.rows, submitted.jobs, submitted.added), (3, 2, 2));
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(2, 0, 0, 0));
    assert_eq!(claim(&mut queue, of("a"), 9).await.len(), 2);
    assert!(finish(&mut queue, "x", 1, done("record of x")).await);

    let rows = queue.rows("a").await.unwrap();
    assert_eq!((rows[0].parameters.as_str(), rows[2].parameters.as_str()), ("parameters of x", "x again"));
    assert_eq!(rows[0].record.as_deref(), Some("record of x"));
    assert_eq!(rows[2].record.as_deref(), Some("record of x"));
}

/// Protects: strings are returned unchanged, whatever they contain.
async fn strings_are_opaque(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let odd = "{\"a\": [1, 'b''\", \"\\u0041 \\\\ \"]}\n\t– μ* ≥ 0 ☃ 1e3";
    let mut odd_study = study(odd, &[odd]);
    odd_study.document = odd.into();
    odd_study.jobs[0].payload = odd.into();
    odd_study.jobs[0].parameters = odd.into();
    queue.submit(&odd_study).await.unwrap();
    let claimed = claim(&mut queue, of(odd), 1).await;
    assert_eq!((claimed[0].key.as_str(), claimed[0].payload.as_str()), (odd, odd));
    assert!(finish(&mut queue, odd, 1, done(odd)).await);
    assert_eq!(queue.study(odd).await.unwrap().unwrap().document, odd);
    let row = queue.rows(odd).await.unwrap().remove(0);
    assert_eq!((row.parameters.as_str(), row.record.as_deref()), (odd, Some(odd)));
}

/// Protects: a cost that cannot be ordered is reported with its job, and nothing of the study is stored.
async fn a_cost_is_a_finite_number(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    for cost in [f64::NAN, f64::INFINITY] {
        let mut bad = study("a", &["x"]);
        bad.jobs.push(job("y", cost));
        let error = queue.submit(&bad).await.unwrap_err();
        assert!(matches!(&error, QueueError::BadCost { key, .. } if key == "y"), "{error:?}");
    }
    assert_eq!(queue.study("a").await.unwrap(), None);
    assert_eq!(queue.counts(&Scope::All).await.unwrap().total(), 0);
}
