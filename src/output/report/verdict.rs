//! What a comparison says first: how far the simulation is from what was measured, and in which direction.

use super::comparison::{Comparison, Difference, Movers};
use super::parameters::in_words;
use super::scalar::FREQUENCY;
use super::sensitivity::Mover;
use super::stability::NEAR;
use crate::publish::value::{count, fixed, significant_number};

/// A parameter that moves a quantity by less than this share of a difference hardly explains it.
const MOVES: f64 = 0.1;

/// Differences within so many standard errors agree.
const AGREE: f64 = 2.0;

impl Difference {
    /// How far the simulation is from the measured value, as a share of it; of two studies, how far the other one is from the reference.
    /// None if the value is zero.
    pub(super) fn deviation(&self) -> Option<f64> {
        let of = if self.is_measured { self.value } else { self.reference };
        Some(self.difference() / of.abs()).filter(|share| share.is_finite())
    }

    /// The combined error as a share of the same value; none if no error is known.
    pub(super) fn error_of_deviation(&self) -> Option<f64> {
        let of = if self.is_measured { self.value } else { self.reference };
        Some(self.combined_error()? / of.abs()).filter(|share| share.is_finite() && *share > 0.0)
    }
}

impl Comparison {
    /// A sentence for each source and quantity, in the order of the sources, and one for squeal if nothing contradicts it.
    pub(super) fn verdicts(&self) -> Vec<String> {
        let same = |a: &Difference, b: &Difference| a.source == b.source && a.scalar == b.scalar;
        let of_quantities = self.differences.chunk_by(same).filter_map(|part| self.verdict(part));
        let of_squeal = (self.contradictions.is_empty() && self.compared_squeals > 0).then(|| {
            let points = match self.compared_squeals {
                1 => "the one point".to_owned(),
                several => format!("all {}", count(several as u64, "point")),
            };
            let other = self.other_frequencies().unwrap_or_default();
            format!(
                "squeal: {} and the others agree at {points} where both are known{other}.",
                self.reference
            )
        });
        of_quantities.chain(of_squeal).collect()
    }

    /// That measured frequencies are far from those of the simulation, as the end of a sentence; `None` if none is.
    fn other_frequencies(&self) -> Option<String> {
        let own = self.differences.iter().filter(|one| one.is_measured && one.scalar == FREQUENCY);
        let deviations: Vec<f64> = own.filter_map(Difference::deviation).collect();
        let far = deviations.iter().filter(|share| share.abs() > NEAR).count();
        (far > 0).then(|| {
            format!(
                ", but frequencies differ by more than {} at {far} of {}: it may be another squeal",
                share(NEAR),
                count(deviations.len(), "point")
            )
        })
    }

    fn verdict(&self, part: &[Difference]) -> Option<String> {
        let first = part.first()?;
        let mut deviations: Vec<f64> = part.iter().filter_map(Difference::deviation).collect();
        deviations.sort_by(f64::total_cmp);
        let (least, most) = (*deviations.first()?, *deviations.last()?);
        let (own, of) = if first.is_measured {
            (&self.reference, &first.source)
        } else {
            (&first.source, &self.reference)
        };
        let points = match deviations.len() {
            1 => "at the one point that is compared".to_owned(),
            several => format!("at all {}", count(several as u64, "point")),
        };
        let has_error = |one: &&Difference| !one.is_measured || one.error.is_some();
        let judged: Vec<bool> = part
            .iter()
            .filter(has_error)
            .filter_map(|one| Some(one.deviation()?.abs() <= AGREE * one.error_of_deviation()?))
            .collect();
        let within = judged.iter().filter(|agrees| **agrees).count();
        let what = first.scalar.words();
        let range = match deviations.len() {
            1 => String::new(),
            _ => format!(" ({})", range_in_words(&deviations)?),
        };
        let open = open_in_words(part).unwrap_or_default();
        if !judged.is_empty() && within == judged.len() && judged.len() == deviations.len() {
            return Some(format!(
                "{what}: {own} agrees with {of} within two standard errors {points}{range}.{open}"
            ));
        }
        let half = deviations.len() / 2;
        let middle = if deviations.len() % 2 == 1 {
            deviations[half]
        } else {
            0.5 * (deviations[half - 1] + deviations[half])
        };
        let deviates = if least > 0.0 || most < 0.0 {
            let way = if middle < 0.0 { "below" } else { "above" };
            format!("{own} is {} {way} {of} {points}{range}", share(middle.abs()))
        } else {
            format!("{own} differs from {of} by {} to {}", signed(least), signed(most))
        };
        let errors = if !part.iter().any(|one| has_error(&one)) {
            "; the errors of the measured values are not given".to_owned()
        } else if judged.is_empty() {
            String::new()
        } else if deviations.len() == 1 {
            "; not within two standard errors".to_owned()
        } else {
            format!("; within two standard errors at {within} of {}", judged.len())
        };
        let one_way = least > 0.0 || most < 0.0;
        let moved = one_way.then(|| self.moved_by(first, middle, own)).flatten().unwrap_or_default();
        let nearest = nearest_curve(part).unwrap_or_default();
        Some(format!("{what}: {deviates}{errors}.{open}{moved}{nearest}"))
    }

