//! The windows of a run whose speed or load changes in time, and the hysteresis between up and down.

use super::cycles::Cycle;
use super::sample::Sample;
use super::sums::Sums;
use crate::spec::{Change, JobSpec};
use serde::{Deserialize, Serialize};

/// Where a program goes in a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Direction {
    /// The window begins during the load's ramp.
    Start,
    /// Nothing has changed yet.
    Hold,
    /// Upwards: the speed rises, or it is constant and rose before. Without a change of the speed, the load.
    Up,
    /// Downwards.
    Down,
    /// Up and down.
    Turn,
}

impl Direction {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The figures of a window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProgramWindow {
    /// Start and end \[s\].
    pub time_s: [f64; 2],
    /// Where the program goes.
    pub direction: Direction,
    /// Mean speed of the disk \[rpm\].
    pub omega_rpm: f64,
    /// Mean load \[N\].
    pub load_n: f64,
    /// μ* = ⟨T⟩/⟨F⟩, with T at the clamp.
    pub mu_star: f64,
    /// ⟨T⟩/⟨N⟩ of the contact forces.
    pub mu_star_contact: f64,
    /// Mean rate \[Hz\] of the cycles of N that end in the window. None with fewer than three, or if N hardly varies.
    pub frequency_hz: Option<f64>,
    /// Half the range of the smoothed N over the mean load.
    pub n_amplitude: f64,
    /// Range of the displacement in y \[m\] of the centre of the trailing edge.
    pub y_peak_to_peak_m: f64,
    /// Share of the node-time in stick.
    pub stick_share: f64,
    /// Share of the node-time in slip.
    pub slip_share: f64,
    /// Share of the node-time separated.
    pub separated_share: f64,
}

impl ProgramWindow {
    /// Its middle \[s\].
    pub fn middle_s(&self) -> f64 {
        0.5 * (self.time_s[0] + self.time_s[1])
    }
}

/// Fewest cycles that have a frequency in a window.
const FEWEST_CYCLES: u64 = 3;

/// Least amplitude of N over the load that has a frequency.
const LEAST_AMPLITUDE: f64 = 1.0e-3;

/// Cuts a run into windows of equal length.
#[derive(Serialize, Deserialize)]
pub(super) struct ProgramWindows {
    length_s: f64,
    count: u64,
    done: Vec<ProgramWindow>,
    /// The number of the window that is open.
    number: u64,
    sums: Sums,
    /// Cycles that ended in the open window, where the first began and the last ended.
    cycles: u64,
    cycles_s: [f64; 2],
}

impl ProgramWindows {
    /// The windows of a job.
    pub fn of(spec: &JobSpec) -> Self {
        let length_s = spec.window_length_s();
        Self {
            length_s,
            count: (spec.run.limit_s / length_s).round() as u64,
            done: Vec::new(),
            number: 0,
            sums: Sums::EMPTY,
            cycles: 0,
            cycles_s: [0.0; 2],
        }
    }

    /// Adds a step, and the cycle that ended in it.
    pub fn push(&mut self, spec: &JobSpec, sample: &Sample, cycle: Option<&Cycle>) {
        // Rounding must not give the last step a window of its own.
        while self.number + 1 < self.count && sample.time_s >= (self.number + 1) as f64 * self.length_s {
            self.done.extend(self.open(spec));
            self.number += 1;
            self.sums = Sums::EMPTY;
            self.cycles = 0;
        }
        self.sums.add(sample, 1.0);
        if let Some(cycle) = cycle {
            if self.cycles == 0 {
                self.cycles_s[0] = cycle.start_s;
            }
            self.cycles += 1;
            self.cycles_s[1] = cycle.end_s;
        }
    }

    /// All windows with steps.
    pub fn all(&self, spec: &JobSpec) -> Vec<ProgramWindow> {
        self.done.iter().cloned().chain(self.open(spec)).collect()
    }

