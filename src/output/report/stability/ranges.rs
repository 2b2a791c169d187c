//! Where sliding is unstable along a series, and how far that is known.

use crate::analysis::branches::{Branch, BranchPoint};
use crate::analysis::{AboveBand, ComplexMode};
use crate::publish::value;
use crate::report::stability_point::StabilityPoint;
use serde_json::Value;

/// The modes at one speed.
pub(in crate::report) struct Speed {
    /// ω in revolutions per minute.
    pub omega: Value,
    /// The smallest and the largest μ with a point.
    pub mus: [f64; 2],
    /// The modes over μ.
    pub branches: Vec<Branch>,
    /// Where modes grow, by ascending μ.
    pub onsets: Vec<Onset>,
    /// The ranges in which sliding is unstable, by ascending μ.
    pub intervals: Vec<Interval>,
    /// Each μ at which no mode was found, so that it is not known whether sliding is stable.
    pub without_modes: Vec<f64>,
    /// The places that several points of a zip share, because what moves with the parameter changes there.
    pub shared: Vec<f64>,
    /// How far it was looked where no mode grows.
    pub known: Known,
}

/// Where a mode begins to grow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Onset {
    /// Index of the branch.
    pub branch: usize,
    /// The threshold μ_c; the first μ at which the mode is known, if it grows there already.
    pub mu: f64,
    /// The largest μ below with a point of the branch, or at which no mode grows; none if the mode grows at its first point already, and
    /// another one, or nothing known, at the point before.
    pub below: Option<f64>,
    /// The smallest μ above with a point of the branch.
    pub above: f64,
    /// Whether the branch has a point below.
    pub is_followed: bool,
    /// Where it ceases to grow; none if it still grows at the last point.
    pub ends: Option<Crossing>,
    /// Its frequency \[Hz\] there.
    pub frequency_hz: f64,
    /// Whether the eigenvalues on both sides are converged.
    pub is_converged: bool,
    /// Bound of the error of the threshold that the mesh makes: the larger one of the growth rates beside it, over their slope. None if
    /// it is unknown, or if there is no threshold.
    pub mesh_error: Option<f64>,
    /// Index of the family.
    pub family: usize,
}

/// How far modes were looked for along a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Known {
    /// The lowest frequency \[Hz\] up to which modes were looked for.
    pub band_hz: f64,
    /// The worst of what is known above.
    pub above: AboveBand,
}

impl Known {
    /// At the points of a series at which no mode grows; at all if there are none.
    pub fn of_stable(points: &[&StabilityPoint]) -> Self {
        let is_stable = |point: &&&StabilityPoint| point.leading().is_none_or(|mode| !mode.grows());
        let stable: Vec<&StabilityPoint> = points.iter().filter(is_stable).copied().collect();
        Self::of(if stable.is_empty() { points } else { &stable })
    }

    fn of(points: &[&StabilityPoint]) -> Self {
        let band_hz = points.iter().map(|point| point.stability.band_hz).fold(f64::INFINITY, f64::min);
        let all = || points.iter().map(|point| point.stability.above_band);
        let above = if let Some(open) = all().find(|above| !above.is_known()) {
            open
        } else if all().any(|above| above == AboveBand::Damped) {
            AboveBand::Damped
        } else {
            AboveBand::Nothing
        };
        Self { band_hz, above }
    }

    /// What it means that no mode grows: `stable`, or less.
    pub fn no_growth(&self) -> String {
        if self.above.is_known() {
            "stable".to_owned()
        } else {
            format!("no mode below {} grows", value::quantity(self.band_hz, "Hz"))
        }
    }
}

/// A range in which sliding is unstable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Interval {
    pub from: Edge,
    pub to: Edge,
    /// Frequency \[Hz\] of the mode that grows first.
    pub frequency_hz: f64,
    /// Whether the eigenvalues at its beginning are converged.
    pub is_converged: bool,
    /// Bound of the error of its beginning that the mesh makes; none if it is unknown.
    pub mesh_error: Option<f64>,
}

/// An end of a range in which sliding is unstable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) enum Edge {
    /// Between two points of which one is stable.
    At(f64),
    /// The first or the last point: the range may go on.
    Outside(f64),
    /// A point beside one of which nothing is known.
    Unknown(f64),
}

/// Where a growth rate is zero, between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::report) struct Crossing {
    pub at: f64,
    pub below: f64,
    pub above: f64,
}

/// Gives the thresholds of modes that were not followed through them: no mode grows at the point before the first one of the branch. The
/// threshold is where a line through the growth rates of the leading modes is zero.
pub(super) fn bracket_by_neighbours(onsets: &mut [Onset], leading: &[(f64, Option<ComplexMode>)]) {
    for onset in onsets.iter_mut().filter(|onset| onset.below.is_none()) {
        let Some(index) = leading.iter().position(|(at, _)| *at == onset.above) else { continue };
        let Some((below, Some(stable))) = index.checked_sub(1).map(|before| leading[before]) else {
            continue;
        };
        let (from, Some(to)) =
            (stable.growth_rate_per_s, leading[index].1.map(|mode| mode.growth_rate_per_s))
        else {
            continue;
        };
        if from < 0.0 && to >= 0.0 {
            onset.mu = below + (onset.above - below) * from / (from - to);
            onset.below = Some(below);
            onset.is_converged &= stable.is_converged;
        }
    }
}