    /// The parameters that could bring a quantity nearer, in a sentence. `deviation` is how far it is away.
    fn moved_by(&self, first: &Difference, deviation: f64, own: &str) -> Option<String> {
        if *own != self.reference {
            return None;
        }
        let Movers { study, of } = self.movers.as_ref()?;
        let (_, movers) = of.iter().find(|(scalar, _)| *scalar == first.scalar)?;
        let movers = match movers {
            Ok(movers) => movers,
            Err(why) => return Some(format!(" What could move it is not known: {study} {why}.")),
        };
        let least = MOVES * deviation.abs();
        let (strong, weak): (Vec<_>, Vec<_>) = movers.iter().partition(|own| own.change.abs() >= least);
        let one = |own: &&Mover| {
            let is_smaller = (own.change > 0.0) == (deviation > 0.0);
            let [from, to] = if is_smaller { [own.ends[1], own.ends[0]] } else { own.ends };
            let [from, to] = [from, to].map(|x| in_words(&own.parameter, &significant_number(x, 4)));
            let size = if is_smaller { "smaller" } else { "larger" };
            let change = signed(-own.change.abs().copysign(deviation));
            format!("a {size} {} ({from} to {to}: {change})", own.parameter)
        };
        let moves = if deviation > 0.0 { "lowers" } else { "raises" };
        let names = weak.iter().map(|own| own.parameter.as_str()).collect::<Vec<_>>().join(" and ");
        let hardly = match weak.len() {
            0 => String::new(),
            1 => format!("; {names} hardly moves it"),
            _ => format!("; {names} hardly move it"),
        };
        Some(match strong.as_slice() {
            [] => format!(" Nothing that {study} varies moves it by a tenth of that."),
            [only] => format!(" In {study}, {} {moves} it{hardly}.", one(only)),
            [first, others @ ..] => {
                let others: Vec<String> = others.iter().map(one).collect();
                let verb = if others.len() == 1 { "does" } else { "do" };
                format!(
                    " In {study}, {} {moves} it, and so {verb} {}{hardly}.",
                    one(first),
                    others.join(" and ")
                )
            }
        })
    }
}

/// At how many points a mean is one over no whole number of cycles, which is no result however near it is, in a sentence; `None` if at none.
fn open_in_words(part: &[Difference]) -> Option<String> {
    let open = part.iter().filter(|one| one.is_open).count();
    let at = match part.len() {
        1 => "there".to_owned(),
        all if open == all => "at any of them".to_owned(),
        _ => format!("at {open} of them"),
    };
    (open > 0).then(|| format!(" The motion is not periodic {at}."))
}

/// Of several curves that the same measured points are compared with, such as those of several μ, the one that is nearest, in a sentence. The
/// differences of a curve follow each other.
fn nearest_curve(part: &[Difference]) -> Option<String> {
    let curves: Vec<&[Difference]> = part.chunk_by(|a, b| a.curve == b.curve).collect();
    // Points of known friction have a curve of their own, and then the curves are no alternatives.
    let points = |own: &[Difference]| own.iter().map(|one| one.value).collect::<Vec<_>>();
    let are_alternatives = curves.len() > 1 && curves.iter().all(|own| points(own) == points(curves[0]));
    if !are_alternatives || !part[0].is_measured {
        return None;
    }
    let deviations = |own: &[Difference]| own.iter().filter_map(Difference::deviation).collect::<Vec<_>>();
    let size = |own: &[Difference]| deviations(own).iter().map(|share| share.powi(2)).sum::<f64>();
    let nearest = curves.iter().min_by(|a, b| size(a).total_cmp(&size(b)))?;
    let mut shares = deviations(nearest);
    shares.sort_by(f64::total_cmp);
    let range = range_in_words(&shares)?;
    let of = curves.len();
    Some(format!(" Of {of} curves, {} is the nearest by the mean square: {range}.", nearest[0].curve))
}

/// The smallest and the largest of deviations in ascending order; `None` without any.
fn range_in_words(ascending: &[f64]) -> Option<String> {
    match ascending {
        [] => None,
        [only] => Some(signed(*only)),
        [least, .., most] => Some(format!("{} to {}", signed(*least), signed(*most))),
    }
}

fn share(x: f64) -> String {
    format!("{} %", fixed(100.0 * x, usize::from(x.abs() < 0.1)))
}

fn signed(x: f64) -> String {
    let sign = if x < 0.0 { "−" } else { "+" };
    format!("{sign}{}", share(x.abs()))
}
