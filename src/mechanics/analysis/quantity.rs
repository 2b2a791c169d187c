//! The quantities of a step, with the names and units that they have in all tables.

use super::sample::{NodeSample, Sample};
use serde_json::Value;

/// A quantity: its name, its unit, its meaning, and how it is read.
pub type Quantity<T> = (&'static str, &'static str, &'static str, fn(&T) -> Value);

/// The whole contact.
pub const TOTALS: [Quantity<Sample>; 11] = [
    ("time_s", "s", "simulated time", |sample| sample.time_s.into()),
    ("load_n", "N", "load F", |sample| sample.load_n.into()),
    ("normal_n", "N", "total normal contact force N", |sample| sample.normal_n.into()),
    ("smooth_normal_n", "N", "N after the low-pass filter", |sample| sample.smooth_normal_n.into()),
    ("clamp_tangential_n", "N", "tangential force T of the clamp", |sample| sample.clamp_tangential_n.into()),
    ("contact_tangential_n", "N", "tangential force of the contact, in y", |sample| {
        sample.contact_tangential_n.into()
    }),
    ("contact_sideways_n", "N", "the same in x", |sample| sample.contact_sideways_n.into()),
    ("mu_eq", "", "tangential force of the contact over N", |sample| sample.equivalent_friction().into()),
    ("stick_nodes", "", "nodes that stick", |sample| sample.stick.into()),
    ("slip_nodes", "", "nodes that slip", |sample| sample.slip.into()),
    ("separated_nodes", "", "nodes without contact", |sample| sample.separated.into()),
];

/// The holder in x, y and z.
const HOLDER: [[Quantity<Sample>; 2]; 3] = [
    [
        ("holder_x_m", "m", "displacement of the holder in x", |sample| {
            sample.holder[0].displacement_m.into()
        }),
        ("holder_x_acceleration_m_s2", "m/s²", "its acceleration in x", |sample| {
            sample.holder[0].acceleration_m_s2.into()
        }),
    ],
    [
        ("holder_y_m", "m", "displacement of the holder in y", |sample| {
            sample.holder[1].displacement_m.into()
        }),
        ("holder_y_acceleration_m_s2", "m/s²", "its acceleration in y", |sample| {
            sample.holder[1].acceleration_m_s2.into()
        }),
    ],
    [
        ("holder_z_m", "m", "displacement of the holder in z", |sample| {
            sample.holder[2].displacement_m.into()
        }),
        ("holder_z_acceleration_m_s2", "m/s²", "its acceleration in z", |sample| {
            sample.holder[2].acceleration_m_s2.into()
        }),
    ],
];

/// The holder in the directions in which it moves.
pub fn of_holder(moves: [bool; 3]) -> impl Iterator<Item = Quantity<Sample>> {
    HOLDER.into_iter().zip(moves).filter_map(|(own, moves)| moves.then_some(own)).flatten()
}

/// A contact node.
pub const NODE: [Quantity<NodeSample>; 11] = [
    ("ux_m", "m", "displacement in x", |node| node.u_m[0].into()),
    ("uy_m", "m", "displacement in y", |node| node.u_m[1].into()),
    ("uz_m", "m", "displacement in z", |node| node.u_m[2].into()),
    ("y_velocity_m_s", "m/s", "velocity in y", |node| node.y_velocity_m_s.into()),
    ("gap_m", "m", "gap to the disk", |node| node.gap_m.into()),
    ("friction_x_n", "N", "friction force in x", |node| node.force_n[0].into()),
    ("friction_y_n", "N", "friction force in y", |node| node.force_n[1].into()),
    ("normal_n", "N", "normal force", |node| node.force_n[2].into()),
    ("slip_speed_m_s", "m/s", "slip speed", |node| node.slip_speed_m_s.into()),
    ("mu_eq", "", "friction force over normal force", |node| node.equivalent_friction().into()),
    ("state", "", "stick, slip or separated", |node| node.state.name().into()),
];

/// The normal stress of a node as in the record.
pub const DELAYED_STRESS: Quantity<NodeSample> =
    ("sigma_n_delayed_pa", "Pa", "normal stress after the filter of the record, which delays it", |node| {
        node.sigma_n_pa.into()
    });
