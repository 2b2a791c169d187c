//! A speed of the disk and a load that change in time.

use super::check::{Violations, readable};
use super::limit::LEAST_LOAD_N;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the speed of the disk and the load change in time. What is absent is constant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Program {
    /// Rotation speed, as points [time (s), speed (rpm)]. Absent: `disk.omega_rpm`; otherwise that is the largest of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega_rpm: Option<Table>,
    /// Total normal load, as points [time (s), load (N)]. Absent: `load.force_n`; otherwise that is the largest of them. The
    /// ramp `load.ramp_s` multiplies it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_n: Option<Table>,
}

/// A quantity over time: points [time (s), value], with straight lines between them. Two points at the same time are a
/// step. Before the first point and after the last one it is constant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Table(pub Vec<[f64; 2]>);

/// How a quantity changes in a part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// It does not.
    None,
    /// It rises, and falls nowhere.
    Rise,
    /// It falls, and rises nowhere.
    Fall,
    /// It rises and falls.
    Both,
}

/// Largest number of points of a table.
pub const MOST_POINTS: usize = 10_000;

impl Table {
    /// The value at a time \[s\]. At a step it is the later one. NaN without points.
    pub fn at(&self, time_s: f64) -> f64 {
        let next = self.0.partition_point(|[point_s, _]| *point_s <= time_s);
        match (next.checked_sub(1).map(|last| self.0[last]), self.0.get(next)) {
            (Some([from_s, from]), Some([to_s, to])) if from != *to => {
                from + (to - from) * ((time_s - from_s) / (to_s - from_s))
            }
            (Some([_, value]), _) | (None, Some(&[_, value])) => value,
            (None, None) => f64::NAN,
        }
    }

    /// The mean over a part of the run \[s\].
    pub fn mean(&self, [from_s, to_s]: [f64; 2]) -> f64 {
        let inside =
            self.0.iter().map(|[time_s, _]| *time_s).filter(|time_s| (from_s..to_s).contains(time_s));
        let ends: Vec<f64> = std::iter::once(from_s).chain(inside).chain([to_s]).collect();
        // The value in the middle of a straight line is its mean.
        let parts = ends.windows(2).map(|part| self.at(0.5 * (part[0] + part[1])) * (part[1] - part[0]));
        parts.sum::<f64>() / (to_s - from_s)
    }

    /// How it changes in a part of the run \[s\]. A step at its beginning is in it, and one at its end is not.
    pub fn change(&self, [from_s, to_s]: [f64; 2]) -> Change {
        let inside = |line: &&[[f64; 2]]| {
            let (begin_s, end_s) = (line[0][0], line[1][0]);
            begin_s < to_s && (end_s > from_s || begin_s == from_s)
        };
        let lines: Vec<&[[f64; 2]]> = self.0.windows(2).filter(inside).collect();
        let has = |sign: f64| lines.iter().any(|line| sign * (line[1][1] - line[0][1]) > 0.0);
        match (has(1.0), has(-1.0)) {
            (false, false) => Change::None,
            (true, false) => Change::Rise,
            (false, true) => Change::Fall,
            (true, true) => Change::Both,
        }
    }

    /// The time of the last point \[s\]; 0 without points.
    pub fn end_s(&self) -> f64 {
        self.0.last().map_or(0.0, |[time_s, _]| *time_s)
    }

    /// The largest value; −∞ without points.
    pub fn largest(&self) -> f64 {
        self.0.iter().map(|[_, value]| *value).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The least value; ∞ without points.
    pub fn least(&self) -> f64 {
        self.0.iter().map(|[_, value]| *value).fold(f64::INFINITY, f64::min)
    }

    /// Adds every violated limit of the times to `found`.
    fn check_times(&self, field: &str, limit_s: f64, found: &mut Violations) {
        let points = &self.0;
        if points.len() < 2 || points.len() > MOST_POINTS {
            let right = format!(
                "at least two points [time, value] and at most {MOST_POINTS}; without a program it is constant"
            );
            found.add(field, format!("{} points", points.len()), right);
        }
        if points.len() > MOST_POINTS {
            return;
        }
        if points.len() >= 2 && points.iter().all(|&[time_s, _]| time_s == 0.0) {
            found.add(field, "all times 0", "a last time > 0 s, at which the run ends");
        }
        if points.len() >= 2 && points.iter().all(|&[_, value]| value == 0.0) {
            found.add(field, "all values 0", "at least one value > 0");
        }
        for (index, &[time_s, _]) in points.iter().enumerate() {
            let field = format!("{field}[{index}]");
            let before_s = index.checked_sub(1).map(|last| points[last][0]);
            let is_third = index >= 2 && points[index - 2][0] == time_s;
            if !time_s.is_finite() || time_s < 0.0 {
                found.add(&field, readable(time_s), "a time >= 0 s");
            } else if before_s.is_some_and(|before_s| time_s < before_s) {
                found.add(&field, readable(time_s), "times that ascend: not earlier than the point before");
            } else if is_third {
                found.add(&field, readable(time_s), "at most two points at the same time, which are a step");
            } else if time_s > limit_s {
                let right = format!("a time within the run (run.limit_s = {})", readable(limit_s));
                found.add(&field, readable(time_s), right);
            }
        }
    }
}

impl Program {
    /// Whether nothing changes in time.
    pub fn is_constant(&self) -> bool {
        self.omega_rpm.is_none() && self.force_n.is_none()
    }

