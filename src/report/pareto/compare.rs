//! From rows to physical cases.

use super::case::Case;
use super::done::DoneJob;
use super::error::ParetoError;
use crate::publish::value::count;
use crate::report::row::JobRow;

/// All physical cases with at least two finished jobs.
#[derive(Debug)]
pub struct Comparison<'a> {
    /// The cases, in the order of the study.
    pub cases: Vec<Case<'a>>,
    /// Cases that are left out because fewer than two of their jobs are done, in words.
    pub left_out: Vec<String>,
}

/// Compares the finished jobs of each physical case with the finest of them.
///
/// A job that is in `rows` twice (of two studies that share it) counts once. `is_numerics` says of a parameter whether it changes how a
/// physical case is solved and not the case.
///
/// # Errors
/// If there is nothing to compare: fewer than two jobs are done, none of them are of the same physical case,
/// or their numerics or run times are not known.
pub fn compare(rows: &[JobRow], is_numerics: fn(&str) -> bool) -> Result<Comparison<'_>, ParetoError> {
    let rows = distinct(rows);
    let done = rows.iter().filter(|row| row.record().is_some()).count();
    if done < 2 {
        return Err(ParetoError::TooFewDone { done, jobs: rows.len() });
    }
    if rows.iter().all(|row| row.numerics.is_none()) {
        return Err(ParetoError::NoNumerics);
    }
    if rows.iter().all(|row| row.record().is_none() || row.wall_s.is_none()) {
        return Err(ParetoError::NoRunTimes { done });
    }
    let mut comparison = Comparison { cases: Vec::new(), left_out: Vec::new() };
    for group in grouped(&rows, |row| row.numerics.as_ref().map(|numerics| numerics.case.clone())) {
        let by_damping = damping_is_physics(&group);
        let parts = if by_damping {
            grouped(&group, |row| row.numerics.as_ref().map(|numerics| numerics.beta_r_s.to_bits()))
        } else {
            vec![group]
        };
        for part in parts {
            let jobs: Vec<DoneJob> = part.iter().filter_map(|row| DoneJob::of(row)).collect();
            if jobs.len() < 2 {
                let words = super::settings::physics_in_words(part[0], is_numerics);
                comparison.left_out.push(format!(
                    "{words}: {} of {} done",
                    jobs.len(),
                    count(part.len(), "job")
                ));
            } else {
                comparison.cases.push(Case::new(jobs, &part, by_damping, is_numerics));
            }
        }
    }
    if comparison.cases.is_empty() {
        return Err(ParetoError::OneJobACase { done });
    }
    Ok(comparison)
}

fn distinct(rows: &[JobRow]) -> Vec<&JobRow> {
    let mut seen = std::collections::HashSet::new();
    rows.iter().filter(|row| seen.insert(row.job.as_str())).collect()
}

/// Groups in the order of their first rows; rows without a key are left out.
fn grouped<'a, K: PartialEq>(
    rows: &[&'a JobRow],
    key: impl Fn(&JobRow) -> Option<K>,
) -> Vec<Vec<&'a JobRow>> {
    let mut groups: Vec<(K, Vec<&JobRow>)> = Vec::new();
    for &row in rows {
        let Some(key) = key(row) else { continue };
        match groups.iter_mut().find(|(own, _)| *own == key) {
            Some((_, group)) => group.push(row),
            None => groups.push((key, vec![row])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Whether β_R was swept as physics: the finest mesh of the group, done or not, has several values of it.
fn damping_is_physics(group: &[&JobRow]) -> bool {
    let numerics = || group.iter().filter_map(|row| row.numerics.as_ref());
    let finest = numerics().map(|n| n.element_size_m).fold(f64::INFINITY, f64::min);
    let mut damping = numerics().filter(|n| n.element_size_m == finest).map(|n| n.beta_r_s);
    damping.next().is_some_and(|first| damping.any(|other| other != first))
}
