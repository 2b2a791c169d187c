//! What reports and the progress display read.

use tribosweep::queue::{
    Claim, Integrity, JobState, Queue, QueueError, Remaining, Rows, Scope, StudyDocument, StudyRow,
    StudySummary,
};

use crate::orchestration::support::{Sandbox, claim, counts, done, failed, finish, labelled, of, study};

on_both_databases! {
    studies_are_listed_with_their_counts,
    the_document_is_kept,
    rows_are_complete_and_in_order,
    rows_are_read_with_their_payloads,
    jobs_are_found_in_one_study,
    remaining_cost,
    an_unknown_study_is_an_error_with_the_known_ones,
    rows_are_found_by_their_label,
    pages_follow_each_other,
}

/// Protects: the list of studies is in the order of submission, each with its own counts.
async fn studies_are_listed_with_their_counts(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    assert!(queue.studies().await.unwrap().is_empty());
    sandbox.clock.set(1_000);
    queue.submit(&study("b", &["x", "y"])).await.unwrap();
    sandbox.clock.set(2_000);
    queue.submit(&study("a", &["y"])).await.unwrap();
    sandbox.clock.set(3_000);
    queue.submit(&study("empty", &[])).await.unwrap();
    claim(&mut queue, of("a"), 1).await;

    let summary = |name: &str, submitted_ms, counts| StudySummary { name: name.into(), submitted_ms, counts };
    let expected = [
        summary("b", 1_000, counts(1, 1, 0, 0)),
        summary("a", 2_000, counts(0, 1, 0, 0)),
        summary("empty", 3_000, counts(0, 0, 0, 0)),
    ];
    assert_eq!(queue.studies().await.unwrap(), expected);
}

/// Protects: the document of a study is kept unchanged. Asking for a missing study is no error here.
async fn the_document_is_kept(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    sandbox.clock.set(1_000);
    queue.submit(&study("a", &["x"])).await.unwrap();
    let expected = StudyDocument { name: "a".into(), document: "document of a".into(), submitted_ms: 1_000 };
    assert_eq!(queue.study("a").await.unwrap(), Some(expected));
    assert_eq!(queue.study("b").await.unwrap(), None);
}

/// Protects: rows come in the order of the study, each with the data of its job.
async fn rows_are_complete_and_in_order(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["z", "y", "x", "w"])).await.unwrap();
    sandbox.clock.set(1_000);
    claim(&mut queue, Scope::All, 3).await;
    sandbox.clock.set(4_000);
    assert!(finish(&mut queue, "z", 1, done("record of z")).await);
    assert!(finish(&mut queue, "y", 1, failed("error of y")).await);

    let row = |ordinal, key: &str, state, attempt| StudyRow {
        ordinal,
        key: key.into(),
        parameters: format!("parameters of {key}"),
        state,
        record: None,
        error: None,
        integrity: Integrity::WithoutDigest,
        wall_s: None,
        attempt,
        crashes: 0,
        note: None,
        payload: None,
    };
    let ended = |row| StudyRow { wall_s: Some(2.5), integrity: Integrity::Intact, ..row };
    let expected = [
        StudyRow { record: Some("record of z".into()), ..ended(row(0, "z", JobState::Done, 1)) },
        StudyRow { error: Some("error of y".into()), ..ended(row(1, "y", JobState::Failed, 1)) },
        row(2, "x", JobState::Running, 1),
        row(3, "w", JobState::Pending, 0),
    ];
    assert_eq!(queue.rows("a").await.unwrap(), expected);
}

/// Protects: payloads are read with the rows if they are asked for, and nothing else changes.
async fn rows_are_read_with_their_payloads(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["y", "x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    let pages = queue.pages_with_payloads("a").await.unwrap();
    let mut rows = queue.all_pages(pages).await.unwrap();
    let payloads: Vec<_> = rows.iter_mut().map(|row| row.payload.take().unwrap()).collect();
    assert_eq!(payloads, ["payload of y", "payload of x", "payload of y"]);
    assert_eq!(rows, queue.rows("a").await.unwrap());
}

/// Protects: a job is looked for in one study only, whatever other studies have, with its parameters there.
async fn jobs_are_found_in_one_study(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["k1", "k2", "m"])).await.unwrap();
    let mut b = study("b", &["k2", "k3"]);
    b.jobs[0].parameters = "k2 in b".into();
    queue.submit(&b).await.unwrap();
    for (study, prefix, keys) in [
        ("a", "k", vec!["k1", "k2"]),
        ("b", "k", vec!["k2", "k3"]),
        ("b", "m", vec![]),
        ("a", "", vec!["k1", "k2", "m"]),
    ] {
        let found = queue.jobs_in(study, prefix, 9).await.unwrap();
        assert_eq!(found.iter().map(|job| job.key.as_str()).collect::<Vec<_>>(), keys, "{prefix} in {study}");
    }
    assert_eq!(queue.jobs("k", 9).await.unwrap().len(), 3);
    assert_eq!(queue.jobs_in("a", "", 2).await.unwrap().len(), 2);
    assert!(matches!(queue.jobs_in("c", "k", 9).await, Err(QueueError::UnknownStudy { .. })));
    assert_eq!(queue.parameters("b", "k2").await.unwrap().as_deref(), Some("k2 in b"));
    assert_eq!(queue.parameters("a", "k2").await.unwrap().as_deref(), Some("parameters of k2"));
    assert_eq!(queue.parameters("b", "k1").await.unwrap(), None);
}

