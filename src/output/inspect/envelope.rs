//! A whole run in a bounded number of bins.

use crate::analysis::sample::Sample;

/// Largest number of bins: more than the columns of pixels in a figure.
const MAX_BINS: usize = 4000;

/// Extremes of a run's totals over consecutive steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// Time [s] of its first step.
    pub start_s: f64,
    /// Smallest and largest smoothed total normal contact force [N].
    pub normal_n: [f64; 2],
    /// Smallest and largest tangential force [N] at the clamp.
    pub tangential_n: [f64; 2],
}

/// The bins of a run of any length. All bins but the last one are equally long.
#[derive(Debug, Clone, Default)]
pub struct Envelope {
    bins: Vec<Bin>,
    steps_per_bin: u64,
    steps_in_last: u64,
}

impl Envelope {
    /// Adds a step.
    pub fn push(&mut self, sample: &Sample) {
        let here = Bin {
            start_s: sample.time_s,
            normal_n: [sample.smooth_normal_n; 2],
            tangential_n: [sample.clamp_tangential_n; 2],
        };
        match self.bins.last_mut() {
            Some(last) if self.steps_in_last < self.steps_per_bin => {
                *last = joined(last, &here);
                self.steps_in_last += 1;
            }
            _ => {
                if self.bins.len() == MAX_BINS {
                    self.bins =
                        self.bins.chunks(2).map(|pair| joined(&pair[0], &pair[pair.len() - 1])).collect();
                    self.steps_per_bin *= 2;
                }
                self.steps_per_bin = self.steps_per_bin.max(1);
                self.bins.push(here);
                self.steps_in_last = 1;
            }
        }
    }

    /// The bins.
    pub fn bins(&self) -> &[Bin] {
        &self.bins
    }
}

fn joined(a: &Bin, b: &Bin) -> Bin {
    let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    Bin {
        start_s: a.start_s,
        normal_n: both(a.normal_n, b.normal_n),
        tangential_n: both(a.tangential_n, b.tangential_n),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: for any length of a run, no step is lost and the number of bins is bounded: the extremes are those of all
    /// steps, and bins start at equal distances.
    #[test]
    fn nothing_is_lost() {
        for steps in [1, 3, MAX_BINS, MAX_BINS + 1, 5 * MAX_BINS + 17] {
            let mut envelope = Envelope::default();
            for step in 0..steps {
                // A single spike, which subsampling would miss.
                let spike = if step == steps / 2 { 7.0 } else { 0.0 };
                envelope.push(&Sample {
                    time_s: step as f64,
                    smooth_normal_n: spike,
                    clamp_tangential_n: -(step as f64),
                    ..Sample::default()
                });
            }
            let bins = envelope.bins();
            assert!(bins.len() <= MAX_BINS && 4 * bins.len() >= steps.min(MAX_BINS), "{}", bins.len());
            assert_eq!(bins.iter().map(|bin| bin.normal_n[1]).fold(0.0, f64::max), 7.0);
            assert_eq!(bins.last().unwrap().tangential_n[0], 1.0 - steps as f64);
            for (number, bin) in bins.iter().enumerate() {
                assert_eq!(bin.start_s, number as f64 * envelope.steps_per_bin as f64, "{steps} steps");
            }
        }
    }
}
