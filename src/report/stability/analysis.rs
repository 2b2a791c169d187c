//! The points in groups, as figures and tables show them: branches over μ at each speed, and where they begin to grow.

use crate::analysis::branches::{Branch, Sample, branches, threads};
use crate::publish::value;
use crate::report::Discretisation;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::{MU, OMEGA};
use crate::report::row::{JobRow, RowState};
use crate::report::stability_point::StabilityPoint;
use crate::report::view::View;
use nalgebra::Complex;
use serde_json::Value;
use std::f64::consts::TAU;

/// The points as rows, so that a [`Layout`] can group them. The key of a row is the number of its point.
pub(in crate::report) fn rows(points: &[StabilityPoint]) -> Vec<JobRow> {
    let row = |(number, point): (usize, &StabilityPoint)| JobRow {
        study: String::new(),
        job: number.to_string(),
        parameters: point.parameters.clone(),
        omega_rpm: point.omega_rpm,
        mu: point.mu,
        state: RowState::Pending,
        wall_s: None,
        numerics: None,
        discretisation: Discretisation::NotMeasured,
        wave: 0,
        why: None,
    };
    points.iter().enumerate().map(row).collect()
}

/// Points with their branches.
pub(in crate::report) struct Analysis<'a> {
    points: &'a [StabilityPoint],
    /// ω along the axis, μ over the series, a group for each combination of the other parameters.
    pub layout: Layout<'a>,
    /// The modes of each group of the layout.
    pub groups: Vec<GroupModes>,
}

/// The modes of a group.
pub(in crate::report) struct GroupModes {
    /// By ascending ω.
    pub speeds: Vec<Speed>,
    /// The frequencies \[Hz\] of modes that grow and are alike at neighbouring speeds: the median of those at which they begin
    /// to grow. The family that grows at the smallest μ comes first.
    pub families: Vec<f64>,
}

/// The modes at one speed.
pub(in crate::report) struct Speed {
    /// ω in revolutions per minute.
    pub omega: Value,
    /// The smallest and the largest μ with a point.
    pub mus: [f64; 2],
    /// The modes over μ.
    pub branches: Vec<Branch>,
    /// Where modes begin to grow, by ascending μ.
    pub onsets: Vec<Onset>,
    /// Each μ at which no mode was found, so that it is not known whether sliding is stable.
    pub without_modes: Vec<f64>,
}

/// Where a mode begins to grow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Onset {
    /// Index of the branch.
    pub branch: usize,
    /// The threshold μ_c; the first μ at which the mode is known, if it grows there already.
    pub mu: f64,
    /// The largest μ below with a point of the branch; none if the mode grows at its first point already.
    pub below: Option<f64>,
    /// The smallest μ above with a point of the branch.
    pub above: f64,
    /// Its frequency \[Hz\] there.
    pub frequency_hz: f64,
    /// Whether the eigenvalues on both sides are converged.
    pub is_converged: bool,
    /// Index of the family.
    pub family: usize,
}

impl<'a> Analysis<'a> {
    /// Analyses points, whose rows are `rows`.
    pub fn of(points: &'a [StabilityPoint], rows: &'a [JobRow], view: &View) -> Self {
        let view = View {
            x: Some(OMEGA.to_owned()),
            by: Some(MU.to_owned()),
            descriptions: view.descriptions.clone(),
            ..View::DEFAULT
        };
        let layout = Layout::of(rows, &view);
        let groups = layout.groups.iter().map(|group| group_modes(points, group)).collect();
        Self { points, layout, groups }
    }

    /// All points.
    pub fn points(&self) -> &'a [StabilityPoint] {
        self.points
    }

    /// The point of a row.
    pub fn point(&self, row: &JobRow) -> &'a StabilityPoint {
        point_of(self.points, row)
    }

    /// The lowest threshold of a speed, the frequency of its mode, and what else there is to say.
    pub fn words(&self, speed: &Speed) -> [String; 3] {
        let frequency = speed.lowest().map(|onset| value::quantity(onset.frequency_hz, "Hz"));
        let frequency = frequency.unwrap_or_else(|| value::MISSING.to_owned());
        [speed.threshold_in_words(), frequency, self.note(speed)]
    }

    fn note(&self, speed: &Speed) -> String {
        let mut words = Vec::new();
        match speed.lowest() {
            Some(onset) if onset.below.is_none() && onset.mu > speed.mus[0] => {
                words.push("the mode is not among those of smaller μ".to_owned());
            }
            Some(onset) if onset.below.is_none() => {
                words.push("unstable at the smallest μ already".to_owned());
            }
            Some(onset) if !onset.is_converged => words.push("not converged".to_owned()),
            Some(_) => {}
            None if !speed.without_modes.is_empty() => {}
            None => {
                let largest = self.layout.dimension(MU).assignment(&speed.mus[1].into());
                words.push(format!("stable up to {largest}"));
            }
        }
        if !speed.without_modes.is_empty() {
            let places = speed.without_modes.iter().map(|mu| value::significant(*mu, 4)).collect::<Vec<_>>();
            let places = places.join(", ");
            words.push(format!(
                "no mode was found at μ = {places}: whether sliding is stable there is not known"
            ));
        }
        let more = speed.onsets.len().saturating_sub(1);
        if more > 0 {
            let verb = if more == 1 { "grows" } else { "grow" };
            words.push(format!("{} {verb} at larger μ", value::count(more, "more mode")));
        }
        words.join("; ")
    }
}

