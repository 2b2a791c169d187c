//! Checks of a database and its environment.

use std::collections::BTreeSet;
use std::path::Path;

use super::clock::Clock;
use super::engine::{Connection, Statement, query};
use super::error::QueueError;
use super::finding::Finding;
use super::handle::Queue;
use super::location::Location;
use super::owner::{Liveness, Owner};
use super::sqlite;

const RUNNING_OF: &str = "SELECT COUNT(*) FROM jobs WHERE owner = $1 AND state = 'running'";

const EXPIRED_OF: &str = "
    SELECT COUNT(*) FROM jobs
    WHERE owner = $1 AND state = 'running' AND (lease_until_ms <= $2 OR lease_until_ms > $3)";

/// Checks the database at `location`. It is not changed, except that tables of an older version are migrated.
///
/// # Errors
/// [`QueueError::NoDatabase`]. Every other problem is a finding.
pub async fn examine(location: &Location, clock: Clock) -> Result<Vec<Finding>, QueueError> {
    let mut findings = match location {
        Location::File(path) => surroundings(path)?,
        Location::Server(_) => vec![Finding::good("database", location.to_string())],
    };
    match Queue::open_to_read(location.clone(), clock).await {
        Err(error @ QueueError::NoDatabase { .. }) => return Err(error),
        // Opening refuses network file systems, old libraries, files of other programs and damaged headers.
        Err(error) => findings.push(Finding::bad("opens", error.to_string())),
        Ok(mut queue) => {
            if let Err(error) = inspect(&mut queue, &mut findings).await {
                findings.push(Finding::bad("reads", error.to_string()));
            }
            queue.close().await?;
        }
    }
    Ok(findings)
}

fn surroundings(path: &Path) -> Result<Vec<Finding>, QueueError> {
    if !path.exists() {
        return Err(QueueError::NoDatabase { database: path.into() });
    }
    let path = sqlite::resolve(path)?;
    let is_writable = sqlite::is_writable(&path);
    let writable = if is_writable {
        "yes"
    } else {
        "no: studies can be read; to work on them, make the file and its folder writable"
    };
    Ok(vec![
        Finding::good("database", path.display().to_string()),
        Finding::judged("writable", writable, is_writable),
    ])
}

async fn inspect(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    match &mut queue.connection {
        Connection::Sqlite(file) => sqlite::examine(file.connection(), findings).await?,
        #[cfg(feature = "postgres")]
        Connection::Postgres(session) => {
            session.examine(findings).await?;
            // A difference is no problem: leases use the server's clock only.
            let ahead_ms = queue.now_ms().await? - super::clock::machine_ms();
            let text = format!("the server's clock is {} s ahead of this machine's", ahead_ms as f64 / 1e3);
            findings.push(Finding::good("clock", text));
        }
    }
    tables(queue, findings).await?;
    rows(queue, findings).await?;
    workers(queue, findings).await
}

async fn tables(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let present: BTreeSet<String> =
        query(PRESENT).scalars(&mut queue.connection).await?.into_iter().collect();
    let missing: Vec<&str> = NEEDED.iter().copied().filter(|name| !present.contains(*name)).collect();
    let text = if missing.is_empty() {
        "all there, with their indexes and triggers".to_owned()
    } else {
        format!("missing: {}; take a backup, or submit the studies to a new database", missing.join(", "))
    };
    findings.push(Finding::judged("tables", text, missing.is_empty()));
    Ok(())
}

async fn rows(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let mut wrong = Vec::new();
    for (statement, what) in IMPOSSIBLE {
        let found: i64 = query(statement).scalar(&mut queue.connection).await?;
        if found > 0 {
            wrong.push(format!("{what}: {found}"));
        }
    }
    let text = if wrong.is_empty() {
        "ok".to_owned()
    } else {
        format!(
            "{}; the database was changed by hand or is damaged: take a backup, or submit the studies to a new database",
            wrong.join(", ")
        )
    };
    findings.push(Finding::judged("rows", text, wrong.is_empty()));
    Ok(())
}