/// The ranges in which sliding is unstable: where the leading mode of the points grows. Between two points of which one is unstable
/// the end is where the branches say, if they do, and otherwise where a line through both leading growth rates is zero.
pub(super) fn intervals(leading: &[(f64, Option<ComplexMode>)], onsets: &[Onset]) -> Vec<Interval> {
    let edge = |stable: (f64, Option<ComplexMode>), unstable: (f64, ComplexMode)| -> Edge {
        let Some(mode) = stable.1 else { return Edge::Unknown(unstable.0) };
        let (from, to) = (mode.growth_rate_per_s, unstable.1.growth_rate_per_s);
        let line = stable.0 + (unstable.0 - stable.0) * from / (from - to);
        let ends = [stable.0.min(unstable.0), stable.0.max(unstable.0)];
        let inside = |at: &f64| (ends[0]..=ends[1]).contains(at);
        let of_branches = if stable.0 < unstable.0 {
            onsets
                .iter()
                .filter(|onset| onset.below.is_some())
                .map(|onset| onset.mu)
                .filter(inside)
                .reduce(f64::min)
        } else {
            onsets.iter().filter_map(|onset| Some(onset.ends?.at)).filter(inside).reduce(f64::max)
        };
        Edge::At(of_branches.unwrap_or(line))
    };
    let mut found: Vec<Interval> = Vec::new();
    let mut open: Option<Interval> = None;
    for (index, &(at, mode)) in leading.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| leading[before]);
        match (mode.filter(ComplexMode::grows), &mut open) {
            (Some(mode), None) => {
                let from = before.map_or(Edge::Outside(at), |stable| edge(stable, (at, mode)));
                let is_sure = before.is_none_or(|(_, mode)| mode.is_none_or(|mode| mode.is_converged));
                let first = onsets.iter().find(|onset| matches!(from, Edge::At(from) if onset.mu == from));
                open = Some(Interval {
                    from,
                    to: Edge::Outside(at),
                    frequency_hz: first.map_or(mode.frequency_hz, |onset| onset.frequency_hz),
                    is_converged: first.map_or(mode.is_converged && is_sure, |onset| onset.is_converged),
                    mesh_error: first.and_then(|onset| onset.mesh_error),
                });
            }
            (Some(_), Some(interval)) => interval.to = Edge::Outside(at),
            (None, Some(interval)) => {
                if let Some((last, Some(mode_before))) = before {
                    interval.to = if mode.is_some() {
                        edge((at, mode), (last, mode_before))
                    } else {
                        Edge::Unknown(last)
                    };
                }
                found.extend(open.take());
            }
            (None, None) => {}
        }
    }
    found.extend(open);
    found
}

impl Speed {
    /// The onset at the smallest μ.
    pub fn lowest(&self) -> Option<&Onset> {
        self.onsets.first()
    }

    /// The branches that may be older ones: those that grow at their first point, after another one that still grew at its last.
    pub fn perhaps_older(&self) -> Vec<usize> {
        let grows = |point: &&BranchPoint| point.mode.grows();
        let lost = self.branches.iter().filter_map(|branch| branch.points.last().filter(grows));
        let mut lost: Vec<f64> = lost.map(|point| point.mu).collect();
        let mut found = Vec::new();
        for onset in self.onsets.iter().filter(|onset| onset.below.is_none()) {
            if let Some(place) = lost.iter().position(|mu| *mu < onset.mu) {
                lost.swap_remove(place);
                found.push(onset.branch);
            }
        }
        found
    }

    /// The onset of a branch.
    pub fn onset_of(&self, branch: usize) -> Option<&Onset> {
        self.onsets.iter().find(|onset| onset.branch == branch)
    }

    /// The place in words at which sliding becomes unstable first: `0.3142`, `≤ 0.1` if sliding is unstable at the smallest one already or
    /// not known at a smaller one, `> 0.6` if no mode grows at any point, and a dash if points without modes leave it open.
    /// `unit` is that of the parameter of the thresholds.
    pub fn threshold_in_words(&self, unit: &str) -> String {
        let text = |at: f64| value::quantity(at, unit);
        let with_unit = |number: &str| format!("{number} {unit}").trim_end().to_owned();
        let first = self.intervals.first();
        match first.map(|interval| interval.from) {
            Some(Edge::At(at)) if !self.without_modes.iter().any(|mu| *mu < at) => {
                let error = first.and_then(|interval| interval.mesh_error);
                let with =
                    |error: f64| format!("{} ± {}", text(at), with_unit(&value::significant(error, 2)));
                error.map_or_else(|| text(at), with)
            }
            Some(Edge::At(at) | Edge::Outside(at) | Edge::Unknown(at)) => format!("≤ {}", text(at)),
            None if self.mus[1].is_finite() && self.without_modes.is_empty() => {
                format!("> {}", text(self.mus[1]))
            }
            None => value::MISSING.to_owned(),
        }
    }

