//! The region that is not ruled out, and the places where the next runs say most.

use super::history::History;
use super::values::Assessment;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// A place that is not ruled out.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The place.
    pub place: Vec<f64>,
    /// The largest implausibility.
    pub implausibility: f64,
    /// The sum of the squares of all implausibilities: it is smallest where the data fit best.
    pub square_sum: f64,
    /// What it is expected to give at each measured point.
    pub at: Vec<Assessment>,
}

/// The part of the unit cube that is not ruled out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Region {
    /// Its share of the unit cube.
    pub share: f64,
    /// Places that fill it evenly; none if everything is ruled out.
    pub inside: Vec<Candidate>,
    /// The place with the least implausibility, also if it is ruled out.
    pub best: Option<Candidate>,
}

/// Places that are tried in a box, for each parameter.
const TRIED: usize = 1024;

/// Places inside that are enough to know the region.
const ENOUGH: usize = 200;

/// Boxes, each inside the one before.
const BOXES: usize = 12;

/// The share of the places of a box that the next one is drawn around.
const KEPT: f64 = 0.1;

/// The part of a box that is added on each side of the places that are kept.
const MARGIN: f64 = 0.1;

/// The errors of emulators no longer matter where they are smaller than this share of all others: they make a distance 6 % less
/// implausible then.
const SMALL: f64 = 0.35;

/// The boundary of squeal is known where at most this share of the region is near runs of both kinds.
const DISPUTED: f64 = 0.2;

/// Places of the region that are compared for the next runs.
const COMPARED: usize = 512;

/// Two places that are nearer than this share of the region are one.
const SAME: f64 = 0.02;

impl History {
    /// The region that is not ruled out. `candidates` gives so many places that fill the unit cube evenly, its second argument, or fewer if it
    /// cannot give as many; its first argument is the number of the box, so that boxes have different places. `is_possible` says whether a job
    /// can have a place.
    pub fn region(
        &self,
        candidates: impl Fn(usize, usize) -> Vec<Vec<f64>>,
        is_possible: impl Fn(&[f64]) -> bool + Sync,
    ) -> Region {
        let Some(parameters) = self.runs().first().map(|run| run.place.len()) else {
            return Region::default();
        };
        let mut bounds = vec![[0.0, 1.0]; parameters];
        let mut tried = TRIED * parameters;
        let mut best: Option<Candidate> = None;
        for number in 0..BOXES {
            let places = candidates(number, tried);
            let count = places.len();
            let mut found: Vec<Candidate> = places
                .into_par_iter()
                .filter_map(|unit| {
                    let place = unit.iter().zip(&bounds).map(|(u, [low, high])| low + u * (high - low));
                    let place: Vec<f64> = place.collect();
                    is_possible(&place).then(|| self.candidate(place))
                })
                .collect();
            if found.is_empty() {
                return Region { best, ..Region::default() };
            }
            for own in &found {
                if best.as_ref().is_none_or(|best| own.implausibility < best.implausibility) {
                    best = Some(own.clone());
                }
            }
            let inside = found.iter().filter(|own| own.implausibility <= self.cutoff()).count();
            if inside >= ENOUGH || number + 1 == BOXES {
                let volume: f64 = bounds.iter().map(|[low, high]| high - low).product();
                found.retain(|own| own.implausibility <= self.cutoff());
                return Region { share: volume * inside as f64 / count as f64, inside: found, best };
            }
            let mut sorted: Vec<f64> = found.iter().map(|own| own.implausibility).collect();
            sorted.sort_by(f64::total_cmp);
            let kept = sorted[(KEPT * sorted.len() as f64) as usize].max(self.cutoff());
            found.retain(|own| own.implausibility <= kept);
            let next = around(&found, &bounds);
            let volume = |of: &[[f64; 2]]| of.iter().map(|[low, high]| high - low).product::<f64>();
            // A region of several parts, or a bent one, has a large box; then more places find it.
            if volume(&next) > 0.5 * volume(&bounds) {
                tried = (2 * tried).min(16 * TRIED * parameters);
            }
            bounds = next;
        }
        unreachable!("the last box returns")
    }

    fn candidate(&self, place: Vec<f64>) -> Candidate {
        let at = self.at(&place);
        let implausibility = at.iter().map(|own| own.implausibility).fold(0.0, f64::max);
        let square_sum = at.iter().map(|own| own.square_sum).sum();
        Candidate { place, implausibility, square_sum, at }
    }

    /// The largest share, over all measured values, that the emulators' errors have in all others, as the root mean square over the region.
    pub fn share_of_emulators(&self, region: &Region) -> f64 {
        let mut largest: f64 = 0.0;
        for (number, target) in self.targets().iter().enumerate() {
            for (quantity, measured) in target.values.iter().enumerate() {
                let Some(measured) = measured else { continue };
                let share = |own: &Candidate| {
                    // A value without an emulator is not known at all.
                    own.at[number].values[quantity].map_or(1.0, |expected| {
                        expected.emulator.powi(2) / (expected.mesh.powi(2) + measured.deviation.powi(2))
                    })
                };
                let sum: f64 = region.inside.iter().map(share).sum();
                largest = largest.max((sum / region.inside.len().max(1) as f64).sqrt());
            }
        }
        largest
    }

