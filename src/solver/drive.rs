//! What one lane is driven by; everything else of a job is shared through the [`Model`](super::Model).

use super::interface::law::Law;

/// What one lane is driven by. All lanes of a state have the same kind of law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// The friction law with its coefficients.
    pub law: Law,
    /// Rate of the target's motion: ω \[rad/s\] of a disk, the speed \[m/s\] of a plane.
    pub rate: f64,
    /// Total load \[N\] after the ramp.
    pub force_n: f64,
    /// Duration \[s\] of the load's linear ramp; 0 is a sudden load.
    pub ramp_s: f64,
}

impl Drive {
    /// The load \[N\] at a time.
    pub fn load_n(&self, time_s: f64) -> f64 {
        if time_s >= self.ramp_s { self.force_n } else { self.force_n * (time_s / self.ramp_s) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the ramp is linear from zero, then constant; without one the load is there at once.
    #[test]
    fn the_load_is_ramped() {
        let law = Law::Coulomb { mu: 0.0 };
        let ramped = Drive { law, rate: 0.0, force_n: 30.0, ramp_s: 1.0e-3 };
        assert_eq!([0.0, 0.25e-3, 1.0e-3, 2.0e-3].map(|t| ramped.load_n(t)), [0.0, 7.5, 30.0, 30.0]);
        assert_eq!(Drive { ramp_s: 0.0, ..ramped }.load_n(0.0), 30.0);
    }
}
