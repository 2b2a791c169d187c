//! Checks of a server.

use std::time::Instant;

use super::session::Session;
use crate::queue::error::QueueError;
use crate::queue::finding::Finding;

impl Session {
    /// Checks the server and the connection to it.
    pub async fn examine(&mut self, findings: &mut Vec<Finding>) -> Result<(), QueueError> {
        let version: String = self.setting("server_version").await?;
        findings.push(Finding::good("PostgreSQL", version));
        let begun = Instant::now();
        let (used, allowed, size) = self.connections().await?;
        let answer_ms = begun.elapsed().as_secs_f64() * 1e3;
        findings.push(Finding::good("answer", format!("after {answer_ms:.1} ms")));
        // Each worker needs a connection, and so does each command.
        let text = format!("{used} of {allowed} connections of the server are in use; each worker needs one");
        findings.push(Finding::judged("connections", text, used < allowed));
        findings.push(Finding::good("size", format!("{:.1} MB in the database", size as f64 / 1e6)));
        for setting in ["synchronous_commit", "fsync"] {
            let value = self.setting(setting).await?;
            let is_good = setting != "fsync" || value == "on";
            let advice = if is_good { "" } else { ": a power cut can damage the database" };
            findings.push(Finding::judged(setting, value + advice, is_good));
        }
        Ok(())
    }

    async fn setting(&mut self, name: &'static str) -> Result<String, QueueError> {
        self.request(async |connection| {
            sqlx::query_scalar("SELECT current_setting($1)").bind(name).fetch_one(connection).await
        })
        .await
    }

    async fn connections(&mut self) -> Result<(i64, i64, i64), QueueError> {
        let connections = "
            SELECT (SELECT COUNT(*) FROM pg_stat_activity WHERE backend_type = 'client backend'),
                   CAST(current_setting('max_connections') AS BIGINT)
                       - CAST(current_setting('superuser_reserved_connections') AS BIGINT),
                   pg_database_size(current_database())";
        self.request(async |connection| sqlx::query_as(connections).fetch_one(connection).await).await
    }
}
