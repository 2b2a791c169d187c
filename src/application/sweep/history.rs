//! The history of a run as CSV.

use crate::analysis::quantity::{DELAYED_STRESS, NODE, TOTALS, of_holder};
use crate::analysis::sample::{OBSERVED_NAMES, Sample};
#[cfg(feature = "cli")]
use crate::publish::table::FileColumns;
use crate::publish::table::{Column, Format, Head, TableWriter};
use crate::spec::Holder;
use std::io;

/// Collects a line of CSV for every n-th step of a run.
pub struct History {
    columns: Vec<Column<Sample>>,
    /// The first error of a line, instead of the lines.
    lines: io::Result<TableWriter<Vec<u8>>>,
    every: u64,
    steps: u64,
}

/// The whole contact, each observed node behind its name, and the holder where it moves.
fn columns(holder: &Holder) -> Vec<Column<Sample>> {
    let of_nodes = OBSERVED_NAMES.into_iter().enumerate().flat_map(|(number, node)| {
        NODE.into_iter().chain([DELAYED_STRESS]).map(move |quantity| {
            let name = format!("{node}_{}", quantity.0);
            Column::from(quantity).within(move |sample: &Sample| &sample.nodes[number]).named(name)
        })
    });
    let moves = holder.directions().map(|direction| direction.is_some());
    let totals = TOTALS.into_iter().map(Column::from);
    totals.chain(of_nodes).chain(of_holder(moves).map(Column::from)).collect()
}

/// The columns, for the page of columns.
#[cfg(feature = "cli")]
pub(crate) fn described() -> FileColumns {
    let lines = "The file of `solve --history`. A line is a step. With a holder that moves, there are columns of its displacement and \
                 acceleration, such as `holder_x_m` and `holder_x_acceleration_m_s2`.";
    FileColumns::new(&["history.csv"], lines, &columns(&Holder::default()))
}

impl History {
    /// An empty history of a pin on this holder. It keeps the first step and then every `every`-th one.
    pub fn new(every: std::num::NonZeroU64, holder: &Holder) -> Self {
        let columns = columns(holder);
        let heads: Vec<Head> = columns.iter().map(|column| column.head.clone()).collect();
        Self {
            columns,
            lines: TableWriter::new(Format::Csv, &heads, Vec::new()),
            every: every.get(),
            steps: 0,
        }
    }

    /// Adds the sample of a step if the step is to be kept.
    pub fn add(&mut self, sample: &Sample) {
        self.steps += 1;
        if let Ok(writer) = &mut self.lines
            && (self.steps - 1).is_multiple_of(self.every)
            && let Err(error) = writer.line(self.columns.iter().map(|column| column.value(sample)))
        {
            self.lines = Err(error);
        }
    }

    /// The text, with a header.
    ///
    /// # Errors
    /// If a line could not be written.
    pub fn into_csv(self) -> io::Result<Vec<u8>> {
        self.lines?.finish()
    }
}
