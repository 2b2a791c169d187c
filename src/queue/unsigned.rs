/// A count that a table has; the nearest one where the table has a number that is none. (PostgreSQL has no unsigned integers,
/// and a damaged page or an editor may leave any number.)
pub(super) fn unsigned(stored: i64) -> u32 {
    u32::try_from(stored.max(0)).unwrap_or(u32::MAX)
}