    /// The window that is open; none without a step.
    fn open(&self, spec: &JobSpec) -> Option<ProgramWindow> {
        if self.sums.is_empty() {
            return None;
        }
        let sums = &self.sums;
        let [stick_share, slip_share, separated_share] = sums.shares();
        let load_n = sums.load_n();
        let swing_n = 0.5 * (sums.normal_max_n - sums.normal_min_n);
        // A window within the first step of a ramp has no load.
        let n_amplitude = if load_n > 0.0 { swing_n / load_n } else { 0.0 };
        let [from_s, to_s] = self.cycles_s;
        let has_frequency = self.cycles >= FEWEST_CYCLES && n_amplitude >= LEAST_AMPLITUDE;
        let time_s = [self.number as f64 * self.length_s, (self.number + 1) as f64 * self.length_s];
        let scene = &spec.scene;
        let omega = scene.program.omega_rpm.as_ref();
        Some(ProgramWindow {
            time_s,
            direction: self.direction(spec, time_s),
            omega_rpm: omega.map_or(scene.disk.omega_rpm, |table| table.mean(time_s)),
            load_n,
            mu_star: sums.mu_star_without_momentum(!scene.holder.is_ideal()),
            mu_star_contact: sums.mu_star_contact(),
            frequency_hz: has_frequency.then(|| self.cycles as f64 / (to_s - from_s)),
            n_amplitude,
            y_peak_to_peak_m: sums.nodes[1].y_peak_to_peak_m(),
            stick_share,
            slip_share,
            separated_share,
        })
    }

    fn direction(&self, spec: &JobSpec, time_s: [f64; 2]) -> Direction {
        let change = spec.scene.program.leading().map_or(Change::None, |table| table.change(time_s));
        match (change, self.done.last().map(|last| last.direction)) {
            _ if time_s[0] < spec.scene.load.ramp_s => Direction::Start,
            (Change::Rise, _) | (Change::None, Some(Direction::Up)) => Direction::Up,
            (Change::Fall, _) | (Change::None, Some(Direction::Down)) => Direction::Down,
            (Change::Both, _) => Direction::Turn,
            (Change::None, Some(Direction::Turn | Direction::Hold | Direction::Start) | None) => {
                Direction::Hold
            }
        }
    }
}

/// The quantity whose rise and fall are up and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Leading {
    /// The speed of the disk \[rpm\].
    Omega,
    /// The load \[N\].
    Load,
}

impl Leading {
    /// The speed, unless it is the same in all windows.
    pub fn of(windows: &[ProgramWindow]) -> Self {
        let first = windows.first().map(|window| window.omega_rpm);
        let varies = windows.iter().any(|window| Some(window.omega_rpm) != first);
        if varies || windows.is_empty() { Self::Omega } else { Self::Load }
    }

    /// Its mean in a window.
    pub fn value(self, window: &ProgramWindow) -> f64 {
        match self {
            Self::Omega => window.omega_rpm,
            Self::Load => window.load_n,
        }
    }
}

/// The largest difference of μ* between up and down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// μ* upwards minus μ* downwards.
    pub difference: f64,
    /// The speed \[rpm\] or the load \[N\] at which it is.
    pub at: f64,
}

