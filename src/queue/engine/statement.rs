/// A statement in the words of each database. Parameters are `$1`, `$2`, … in both.
#[derive(Debug, Clone, Copy)]
pub struct Statement {
    sqlite: &'static str,
    #[cfg(feature = "postgres")]
    postgres: &'static str,
}

impl Statement {
    /// In two dialects.
    pub const fn each(sqlite: &'static str, postgres: &'static str) -> Self {
        #[cfg(not(feature = "postgres"))]
        let _ = postgres;
        Self {
            sqlite,
            #[cfg(feature = "postgres")]
            postgres,
        }
    }

    /// For `SQLite`.
    pub const fn sqlite(self) -> &'static str {
        self.sqlite
    }

    /// For PostgreSQL.
    #[cfg(feature = "postgres")]
    pub const fn postgres(self) -> &'static str {
        self.postgres
    }
}

impl From<&'static str> for Statement {
    fn from(both: &'static str) -> Self {
        Self::each(both, both)
    }
}
