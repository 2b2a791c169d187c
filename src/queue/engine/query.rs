//! Statements with their parameters, and the ways to run them.

use std::borrow::Cow;
use std::pin::Pin;

use sqlx::FromRow;
#[cfg(feature = "postgres")]
use sqlx::postgres::PgRow;
use sqlx::sqlite::SqliteRow;

use super::connection::Connection;
use super::statement::Statement;
use crate::queue::error::QueueError;

/// The types that rows of both databases can be read as: tuples, and structs (`columns`), of `i64`, `f64`, `String`, `Vec<u8>` and
/// options of these. (PostgreSQL has no unsigned integers.)
#[cfg(feature = "postgres")]
pub trait Columns: Send + Unpin + for<'r> FromRow<'r, SqliteRow> + for<'r> FromRow<'r, PgRow> {}
#[cfg(feature = "postgres")]
impl<T: Send + Unpin + for<'r> FromRow<'r, SqliteRow> + for<'r> FromRow<'r, PgRow>> Columns for T {}

/// The types that rows can be read as: tuples, and structs (`columns`), of `i64`, `f64`, `String`, `Vec<u8>` and options of these.
#[cfg(not(feature = "postgres"))]
pub trait Columns: Send + Unpin + for<'r> FromRow<'r, SqliteRow> {}
#[cfg(not(feature = "postgres"))]
impl<T: Send + Unpin + for<'r> FromRow<'r, SqliteRow>> Columns for T {}

/// A row of one of the databases.
enum Row {
    Sqlite(SqliteRow),
    #[cfg(feature = "postgres")]
    Postgres(PgRow),
}

impl Row {
    fn read<T: Columns>(&self) -> Result<T, sqlx::Error> {
        match self {
            Self::Sqlite(row) => T::from_row(row),
            #[cfg(feature = "postgres")]
            Self::Postgres(row) => T::from_row(row),
        }
    }
}

/// Which rows of a statement are read.
#[derive(Clone, Copy)]
enum Rows {
    All,
    /// The first one, if there is one.
    First,
}

type ReadRow<'r> = dyn FnMut(Row) -> Result<(), sqlx::Error> + Send + 'r;

/// A statement that runs. It has no type parameters, because a generic future is compiled again for each use, and again
/// in each program that uses the library.
pub type Answer<'a, T> = Pin<Box<dyn Future<Output = Result<T, QueueError>> + Send + 'a>>;

/// A parameter of a statement.
#[derive(Debug, Clone)]
pub enum Value<'q> {
    Integer(Option<i64>),
    Real(Option<f64>),
    Text(Option<Cow<'q, str>>),
    Bytes(Option<&'q [u8]>),
}

/// A statement and its parameters, which are bound in the order `$1`, `$2`, ….
#[derive(Debug, Clone)]
pub struct Query<'q> {
    statement: Statement,
    values: Vec<Value<'q>>,
}

/// A statement whose parameters are not bound yet.
pub fn query<'q>(statement: impl Into<Statement>) -> Query<'q> {
    Query { statement: statement.into(), values: Vec::new() }
}

/// sqlx's query with the parameters bound.
macro_rules! bound {
    ($query:expr, $values:expr) => {{
        let mut query = $query;
        for value in $values {
            query = match value {
                Value::Integer(value) => query.bind(value),
                Value::Real(value) => query.bind(value),
                Value::Text(value) => query.bind(value),
                Value::Bytes(value) => query.bind(value),
            };
        }
        query
    }};
}

impl<'q> Query<'q> {
    /// Binds the next parameter.
    pub fn bind(mut self, value: impl Into<Value<'q>>) -> Self {
        self.values.push(value.into());
        self
    }