fn point_of<'a>(points: &'a [StabilityPoint], row: &JobRow) -> &'a StabilityPoint {
    // The rows are those of these points.
    &points[row.job.parse::<usize>().unwrap_or_default()]
}

fn group_modes(points: &[StabilityPoint], group: &Group) -> GroupModes {
    let of_speed = |(index, omega): (usize, &Value)| {
        let own = group.jobs.iter().filter(|job| job.axis_index == index);
        let mut own: Vec<&StabilityPoint> = own.map(|job| point_of(points, job.row)).collect();
        // Of two results at one μ that of the grid counts.
        own.sort_by_key(|point| !point.on_grid);
        speed(omega, &own)
    };
    let mut speeds: Vec<Speed> = group.axis_values.iter().enumerate().map(of_speed).collect();
    let families = name_families(&mut speeds);
    GroupModes { speeds, families }
}

fn speed(omega: &Value, points: &[&StabilityPoint]) -> Speed {
    let sample = |point: &&StabilityPoint| Sample { mu: point.mu, modes: point.stability.modes.clone() };
    let mus = points.iter().map(|point| point.mu);
    let mus = mus.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], mu| [low.min(mu), high.max(mu)]);
    let branches = branches(&points.iter().map(sample).collect::<Vec<_>>());
    let mut onsets: Vec<Onset> =
        branches.iter().enumerate().filter_map(|(number, branch)| onset(number, branch)).collect();
    onsets.sort_by(|a, b| a.mu.total_cmp(&b.mu).then(a.frequency_hz.total_cmp(&b.frequency_hz)));
    let without_modes = points.iter().filter(|point| point.stability.modes.is_empty()).map(|point| point.mu);
    let mut without_modes: Vec<f64> = without_modes.collect();
    without_modes.sort_by(f64::total_cmp);
    Speed { omega: omega.clone(), mus, branches, onsets, without_modes }
}

/// Where a branch begins to grow; none if it does not.
fn onset(branch: usize, points: &Branch) -> Option<Onset> {
    let first = points.points.first()?;
    if first.mode.growth_rate_per_s >= 0.0 {
        let is_converged = first.mode.is_converged;
        let frequency_hz = first.mode.frequency_hz;
        let (mu, family) = (first.mu, 0);
        return Some(Onset { branch, mu, below: None, above: mu, frequency_hz, is_converged, family });
    }
    let (mu, [below, above]) = (points.mu_c?, points.around_mu_c()?);
    let share = (mu - below.mu) / (above.mu - below.mu);
    let (from, to) = (below.mode.frequency_hz, above.mode.frequency_hz);
    Some(Onset {
        branch,
        mu,
        below: Some(below.mu),
        above: above.mu,
        frequency_hz: from + share * (to - from),
        is_converged: below.mode.is_converged && above.mode.is_converged,
        family: 0,
    })
}

/// Finds the families of a group and names them in the onsets; returns their frequencies.
fn name_families(speeds: &mut [Speed]) -> Vec<f64> {
    let value = |onset: &Onset| Complex::new(0.0, TAU * onset.frequency_hz);
    let positions: Vec<(f64, Vec<Complex<f64>>)> = speeds
        .iter()
        .enumerate()
        .map(|(number, speed)| {
            let at = speed.omega.as_f64().unwrap_or(number as f64);
            (at, speed.onsets.iter().map(value).collect())
        })
        .collect();
    let mut found = threads(&positions);
    let lowest = |family: &Vec<(usize, usize)>| {
        family.iter().map(|(speed, onset)| speeds[*speed].onsets[*onset].mu).fold(f64::INFINITY, f64::min)
    };
    found.sort_by(|a, b| lowest(a).total_cmp(&lowest(b)));
    let mut frequencies = Vec::new();
    for (number, family) in found.iter().enumerate() {
        let mut own = Vec::new();
        for (speed, onset) in family {
            let onset = &mut speeds[*speed].onsets[*onset];
            onset.family = number;
            own.push(onset.frequency_hz);
        }
        own.sort_by(f64::total_cmp);
        frequencies.push(own.get(own.len() / 2).copied().unwrap_or_default());
    }
    frequencies
}

