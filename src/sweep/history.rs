//! The history of a run as CSV.

use crate::analysis::sample::{DIRECTIONS, HolderSample, OBSERVED_NAMES, Sample};
use crate::spec::Holder;
use std::io;

/// Columns of the whole contact.
const TOTALS: [&str; 9] = [
    "time_s",
    "load_n",
    "normal_n",
    "tangential_n",
    "contact_tangential_n",
    "mu_eq",
    "stick_nodes",
    "slip_nodes",
    "separated_nodes",
];

/// Columns of each observed node, behind its name and `_`.
const OF_NODE: [&str; 8] =
    ["ux_m", "uy_m", "uz_m", "y_velocity_m_s", "sigma_n_pa", "slip_speed_m_s", "mu_eq", "state"];

/// Columns of the holder in each direction in which it moves, behind `holder_`, the direction and `_`.
const OF_HOLDER: [&str; 2] = ["m", "acceleration_m_s2"];

/// Collects a line of CSV for every n-th step of a run.
#[derive(Debug)]
pub struct History {
    writer: csv::Writer<Vec<u8>>,
    every: u64,
    /// The directions, from 0 to 2, in which the holder moves.
    holder: Vec<usize>,
    steps: u64,
    /// The first error of a line.
    failure: Option<io::Error>,
}

impl History {
    /// An empty history of a pin on this holder. It keeps the first step and then every `every`-th one.
    pub fn new(every: std::num::NonZeroU64, holder: &Holder) -> Self {
        let moves = holder.directions();
        let mut history = Self {
            writer: csv::Writer::from_writer(Vec::new()),
            every: every.get(),
            holder: (0..3).filter(|axis| moves[*axis].is_some()).collect(),
            steps: 0,
            failure: None,
        };
        let of_nodes =
            OBSERVED_NAMES.iter().flat_map(|node| OF_NODE.map(|column| format!("{node}_{column}")));
        let of_holder: Vec<_> = history
            .holder
            .iter()
            .flat_map(|&axis| OF_HOLDER.map(|column| format!("holder_{}_{column}", DIRECTIONS[axis])))
            .collect();
        history.write(TOTALS.map(str::to_owned).into_iter().chain(of_nodes).chain(of_holder));
        history
    }

    /// Adds the sample of a step if the step is to be kept.
    pub fn add(&mut self, sample: &Sample) {
        self.steps += 1;
        if !(self.steps - 1).is_multiple_of(self.every) {
            return;
        }
        let totals = [
            format!("{:e}", sample.time_s),
            sample.load_n.to_string(),
            sample.normal_n.to_string(),
            sample.clamp_tangential_n.to_string(),
            sample.contact_tangential_n.to_string(),
            sample.equivalent_friction().to_string(),
            sample.stick.to_string(),
            sample.slip.to_string(),
            sample.separated.to_string(),
        ];
        let of_nodes = sample.nodes.iter().flat_map(|node| {
            let [x, y, z] = node.u_m.map(|u| format!("{u:e}"));
            [
                x,
                y,
                z,
                node.y_velocity_m_s.to_string(),
                node.sigma_n_pa.to_string(),
                node.slip_speed_m_s.to_string(),
                node.equivalent_friction().to_string(),
                node.state.name().to_owned(),
            ]
        });
        let of_holder: Vec<_> = self
            .holder
            .iter()
            .flat_map(|&axis| {
                let HolderSample { displacement_m, acceleration_m_s2 } = sample.holder[axis];
                [displacement_m, acceleration_m_s2].map(|value| format!("{value:e}"))
            })
            .collect();
        self.write(totals.into_iter().chain(of_nodes).chain(of_holder));
    }

    fn write(&mut self, fields: impl Iterator<Item = String>) {
        if let Err(error) = self.writer.write_record(fields) {
            self.failure.get_or_insert(error.into());
        }
    }

    /// The text, with a header.
    ///
    /// # Errors
    /// If a line could not be written.
    pub fn into_csv(self) -> io::Result<Vec<u8>> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.writer.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}
