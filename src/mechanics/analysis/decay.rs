//! Whether steady sliding decays.
//!
//! While no node sticks and none opens or closes, the system is linear. All its signals are then sums of
//! lines that grow or decay exponentially (see `lines`). Sliding counts as decaying only if each of several
//! signals decays: N alone does not show a mode of a symmetric pin that is odd in x or y, and a swing of the holder in the sliding
//! direction shows best in the force T that the holder carries.

use super::lines::{self, LineMonitor, StrongLine};
use super::sample::Sample;
use serde::{Deserialize, Serialize};

/// Number of observed signals. All of them are over F: N, its first moments about the y and x axes, the sideways friction, and, with a
/// holder that moves, T.
const SIGNALS: usize = 5;

/// Amplitude, over F, below which lines are not judged on an elastic disk.
///
/// Nodes that pass from patch to patch excite the disk all the time. Its lowest modes, at some kHz, have
/// almost no damping, so N never comes to rest. On steel with elements of 2.5 mm the oscillation that remains
/// after 50 ms is less than 4·10⁻⁸ of F at 7 rpm and 10⁻⁶ at 100 rpm. Therefore a growth that is slower than
/// about 300 1/s and begins below this floor is not detected within an observation of 8 ms.
pub const ELASTIC_FLOOR: f64 = 1.0e-6;

/// Amplitude, over F, below which lines are not judged in single precision.
///
/// Every step rounds displacements u at 6·10⁻⁸ of u. The roundings excite all modes, and damping limits what remains. In the
/// reference scene this is an oscillation of N of 10⁻⁶ of F, and of 3·10⁻⁶ at 0.5 rpm, on meshes from 6 × 8 × 5 to
/// 24 × 30 × 20 elements. Therefore a growth that is slower than about 300 1/s and begins at rounding is not detected
/// within an observation of 8 ms. With less damping more remains, and then the run goes on to its limit.
pub const SINGLE_FLOOR: f64 = 1.0e-5;

/// Detects growth and decay of steady sliding.
#[derive(Serialize, Deserialize)]
pub struct DecayMonitor {
    ramp_s: f64,
    monitors: Vec<LineMonitor>,
    decays: bool,
}

impl DecayMonitor {
    /// A monitor that starts after the load's ramp. It judges lines above the amplitude `floor`, over F, in observations of
    /// `observation_s`.
    pub fn new(time_step_s: f64, ramp_s: f64, observation_s: f64, floor: f64, holder_moves: bool) -> Self {
        let signals = if holder_moves { SIGNALS } else { SIGNALS - 1 };
        let monitors = (0..signals).map(|_| LineMonitor::new(time_step_s, observation_s, floor)).collect();
        Self { ramp_s, monitors, decays: false }
    }

    /// Growth rate \[1/s\] of the fastest growing (or slowest decaying) strong line of any signal over the
    /// last observation time, without the harmonics of others. After the oscillation has decayed to rounding, it is the last
    /// measured rate. It is none unless sliding was steady during the whole observation time.
    pub fn growth_rate_per_s(&self) -> Option<f64> {
        let fastest = self.fastest_per_s()?;
        if fastest <= 0.0 {
            // What two decaying lines make decays faster than both.
            return Some(fastest);
        }
        let lines: Vec<StrongLine> =
            self.monitors.iter().flat_map(|monitor| monitor.strong_lines().iter().copied()).collect();
        Some(lines::fastest_of_modes(&lines).unwrap_or(fastest))
    }

    /// The largest rate \[1/s\] of any strong line.
    fn fastest_per_s(&self) -> Option<f64> {
        let rates = self.monitors.iter().filter_map(|monitor| monitor.verdict()?.growth_rate_per_s);
        rates.reduce(f64::max)
    }

    /// Adds one step. Returns whether sliding was measured to decay and has not ended since.
    pub fn push(&mut self, sample: &Sample) -> bool {
        if sample.time_s < self.ramp_s {
            return false;
        }
        if sample.stick + sample.transitions > 0 {
            self.monitors.iter_mut().for_each(LineMonitor::start_anew);
            self.decays = false;
            return false;
        }
        let signals: [f64; SIGNALS] = [
            sample.normal_n - sample.load_n,
            sample.x_moment_n,
            sample.y_moment_n,
            sample.contact_sideways_n,
            sample.clamp_tangential_n,
        ];
        for (monitor, signal) in self.monitors.iter_mut().zip(signals) {
            monitor.push(signal / sample.load_n);
        }
        if self.monitors.iter().all(|monitor| monitor.verdict().is_some_and(|verdict| verdict.decays)) {
            self.decays = true;
        } else if self.fastest_per_s().is_some_and(|rate| rate > 0.0) {
            // Only growth revokes a measured decay. An undecided observation does not.
            self.decays = false;
        }
        self.decays
    }
}
