//! The first of the two runs: the record of the job, and the times of its last limit cycles.

use super::envelope::Envelope;
use crate::analysis::cycles::CycleCutter;
use crate::analysis::{self, JobError, JobObserver, JobRecord, Moment, Outcome};
use crate::solver::Model;
use crate::solver::energy::Energies;
use crate::spec::JobSpec;
use std::ops::ControlFlow;

/// The cycle of a node may start anywhere in a cycle of the job. So many cycles of the job contain it with certainty.
pub const FEWEST_CYCLES: usize = 3;

/// The results of the first run, which the second run needs.
#[derive(Debug, Clone)]
pub struct Survey {
    /// The job's record.
    pub record: JobRecord,
    /// Start and end \[s\] of all passages between upward crossings of N = F.
    pub passages_s: Vec<[f64; 2]>,
    /// Extremes of the totals over the whole run.
    pub envelope: Envelope,
    /// The time windows of the second run.
    pub windows: TimeWindows,
}

/// The time windows that are shown, all at the end of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeWindows {
    /// Number of cycles that are shown, or of periods of a job without cycles.
    pub cycle_count: usize,
    /// Whether there are limit cycles, or cycles of a state that is not periodic. Otherwise the period is that of the pin
    /// as a quarter-wave resonator in shear, 4h/c_s.
    pub has_cycles: bool,
    /// Mean duration \[s\] of the cycles that are shown.
    pub period_s: f64,
    /// Start and end \[s\] of the time in which the observed nodes are shown.
    pub shown_s: [f64; 2],
    /// Start and end \[s\] of the cycle in which the whole contact face and the pin are shown.
    pub cycle_s: [f64; 2],
    /// Time \[s\] from which the totals are recorded: the start of the averaging window, or of `shown_s` if that is earlier.
    pub totals_from_s: f64,
}

/// Runs the job.
///
/// # Errors
/// Those of [`analysis::solve`].
pub fn survey(
    spec: &JobSpec,
    cycles: usize,
    on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
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
    let windows = TimeWindows::of(&record, &passages_s, cycles, quarter_wave_s);
    Ok(Survey { record, passages_s, envelope, windows })
}

impl TimeWindows {
    fn of(record: &JobRecord, passages_s: &[[f64; 2]], cycles: usize, quarter_wave_s: f64) -> Self {
        let crossings = record.crossings_per_cycle;
        // No more cycles than those that repeat, because the transient comes before the averaging window.
        let available = match record.outcome {
            Outcome::Periodic => record.cycles.min(passages_s.len() / crossings),
            _ => passages_s.len() / crossings,
        };
        let cycles = if available >= FEWEST_CYCLES { cycles.min(available) } else { cycles };
        let needed = cycles * crossings;
        let end_s = record.simulated_s;
        let (has_cycles, period_s, shown_s, cycle_s) = match passages_s.len().checked_sub(needed) {
            // The remains of a decaying oscillation are no cycles.
            Some(first) if record.outcome != Outcome::Decayed => {
                let shown = &passages_s[first..];
                let start_s = shown[0][0];
                let period_s = (shown[needed - 1][1] - start_s) / cycles as f64;
                // The last cycle but one, so that phases that start in it end in the time that is shown.
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

struct Surveyor<'a> {
    spec: &'a JobSpec,
    /// As in the analysis, so that it finds the same cycles.
    cutter: Option<CycleCutter>,
    passages_s: Vec<[f64; 2]>,
    envelope: Envelope,
    quarter_wave_s: f64,
    on_progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl JobObserver for Surveyor<'_> {
    fn needs_run(&self) -> bool {
        true
    }

    fn step(&mut self, moment: &Moment<'_>) {
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

/// 4h/c_s: the period [s] of a block in shear between a fixed and a free face.
fn quarter_wave_s(model: &Model) -> f64 {
    4.0 * model.pin().shear_transit_s()
}
