//! What can be wrong with a database and its surroundings, looked at one by one.

use std::path::Path;
use std::sync::Arc;

use sqlx::SqliteConnection;

use super::take_back::{Owner, Verdict};
use super::{Clock, Queue, QueueError, open};

/// One thing that was looked at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What was looked at.
    pub subject: &'static str,
    /// What was found, and what to do about it if it is wrong.
    pub text: String,
    /// Whether it needs doing something.
    pub is_problem: bool,
}

impl Finding {
    fn good(subject: &'static str, text: impl Into<String>) -> Self {
        Self { subject, text: text.into(), is_problem: false }
    }

    fn bad(subject: &'static str, text: impl Into<String>) -> Self {
        Self { subject, text: text.into(), is_problem: true }
    }

    fn judged(subject: &'static str, text: impl Into<String>, is_good: bool) -> Self {
        Self { subject, text: text.into(), is_problem: !is_good }
    }
}

const SYNCHRONOUS: [&str; 4] = ["off", "normal", "full", "extra"];

const RUNNING_OF: &str = "SELECT COUNT(*) FROM jobs WHERE owner = ?1 AND state = 'running'";

const EXPIRED_OF: &str = "
    SELECT COUNT(*) FROM jobs
    WHERE owner = ?1 AND state = 'running' AND (lease_until_ms <= ?2 OR lease_until_ms > ?3)";

/// Looks at the database at `path`. It is not changed, but for tables that are brought up to date.
///
/// # Errors
/// [`QueueError::NoDatabase`]; all else is a finding.
pub async fn examine(path: &Path, clock: Arc<dyn Clock>) -> Result<Vec<Finding>, QueueError> {
    if !path.exists() {
        return Err(QueueError::NoDatabase { path: path.into() });
    }
    let path = open::resolve(path)?;
    let mut findings = vec![Finding::good("database", path.display().to_string())];
    let is_writable = open::is_writable(&path);
    findings.push(Finding::judged(
        "writable",
        if is_writable {
            "yes"
        } else {
            "no: studies can be looked at; to work on them, make file and folder writable"
        },
        is_writable,
    ));
    match Queue::open_to_read(&path, clock).await {
        // Network file systems, old libraries, other programs' files and damaged headers are refused there.
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

async fn inspect(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let version: String = scalar(&mut queue.connection, "SELECT sqlite_version()").await?;
    findings.push(Finding::good("SQLite", version));
    findings.push(Finding::good("file system", "local, or not known to be of the network"));
    let mode: String = scalar(&mut queue.connection, "PRAGMA journal_mode").await?;
    // A database that cannot be written is read as if it had no log.
    findings.push(Finding::good("journal", mode));
    let level: i64 = scalar(&mut queue.connection, "PRAGMA synchronous").await?;
    let level = usize::try_from(level).ok().and_then(|level| SYNCHRONOUS.get(level));
    findings.push(Finding::good("synchronous", *level.unwrap_or(&"unknown")));

    // The first few tell what is wrong.
    let damage: Vec<String> =
        sqlx::query_scalar("PRAGMA integrity_check(5)").fetch_all(&mut queue.connection).await?;
    let is_whole = damage == ["ok"];
    let advice = "; copy what can be read with `sqlite3 FILE .recover`, or take a backup";
    let text = if is_whole { "ok".to_owned() } else { damage.join("; ") + advice };
    findings.push(Finding::judged("integrity", text, is_whole));

    let orphans: i64 = scalar(&mut queue.connection, "SELECT COUNT(*) FROM pragma_foreign_key_check").await?;
    let text =
        if orphans == 0 { "ok".to_owned() } else { format!("{orphans} rows refer to what is not there") };
    findings.push(Finding::judged("references", text, orphans == 0));

    workers(queue, findings).await
}

async fn workers(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let (now_ms, far_ms) = queue.lease_window();
    let owners = queue.owners().await?;
    let (mut running, mut stale) = (0, 0);
    for owner in &owners {
        let connection = &mut queue.connection;
        let own: i64 = sqlx::query_scalar(RUNNING_OF).bind(owner.id).fetch_one(&mut *connection).await?;
        let expired = sqlx::query_scalar(EXPIRED_OF).bind(owner.id).bind(now_ms).bind(far_ms);
        let (word, left) = match owner.verdict() {
            Verdict::Alive => ("alive", 0),
            Verdict::Gone => ("gone", own),
            Verdict::Elsewhere => ("not to be seen from here", expired.fetch_one(connection).await?),
        };
        running += own;
        stale += left;
        let ago_s = (now_ms - owner.heartbeat_ms) / 1000;
        let Owner { id, host, pid, version, .. } = owner;
        let text = format!(
            "{id}: process {pid} on {host}, version {version}, {word}, {own} jobs, last seen {ago_s} s ago"
        );
        findings.push(Finding::good("worker", text));
    }
    if owners.is_empty() {
        findings.push(Finding::good("worker", "none at work"));
    }
    // Nobody has to do anything about them: the next worker does.
    let text = format!("{running} running jobs, {stale} of them left by processes that are gone");
    let advice = if stale > 0 { "; the next `tribosweep work` takes them back" } else { "" };
    findings.push(Finding::good("leases", text + advice));
    Ok(())
}

async fn scalar<T>(connection: &mut SqliteConnection, statement: &'static str) -> Result<T, QueueError>
where
    T: Send + Unpin + for<'r> sqlx::Decode<'r, sqlx::Sqlite> + sqlx::Type<sqlx::Sqlite>,
{
    Ok(sqlx::query_scalar(statement).fetch_one(connection).await?)
}
