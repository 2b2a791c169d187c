//! The size the queue is for.

use tribosweep::queue::{NewStudy, Scope};

use crate::support::{Sandbox, claim, counts, job, keys, of};

/// Protects: a study of 100 000 jobs is planned completely and in order, across the parts it is inserted in,
/// and again without adding anything.
#[tokio::test]
async fn a_hundred_thousand_jobs_are_planned() {
    const JOBS: u64 = 100_000;
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let study = NewStudy {
        name: "large".into(),
        document: String::new(),
        jobs: (0..JOBS).map(|index| job(&format!("job {index}"), (index / 2) as f64)).collect(),
    };
    assert_eq!(queue.submit(&study).await.unwrap().added, JOBS);
    assert_eq!(queue.submit(&study).await.unwrap().already_known, JOBS);
    assert_eq!(queue.counts(&of("large")).await.unwrap(), counts(JOBS, 0, 0, 0));
    assert_eq!(keys(&claim(&mut queue, of("large"), 3).await), ["job 99998", "job 99999", "job 99996"]);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(JOBS - 3, 3, 0, 0));

    let rows = queue.rows("large").await.unwrap();
    assert_eq!(rows.len() as u64, JOBS);
    for (index, row) in (0..).zip(&rows) {
        assert_eq!((row.ordinal, &row.key), (index, &format!("job {index}")));
    }
}