    /// The time of the last point \[s\]; none if nothing changes in time.
    pub fn end_s(&self) -> Option<f64> {
        self.tables().map(Table::end_s).reduce(f64::max)
    }

    /// What up and down refer to: the speed if it changes, otherwise the load.
    pub fn leading(&self) -> Option<&Table> {
        let end_s = self.end_s()?;
        let changes = |table: &&Table| table.change([0.0, end_s]) != Change::None;
        self.tables().find(changes).or_else(|| self.tables().next())
    }

    /// Sets a speed and a load to the largest ones of the program, as far as it changes them and `keeps` [speed, load] does not
    /// forbid it.
    pub(super) fn raise(&self, constants: [&mut f64; 2], keeps: [bool; 2]) {
        let tables = [&self.omega_rpm, &self.force_n];
        for ((table, keeps), constant) in tables.into_iter().zip(keeps).zip(constants) {
            // A table without a value above 0 is refused itself.
            if let Some(table) = table.as_ref().filter(|table| !keeps && table.largest() > 0.0) {
                *constant = table.largest();
            }
        }
    }

    /// Adds every violated limit in a run of `limit_s` to `found`. The speed and the load of the scene must be the largest ones.
    pub(super) fn check(
        &self,
        limit_s: f64,
        [omega_rpm, force_n]: [f64; 2],
        needs_constant_speed: bool,
        found: &mut Violations,
    ) {
        if let Some(omega) = &self.omega_rpm {
            let field = "scene.program.omega_rpm";
            omega.check_times(field, limit_s, found);
            for (index, &[_, speed]) in omega.0.iter().enumerate() {
                let field = format!("{field}[{index}]");
                let right = "a speed >= 0 rpm (the disk always turns towards +y)";
                found.require(&field, speed, speed >= 0.0, right);
                found.limit_magnitude(&field, speed);
            }
            check_largest(field, "scene.disk.omega_rpm", omega_rpm, omega, found);
            if needs_constant_speed {
                let right = "absent with an elastic disk, run-out or waviness, whose contact knows constant speeds only";
                found.add(field, "a speed that changes", right);
            }
        }
        if let Some(force) = &self.force_n {
            let field = "scene.program.force_n";
            force.check_times(field, limit_s, found);
            for (index, &[_, force]) in force.0.iter().enumerate() {
                let field = format!("{field}[{index}]");
                let right = format!("a load > 0 N, at least {LEAST_LOAD_N:e} N");
                found.require(&field, force, force >= LEAST_LOAD_N, &right);
                found.limit_magnitude(&field, force);
            }
            check_largest(field, "scene.load.force_n", force_n, force, found);
        }
    }

    fn tables(&self) -> impl Iterator<Item = &Table> {
        self.omega_rpm.iter().chain(&self.force_n)
    }
}

/// Adds a violation if a constant differs from the largest value of the program that stands for it.
fn check_largest(of: &str, field: &str, constant: f64, table: &Table, found: &mut Violations) {
    let largest = table.largest();
    if largest.is_finite() && largest > 0.0 && constant != largest {
        let right = format!("absent, or {}, the largest value of {of}", readable(largest));
        found.add(field, readable(constant), right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        Table(vec![[0.1, 1.0], [0.3, 5.0], [0.3, 2.0], [0.4, 2.0], [0.5, 1.0]])
    }

    /// Protects: a table is straight between its points, constant outside of them, and has the later value at a step.
    #[test]
    fn a_table_has_its_values() {
        let exact = [
            (0.0, 1.0),
            (0.1, 1.0),
            (0.2, 3.0),
            (0.3, 2.0),
            (0.35, 2.0),
            (0.4, 2.0),
            (0.45, 1.5),
            (0.5, 1.0),
            (9.0, 1.0),
        ];
        for (time_s, value) in exact {
            let found = table().at(time_s);
            assert!((found - value).abs() < 1.0e-14, "at {time_s} s: {found}, not {value}");
        }
        assert!(table().at(0.3_f64.next_down()) > 4.99);
        assert_eq!((table().end_s(), table().largest(), table().least()), (0.5, 5.0, 1.0));
    }

    /// Protects: a mean is the integral over the time, also over steps and beyond the ends, and a change counts where it is.
    #[test]
    fn means_and_changes_are_those_of_a_part() {
        // 0.1 s at 1, 0.2 s at 3 in the mean, 0.1 s at 2, 0.1 s at 1.5, 0.5 s at 1.
        for (part, mean, change) in [
            ([0.0, 1.0], 1.55, Change::Both),
            ([0.0, 0.1], 1.0, Change::None),
            ([0.1, 0.3], 3.0, Change::Rise),
            ([0.2, 0.4], 3.0, Change::Both),
            ([0.3, 0.5], 1.75, Change::Fall),
            ([0.3, 0.35], 2.0, Change::Fall),
            ([0.32, 0.38], 2.0, Change::None),
            ([0.6, 0.7], 1.0, Change::None),
        ] {
            let found = table().mean(part);
            assert!((found - mean).abs() < 1.0e-14, "{part:?}: {found}, not {mean}");
            assert_eq!(table().change(part), change, "{part:?}");
        }
    }
}
