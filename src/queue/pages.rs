//! Long tables, page by page. Reading all rows at once would prevent checkpoints of the write-ahead log meanwhile, and would need
//! memory for all of them.

use super::engine::{Answer, Columns, Connection, Query};
use super::error::QueueError;
use super::handle::Queue;

/// A place in a long table, from which [`Queue::next_page`] reads on.
pub struct Pages<T> {
    /// Without the last place and the size of a page.
    query: Query<'static>,
    last: Vec<i64>,
    size: i64,
    read: ReadPage<T>,
}

/// What a page has, and the place of its last row, if it has one.
type Page<T> = (Vec<T>, Option<Vec<i64>>);

type ReadPage<T> = for<'a> fn(Query<'static>, &'a mut Connection) -> Answer<'a, Page<T>>;

/// A row of a long table.
pub(super) trait Paged: Columns {
    /// What a reader gets.
    type Item;

    /// The numbers by which the table is ordered.
    fn place(&self) -> Vec<i64>;

    fn item(self) -> Result<Self::Item, QueueError>;
}

impl<T> Pages<T> {
    /// Those of a statement whose last parameters are the place after which it reads, and the number of rows. `before` is a place
    /// before all rows. Rows are read after the last one, because the largest number has none after it.
    pub(super) fn of<R: Paged<Item = T>>(query: Query<'static>, before: &[i64], size: i64) -> Self {
        Self { query, last: before.to_vec(), size, read: read::<R> }
    }
}

fn read<'a, R: Paged>(query: Query<'static>, connection: &'a mut Connection) -> Answer<'a, Page<R::Item>> {
    Box::pin(async move {
        let rows: Vec<R> = query.all(connection).await?;
        let last = rows.last().map(R::place);
        Ok((rows.into_iter().map(R::item).collect::<Result<_, _>>()?, last))
    })
}

impl Queue {
    /// All that is left of some pages.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn all_pages<T>(&mut self, mut pages: Pages<T>) -> Result<Vec<T>, QueueError> {
        let mut all = Vec::new();
        while let Some(page) = self.next_page(&mut pages).await? {
            all.extend(page);
        }
        Ok(all)
    }

    /// The next page, or none after the last one. A change that is made meanwhile is visible in later pages only.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn next_page<T>(&mut self, pages: &mut Pages<T>) -> Result<Option<Vec<T>>, QueueError> {
        let at_place = pages.last.iter().fold(pages.query.clone(), |query, number| query.bind(*number));
        let (page, last) = (pages.read)(at_place.bind(pages.size), &mut self.connection).await?;
        Ok(last.map(|last| {
            pages.last = last;
            page
        }))
    }
}