    /// Runs the statement. Returns the number of changed rows.
    pub fn run<'a>(self, connection: &'a mut Connection) -> Answer<'a, u64>
    where
        'q: 'a,
    {
        let Self { statement, values } = self;
        Box::pin(async move {
            match connection {
                Connection::Sqlite(file) => {
                    let query = bound!(sqlx::query(statement.sqlite()), values);
                    let done = query.execute(file.connection()).await;
                    Ok(done.map_err(|error| file.explain(error))?.rows_affected())
                }
                #[cfg(feature = "postgres")]
                Connection::Postgres(session) => {
                    let done = session.request(async |connection| {
                        bound!(sqlx::query(statement.postgres()), values).execute(connection).await
                    });
                    Ok(done.await?.rows_affected())
                }
            }
        })
    }

    /// Runs the statement. Passes the rows to `read` as they arrive.
    fn fetch<'a>(
        self,
        connection: &'a mut Connection,
        rows: Rows,
        read: &'a mut ReadRow<'_>,
    ) -> Answer<'a, ()>
    where
        'q: 'a,
    {
        let Self { statement, values } = self;
        Box::pin(async move {
            match connection {
                Connection::Sqlite(file) => {
                    let query = bound!(sqlx::query(statement.sqlite()), values);
                    let query = query.try_map(|row| read(Row::Sqlite(row)));
                    let done = match rows {
                        Rows::All => query.fetch_all(file.connection()).await.map(drop),
                        Rows::First => query.fetch_optional(file.connection()).await.map(drop),
                    };
                    done.map_err(|error| file.explain(error))
                }
                #[cfg(feature = "postgres")]
                Connection::Postgres(session) => {
                    let done = session.request(async |connection| {
                        let query = bound!(sqlx::query(statement.postgres()), values);
                        let query = query.try_map(|row| read(Row::Postgres(row)));
                        match rows {
                            Rows::All => query.fetch_all(connection).await.map(drop),
                            Rows::First => query.fetch_optional(connection).await.map(drop),
                        }
                    });
                    done.await
                }
            }
        })
    }

    /// Runs the statement. Returns all rows.
    pub async fn all<T: Columns>(self, connection: &mut Connection) -> Result<Vec<T>, QueueError> {
        let mut rows = Vec::new();
        self.fetch(connection, Rows::All, &mut |row| row.read().map(|row| rows.push(row))).await?;
        Ok(rows)
    }

    /// Runs the statement. Returns the first row, if there is one.
    pub async fn optional<T: Columns>(self, connection: &mut Connection) -> Result<Option<T>, QueueError> {
        let mut first = None;
        self.fetch(connection, Rows::First, &mut |row| row.read().map(|row| first = Some(row))).await?;
        Ok(first)
    }

    /// Runs a statement that returns one row.
    pub async fn one<T: Columns>(self, connection: &mut Connection) -> Result<T, QueueError> {
        self.optional(connection).await?.ok_or_else(|| QueueError::Database(sqlx::Error::RowNotFound.into()))
    }

    /// Runs a statement that returns one row with one value.
    pub async fn scalar<T>(self, connection: &mut Connection) -> Result<T, QueueError>
    where
        (T,): Columns,
    {
        self.one::<(T,)>(connection).await.map(|(value,)| value)
    }

    /// Runs a statement whose rows have one value each.
    pub async fn scalars<T>(self, connection: &mut Connection) -> Result<Vec<T>, QueueError>
    where
        (T,): Columns,
    {
        let rows: Vec<(T,)> = self.all(connection).await?;
        Ok(rows.into_iter().map(|(value,)| value).collect())
    }
}

impl From<i64> for Value<'_> {
    fn from(value: i64) -> Self {
        Self::Integer(Some(value))
    }
}

impl From<u32> for Value<'_> {
    fn from(value: u32) -> Self {
        Self::Integer(Some(value.into()))
    }
}

impl From<Option<i64>> for Value<'_> {
    fn from(value: Option<i64>) -> Self {
        Self::Integer(value)
    }
}

impl From<Option<f64>> for Value<'_> {
    fn from(value: Option<f64>) -> Self {
        Self::Real(value)
    }
}

impl<'q> From<&'q str> for Value<'q> {
    fn from(value: &'q str) -> Self {
        Self::Text(Some(value.into()))
    }
}

impl<'q> From<&'q String> for Value<'q> {
    fn from(value: &'q String) -> Self {
        Self::Text(Some(value.into()))
    }
}

impl From<String> for Value<'_> {
    fn from(value: String) -> Self {
        Self::Text(Some(value.into()))
    }
}

impl<'q> From<Option<&'q str>> for Value<'q> {
    fn from(value: Option<&'q str>) -> Self {
        Self::Text(value.map(Into::into))
    }
}

impl From<Option<String>> for Value<'_> {
    fn from(value: Option<String>) -> Self {
        Self::Text(value.map(Into::into))
    }
}

impl<'q> From<&'q Option<String>> for Value<'q> {
    fn from(value: &'q Option<String>) -> Self {
        Self::Text(value.as_deref().map(Into::into))
    }
}

impl<'q> From<&'q [u8]> for Value<'q> {
    fn from(value: &'q [u8]) -> Self {
        Self::Bytes(Some(value))
    }
}
