//! Errors and costs of the jobs of a case.

use super::reference::{self, DoneJob, FIGURES, FREQUENCY, MU_STAR, Reference};

/// The errors and costs of a job.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// (μ* − reference) / reference.
    pub mu_star_error: f64,
    /// Smallest relative error of μ* that can be distinguished from 0: √(se² + se_ref²) + u over the reference.
    pub mu_star_resolution: f64,
    /// (f − reference) / reference; none if one of them has no frequency.
    pub frequency_error: Option<f64>,
    /// Smallest relative error of the frequency that can be distinguished from 0.
    pub frequency_resolution: Option<f64>,
    /// Largest resolved absolute difference of the three shares; if none is resolved, that of the share with the largest
    /// resolution.
    pub shares_error: f64,
    /// Smallest difference of that share that can be distinguished from 0.
    pub shares_resolution: f64,
    /// Nodes × steps.
    pub node_steps: f64,
    /// Solver time \[s\].
    pub wall_s: Option<f64>,
    /// On the Pareto front of error and solver time.
    pub on_wall_front: bool,
    /// On the Pareto front of error and node-steps.
    pub on_node_step_front: bool,
}

impl Score {
    /// Whether the error of μ* can be distinguished from 0.
    pub fn is_resolved(&self) -> bool {
        exceeds(self.mu_star_error, self.mu_star_resolution)
    }

    /// The error of μ* that can be claimed: the error, or the resolution if the error is not resolved.
    ///
    /// A resolution is rounded up to two digits, because a difference in the third digit does not make one of two
    /// unresolved jobs better than the other.
    pub fn claimed_error(&self) -> f64 {
        if self.is_resolved() { self.mu_star_error.abs() } else { two_digits_up(self.mu_star_resolution) }
    }
}

/// Whether an error can be distinguished from 0. For the reference itself, error and resolution are both the size of its
/// correction: they are equal up to rounding, and the error is not resolved.
pub(super) fn exceeds(error: f64, resolution: f64) -> bool {
    error.abs() > resolution * (1.0 + 1.0e-9)
}

fn two_digits_up(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return value;
    }
    let unit = 10.0_f64.powf(value.log10().floor() - 1.0);
    // The tolerance keeps a number that has two digits already.
    (value / unit - 1.0e-9).ceil() * unit
}

/// The scores of a case's jobs.
pub(super) fn scores(jobs: &[DoneJob], reference: &Reference) -> Vec<Score> {
    let mut scores: Vec<Score> = jobs.iter().map(|job| score(job, reference)).collect();
    let costs = |cost: fn(&Score) -> f64| -> Vec<(f64, f64)> {
        scores.iter().map(|score| (cost(score), score.claimed_error())).collect()
    };
    let by_wall = on_front(&costs(|score| score.wall_s.unwrap_or(f64::NAN)));
    let by_node_steps = on_front(&costs(|score| score.node_steps));
    for (i, score) in scores.iter_mut().enumerate() {
        score.on_wall_front = by_wall[i];
        score.on_node_step_front = by_node_steps[i];
    }
    scores
}

fn score(job: &DoneJob, reference: &Reference) -> Score {
    // Signed difference, its resolution, and the value of the reference.
    let difference = |figure: usize| {
        let target = reference.targets[figure]?;
        let noise = reference::standard_error(job, figure).hypot(target.standard_error);
        Some((
            FIGURES[figure].value(job.record)? - target.value,
            noise + target.uncertainty.unwrap_or(0.0),
            target.value,
        ))
    };
    let relative = |figure| {
        difference(figure).map(|(error, resolution, value)| (error / value, (resolution / value).abs()))
    };
    let shares: Vec<_> = (FREQUENCY + 1..FIGURES.len()).filter_map(difference).collect();
    // The largest resolved error of a share, or else the share with the largest resolution.
    let resolved = shares.iter().filter(|(error, resolution, _)| exceeds(*error, *resolution));
    let shown = resolved.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let shown = shown.or_else(|| shares.iter().max_by(|a, b| a.1.total_cmp(&b.1)));
    let (shares_error, shares_resolution) = shown.map_or((0.0, 0.0), |s| (s.0.abs(), s.1));
    let (mu_star_error, mu_star_resolution) = relative(MU_STAR).unwrap_or((f64::NAN, f64::NAN));
    let frequency = relative(FREQUENCY);
    Score {
        mu_star_error,
        mu_star_resolution,
        frequency_error: frequency.map(|(error, _)| error),
        frequency_resolution: frequency.map(|(_, resolution)| resolution),
        shares_error,
        shares_resolution,
        node_steps: job.numerics.nodes as f64 * job.record.steps as f64,
        wall_s: job.row.wall_s,
        on_wall_front: false,
        on_node_step_front: false,
    }
}

/// For each point (cost, error) whether it is on the Pareto front: no other point has at most the same cost and at most the same
/// error, and less of one of them. Points with a number that is not finite are never on it.
pub fn on_front(points: &[(f64, f64)]) -> Vec<bool> {
    let is_finite = |(cost, error): (f64, f64)| cost.is_finite() && error.is_finite();
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b && is_finite(a);
    let is_on = |point: &(f64, f64)| is_finite(*point) && !points.iter().any(|other| beats(*other, *point));
    points.iter().map(is_on).collect()
}
