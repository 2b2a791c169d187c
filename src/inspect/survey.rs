//! The first of the two runs: what is found in the job, and when its last limit cycles are.

use super::envelope::Envelope;
use crate::analysis::cycles::CycleCutter;
use crate::analysis::{self, JobError, JobObserver, JobRecord, Moment, Outcome};
use crate::solver::Model;
use crate::solver::energy::Energies;
use crate::spec::JobSpec;
use std::ops::ControlFlow;

/// A node's cycle, which begins and ends anywhere, is found in so many of the job's.
pub const FEWEST_CYCLES: usize = 3;

/// What the first run of a job tells the second.
#[derive(Debug, Clone)]
pub struct Survey {
    /// The job's record.
    pub record: JobRecord,
    /// All passages between upward crossings of N = F, from start to end [s].
    pub passages_s: Vec<[f64; 2]>,
    /// The whole run.
    pub envelope: Envelope,
    /// The time that is looked at.
    pub windows: Windows,
}

/// What of a run is looked at, all at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Windows {
    /// Number of cycles that are shown, or of periods of a job without cycles.
    pub cycle_count: usize,
    /// Whether there are limit cycles, or cycles of a state that is not periodic. Otherwise the period is that of the pin
    /// as a quarter-wave resonator in shear, 4h/c_s.
    pub has_cycles: bool,
    /// Duration [s] of a cycle: the mean over those that are shown.
    pub period_s: f64,
    /// Over which the observed nodes are shown [s].
    pub shown_s: [f64; 2],
    /// One cycle of these, of which the whole contact face and the pin are shown [s].
    pub cycle_s: [f64; 2],
    /// Where the window of the job's averages begins [s], over which the totals are kept.
    pub totals_from_s: f64,
}

/// Runs the job.
///
/// # Errors
/// Those of [`analysis::solve`].
pub fn survey(
    spec: &JobSpec,
    cycles: usize,
    on_progress: &mut impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Survey, JobError> {
    let mut surveyor = Surveyor {
        cutter: None,
        passages_s: Vec::new(),
        envelope: Envelope::default(),
        quarter_wave_s: 0.0,
        spec,
        on_progress,
    };
    let record = analysis::solve(spec, &mut surveyor)?;
    let Surveyor { passages_s, envelope, quarter_wave_s, .. } = surveyor;
    let windows = Windows::of(&record, &passages_s, cycles, quarter_wave_s);
    Ok(Survey { record, passages_s, envelope, windows })
}

impl Windows {
    fn of(record: &JobRecord, passages_s: &[[f64; 2]], cycles: usize, quarter_wave_s: f64) -> Self {
        let crossings = record.crossings_per_cycle;
        // No more than repeat: what is before the averaging window is the way there.
        let there = match record.outcome {
            Outcome::Periodic => record.cycles.min(passages_s.len() / crossings),
            _ => passages_s.len() / crossings,
        };
        let cycles = if there >= FEWEST_CYCLES { cycles.min(there) } else { cycles };
        let needed = cycles * crossings;
        let end_s = record.simulated_s;
        let (has_cycles, period_s, shown_s, cycle_s) = match passages_s.len().checked_sub(needed) {
            // What is left of an oscillation that decays is no cycle.
            Some(first) if record.outcome != Outcome::Decayed => {
                let shown = &passages_s[first..];
                let start_s = shown[0][0];
                let period_s = (shown[needed - 1][1] - start_s) / cycles as f64;
                // The last but one: what begins in it ends in what is shown.
                let at = cycles.saturating_sub(2) * crossings;
                (
                    true,
                    period_s,
                    [start_s, shown[needed - 1][1]],
                    [shown[at][0], shown[at + crossings - 1][1]],
                )
            }
            _ => {
                let start_s = |periods: usize| (end_s - periods as f64 * quarter_wave_s).max(0.0);
                let cycle_s = [start_s(cycles.min(2)), start_s(cycles.min(2) - 1)];
                (false, quarter_wave_s, [start_s(cycles), end_s], cycle_s)
            }
        };
        Self {
            cycle_count: cycles,
            has_cycles,
            period_s,
            shown_s,
            cycle_s,
            totals_from_s: record.window_start_s.min(shown_s[0]),
        }
    }
}

struct Surveyor<'a, G> {
    spec: &'a JobSpec,
    /// The same as the analysis has, so that it finds the same cycles.
    cutter: Option<CycleCutter>,
    passages_s: Vec<[f64; 2]>,
    envelope: Envelope,
    quarter_wave_s: f64,
    on_progress: &'a mut G,
}

impl<G: FnMut(f64) -> ControlFlow<()>> JobObserver for Surveyor<'_, G> {
    fn step(&mut self, moment: &Moment<'_, 1>) {
        let cutter = self.cutter.get_or_insert_with(|| {
            self.quarter_wave_s = quarter_wave_s(moment.model);
            CycleCutter::new(moment.model, self.spec.scene.load.ramp_s)
        });
        if let Some(cycle) = cutter.push(moment.sample, &Energies::default()) {
            self.passages_s.push([cycle.start_s, cycle.end_s]);
        }
        self.envelope.push(moment.sample);
    }

    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        (self.on_progress)(simulated_s)
    }
}

/// 4h/c_s: the period of a block that shears between a held and a free face.
fn quarter_wave_s(model: &Model) -> f64 {
    4.0 * model.mesh().size_m()[2] / model.material().shear_wave_speed_m_s()
}
