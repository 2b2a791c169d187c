//! How state changes travel along the middle of the contact face.

use super::inspection::Inspection;
use super::low_pass::zero_phase_low_pass;
use super::phases::{Instants, phases};
use serde::Serialize;

/// The instants of a node on the line through the middle of the contact face along the sliding direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Its y [m] from the pin's axis.
    pub y_m: f64,
    /// Its instants; none if no step of the contact face was recorded.
    pub instants: Option<Instants>,
}

/// A change of the contact state that can travel along the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Contact begins, t_A.
    Contact,
    /// Stick begins, t_B.
    Stick,
    /// Stick ends, t_D.
    Slip,
    /// Contact ends, t_E.
    Separation,
}

impl Change {
    /// All changes in the order of their instants.
    pub const ALL: [Self; 4] = [Self::Contact, Self::Stick, Self::Slip, Self::Separation];

    /// The change in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact begins",
            Self::Stick => "stick begins",
            Self::Slip => "stick ends",
            Self::Separation => "contact ends",
        }
    }
}

impl Station {
    /// Time [s] of a change at this node, if it happens.
    pub fn at(&self, change: Change) -> Option<f64> {
        let instants = self.instants.as_ref()?;
        match change {
            Change::Contact => instants.contact_s,
            Change::Stick => instants.stick_s,
            Change::Slip => instants.slip_s,
            Change::Separation => instants.separation_s,
        }
    }
}

/// A change that travels over neighbouring stations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Wave {
    /// What changes.
    pub change: Change,
    /// y \[m\] of the first and the last station, from front to rear.
    pub from_to_m: [f64; 2],
    /// Time \[s\] of the change at the first station after the start of the cycle, within one period.
    pub start_s: f64,
    /// Delay \[s\] from the first to the last station; negative if the wave travels towards the front.
    pub delay_s: f64,
}

impl Wave {
    /// Its speed [m/s] along y, positive towards the rear; none if it is at all stations at the same time.
    pub fn speed_m_s(&self) -> Option<f64> {
        let [from_m, to_m] = self.from_to_m;
        (self.delay_s != 0.0).then(|| (to_m - from_m) / self.delay_s)
    }
}

/// The instants along that line, from front to rear. They are found in the recorded cycle, repeated three times.
pub fn stations(inspection: &Inspection) -> Vec<Station> {
    let mesh = inspection.mesh();
    let [start_s, end_s] = inspection.survey.windows.cycle_s;
    let period_s = end_s - start_s;
    let face = &inspection.capture.face;
    let station = |slave: usize| {
        let three_cycles = || {
            (0..3).flat_map(|cycle| {
                face.iter().map(move |step| (step.time_s + f64::from(cycle) * period_s, &step.nodes[slave]))
            })
        };
        let phases =
            phases(three_cycles().map(|(time_s, node)| (time_s, node.state)), start_s + 3.0 * period_s);
        let area_m2 = inspection.capture.model.slaves()[slave].area_m2;
        let raw: Vec<f64> = three_cycles().map(|(_, node)| node.force_n[2] / area_m2).collect();
        let stress: Vec<(f64, f64)> = three_cycles()
            .map(|(time_s, _)| time_s)
            .zip(zero_phase_low_pass(&raw, inspection.capture.stress_gain))
            .collect();
        let instants = Instants::find(&phases, &stress, start_s, period_s);
        Station { y_m: mesh.coordinates_m(slave)[1], instants }
    };
    inspection.face_grid().middle().map(station).collect()
}

/// The waves of a cycle that starts at `start_s`: every change over every run of two or more neighbouring stations that
/// have it. The delay between two neighbours is the one of least magnitude modulo the period. Delays between runs are not
/// known.
pub fn waves(stations: &[Station], start_s: f64, period_s: f64) -> Vec<Wave> {
    let mut waves = Vec::new();
    for change in Change::ALL {
        let times: Vec<Option<f64>> = stations.iter().map(|station| station.at(change)).collect();
        let runs = times.iter().zip(stations).collect::<Vec<_>>();
        for run in runs.split(|(time_s, _)| time_s.is_none()).filter(|run| run.len() > 1) {
            let at: Vec<f64> = run.iter().filter_map(|(time_s, _)| **time_s).collect();
            let shorter = |delay_s: f64| delay_s - period_s * (delay_s / period_s).round();
            waves.push(Wave {
                change,
                from_to_m: [run[0].1.y_m, run[run.len() - 1].1.y_m],
                start_s: (at[0] - start_s).rem_euclid(period_s),
                delay_s: at.windows(2).map(|pair| shorter(pair[1] - pair[0])).sum(),
            });
        }
    }
    waves
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(y_m: f64, slip_s: Option<f64>) -> Station {
        Station { y_m, instants: Some(Instants { slip_s, ..Instants::default() }) }
    }

    /// Protects: the delay between neighbours is the one of least magnitude modulo the period. If nodes in between do not
    /// have the change, there are two waves, and no delay between them.
    #[test]
    fn waves_run_over_neighbours() {
        let line = [
            at(-2.0, Some(10.9)),
            at(-1.0, Some(10.1)),
            at(0.0, Some(10.3)),
            at(1.0, None),
            at(2.0, Some(10.7)),
            at(3.0, None),
            at(4.0, Some(10.6)),
            at(5.0, Some(10.4)),
        ];
        let found = waves(&line, 10.0, 1.0);
        let [first, second] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!((first.change, first.from_to_m), (Change::Slip, [-2.0, 0.0]));
        // From 0.9 to 1.1 and to 1.3.
        assert!((first.delay_s - 0.4).abs() < 1e-12 && (first.start_s - 0.9).abs() < 1e-12, "{first:?}");
        assert!((first.speed_m_s().unwrap() - 5.0).abs() < 1e-9);
        assert_eq!(second.from_to_m, [4.0, 5.0]);
        assert!((second.speed_m_s().unwrap() + 5.0).abs() < 1e-9, "towards the front: {second:?}");
    }
}
