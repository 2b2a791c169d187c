//! Nothing is replaced or removed unnoticed: replacements that are refused, names, previews, and retries after a crash.

use tribosweep::queue::{Garbage, QueueError, Replace, Replaced, Retry, Scope, Shard, Submitted, TakenBack};

use crate::orchestration::support::{
    Sandbox, claim, counts, dead_worker, done, failed, finish, foreign_worker, keys, of, study,
};

on_both_databases! {
    results_stay_in_view,
    a_shard_is_not_replaced_by_another,
    an_agreement_holds_for_one_document,
    a_study_gets_another_name,
    previews_tell_what_happens,
    a_retry_finds_jobs_of_dead_workers,
}

const KEEPING: Replace = Replace::KeepingResults;

/// A database with a study a of x (done), y (failed), z and w. Study b has w too.
async fn begun(sandbox: &Sandbox) -> tribosweep::queue::Queue {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y", "z", "w"])).await.unwrap();
    queue.submit(&study("b", &["w"])).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, of("a"), 2).await), ["x", "y"]);
    assert!(finish(&mut queue, "x", 1, done("record of x")).await);
    assert!(finish(&mut queue, "y", 1, failed("diverged")).await);
    queue
}

fn replaced(submitted: Result<Submitted, QueueError>) -> Replaced {
    submitted.unwrap().replaced.unwrap()
}

/// Protects: a submission that would take a result out of view is refused, says what would change, and changes nothing.
/// Any other one needs no permission: an extension, another order, fewer jobs without results.
async fn results_stay_in_view(sandbox: &Sandbox) {
    let mut queue = begun(sandbox).await;
    let (rows, states) = (queue.rows("a").await.unwrap(), queue.counts(&Scope::All).await.unwrap());
    let mut other = study("a", &["y", "v"]);
    other.document = "another document".into();
    let error = queue.submit_shard(&other, Shard::WHOLE, &KEEPING).await.unwrap_err();
    assert!(error.to_string().contains("--replace"), "{error}");
    let QueueError::ResultsWouldBeDropped { name, replaced: refused } = error else { panic!("{error}") };
    let expected = Replaced {
        document: "document of a".into(),
        parameters: Some("parameters of x".into()),
        kept: 1,
        new: 1,
        dropped: 3,
        dropped_done: 1,
        cancelled: 1,
    };
    assert_eq!((name.as_str(), &*refused), ("a", &expected));
    let preview = queue.preview_replacement("a", &["y", "v"].into(), "").await.unwrap();
    assert_eq!(preview.as_ref(), Some(&expected), "the preview has the numbers of the submission");
    assert_eq!(queue.preview_replacement("c", &["y", "v"].into(), "").await.unwrap(), None);
    assert_eq!(queue.rows("a").await.unwrap(), rows);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), states);
    assert_eq!(queue.study("a").await.unwrap().unwrap().document, "document of a");

    // x has other rows and is done: it is kept. z and w have no result.
    let mut extended = study("a", &["v", "y", "x", "x"]);
    extended.document = "extended".into();
    let changed = replaced(queue.submit_shard(&extended, Shard::WHOLE, &KEEPING).await);
    let expected = Replaced { kept: 2, dropped: 2, dropped_done: 0, ..expected };
    assert_eq!(changed, expected);
    assert_eq!(queue.rows("a").await.unwrap()[3].record.as_deref(), Some("record of x"));
    let same = replaced(queue.submit_shard(&extended, Shard::WHOLE, &KEEPING).await);
    assert_eq!((same.kept, same.new, same.dropped, same.cancelled), (3, 0, 0, 0));

    let changed = replaced(queue.submit_shard(&other, Shard::WHOLE, &Replace::Always).await);
    assert_eq!((changed.kept, changed.new, changed.dropped, changed.dropped_done), (2, 0, 1, 1));
    assert_eq!(changed.document, "extended");
}

/// Protects: a shard with results is not replaced by another shard of the same study, whose jobs are others.
async fn a_shard_is_not_replaced_by_another(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let whole = study("a", &["x", "y", "z"]);
    let shard = |index| Shard { index, of: 2 };
    queue.submit_shard(&whole, shard(0), &KEEPING).await.unwrap();
    let open = replaced(queue.submit_shard(&whole, shard(1), &KEEPING).await);
    assert_eq!((open.kept, open.new, open.dropped, open.cancelled), (0, 1, 2, 2), "nothing is done yet");
    claim(&mut queue, of("a"), 1).await;
    assert!(finish(&mut queue, "y", 1, done("r")).await);
    let refused = queue.submit_shard(&whole, shard(0), &KEEPING).await.unwrap_err();
    assert!(matches!(refused, QueueError::ResultsWouldBeDropped { .. }), "{refused}");
    let all = replaced(queue.submit_shard(&whole, Shard::WHOLE, &KEEPING).await);
    assert_eq!((all.kept, all.new, all.dropped), (1, 2, 0));
}

