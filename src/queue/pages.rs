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
    read: Box<ReadPage<T>>,
}

/// What a page has, and the place of its last row, if it has one.
type Page<T> = (Vec<T>, Option<Vec<i64>>);

type ReadPage<T> = dyn for<'a> Fn(Query<'static>, &'a mut Connection) -> Answer<'a, Page<T>> + Send + Sync;

impl<T: Send + 'static> Pages<T> {
    /// Those of a statement whose last parameters are the place after which it reads, and the number of rows. `before` is a place
    /// before all rows. Rows are read after the last one, because the largest number has none after it.
    pub(super) fn of<R: Columns + 'static>(
        query: Query<'static>,
        before: &[i64],
        size: i64,
        item: ItemOf<R, T>,
    ) -> Self {
        let read: Box<ReadPage<T>> = Box::new(move |query, connection| read(query, connection, item));
        Self { query, last: before.to_vec(), size, read }
    }
}

/// Gives the place of a row, and what a reader gets of it.
type ItemOf<R, T> = fn(R) -> Result<(Vec<i64>, T), QueueError>;

fn read<'a, R: Columns + 'static, T: Send + 'static>(
    query: Query<'static>,
    connection: &'a mut Connection,
    item: ItemOf<R, T>,
) -> Answer<'a, Page<T>> {
    Box::pin(async move {
        let rows: Vec<R> = query.all(connection).await?;
        let (mut items, mut last) = (Vec::with_capacity(rows.len()), None);
        for row in rows {
            let (place, own) = item(row)?;
            last = Some(place);
            items.push(own);
        }
        Ok((items, last))
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
