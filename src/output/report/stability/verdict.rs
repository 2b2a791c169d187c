//! What linear stability says about the result of a job.

use crate::analysis::{Outcome, SlidingStability};
use crate::publish::value;
use crate::report::parameters::Parameters;
use crate::report::row::JobRow;
use crate::report::stability_point::{StabilityPoint, leading};
use std::collections::HashMap;

/// A job whose result linear stability alone does not explain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Verdict {
    /// It has a limit cycle, although every mode decays: stable sliding and the limit cycle exist side by side.
    CycleBelowThreshold,
    /// A mode grows, but μ\* is that of steady sliding.
    NoEffect,
}

impl Verdict {
    /// Both.
    pub const ALL: [Self; 2] = [Self::CycleBelowThreshold, Self::NoEffect];

    /// Its name in attributes of drawings.
    pub fn name(self) -> &'static str {
        match self {
            Self::CycleBelowThreshold => "cycle-below-threshold",
            Self::NoEffect => "no-effect",
        }
    }

    /// What it is, for a legend and a tooltip.
    pub fn words(self) -> &'static str {
        match self {
            Self::CycleBelowThreshold => "limit cycle, although every mode decays",
            Self::NoEffect => "a mode grows, but μ* is that of steady sliding",
        }
    }
}

/// Largest difference of μ\* from that of steady sliding, relative to it, at which a growing mode has no effect.
const NO_EFFECT: f64 = 1e-3;

/// The stability at the points of jobs.
pub(in crate::report) struct Verdicts<'a> {
    known: HashMap<String, &'a SlidingStability>,
}

impl<'a> Verdicts<'a> {
    pub fn new(points: &'a [StabilityPoint]) -> Self {
        let mut known = HashMap::new();
        for point in points {
            known.entry(key(&point.parameters)).or_insert(&point.stability);
        }
        Self { known }
    }

    /// The verdict on a job; none if linear stability explains its result, or if its leading mode is not converged.
    pub fn of(&self, row: &JobRow) -> Option<Verdict> {
        let record = row.record().filter(|_| !self.known.is_empty())?;
        let own = record.stability.as_ref();
        let stability = own.or_else(|| self.known.get(&key(&row.parameters)).copied())?;
        let mode = leading(stability).filter(|mode| mode.is_converged && !stability.decided)?;
        let difference = (record.mu_star - stability.mu_star).abs();
        if mode.growth_rate_per_s < 0.0 {
            (record.outcome == Outcome::Periodic).then_some(Verdict::CycleBelowThreshold)
        } else {
            let is_near = difference <= NO_EFFECT * stability.mu_star.abs();
            (mode.growth_rate_per_s > 0.0 && is_near).then_some(Verdict::NoEffect)
        }
    }
}

/// Values are compared as they are shown: 1 and 1.0 are equal. The order of the parameters does not matter.
fn key(parameters: &Parameters) -> String {
    let known = parameters.iter().filter(|(_, value)| !value.is_null());
    let mut texts: Vec<String> =
        known.map(|(name, value)| format!("{name}={}", value::text(value))).collect();
    texts.sort();
    texts.join(",")
}