/// Protects: who has agreed that a certain study is replaced has not agreed to the replacement of what another process
/// has put in its place.
async fn an_agreement_holds_for_one_document(sandbox: &Sandbox) {
    let mut queue = begun(sandbox).await;
    let agreed = Replace::Document("document of a".into());
    let mut other = study("a", &["x", "z"]);
    other.document = "of another process".into();
    queue.submit(&other).await.unwrap();
    let mine = study("a", &["v"]);
    let refused = queue.submit_shard(&mine, Shard::WHOLE, &agreed).await.unwrap_err();
    assert!(matches!(refused, QueueError::ResultsWouldBeDropped { .. }), "{refused}");
    let agreed = Replace::Document("of another process".into());
    assert_eq!(replaced(queue.submit_shard(&mine, Shard::WHOLE, &agreed).await).dropped_done, 1);
}

/// Protects: a study that is renamed keeps its rows and results, its document is edited, and no other study is touched.
/// A name that a study has is refused.
async fn a_study_gets_another_name(sandbox: &Sandbox) {
    let mut queue = begun(sandbox).await;
    let rows = queue.rows("a").await.unwrap();
    let taken = queue.rename("a", "b", str::to_owned).await.unwrap_err();
    assert!(matches!(&taken, QueueError::NameTaken { name } if name == "b"), "{taken}");
    let unknown = queue.rename("c", "d", str::to_owned).await.unwrap_err();
    assert!(matches!(unknown, QueueError::UnknownStudy { .. }), "{unknown}");
    queue.rename("a", "c", |document| document.replace(" a", " c")).await.unwrap();
    assert!(queue.study("a").await.unwrap().is_none());
    assert_eq!(queue.study("c").await.unwrap().unwrap().document, "document of c");
    assert_eq!(queue.rows("c").await.unwrap(), rows);
    assert_eq!(queue.study("b").await.unwrap().unwrap().document, "document of b");
}

/// Protects: the previews of a removal and of garbage collection have the numbers of what then happens, and change nothing.
async fn previews_tell_what_happens(sandbox: &Sandbox) {
    let mut queue = begun(sandbox).await;
    // w is done too, and also in b.
    assert_eq!(keys(&claim(&mut queue, of("b"), 1).await), ["w"]);
    assert!(finish(&mut queue, "w", 1, done("record of w")).await);
    let before = queue.counts(&Scope::All).await.unwrap();
    let preview = queue.preview_removal("a").await.unwrap();
    assert_eq!((preview.rows, preview.jobs, preview.cancelled), (4, 4, 1));
    assert_eq!((preview.done, preview.shared_done), (2, 1));
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), before);
    assert_eq!(queue.preview_garbage().await.unwrap(), Garbage::default());
    assert_eq!(queue.remove("a").await.unwrap(), preview);
    assert!(matches!(queue.preview_removal("a").await, Err(QueueError::UnknownStudy { .. })));

    let ended = sandbox.open_as(&dead_worker()).await;
    ended.close().await.unwrap();
    queue.take_back().await.unwrap();
    let before = queue.counts(&Scope::All).await.unwrap();
    let preview = queue.preview_garbage().await.unwrap();
    assert_eq!((preview.jobs, preview.results), (3, 2), "x, y and z; w is in b");
    let texts = ["payload of x", "payload of y", "payload of z", "record of x", "diverged"];
    assert_eq!(preview.bytes, texts.map(str::len).iter().sum::<usize>() as u64);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), before);
    let garbage = queue.collect_garbage().await.unwrap();
    assert_eq!(
        (garbage.jobs, garbage.results, garbage.workers),
        (preview.jobs, preview.results, preview.workers)
    );
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 0, 1, 0));
}

/// Protects: a retry makes pending what a worker left that has died, and says so. Jobs of a worker that may be alive stay
/// with it.
async fn a_retry_finds_jobs_of_dead_workers(sandbox: &Sandbox) {
    let mut dead = sandbox.open_as(&dead_worker()).await;
    dead.submit(&study("a", &["x", "y", "z"])).await.unwrap();
    claim(&mut dead, of("a"), 2).await;
    dead.close().await.unwrap();
    let mut elsewhere = sandbox.open_as(&foreign_worker()).await;
    claim(&mut elsewhere, of("a"), 1).await;
    let mut queue = sandbox.open().await;
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(0, 3, 0, 0));
    let unknown = queue.retry("b", Retry::All).await.unwrap_err();
    assert!(matches!(unknown, QueueError::UnknownStudy { .. }), "{unknown}");
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(0, 3, 0, 0), "nothing has changed");
    let retried = queue.retry("a", Retry::Failed).await.unwrap();
    assert_eq!(retried.taken_back, TakenBack { pending: 2, failed: 0 });
    assert_eq!((retried.failed, retried.cancelled), (0, 0));
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(2, 1, 0, 0));
}