impl Speed {
    /// The onset at the smallest μ.
    pub fn lowest(&self) -> Option<&Onset> {
        self.onsets.first()
    }

    /// The onset of a branch.
    pub fn onset_of(&self, branch: usize) -> Option<&Onset> {
        self.onsets.iter().find(|onset| onset.branch == branch)
    }

    /// The threshold in words: `0.3142`, `≤ 0.1` if sliding is unstable at the smallest μ already or not known at a smaller one, `> 0.6` if it is stable at
    /// every μ, and a dash if no mode grows but points without modes leave it open.
    pub fn threshold_in_words(&self) -> String {
        let text = |mu: f64| value::significant(mu, 4);
        match self.lowest() {
            Some(onset) if onset.below.is_some() && !self.without_modes.iter().any(|mu| *mu < onset.mu) => {
                text(onset.mu)
            }
            Some(onset) => format!("≤ {}", text(onset.mu)),
            None if self.mus[1].is_finite() && self.without_modes.is_empty() => {
                format!("> {}", text(self.mus[1]))
            }
            None => value::MISSING.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{ComplexMode, SlidingStability, AboveBand};

    fn point(omega_rpm: f64, mu: f64, modes: &[(f64, f64)]) -> StabilityPoint {
        let mode = |(frequency_hz, growth_rate_per_s): &(f64, f64)| ComplexMode {
            frequency_hz: *frequency_hz,
            growth_rate_per_s: *growth_rate_per_s,
            damping_ratio: -growth_rate_per_s / (TAU * frequency_hz),
            residual: 1e-9,
            is_converged: true,
        };
        let stability = SlidingStability {
            decided: false,
            contact_nodes: 9,
            lifted_nodes: 0,
            mu_star: mu,
            band_hz: 5e4,
            above_band: AboveBand::NotLookedAt,
            damped_above_hz: None,
            modes: modes.iter().map(mode).collect(),
        };
        StabilityPoint { omega_rpm, mu, parameters: Vec::new(), on_grid: true, stability }
    }

    /// Protects: modes of neighbouring speeds with nearly the same frequency are one family, the one with the smallest threshold
    /// comes first, and a speed without a growing mode says up to which μ it is stable, or that this is not known because a point
    /// has no modes.
    #[test]
    fn families_and_thresholds() {
        let points = [
            point(1.0, 0.1, &[(10_000.0, -10.0), (20_000.0, 5.0)]),
            point(1.0, 0.3, &[(10_000.0, 10.0), (20_000.0, 10.0)]),
            point(2.0, 0.1, &[(10_100.0, -30.0), (20_100.0, -5.0)]),
            point(2.0, 0.3, &[(10_100.0, 10.0), (20_100.0, 5.0)]),
            point(4.0, 0.1, &[(10_200.0, -30.0)]),
            point(4.0, 0.3, &[(10_200.0, -10.0)]),
            point(8.0, 0.1, &[(10_200.0, -30.0)]),
            point(8.0, 0.3, &[]),
        ];
        let rows = rows(&points);
        let found = Analysis::of(&points, &rows, &View::DEFAULT);
        let group = &found.groups[0];
        assert_eq!(group.families, [20_100.0, 10_100.0]);
        let words: Vec<String> = group.speeds.iter().map(Speed::threshold_in_words).collect();
        assert_eq!(words, ["≤ 0.1", "0.2", "> 0.3", value::MISSING]);
        let notes: Vec<String> = group.speeds.iter().map(|speed| found.note(speed)).collect();
        assert_eq!(notes[2], "stable up to μ = 0.3");
        assert_eq!(notes[3], "no mode was found at μ = 0.3: whether sliding is stable there is not known");
        let families: Vec<Vec<usize>> = group
            .speeds
            .iter()
            .map(|speed| speed.onsets.iter().map(|onset| onset.family).collect())
            .collect();
        assert_eq!(families, [vec![0, 1], vec![0, 1], vec![], vec![]]);
        assert_eq!(group.speeds[1].onsets[0].frequency_hz, 20_100.0);
    }
}
