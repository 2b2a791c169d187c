//! A measured point: what somebody else found for some parameters.

/// The results of a measured point, each with its error if that is known.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measurement {
    /// Quantities by the names of the export's columns, such as `mu_star`.
    pub values: Vec<MeasuredValue>,
    /// Whether it squeals, if that is known.
    pub squeals: Option<bool>,
}

/// One result of a measured point.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredValue {
    /// The quantity, by the name of its column in the export.
    pub name: String,
    /// Its value, in the unit of that column.
    pub value: f64,
    /// Its error, in the same unit, if it is known.
    pub error: Option<f64>,
}

impl Measurement {
    /// The result of that name.
    pub fn value(&self, name: &str) -> Option<&MeasuredValue> {
        self.values.iter().find(|value| value.name == name)
    }
}
