//! The history of a run as CSV.

use crate::analysis::sample::{DIRECTIONS, HolderSample, NodeSample, OBSERVED_NAMES, Sample};
use crate::publish::table::{Column, FileColumns, Format, Head, TableWriter};
use crate::spec::Holder;
use std::io;

/// Columns of the whole contact.
const TOTALS: [Column<Sample>; 9] = [
    Column::new("time_s", "s", "simulated time", |of| of.time_s.into()),
    Column::new("load_n", "N", "load F", |of| of.load_n.into()),
    Column::new("normal_n", "N", "total normal contact force N", |of| of.normal_n.into()),
    Column::new("tangential_n", "N", "tangential force T of the clamp", |of| of.clamp_tangential_n.into()),
    Column::new("contact_tangential_n", "N", "tangential force of the contact, in y", |of| {
        of.contact_tangential_n.into()
    }),
    Column::new("mu_eq", "", "tangential force of the contact over N", |of| of.equivalent_friction().into()),
    Column::new("stick_nodes", "", "nodes that stick", |of| of.stick.into()),
    Column::new("slip_nodes", "", "nodes that slip", |of| of.slip.into()),
    Column::new("separated_nodes", "", "nodes without contact", |of| of.separated.into()),
];

/// Columns of each observed node, behind its name and `_`.
const OF_NODE: [Column<NodeSample>; 8] = [
    Column::new("ux_m", "m", "displacement in x", |node| node.u_m[0].into()),
    Column::new("uy_m", "m", "displacement in y", |node| node.u_m[1].into()),
    Column::new("uz_m", "m", "displacement in z", |node| node.u_m[2].into()),
    Column::new("y_velocity_m_s", "m/s", "velocity in y", |node| node.y_velocity_m_s.into()),
    Column::new("sigma_n_pa", "Pa", "normal stress, smoothed", |node| node.sigma_n_pa.into()),
    Column::new("slip_speed_m_s", "m/s", "slip speed", |node| node.slip_speed_m_s.into()),
    Column::new("mu_eq", "", "friction force over normal force", |node| node.equivalent_friction().into()),
    Column::new("state", "", "stick, slip or separated", |node| node.state.name().into()),
];

/// Columns of the holder in each direction in which it moves, behind `holder_`, the direction and `_`.
const OF_HOLDER: [Column<HolderSample>; 2] = [
    Column::new("m", "m", "displacement of the holder", |of| of.displacement_m.into()),
    Column::new("acceleration_m_s2", "m/s²", "its acceleration", |of| of.acceleration_m_s2.into()),
];

/// The columns of the samples of a pin whose holder moves in these directions, from 0 to 2.
fn columns(holder: impl IntoIterator<Item = usize>) -> Vec<Column<Sample>> {
    let nodes = OBSERVED_NAMES.iter().enumerate().flat_map(|(index, name)| {
        OF_NODE.map(|column| column.within(name, move |of: &Sample| Some(&of.nodes[index])))
    });
    let directions = holder.into_iter().flat_map(|axis| {
        let part = format!("holder_{}", DIRECTIONS[axis]);
        OF_HOLDER.map(|column| column.within(&part, move |of: &Sample| Some(&of.holder[axis])))
    });
    TOTALS.into_iter().chain(nodes).chain(directions).collect()
}

/// The columns, for the page of columns.
#[cfg(feature = "cli")]
pub(crate) fn described() -> FileColumns {
    let lines = "The file of `solve --history`. A line is a step. With a holder that moves, there are columns of its displacement and \
                 acceleration, such as `holder_x_m` and `holder_x_acceleration_m_s2`.";
    FileColumns::new(&["history.csv"], lines, &columns([]))
}

/// Collects a line of CSV for every n-th step of a run.
pub struct History {
    columns: Vec<Column<Sample>>,
    /// The text, or the first error of a line.
    lines: io::Result<TableWriter<Vec<u8>>>,
    every: u64,
    steps: u64,
}

impl History {
    /// An empty history of a pin on this holder. It keeps the first step and then every `every`-th one.
    pub fn new(every: std::num::NonZeroU64, holder: &Holder) -> Self {
        let moves = holder.directions();
        let columns = columns((0..3).filter(|axis| moves[*axis].is_some()));
        let heads: Vec<Head> = columns.iter().map(|column| column.head.clone()).collect();
        let lines = TableWriter::new(Format::Csv, &heads, Vec::new());
        Self { columns, lines, every: every.get(), steps: 0 }
    }

    /// Adds the sample of a step if the step is to be kept.
    pub fn add(&mut self, sample: &Sample) {
        self.steps += 1;
        if !(self.steps - 1).is_multiple_of(self.every) {
            return;
        }
        if let Ok(lines) = &mut self.lines
            && let Err(error) = lines.line(self.columns.iter().map(|column| column.value(sample)))
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
