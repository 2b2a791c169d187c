//! The rows of the plans of studies that grow: what submissions, removals and copies do with them.

use super::engine::{Connection, query};
use super::error::QueueError;

/// Whether there are studies that may grow, in all the database or with the number $1.
const OPEN: &str = "
    SELECT COUNT(*) FROM (
        SELECT 1 FROM plans AS p JOIN studies AS s ON s.id = p.study_id
        WHERE p.state = 'open' AND s.cancelled_ms IS NULL AND ($1 IS NULL OR s.id = $1) LIMIT 1) AS o";

/// What is being planned is out of date.
const REOPEN: &str = "
    UPDATE plans SET state = 'open', note = NULL, owner = NULL, lease_until_ms = NULL WHERE study_id = $1";

const BEGIN: &str = "
    INSERT INTO plans (study_id) VALUES ($1)
    ON CONFLICT (study_id) DO UPDATE
    SET wave = 0, state = 'open', note = NULL, owner = NULL, lease_until_ms = NULL";

const STATUS: &str = "SELECT wave, state, note FROM plans WHERE study_id = $1";

const COPY: &str = "
    INSERT INTO plans (study_id, wave, state, note) VALUES ($1, $2, $3, $4)
    ON CONFLICT (study_id) DO UPDATE
    SET wave = excluded.wave, state = excluded.state, note = excluded.note
    WHERE plans.wave < excluded.wave OR plans.wave = excluded.wave AND plans.state = 'open'";

/// Whether studies may grow, of all or of this number.
pub(super) async fn has_open(connection: &mut Connection, study_id: Option<i64>) -> Result<bool, QueueError> {
    let found: i64 = query(OPEN).bind(study_id).scalar(connection).await?;
    Ok(found > 0)
}

/// Begins the plan of a study again, with no waves.
pub(super) async fn begin(connection: &mut Connection, study_id: i64) -> Result<(), QueueError> {
    query(BEGIN).bind(study_id).run(connection).await.map(drop)
}

/// The study does not grow any more.
pub(super) async fn delete(connection: &mut Connection, study_id: i64) -> Result<(), QueueError> {
    query("DELETE FROM plans WHERE study_id = $1").bind(study_id).run(connection).await.map(drop)
}

/// The study is planned further, even if its plan was complete or has failed: jobs may have other results.
pub(super) async fn reopen(connection: &mut Connection, study_id: i64) -> Result<(), QueueError> {
    query(REOPEN).bind(study_id).run(connection).await.map(drop)
}

/// Waves, state and note of a plan.
pub(super) type Columns = (i64, String, Option<String>);

/// The plan of a study as it is stored.
pub(super) async fn read(connection: &mut Connection, study_id: i64) -> Result<Option<Columns>, QueueError> {
    query(STATUS).bind(study_id).optional(connection).await
}

/// Gives a study the plan that it has in another database, unless its own one is further.
pub(super) async fn copy(
    connection: &mut Connection,
    study_id: i64,
    (waves, state, note): &Columns,
) -> Result<(), QueueError> {
    query(COPY).bind(study_id).bind(*waves).bind(state).bind(note).run(connection).await.map(drop)
}
