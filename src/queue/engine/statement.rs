/// A statement in the dialect of each database. Parameters are `$1`, `$2`, … in both.
#[derive(Debug, Clone, Copy)]
pub struct Statement {
    sqlite: &'static str,
    #[cfg(feature = "postgres")]
    postgres: &'static str,
}

impl Statement {
    /// A statement with different texts for the two databases.
    pub const fn each(sqlite: &'static str, postgres: &'static str) -> Self {
        #[cfg(not(feature = "postgres"))]
        let _ = postgres;
        Self {
            sqlite,
            #[cfg(feature = "postgres")]
            postgres,
        }
    }

    /// The text for `SQLite`.
    pub const fn sqlite(self) -> &'static str {
        self.sqlite
    }

    /// The text for PostgreSQL.
    #[cfg(feature = "postgres")]
    pub const fn postgres(self) -> &'static str {
        self.postgres
    }
}

/// A statement with one text for both databases.
impl From<&'static str> for Statement {
    fn from(both: &'static str) -> Self {
        Self::each(both, both)
    }
}
