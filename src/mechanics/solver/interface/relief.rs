//! The heights of a rigid target that is not a plane. They move with the target.
//!
//! A slave node at the place q has the surface height `h = Σ a cos(m (q − r t))` under it, with the drive's rate r. On a disk q is an
//! angle, and m the number of waves in a revolution; on a plane q is a length. The normal force stays in z, because
//! slopes are small: the drive does the work N dh on the pin, as a wedge does.

use super::{Contacts, SlaveNode};
use crate::solver::field::{FieldOf, LaneSlot};
use crate::solver::interface::solve::StepData;
use crate::solver::number::Number;

/// Waves of a surface that moves with the target.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    waves: Vec<Wave>,
    /// The place of each slave node: rad on a disk, m on a plane.
    places: Vec<f64>,
}

/// A wave: amplitude \[m\], and waves per unit of q times 2π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Amplitude a \[m\].
    pub amplitude_m: f64,
    /// m: rad per unit of q.
    pub number: f64,
}

impl Relief {
    /// The waves under slave nodes at these places (rad on a disk, m on a plane).
    pub fn new(waves: Vec<Wave>, places: Vec<f64>) -> Self {
        Self { waves, places }
    }

    /// Waves around the axis of a disk, given by their amplitudes \[m\] and their numbers in a revolution.
    pub(in crate::solver) fn of_disk(
        waves: &[(f64, u32)],
        track_radius_m: f64,
        slaves: &[SlaveNode],
    ) -> Self {
        let wave = |&(amplitude_m, count): &(f64, u32)| Wave { amplitude_m, number: f64::from(count) };
        let angle = |slave: &SlaveNode| {
            let [x, y] = slave.position_m;
            libm::atan2(y, track_radius_m + x)
        };
        Self::new(waves.iter().map(wave).collect(), slaves.iter().map(angle).collect())
    }

    /// The height \[m\] under a slave node when the target has moved by `travelled`.
    pub fn height_m(&self, slave: usize, travelled: f64) -> f64 {
        let place = self.places[slave] - travelled;
        self.waves.iter().map(|wave| wave.amplitude_m * libm::cos(wave.number * place)).sum()
    }

    /// Gaps \[m\] over the mean plane of the surface with which the lowest slave node touches at the beginning, from those over a
    /// plane target.
    pub(in crate::solver) fn gaps_m(&self, slaves: &[SlaveNode]) -> Vec<f64> {
        let over_surface =
            |(slave, node): (usize, &SlaveNode)| node.initial_gap_m - self.height_m(slave, 0.0);
        let lowest_m = slaves.iter().enumerate().map(over_surface).fold(f64::INFINITY, f64::min);
        slaves.iter().map(|node| node.initial_gap_m - lowest_m).collect()
    }
}

/// A relief in every lane.
#[derive(Debug, Clone)]
pub(super) struct MovingRelief<const L: usize> {
    relief: Relief,
    nodes: Vec<MovingNode<L>>,
}

#[derive(Debug, Clone)]
struct MovingNode<const L: usize> {
    place: LaneSlot,
    /// Gap \[m\] over the mean plane.
    gap_m: f64,
    /// cos mq and sin mq for every wave.
    phases: Vec<[f64; 2]>,
    /// Rise \[m\] of the surface over the step after t_n and over the step before. All lanes begin at rest.
    rises_m: [[f64; L]; 2],
}

impl<const L: usize> MovingRelief<L> {
    /// The relief under these slave nodes, whose gaps are over its mean plane.
    pub fn new(relief: &Relief, slaves: &[SlaveNode], place: impl Fn(usize) -> LaneSlot) -> Self {
        let phases = |slave: usize| {
            let of_wave = |wave: &Wave| {
                let (sin, cos) = libm::sincos(wave.number * relief.places[slave]);
                [cos, sin]
            };
            relief.waves.iter().map(of_wave).collect()
        };
        let node = |(slave, node): (usize, &SlaveNode)| MovingNode {
            place: place(slave),
            gap_m: node.initial_gap_m,
            phases: phases(slave),
            rises_m: [[0.0; L]; 2],
        };
        Self { nodes: slaves.iter().enumerate().map(node).collect(), relief: relief.clone() }
    }

    /// Writes the gaps \[m\] at t_{n+1} of undeformed slave nodes to the first component of `gap_m`.
    pub fn advance<R: Number>(&mut self, given: &StepData<'_, L, R>, gap_m: &mut FieldOf<L, R>) {
        for lane in 0..L {
            let n = given.steps_done[lane];
            let turned = |steps: u64| {
                let travelled = given.drives[lane].rate * (steps as f64 * given.factors.time_step_s);
                let of_wave = |wave: &Wave| {
                    let (sin, cos) = libm::sincos(wave.number * travelled);
                    [wave.amplitude_m * cos, wave.amplitude_m * sin]
                };
                self.relief.waves.iter().map(of_wave).collect::<Vec<_>>()
            };
            // Before its first step a lane did not move.
            let times = [turned(n.saturating_sub(1)), turned(n), turned(n + 1)];
            for node in &mut self.nodes {
                // cos m(q − r t)
                let [before, now, after] = times.each_ref().map(|turned| {
                    let of_wave =
                        |(at, turned): (&[f64; 2], &[f64; 2])| at[0] * turned[0] + at[1] * turned[1];
                    node.phases.iter().zip(turned).map(of_wave).sum::<f64>()
                });
                node.rises_m[0][lane] = after - now;
                node.rises_m[1][lane] = now - before;
                gap_m.at_mut(node.place, 0)[lane] = R::from_f64(node.gap_m - after);
            }
        }
    }

    /// Makes the increments in z those of the gaps.
    pub fn relate<R: Number>(&self, contacts: &mut Contacts<L, R>) {
        for node in &self.nodes {
            let increments = contacts.increment_m.at_mut(node.place, 2);
            for (increment, rise_m) in increments.iter_mut().zip(&node.rises_m[0]) {
                *increment = R::from_f64(increment.to_f64() - rise_m);
            }
        }
    }

    /// Works \[J\] of the normal forces over the rises after and before t_n.
    pub fn works_j<R: Number>(&self, contacts: &Contacts<L, R>) -> [[f64; L]; 2] {
        let mut works_j = [[0.0; L]; 2];
        for node in &self.nodes {
            let normal_n = contacts.force_n.at(node.place, 2).map(R::to_f64);
            for (work_j, rises_m) in works_j.iter_mut().zip(&node.rises_m) {
                for lane in 0..L {
                    work_j[lane] += normal_n[lane] * rises_m[lane];
                }
            }
        }
        works_j
    }
}