    /// The ranges in words in which sliding is unstable: `0.3142 to ≥ 0.6`, `≤ 0.05 to 0.29`, `none`.
    pub fn intervals_in_words(&self, unit: &str) -> String {
        let text = |at: f64| value::quantity(at, unit);
        let words = |interval: &Interval| {
            let from = match interval.from {
                Edge::At(at) => text(at),
                Edge::Outside(at) | Edge::Unknown(at) => format!("≤ {}", text(at)),
            };
            let to = match interval.to {
                Edge::At(at) => text(at),
                Edge::Outside(at) | Edge::Unknown(at) => format!("≥ {}", text(at)),
            };
            format!("{from} to {to}")
        };
        if self.mus[0] >= self.mus[1] {
            let at = text(self.mus[0]);
            return if self.intervals.is_empty() { "none".to_owned() } else { format!("at {at}") };
        }
        match self.intervals.as_slice() {
            [] if self.without_modes.is_empty() => "none".to_owned(),
            [] => value::MISSING.to_owned(),
            all => all.iter().map(words).collect::<Vec<_>>().join("; "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(growth_rate_per_s: f64) -> ComplexMode {
        ComplexMode::of(1.0e4, growth_rate_per_s)
    }

    fn of(rates: &[f64]) -> Vec<(Edge, Edge)> {
        let leading = |(k, rate): (usize, &f64)| (k as f64, rate.is_finite().then(|| mode(*rate)));
        let leading: Vec<_> = rates.iter().enumerate().map(leading).collect();
        intervals(&leading, &[]).into_iter().map(|interval| (interval.from, interval.to)).collect()
    }

    /// Protects: all ranges in which sliding is unstable are found, also those that begin at the first point and end before the last,
    /// as with friction that falls with the speed; their ends are interpolated. A point without modes ends a range at the last
    /// point of which something is known.
    #[test]
    fn all_ranges_of_instability_are_found() {
        let (at, outside, unknown) = (Edge::At, Edge::Outside, Edge::Unknown);
        assert_eq!(of(&[30.0, 10.0, -10.0, -5.0]), [(outside(0.0), at(1.5))]);
        assert_eq!(of(&[-10.0, 10.0, 20.0]), [(at(0.5), outside(2.0))]);
        assert_eq!(of(&[5.0, -5.0, -5.0, 15.0, -15.0]), [(outside(0.0), at(0.5)), (at(2.25), at(3.5))]);
        assert_eq!(of(&[-1.0, f64::NAN, 1.0, f64::NAN]), [(unknown(2.0), unknown(2.0))]);
        assert_eq!(of(&[5.0, 5.0]), [(outside(0.0), outside(1.0))]);
        assert_eq!(of(&[-5.0, f64::NAN]), []);
    }

    /// Protects: between two points of which one is unstable, the end of a range is where a branch of the modes crosses zero, because a
    /// line through the leading growth rates joins two modes.
    #[test]
    fn branches_say_where_a_range_ends() {
        let crossing = |at| Crossing { at, below: 1.0, above: 2.0 };
        let onset = |mu, ends| Onset {
            is_followed: true,
            branch: 0,
            mu,
            below: Some(0.0),
            above: 1.0,
            ends,
            frequency_hz: 9.0e3,
            is_converged: true,
            mesh_error: None,
            family: 0,
        };
        let leading = [(0.0, Some(mode(-1.0))), (1.0, Some(mode(1.0))), (2.0, Some(mode(-1.0)))];
        let found = intervals(&leading, &[onset(0.9, Some(crossing(1.2)))]);
        assert_eq!((found[0].from, found[0].to), (Edge::At(0.9), Edge::At(1.2)));
        assert_eq!(found[0].frequency_hz, 9.0e3);
        let found = intervals(&leading, &[onset(1.9, None)]);
        assert_eq!((found[0].from, found[0].to), (Edge::At(0.5), Edge::At(1.5)));
    }

    /// Protects: nothing is called stable above a band that nobody looked beyond. The worst point of a series counts.
    #[test]
    fn stable_is_said_of_what_is_known() {
        let known = |above| Known { band_hz: 24_500.0, above };
        assert_eq!(known(AboveBand::Damped).no_growth(), "stable");
        assert_eq!(known(AboveBand::Nothing).no_growth(), "stable");
        for above in [AboveBand::NotLookedAt, AboveBand::CoarserRun] {
            assert_eq!(known(above).no_growth(), "no mode below 24.5 kHz grows");
        }
    }
}
