//! Rows of a statement as structs.

/// Defines a struct whose fields are the columns of the same names. Both databases can read it, as they can read a tuple.
///
/// `sqlx::FromRow` has a derive that does the same. With it, both drivers would be compiled before this package, because they are
/// dependencies of all macros of `sqlx`.
macro_rules! columns {
    ($(#[$about:meta])* $visible:vis struct $name:ident { $($(#[$of_field:meta])* $seen:vis $field:ident: $kind:ty,)+ }) => {
        $(#[$about])*
        $visible struct $name { $($(#[$of_field])* $seen $field: $kind,)+ }

        impl<'r, R: sqlx::Row> sqlx::FromRow<'r, R> for $name
        where
            &'static str: sqlx::ColumnIndex<R>,
            $($kind: sqlx::Decode<'r, R::Database> + sqlx::Type<R::Database>,)+
        {
            fn from_row(row: &'r R) -> Result<Self, sqlx::Error> {
                Ok(Self { $($field: row.try_get(stringify!($field))?,)+ })
            }
        }
    };
}

pub(in crate::queue) use columns;