impl Hysteresis {
    /// The largest difference between each way up or down and the next way back, where both have the same speed (or load). μ*
    /// is interpolated between windows. None if there is no way back, or no speed that both have.
    pub fn of(windows: &[ProgramWindow]) -> Option<Self> {
        let leading = Leading::of(windows);
        let ways: Vec<&[ProgramWindow]> = windows
            .chunk_by(|a, b| a.direction == b.direction)
            .filter(|way| matches!(way[0].direction, Direction::Up | Direction::Down))
            .collect();
        let pairs = ways.windows(2).filter(|pair| pair[0][0].direction != pair[1][0].direction);
        let differences = pairs.flat_map(|pair| {
            let (up, down) =
                if pair[0][0].direction == Direction::Up { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
            let [up, down] = [up, down].map(|way| curve(way, leading));
            let all: Vec<f64> = up.iter().chain(&down).map(|(at, _)| *at).collect();
            let of_both = all.into_iter().filter_map(move |at| {
                let difference = interpolated(&up, at)? - interpolated(&down, at)?;
                Some(Self { difference, at })
            });
            of_both.collect::<Vec<_>>()
        });
        differences.max_by(|a, b| a.difference.abs().total_cmp(&b.difference.abs()))
    }
}

/// Two speeds that differ less than this, relatively, are the same one.
const SAME: f64 = 1.0e-9;

/// The points (leading quantity, μ*) of a way in the order of the quantity. Windows at the same value are one point.
fn curve(way: &[ProgramWindow], leading: Leading) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        way.iter().map(|window| (leading.value(window), window.mu_star)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let same = points.chunk_by(|a, b| (b.0 - a.0).abs() <= SAME * b.0.abs());
    same.map(|same| (same[0].0, same.iter().map(|point| point.1).sum::<f64>() / same.len() as f64)).collect()
}

/// The value of a curve; none outside of its points.
fn interpolated(curve: &[(f64, f64)], at: f64) -> Option<f64> {
    let next = curve.partition_point(|point| point.0 < at);
    let (end, mu_star) = *curve.get(next)?;
    if end == at {
        return Some(mu_star);
    }
    let (begin, before) = curve[next.checked_sub(1)?];
    Some(before + (mu_star - before) * ((at - begin) / (end - begin)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn windows(points: &[(Direction, f64, f64)]) -> Vec<ProgramWindow> {
        let window = |&(direction, omega_rpm, mu_star): &(Direction, f64, f64)| ProgramWindow {
            direction,
            omega_rpm,
            mu_star,
            ..ProgramWindow::example()
        };
        points.iter().map(window).collect()
    }

    /// Protects: the hysteresis is the largest difference at the same speed, with its sign, of neighbouring ways only. Windows
    /// at the start and at a turn do not count.
    #[test]
    fn hysteresis_compares_at_the_same_speed() {
        use Direction::{Down, Start, Turn, Up};
        let loop_of = [
            (Start, 1.0, 9.0),
            (Up, 2.0, 0.40),
            (Up, 4.0, 0.30),
            (Up, 6.0, 0.20),
            (Turn, 7.0, 5.0),
            (Down, 5.0, 0.20),
            (Down, 3.0, 0.30),
            (Down, 1.0, 0.70),
        ];
        // At 2: 0.4 − 0.5. At 3: 0.35 − 0.3. At 4: 0.3 − 0.25. At 5: 0.25 − 0.2. The way down does not reach 6.
        let found = Hysteresis::of(&windows(&loop_of)).unwrap();
        assert!((found.difference + 0.1).abs() < 1e-12 && found.at == 2.0, "{found:?}");
        assert_eq!(Hysteresis::of(&windows(&loop_of[..4])), None);
        // Two windows at the same speed are one point with their mean.
        let held = [(Up, 1.0, 0.1), (Up, 2.0, 0.2), (Down, 2.0, 0.1), (Down, 2.0, 0.2), (Down, 1.5, 0.1)];
        let found = Hysteresis::of(&windows(&held)).unwrap();
        assert!((found.difference - 0.05).abs() < 1e-12, "{found:?}");
    }

    /// Protects: with a constant speed, up and down are those of the load.
    #[test]
    fn the_load_leads_if_the_speed_is_constant() {
        let mut all =
            windows(&[(Direction::Up, 5.0, 0.2), (Direction::Up, 5.0, 0.3), (Direction::Down, 5.0, 0.1)]);
        for (window, load_n) in all.iter_mut().zip([10.0, 30.0, 20.0]) {
            window.load_n = load_n;
        }
        let found = Hysteresis::of(&all).unwrap();
        assert!((found.difference - 0.15).abs() < 1e-12 && found.at == 20.0, "{found:?}");
    }
}
