//! The spectrum of a job alone, from one run: what a waterfall of many jobs needs.

use super::capture::MAX_TOTALS;
use super::spectrum::Spectrum;
use super::summary::SUMMARY;
use super::tables;
use super::write::{self, KIND};
use crate::analysis::{self, JobError, JobObserver, JobRecord, Moment};
use crate::publish::{Folder, PublishError};
use crate::spec::JobSpec;
use serde::Serialize;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The spectrum of a job's total normal force over its averaging window, with its record.
#[derive(Debug, Clone, PartialEq)]
pub struct JobSpectrum {
    /// The job's record.
    pub record: JobRecord,
    /// The spectrum of the total normal force.
    pub spectrum: Spectrum,
}

/// The numbers of a job of which the spectrum alone is stored.
#[derive(Serialize)]
struct SpectrumSummary<'a> {
    /// The job's key.
    key: &'a str,
    /// Everything that determines the run.
    job: &'a JobSpec,
    /// The job's record.
    record: &'a JobRecord,
    /// The largest lines of the total normal force, frequency \[Hz\] and amplitude \[N\].
    spectrum_peaks: Vec<(f64, f64)>,
}

impl JobSpectrum {
    /// Runs a job once. `on_progress` gets the simulated time \[s\] and can end the run.
    ///
    /// # Errors
    /// Those of [`analysis::solve`].
    pub fn of_job(
        spec: &JobSpec,
        on_progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Self, JobError> {
        let mut recorder = Recorder { normal: VecDeque::new(), on_progress };
        let record = analysis::solve(spec, &mut recorder)?;
        let is_averaged = |(time_s, _): &(f64, f64)| *time_s >= record.window_start_s;
        let normal_n: Vec<f64> =
            recorder.normal.into_iter().filter(is_averaged).map(|(_, normal_n)| normal_n).collect();
        let spectrum = Spectrum::of(&normal_n, record.time_step_s);
        Ok(Self { record, spectrum })
    }

    /// Writes `spectrum.csv` and a short `inspection.json` into `out_dir`; returns the files. `spec` is the job, and `key`
    /// its key.
    ///
    /// # Errors
    /// The first file that could not be written.
    pub fn write(&self, spec: &JobSpec, key: &str, out_dir: &Path) -> Result<Vec<PathBuf>, PublishError> {
        let mut folder = Folder::create(out_dir, KIND)?;
        tables::write_spectrum(&self.spectrum, &mut folder)?;
        let spectrum_peaks = self.spectrum.peaks(5);
        let summary = SpectrumSummary { key, job: spec, record: &self.record, spectrum_peaks };
        folder.write_with(SUMMARY, |out| write::json(&summary, out))?;
        folder.finish()
    }
}

/// Records the last normal forces of a run.
struct Recorder<'a> {
    /// t_n [s] and N [N].
    normal: VecDeque<(f64, f64)>,
    on_progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl JobObserver for Recorder<'_> {
    fn needs_run(&self) -> bool {
        true
    }

    fn step(&mut self, moment: &Moment<'_>) {
        if self.normal.len() == MAX_TOTALS {
            self.normal.pop_front();
        }
        self.normal.push_back((moment.sample.time_s, moment.sample.normal_n));
    }

    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        (self.on_progress)(simulated_s)
    }
}
