//! What was measured, what runs gave, and what is expected.

/// The number of quantities of a measured point.
pub const QUANTITIES: usize = 2;

/// The quantity whose jumps divide limit cycles into branches: the logarithm of the frequency.
pub const LOG_FREQUENCY: usize = 1;

/// What was measured at a point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Target {
    /// Whether it squeals, if that is known.
    pub squeals: Option<bool>,
    /// The quantities that were measured.
    pub values: [Option<Measured>; QUANTITIES],
}

/// A measured value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// The standard deviation of the measurement and of the model's discrepancy together.
    pub deviation: f64,
}

/// What a run gave where something was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// Whether it squeals, if that is known.
    pub squeals: Option<bool>,
    /// The quantities that it has.
    pub values: [Option<Computed>; QUANTITIES],
}

/// A value of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Computed {
    /// The value.
    pub value: f64,
    /// The standard deviation of the error that the mesh makes, if it is known.
    pub mesh_deviation: Option<f64>,
}

/// A run: its place in the unit cube, and what it gave at each measured point; none where it has no result.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The place: a number from 0 to 1 for each free parameter.
    pub place: Vec<f64>,
    /// In the order of the measured points.
    pub outcomes: Vec<Option<Outcome>>,
}

/// An expected value at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// The mean.
    pub mean: f64,
    /// The standard deviation of the emulator.
    pub emulator: f64,
    /// The standard deviation of the mesh; 0 where it is not known.
    pub mesh: f64,
}

impl Expected {
    /// How far a measured value is away, in standard deviations.
    pub fn implausibility(&self, measured: &Measured) -> f64 {
        (measured.value - self.mean).abs() / self.deviation(measured)
    }

    fn deviation(&self, measured: &Measured) -> f64 {
        (self.emulator.powi(2) + self.mesh.powi(2) + measured.deviation.powi(2)).sqrt()
    }
}

/// What a place is expected to give at a measured point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assessment {
    /// The largest implausibility.
    pub implausibility: f64,
    /// The sum of the squares of the implausibilities.
    pub square_sum: f64,
    /// The expected values of the measured quantities, where there is an emulator.
    pub values: [Option<Expected>; QUANTITIES],
    /// Whether it is ruled out because all runs around it squeal and the machine does not, or the other way round. The implausibility is
    /// infinite then.
    pub is_other_state: bool,
}
