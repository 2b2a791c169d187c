//! Checks of a database and its environment.

use std::path::Path;

use super::clock::Clock;
use super::engine::{Connection, query};
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
        Connection::Sqlite(connection) => sqlite::examine(connection, findings).await?,
        #[cfg(feature = "postgres")]
        Connection::Postgres(session) => {
            session.examine(findings).await?;
            // A difference is no problem: leases use the server's clock only.
            let ahead_ms = queue.now_ms().await? - super::clock::machine_ms();
            let text = format!("the server's clock is {} s ahead of this machine's", ahead_ms as f64 / 1e3);
            findings.push(Finding::good("clock", text));
        }
    }
    workers(queue, findings).await
}

async fn workers(queue: &mut Queue, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
    let now_ms = queue.now_ms().await?;
    let owners = queue.owners().await?;
    let (mut running, mut stale) = (0, 0);
    for owner in &owners {
        let connection = &mut queue.connection;
        let own: i64 = query(RUNNING_OF).bind(owner.id).scalar(connection).await?;
        let expired = query(EXPIRED_OF).bind(owner.id).bind(now_ms).bind(owner.latest_plausible_ms(now_ms));
        let (word, left) = match owner.liveness() {
            Liveness::Alive => ("alive", 0),
            Liveness::Gone => ("gone", own),
            Liveness::Unknown => ("not visible from here", expired.scalar(connection).await?),
        };
        running += own;
        stale += left;
        let ago_s = (now_ms - owner.heartbeat_ms) / 1000;
        let Owner { id, host, pid, version, .. } = owner;
        let text = format!(
            "{id}: process {pid} on {host}, version {version}, {word}, running jobs: {own}, last seen {ago_s} s ago"
        );
        findings.push(Finding::good("worker", text));
    }
    if owners.is_empty() {
        findings.push(Finding::good("worker", "none at work"));
    }
    // This is no problem: the next worker takes the jobs back.
    let text = format!("running jobs: {running}, of which processes that are gone have left {stale}");
    let advice = if stale > 0 { "; the next `tribosweep work` takes them back" } else { "" };
    findings.push(Finding::good("leases", text + advice));
    Ok(())
}
