//! The parameters that vary between the points.

/// A parameter with its value in each row as a number. Names are numbered in the order of the rows.
pub(super) struct Parameter {
    pub name: String,
    pub is_number: bool,
    pub values: Vec<f64>,
}