    /// Whether further runs would not change the region much: it is empty, or the emulators are exact enough in it and its best place was run.
    pub fn is_known(&self, region: &Region) -> bool {
        region.inside.is_empty()
            || self.share_of_emulators(region) <= SMALL
                && self.share_disputed(region) <= DISPUTED
                && self.is_new(region, best_fit(region)).is_none()
    }

    /// The share of the region where runs that squeal and runs that slide steadily are near each other, and it was measured which of the two.
    fn share_disputed(&self, region: &Region) -> f64 {
        let disputed = region.inside.iter().filter(|own| self.is_disputed(&own.place)).count();
        disputed as f64 / region.inside.len().max(1) as f64
    }

    /// The best fit, if no run is near it.
    fn is_new<'a>(&self, region: &Region, best: Option<&'a Candidate>) -> Option<&'a Candidate> {
        let widths = widths(region);
        best.filter(|best| self.distance(&best.place, &[], &widths) > SAME)
    }

    /// The places of the next runs: that which fits best, and places that are as far as possible from all runs and from each other, in
    /// units of the widths of the region.
    pub fn next(&self, region: &Region, count: usize) -> Vec<Vec<f64>> {
        let widths = widths(region);
        let mut chosen: Vec<Vec<f64>> = Vec::new();
        chosen.extend(self.is_new(region, best_fit(region)).map(|own| own.place.clone()));
        let compared = &region.inside[..region.inside.len().min(COMPARED)];
        while chosen.len() < count {
            let far = compared.iter().map(|own| (self.distance(&own.place, &chosen, &widths), own));
            let farthest = far.reduce(|best, own| if own.0 > best.0 { own } else { best });
            let Some((_, own)) = farthest.filter(|(distance, _)| *distance > SAME) else { break };
            chosen.push(own.place.clone());
        }
        chosen.truncate(count);
        chosen
    }

    /// The distance of a place from the nearest run or chosen place.
    fn distance(&self, place: &[f64], chosen: &[Vec<f64>], widths: &[f64]) -> f64 {
        let all = self.runs().iter().map(|run| &run.place).chain(chosen);
        let square = |other: &Vec<f64>| -> f64 {
            let parts = place.iter().zip(other).zip(widths);
            parts.map(|((a, b), width)| ((a - b) / width).powi(2)).sum()
        };
        all.map(square).fold(f64::INFINITY, f64::min).sqrt()
    }
}

fn best_fit(region: &Region) -> Option<&Candidate> {
    region.inside.iter().reduce(|best, own| if own.square_sum < best.square_sum { own } else { best })
}

/// The smallest box of some places.
fn extent(inside: &[Candidate]) -> Vec<[f64; 2]> {
    let parameters = inside.first().map_or(0, |own| own.place.len());
    let of = |at: usize| {
        let values = inside.iter().map(|own| own.place[at]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    (0..parameters).map(of).collect()
}

fn widths(region: &Region) -> Vec<f64> {
    extent(&region.inside).into_iter().map(|[low, high]| (high - low).max(1.0e-6)).collect()
}

/// A box around places, inside the one that they are from.
fn around(kept: &[Candidate], bounds: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let spacing = 1.0 / (kept.len() as f64).powf(1.0 / bounds.len() as f64);
    let side = |([low, high], [from, to]): ([f64; 2], &[f64; 2])| {
        let margin = (MARGIN + 0.5 * spacing.min(1.0)) * (high - low) + 0.01 * (to - from);
        [(low - margin).max(*from), (high + margin).min(*to)]
    };
    extent(kept).into_iter().zip(bounds).map(side).collect()
}

impl Region {
    /// The ends of the region for each parameter.
    pub fn extent(&self) -> Vec<[f64; 2]> {
        extent(&self.inside)
    }

    /// The correlation of two parameters inside; 0 if one of them does not vary.
    pub fn correlation(&self, a: usize, b: usize) -> f64 {
        let count = self.inside.len().max(1) as f64;
        let mean = |at: usize| self.inside.iter().map(|own| own.place[at]).sum::<f64>() / count;
        let (mean_a, mean_b) = (mean(a), mean(b));
        let sum = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            self.inside.iter().map(|own| f(own.place[a] - mean_a, own.place[b] - mean_b)).sum()
        };
        let product = sum(&|x, _| x * x) * sum(&|_, y| y * y);
        if product > 0.0 { sum(&|x, y| x * y) / product.sqrt() } else { 0.0 }
    }
}
