//! Run times of jobs. The time of a job is its share of the time of its thread.

use super::row::JobRow;

/// Number of the slowest jobs that are listed.
const SLOWEST: usize = 8;

/// Statistics of the run times of a study's jobs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Times<'a> {
    /// Number of jobs whose time is known.
    pub jobs: usize,
    pub total_s: f64,
    pub min_s: f64,
    pub median_s: f64,
    pub mean_s: f64,
    pub max_s: f64,
    /// Time steps per second of thread time, over all jobs with a result.
    pub steps_per_s: Option<f64>,
    /// The slowest jobs with their times [s], slowest first.
    pub slowest: Vec<(&'a JobRow, f64)>,
}

impl<'a> Times<'a> {
    /// The statistics; none if no time is known.
    pub fn of(rows: &'a [JobRow]) -> Option<Self> {
        let known = |row: &'a JobRow| Some((row, row.wall_s.filter(|s| s.is_finite())?));
        let mut times: Vec<(&JobRow, f64)> = rows.iter().filter_map(known).collect();
        times.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (jobs, &(_, max_s)) = (times.len(), times.first()?);
        let total_s: f64 = times.iter().map(|(_, s)| s).sum();
        let with_steps = times.iter().filter_map(|(row, s)| Some((row.record()?.steps as f64, s)));
        let (steps, seconds) = with_steps.fold((0.0, 0.0), |(steps, all), (own, s)| (steps + own, all + s));
        Some(Self {
            jobs,
            total_s,
            min_s: times[jobs - 1].1,
            median_s: f64::midpoint(times[(jobs - 1) / 2].1, times[jobs / 2].1),
            mean_s: total_s / jobs as f64,
            max_s,
            steps_per_s: (seconds > 0.0).then_some(steps / seconds),
            slowest: times.into_iter().take(SLOWEST).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::RowState;

    fn row(wall_s: Option<f64>) -> JobRow {
        JobRow {
            study: String::new(),
            job: String::new(),
            parameters: crate::report::Parameters::new(1.0, 0.1, Vec::new()),
            has_one_mu: true,
            state: RowState::Pending,
            wall_s,
            numerics: None,
            wave: 0,
            why: None,
            inputs: Vec::new(),
        }
    }

    /// Protects: the statistics are those of the known times, in any order and for an even number of them.
    #[test]
    fn times_are_summed_up() {
        let rows = [Some(4.0), None, Some(1.0), Some(10.0), Some(2.0)].map(row);
        let times = Times::of(&rows).unwrap();
        assert_eq!((times.jobs, times.total_s, times.mean_s), (4, 17.0, 4.25));
        assert_eq!((times.min_s, times.median_s, times.max_s), (1.0, 3.0, 10.0));
        assert_eq!(times.slowest.iter().map(|slow| slow.1).collect::<Vec<_>>(), [10.0, 4.0, 2.0, 1.0]);
        assert_eq!(times.steps_per_s, None);
        assert_eq!(Times::of(&rows[1..2]), None);
    }
}
