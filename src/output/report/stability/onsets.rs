//! Where modes begin to grow, and which of them belong together at neighbouring speeds.

use super::ranges::{Crossing, Onset, Speed};
use crate::analysis::branches::{Branch, BranchPoint, crossing, threads};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Where a branch grows; nothing if it does not.
pub(super) fn onsets_of(branch: usize, points: &Branch) -> Vec<Onset> {
    let place =
        |pair: [BranchPoint; 2]| Crossing { at: crossing(pair), below: pair[0].mu, above: pair[1].mu };
    let onset = |[begins, ends]: [Option<[BranchPoint; 2]>; 2]| {
        let ends_converged = ends.is_none_or(|[a, b]| a.mode.is_converged && b.mode.is_converged);
        let ends = ends.map(place);
        let Some([below, above]) = begins else {
            let first = points.points.first()?;
            let is_converged = first.mode.is_converged && ends_converged;
            let frequency_hz = first.mode.frequency_hz;
            let (mu, family) = (first.mu, 0);
            return Some(Onset {
                branch,
                mu,
                below: None,
                above: mu,
                is_followed: false,
                ends,
                frequency_hz,
                is_converged,
                mesh_error: None,
                family,
            });
        };
        let mu = crossing([below, above]);
        // Two points of a zip may share a place.
        let width = above.mu - below.mu;
        let share = if width > 0.0 { (mu - below.mu) / width } else { 0.0 };
        let [error, slope] = [
            below
                .mode
                .growth_rate_mesh_error_per_s
                .zip(above.mode.growth_rate_mesh_error_per_s)
                .map(|(a, b)| a.max(b)),
            (width > 0.0).then(|| (above.mode.growth_rate_per_s - below.mode.growth_rate_per_s) / width),
        ];
        let (from, to) = (below.mode.frequency_hz, above.mode.frequency_hz);
        Some(Onset {
            branch,
            mu,
            below: Some(below.mu),
            above: above.mu,
            is_followed: true,
            ends,
            frequency_hz: from + share * (to - from),
            is_converged: below.mode.is_converged && above.mode.is_converged && ends_converged,
            mesh_error: error.zip(slope).map(|(error, slope)| error / slope),
            family: 0,
        })
    };
    points.spans().into_iter().filter_map(onset).collect()
}

/// Sorts onsets by their places. Of modes that grow from the same place on, the fastest is that of the range, and it comes first.
pub(super) fn sort(onsets: &mut [Onset], branches: &[Branch]) {
    let growth_per_s = |onset: &Onset| {
        let mut points = branches[onset.branch].points.iter().filter(|point| point.mu == onset.above);
        points.next().map_or(f64::NEG_INFINITY, |point| point.mode.growth_rate_per_s)
    };
    onsets.sort_by(|a, b| {
        let by_growth = growth_per_s(b).total_cmp(&growth_per_s(a));
        a.mu.total_cmp(&b.mu).then(by_growth).then(a.frequency_hz.total_cmp(&b.frequency_hz))
    });
}

/// Finds the families of a group and names them in the onsets; returns their frequencies.
pub(super) fn name_families(speeds: &mut [Speed]) -> Vec<f64> {
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
