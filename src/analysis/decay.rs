//! Whether steady sliding decays.
//!
//! While no node sticks and none opens or closes, the system is linear, and all its signals are sums of
//! lines that grow or decay exponentially (see `lines`). Sliding is called decaying only when every one of
//! several signals decays: N alone would not show a mode that is odd in x or y on a symmetric pin.

use super::lines::LineMonitor;
use super::sample::Sample;
use crate::spec::Detection;
use serde::{Deserialize, Serialize};

/// The signals watched, all over F: N, its first moments about the y and x axes, and the sideways friction.
const SIGNALS: usize = 4;

/// Amplitude, over F, below which lines are not judged on an elastic disk.
///
/// Nodes that pass from patch to patch excite the disk all the time, and its lowest modes, at some kHz, are hardly
/// damped: N never comes to rest. On steel with elements of 2.5 mm what is left after 50 ms is less than 4·10⁻⁸ of F at
/// 7 rpm and 10⁻⁶ at 100 rpm. So a growth that is slower than about 300 1/s and begins below this is not seen
/// within an observation of 8 ms.
pub const ELASTIC_FLOOR: f64 = 1.0e-6;

/// Watches sliding for growth and decay.
#[derive(Serialize, Deserialize)]
pub struct DecayMonitor {
    ramp_s: f64,
    monitors: [LineMonitor; SIGNALS],
    decays: bool,
}

impl DecayMonitor {
    /// A monitor that starts after the load's ramp and judges what is above the amplitude `floor`, over F.
    pub fn new(time_step_s: f64, ramp_s: f64, detection: &Detection, floor: f64) -> Self {
        let observation_s = detection.decay_observation_s;
        let monitors = std::array::from_fn(|_| LineMonitor::new(time_step_s, observation_s, floor));
        Self { ramp_s, monitors, decays: false }
    }

    /// Growth rate [1/s] of the fastest growing (or slowest decaying) strong line of any signal over the
    /// last observation time, or, once it has decayed to rounding, the last one measured; none unless all
    /// of the observation time was sliding.
    pub fn growth_rate_per_s(&self) -> Option<f64> {
        let rates = self.monitors.iter().filter_map(|monitor| monitor.verdict()?.growth_rate_per_s);
        rates.reduce(f64::max)
    }

    /// Adds one step; returns whether sliding has been measured to decay and has not ended since.
    pub fn push(&mut self, sample: &Sample) -> bool {
        if sample.time_s < self.ramp_s {
            return false;
        }
        if sample.stick + sample.transitions > 0 {
            self.monitors.iter_mut().for_each(LineMonitor::start_anew);
            self.decays = false;
            return false;
        }
        let signals = [
            sample.normal_n - sample.load_n,
            sample.x_moment_n,
            sample.y_moment_n,
            sample.contact_sideways_n,
        ];
        for (monitor, signal) in self.monitors.iter_mut().zip(signals) {
            monitor.push(signal / sample.load_n);
        }
        if self.monitors.iter().all(|monitor| monitor.verdict().is_some_and(|verdict| verdict.decays)) {
            self.decays = true;
        } else if self.growth_rate_per_s().is_some_and(|rate| rate > 0.0) {
            // Once measured, a decay is only taken back by growth, not by an undecided stretch.
            self.decays = false;
        }
        self.decays
    }
}