/// Protects: the remaining cost is that of the pending and running jobs, and those without a cost are counted.
async fn remaining_cost(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut a = study("a", &["p", "q", "r", "s", "t"]);
    for (job, cost) in a.jobs.iter_mut().zip([16.0, 8.0, 4.0, 2.0, 1.0]) {
        job.cost = cost;
    }
    let is = |cost, without_cost| Remaining { cost, without_cost };
    queue.submit(&a).await.unwrap();
    queue.submit(&study("b", &["p", "u"])).await.unwrap();
    assert_eq!(queue.remaining(&Scope::All).await.unwrap(), is(32.0, 0));
    claim(&mut queue, of("a"), 4).await;
    for (key, outcome) in [("q", done("r")), ("p", done("r")), ("r", failed("e"))] {
        assert!(finish(&mut queue, key, 1, outcome).await);
    }

    assert_eq!(queue.remaining(&Scope::All).await.unwrap(), is(4.0, 0), "s is running; t and u are pending");
    assert_eq!(queue.remaining(&of("a")).await.unwrap(), is(3.0, 0));

    let mut modes = study("c", &["v", "w", "t"]);
    for job in &mut modes.jobs[..2] {
        job.cost = 0.0;
    }
    queue.submit(&modes).await.unwrap();
    claim(&mut queue, of("c"), 2).await;
    assert_eq!(
        queue.remaining(&of("c")).await.unwrap(),
        is(1.0, 2),
        "t and a job without a cost are running, the other one is pending"
    );
    assert_eq!(queue.remaining(&Scope::All).await.unwrap(), is(4.0, 2));
}

/// Protects: for a mistyped study name, every operation returns an error that lists the existing names.
async fn an_unknown_study_is_an_error_with_the_known_ones(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let error = queue.rows("a").await.unwrap_err();
    assert!(error.to_string().contains("it has none yet"), "{error}");

    queue.submit(&study("speed map", &["x"])).await.unwrap();
    queue.submit(&study("friction map", &["x"])).await.unwrap();
    let errors = [
        queue.rows("map").await.unwrap_err(),
        queue.counts(&of("map")).await.unwrap_err(),
        queue.remaining(&of("map")).await.unwrap_err(),
        queue.exchange(&[], &[Claim { scope: of("map"), limit: 0, batch: None }]).await.unwrap_err(),
    ];
    for error in errors {
        assert!(matches!(error, QueueError::UnknownStudy { .. }), "{error:?}");
        assert_eq!(
            error.to_string(),
            "there is no study `map` in the database; it has: speed map, friction map"
        );
    }
}

/// The ordinals of the rows of study `a`.
async fn ordinals_of(queue: &mut Queue, which: Rows<'_>) -> Vec<u64> {
    let pages = queue.pages_of_rows("a", which).await.unwrap();
    queue.all_pages(pages).await.unwrap().iter().map(|row| row.ordinal).collect()
}

/// Protects: rows are found by their label, and only if their job is done.
async fn rows_are_found_by_their_label(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut a = study("a", &["p", "q", "r", "s", "p"]);
    a.jobs[4].parameters = "p again".into();
    queue.submit(&a).await.unwrap();
    claim(&mut queue, of("a"), 3).await;
    for (key, outcome) in [("p", labelled("r", "good")), ("q", labelled("r", "bad")), ("r", failed("good"))] {
        assert!(finish(&mut queue, key, 1, outcome).await);
    }
    for (label, ordinals) in [("good", vec![0, 4]), ("bad", vec![1]), ("none", vec![])] {
        assert_eq!(ordinals_of(&mut queue, Rows::Done(label)).await, ordinals, "{label}");
    }
    assert_eq!(ordinals_of(&mut queue, Rows::Failed).await, [2]);
    assert_eq!(ordinals_of(&mut queue, Rows::All).await, [0, 1, 2, 3, 4]);
}

/// Protects: the pages of a long study have all its rows, each once and in order.
async fn pages_follow_each_other(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let names: Vec<String> = (0..2_500).map(|number| format!("job {number}")).collect();
    queue.submit(&study("a", &names.iter().map(String::as_str).collect::<Vec<_>>())).await.unwrap();
    let mut pages = queue.pages_of_rows("a", Rows::All).await.unwrap();
    let (mut sizes, mut ordinals) = (Vec::new(), Vec::new());
    while let Some(page) = queue.next_page(&mut pages).await.unwrap() {
        sizes.push(page.len());
        ordinals.extend(page.iter().map(|row| row.ordinal));
    }
    assert_eq!(sizes, [1_000, 1_000, 500]);
    assert!(ordinals.into_iter().eq(0..2_500));
    let pages = queue.pages_of_parameters("a").await.unwrap();
    let parameters = queue.all_pages(pages).await.unwrap();
    assert_eq!(parameters.len(), 2_500);
    assert_eq!(parameters[2_499], "parameters of job 2499");
}
