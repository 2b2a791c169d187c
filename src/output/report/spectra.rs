//! The spectra that inspections of a report's jobs have stored.

use super::inspections::inspections;
use super::layout::Layout;
use super::parameters;
use super::row::JobRow;
use crate::publish::table::{Column, FileColumns, Table};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// The file of a spectrum in the folder of an inspection.
const FILE: &str = "spectrum.csv";

/// The amplitude spectrum of a job's total normal contact force.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct StoredSpectrum {
    /// Frequency \[Hz\] and amplitude \[N\] of every line, in the order of the frequencies.
    pub lines: Vec<(f64, f64)>,
}

/// The spectra of jobs, by their keys.
pub(super) type Spectra = HashMap<String, StoredSpectrum>;

/// The stored spectra of the jobs in `rows`. A file that cannot be read is none.
pub(super) fn read(report_folder: &Path, rows: &[JobRow]) -> Spectra {
    let found = inspections(report_folder);
    if found.is_empty() {
        return Spectra::new();
    }
    let keys: HashSet<&str> = rows.iter().map(|row| row.job.as_str()).collect();
    let of_rows = found.into_iter().filter(|inspection| keys.contains(inspection.job.as_str()));
    of_rows
        .filter_map(|inspection| {
            let spectrum = spectrum(&report_folder.join(&inspection.folder).join(FILE))?;
            Some((inspection.job, spectrum))
        })
        .collect()
}

fn spectrum(file: &Path) -> Option<StoredSpectrum> {
    let mut reader = ::csv::Reader::from_path(file).ok()?;
    let lines: Result<Vec<(f64, f64)>, _> = reader.deserialize().collect();
    let lines = lines.ok()?;
    let is_sound = |(frequency_hz, amplitude_n): &(f64, f64)| {
        frequency_hz.is_finite() && amplitude_n.is_finite() && *amplitude_n >= 0.0
    };
    let ascends = lines.is_sorted_by(|a, b| a.0 < b.0);
    (lines.len() > 1 && ascends && lines.iter().all(is_sound)).then_some(StoredSpectrum { lines })
}

/// A line of a job's spectrum: frequency \[Hz\] and amplitude \[N\].
#[derive(Clone, Copy)]
struct Line<'a> {
    row: &'a JobRow,
    frequency_hz: f64,
    amplitude_n: f64,
}

fn columns<'a>() -> [Column<Line<'a>>; 5] {
    [
        Column::new("job", "", "key of the job", |of| of.row.job.as_str().into()),
        Column::new("omega_rpm", "rpm", "rotation speed ω of the disk", |of| {
            of.row.parameters.omega_rpm().into()
        }),
        Column::new("mu", "", "local friction coefficient μ", |of| of.row.parameters.mu().into()),
        Column::new("frequency_hz", "Hz", "frequency of the line", |of| of.frequency_hz.into()),
        Column::new("normal_amplitude_n", "N", "amplitude of N at it", |of| of.amplitude_n.into()),
    ]
}

/// The lines of all stored spectra of the jobs of a layout.
pub(super) fn table(layout: &Layout, spectra: &Spectra) -> Table {
    let of_parameter = |name: &&str| {
        let (head, name) = (parameters::head(name), (*name).to_owned());
        Column::made(head, move |of: &Line| of.row.parameter(&name))
    };
    let fixed = columns();
    let further = layout.varied.iter().filter(|name| fixed.iter().all(|own| own.head.name != **name));
    let further: Vec<Column<Line>> = further.map(of_parameter).collect();
    let columns: Vec<Column<Line>> = fixed.into_iter().chain(further).collect();
    let jobs = layout.groups.iter().flat_map(|group| &group.jobs).map(|job| job.row);
    let lines = jobs.flat_map(|row| {
        let own = spectra.get(&row.job).map_or(&[][..], |own| &own.lines);
        own.iter().map(move |&(frequency_hz, amplitude_n)| Line { row, frequency_hz, amplitude_n })
    });
    Table::of("waterfall", &columns, &lines.collect::<Vec<_>>())
}

/// The columns, for the page of columns.
pub(super) fn described() -> FileColumns {
    FileColumns::new(&["waterfall.csv"], "A line is a line of the spectrum of an inspected job.", &columns())
}

impl StoredSpectrum {
    /// Largest amplitude \[N\] of the lines in a band of frequencies \[Hz\]; that of the nearest line if the band has none.
    pub fn largest_in(&self, from_hz: f64, to_hz: f64) -> f64 {
        let first = self.lines.partition_point(|line| line.0 < from_hz);
        let end = self.lines.partition_point(|line| line.0 < to_hz);
        let inside = self.lines[first..end].iter().map(|line| line.1);
        if first < end {
            return inside.fold(0.0, f64::max);
        }
        let middle_hz = (from_hz + to_hz) / 2.0;
        let beside = [first.checked_sub(1), Some(first)].into_iter().flatten();
        let near = beside.filter_map(|at| self.lines.get(at));
        let nearest = near.min_by(|a, b| (a.0 - middle_hz).abs().total_cmp(&(b.0 - middle_hz).abs()));
        nearest.map_or(0.0, |line| line.1)
    }

    /// The largest frequency \[Hz\].
    pub fn last_hz(&self) -> f64 {
        self.lines.last().map_or(0.0, |line| line.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a band has its own largest line, and a band between two lines has the nearer one.
    #[test]
    fn bands_have_their_lines() {
        let lines = vec![(0.0, 1.0), (100.0, 5.0), (200.0, 2.0), (300.0, 3.0)];
        let spectrum = StoredSpectrum { lines };
        assert_eq!(spectrum.largest_in(50.0, 250.0), 5.0);
        assert_eq!(spectrum.largest_in(150.0, 301.0), 3.0);
        assert_eq!(spectrum.largest_in(210.0, 220.0), 2.0);
        assert_eq!(spectrum.largest_in(280.0, 299.0), 3.0);
        assert_eq!(spectrum.largest_in(900.0, 901.0), 3.0);
        assert_eq!(spectrum.last_hz(), 300.0);
    }
}