/// Rows that this program never writes, and what they are.
const IMPOSSIBLE: [(&str, &str); 6] = [
    (
        "SELECT COUNT(*) FROM jobs WHERE state NOT IN ('pending', 'running', 'done', 'failed', 'cancelled')",
        "jobs with a state that there is not",
    ),
    (
        "SELECT COUNT(*) FROM jobs WHERE attempt < 0 OR attempt > 4294967295 OR crashes < 0",
        "jobs with an impossible number of starts",
    ),
    (
        "SELECT COUNT(*) FROM jobs AS j WHERE j.state IN ('done', 'failed')
           AND NOT EXISTS (SELECT 1 FROM results AS r WHERE r.job_id = j.id AND r.attempt = j.attempt)",
        "ended jobs without a result",
    ),
    (
        "SELECT COUNT(*) FROM jobs AS j WHERE NOT EXISTS (SELECT 1 FROM payloads AS p WHERE p.job_id = j.id)",
        "jobs without a specification",
    ),
    (
        "SELECT COUNT(*) FROM study_jobs WHERE ordinal < 0 OR ordinal >= 9000000000000000000",
        "rows with an impossible number",
    ),
    (
        "SELECT (SELECT COUNT(*) FROM study_pending AS p
                 WHERE NOT EXISTS (SELECT 1 FROM jobs AS j WHERE j.id = p.job_id AND j.state = 'pending'))
              + (SELECT COUNT(*) FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id
                 WHERE j.state = 'pending' AND NOT EXISTS (
                     SELECT 1 FROM study_pending AS p WHERE p.study_id = m.study_id AND p.job_id = j.id))",
        "rows of pending jobs that disagree with the list of pending jobs",
    ),
];

/// The names of tables, indexes and triggers.
const PRESENT: Statement = Statement::each(
    "SELECT name FROM sqlite_schema",
    "SELECT relname::text FROM pg_class WHERE relnamespace = current_schema()::regnamespace
     UNION ALL SELECT tgname::text FROM pg_trigger",
);

/// Those that every database has.
const NEEDED: [&str; 22] = [
    "checkpoints",
    "final_states",
    "jobs",
    "jobs_ended",
    "jobs_owner",
    "jobs_pending",
    "jobs_pending_batch",
    "jobs_pending_changed",
    "jobs_pending_no_more",
    "jobs_state",
    "payloads",
    "plans",
    "results",
    "studies",
    "study_jobs",
    "study_jobs_added",
    "study_jobs_job",
    "study_jobs_removed",
    "study_pending",
    "study_pending_batch",
    "workers",
    "_sqlx_migrations",
];

const ORPHANS: &str = "
    SELECT COUNT(*) FROM jobs AS j
    WHERE j.state = 'running' AND NOT EXISTS (SELECT 1 FROM workers AS w WHERE w.id = j.owner)";

async fn workers(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let now_ms = queue.now_ms().await?;
    let owners = queue.owners().await?;
    let (mut running, mut stale) = (0, 0);
    for owner in &owners {
        let connection = &mut queue.connection;
        let own: i64 = query(RUNNING_OF).bind(owner.id).scalar(connection).await?;
        let expired = query(EXPIRED_OF).bind(owner.id).bind(now_ms).bind(owner.latest_plausible_ms(now_ms));
        let (word, left) = match owner.liveness() {
            Liveness::Alive if owner.is_stopped() => ("stopped", 0),
            Liveness::Alive => ("alive", 0),
            Liveness::Gone => ("gone", own),
            Liveness::Unknown => ("not visible from here", expired.scalar(connection).await?),
        };
        running += own;
        stale += left;
        let ago_s = now_ms.saturating_sub(owner.heartbeat_ms) / 1000;
        let Owner { id, host, pid, version, .. } = owner;
        let text = format!(
            "{id}: process {pid} on {host}, version {version}, {word}, running jobs: {own}, last seen {ago_s} s ago"
        );
        findings.push(Finding::good("worker", text));
    }
    if owners.is_empty() {
        findings.push(Finding::good("worker", "none at work"));
    }
    let orphans: i64 = query(ORPHANS).scalar(&mut queue.connection).await?;
    running += orphans;
    stale += orphans;
    // This is no problem: the next worker takes the jobs back.
    let text = format!("running jobs: {running}, of which processes that are gone have left {stale}");
    let advice = if stale > 0 { "; the next `tribosweep work` takes them back" } else { "" };
    findings.push(Finding::good("leases", text + advice));
    for advice in queue.stopped_workers().await? {
        findings.push(Finding::bad("stopped", advice));
    }
    Ok(())
}
