//! The inputs that differ between lanes. All lanes share everything else through the [`Model`](super::Model).

use super::interface::law::Law;

/// The inputs of one lane in a step. A lane whose rate or load changes in time gets another drive before every step: the load
/// is that at the step's t_n, and the rate is the mean one of the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// The friction law with its coefficients.
    pub law: Law,
    /// Rate of the target's motion: ω \[rad/s\] of a disk, the speed \[m/s\] of a plane.
    pub rate: f64,
    /// Total load \[N\] after the ramp.
    pub force_n: f64,
    /// Duration \[s\] of the load's linear ramp. With 0 the load is applied suddenly.
    pub ramp_s: f64,
}

impl Drive {
    /// The load \[N\] at the time `time_s`.
    pub fn load_n(&self, time_s: f64) -> f64 {
        if time_s >= self.ramp_s { self.force_n } else { self.force_n * (time_s / self.ramp_s) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the load rises linearly from zero, then stays constant. Without a ramp it is there at once.
    #[test]
    fn the_load_is_ramped() {
        let law = Law::coulomb(0.0);
        let ramped = Drive { law, rate: 0.0, force_n: 30.0, ramp_s: 1.0e-3 };
        assert_eq!([0.0, 0.25e-3, 1.0e-3, 2.0e-3].map(|t| ramped.load_n(t)), [0.0, 7.5, 30.0, 30.0]);
        assert_eq!(Drive { ramp_s: 0.0, ..ramped }.load_n(0.0), 30.0);
    }
}
