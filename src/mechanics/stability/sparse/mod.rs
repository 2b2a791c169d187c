//! Steady sliding of scenes without fast transforms: K as rows of a sparse matrix with lumped masses, and sparse factors. An
//! elastic disk is such a scene. Any rigid one can be, too, which serves as a check.

mod arnoldi;
mod bodies;
mod system;

use super::bound::{self, Coupling};
use super::error::StabilityError;
use super::friction::SlidingFriction;
use super::sliding::{Equilibrium, Mode, SlidingPoint};
use super::stop::Stop;
use crate::solver::{Drive, Model};
use arnoldi::{Found, Near, near};
use bodies::{Bodies, Form};
use faer::c64;
use std::f64::consts::TAU;
use system::System;

/// Largest number of changes of the nodes in contact.
const MOST_CHANGES: usize = 60;
/// Steps of the iteration at one point. About a quarter as many eigenvalues converge on the side of positive frequencies.
const STEPS: usize = 80;
/// Largest number of unknowns. The factors of more fill more than a few gigabytes.
const MOST_UNKNOWNS: usize = 30_000;
/// Frequencies up to this multiple of c_s/(4h) are searched, the lowest shear mode of a pin of the height h.
const BAND: f64 = 2.5;
/// Parts of the band that are searched at first, and how often a part without enough eigenvalues is halved.
const PARTS: usize = 4;
const HALVINGS: usize = 4;
/// Beyond the band this many steps of [`near`] are taken, over the number of unknowns: the time of a point stays within bounds.
const WORK_BEYOND: usize = 50_000;
const MOST_BEYOND: usize = 120;
/// Smallest width of a search, over its frequency.
const NARROWEST: f64 = 1.0e-3;
/// Frequencies are searched up to this multiple of the mesh's largest one, which friction changes a little.
const ALL: f64 = 1.1;
/// Least radius around the middle of a part over half its width, so that modes away from the imaginary axis are found, too.
const OVERLAP: f64 = 1.15;

/// What all points of a model share.
#[derive(Debug)]
pub struct SparseStructure {
    bodies: Bodies,
    band_hz: f64,
    pub(super) stop: Stop,
}

/// The eigenvalues near one frequency.
#[derive(Debug, Clone)]
pub struct ModesNear {
    /// The modes, the nearest first.
    pub modes: Vec<Mode>,
    /// No eigenvalue is missing at less than this distance \[1/s\] from the frequency on the imaginary axis.
    pub radius_per_s: f64,
}

/// Checks the number of displacements of pin and disk.
pub fn check_size(model: &Model) -> Result<(), StabilityError> {
    let disk = model.ring().map_or(0, |ring| ring.mesh().node_count());
    let unknowns = 3 * (model.mesh().node_count() + disk);
    if unknowns > MOST_UNKNOWNS {
        return Err(StabilityError::TooLarge { unknowns, most: MOST_UNKNOWNS });
    }
    Ok(())
}

impl SparseStructure {
    /// What all points of `model` share. Its disk may be rigid or elastic.
    ///
    /// # Errors
    /// If there are too many unknowns.
    pub fn new(model: &Model) -> Result<Self, StabilityError> {
        check_size(model)?;
        let bodies = Bodies::new(model);
        Ok(Self { bodies, band_hz: BAND / (4.0 * model.pin().shear_transit_s()), stop: Stop::default() })
    }

    /// Adds the eigenvalues between two frequencies \[1/s\] from the lower one on, with at most `most` searches, the first of which is to
    /// be `width` wide. Returns the frequency up to which none is missing.
    fn beyond(
        &self,
        system: &System,
        damping_s: f64,
        [from, to]: [f64; 2],
        width: f64,
        most: usize,
        all: &mut Vec<Found>,
    ) -> Result<f64, StabilityError> {
        let (mut reached, mut width) = (from, width);
        for _ in 0..most {
            if reached >= to || width < NARROWEST * reached {
                break;
            }
            self.stop.check()?;
            let middle = reached + 0.5 * width;
            let Near { found, radius_per_s } =
                near(&system.matrices, damping_s, c64::new(0.0, middle), STEPS)?;
            all.extend(found);
            let covered = radius_per_s / OVERLAP;
            if covered >= 0.5 * width {
                reached = middle + covered;
            }
            // A radius of the same size is likely next to it.
            width = if radius_per_s > 0.0 { (1.8 * covered).min(to) } else { 0.5 * width };
        }
        Ok(reached.min(to))
    }

    /// Equilibrium and the leading `count` modes of the band.
    ///
    /// # Errors
    /// If there is no equilibrium, if an iteration does not converge, or if somebody asked to stop.
    pub fn point(&self, model: &Model, drive: &Drive, count: usize) -> Result<SlidingPoint, StabilityError> {
        let settled = self.settle(model, drive)?;
        let system = settled.vibrations(&self.bodies, model, drive);
        let damping_s = super::damping_s(model);
        let part = TAU * self.band_hz / PARTS as f64;
        let mut all = Vec::new();
        let mut reached_per_s = 0.0;
        let mut open: Vec<(f64, f64, usize)> =
            (0..PARTS).rev().map(|at| (part * at as f64, part * (at + 1) as f64, HALVINGS)).collect();
        while let Some((low, high, halvings)) = open.pop() {
            self.stop.check()?;
            let half = 0.5 * (high - low);
            let Near { found, radius_per_s } =
                near(&system.matrices, damping_s, c64::new(0.0, low + half), STEPS)?;
            let is_covered = radius_per_s >= OVERLAP * half;
            all.extend(found);
            if is_covered {
                reached_per_s = high;
            } else if halvings > 0 {
                open.push((low + half, high, halvings - 1));
                open.push((low, low + half, halvings - 1));
            } else {
                break;
            }
        }
        let band_per_s = TAU * self.band_hz;
        let damped_above_hz = self.damped_above_hz(&settled, &system, damping_s);
        let highest_per_s = model.ring().is_none().then(|| ALL * model.pin().omega_max_rad_s());
        let last_per_s = damped_above_hz.map(|limit_hz| TAU * limit_hz).into_iter().chain(highest_per_s);
        let last_per_s = last_per_s.fold(f64::INFINITY, f64::min);
        if reached_per_s >= band_per_s && last_per_s > band_per_s && last_per_s.is_finite() {
            let most = (WORK_BEYOND / system.matrices.size()).min(MOST_BEYOND);
            reached_per_s =
                self.beyond(&system, damping_s, [band_per_s, last_per_s], part, most, &mut all)?;
        }
        // A mode above what was covered is one, too, but others may be missing there.
        all.retain(|found: &Found| {
            found.value.im >= -1.0e-9 * found.value.norm()
                && (found.value.im <= reached_per_s || found.value.re > 0.0)
        });
        let mut distinct: Vec<Found> = Vec::new();
        for found in all {
            let is_known = |known: &Found| (known.value - found.value).norm() <= 1.0e-6 * found.value.norm();
            if !distinct.iter().any(is_known) {
                distinct.push(found);
            }
        }
        distinct.sort_by(|a, b| b.value.re.total_cmp(&a.value.re));
        distinct.truncate(count);
        Ok(SlidingPoint {
            modes: distinct.iter().map(|found| self.mode(&system, found)).collect(),
            band_hz: reached_per_s / TAU,
            has_all_modes: highest_per_s.is_some_and(|highest| reached_per_s >= highest),
            damped_above_hz,
            basis: system.matrices.size(),
            is_reduced: false,
            equilibrium: settled.equilibrium,
        })
    }

    /// The frequency above which no mode grows. It is known on a rigid disk without holders whose friction does not fall.
    fn damped_above_hz(&self, settled: &Settled, system: &System, damping_s: f64) -> Option<f64> {
        let bodies = &self.bodies;
        let is_rigid = bodies.masses_kg.len() == bodies.pin;
        if !is_rigid || !bodies.holders.is_empty() || damping_s <= 0.0 || settled.friction.falls() {
            return None;
        }
        let in_contact = &settled.equilibrium.in_contact;
        let symmetric = System::new(bodies, in_contact, &vec![0.0; in_contact.len()], &[]).matrices;
        let factors = symmetric.factored(|[_, k, _]| *k).ok()?;
        let difference = |is_transposed: bool| {
            let symmetric = &symmetric;
            move |x: &[f64]| -> Vec<f64> {
                let own = symmetric.stiffness_times(x, is_transposed);
                let with_friction = system.matrices.stiffness_times(x, is_transposed);
                own.iter().zip(with_friction).map(|(own, with)| own - with).collect()
            }
        };
        let mut coupling = Coupling {
            b: &mut difference(false),
            transposed: &mut difference(true),
            solve: &mut |force| factors.solve(force),
        };
        let start: Vec<f64> = (0..symmetric.size()).map(arnoldi::pseudo_random).collect();
        bound::damped_above_hz(bound::sector(&mut coupling, &start)?, damping_s)
    }

    /// Modes near a frequency.
    ///
    /// # Errors
    /// As [`SparseStructure::point`].
    pub fn near(&self, model: &Model, drive: &Drive, frequency_hz: f64) -> Result<ModesNear, StabilityError> {
        let settled = self.settle(model, drive)?;
        let system = settled.vibrations(&self.bodies, model, drive);
        let sigma = c64::new(0.0, TAU * frequency_hz);
        let Near { found, radius_per_s } = near(&system.matrices, super::damping_s(model), sigma, STEPS)?;
        let modes = found.iter().map(|found| self.mode(&system, found)).collect();
        Ok(ModesNear { modes, radius_per_s })
    }

    fn mode(&self, system: &System, found: &Found) -> Mode {
        let mut shape = system.displacements(&found.q);
        shape.truncate(self.bodies.pin);
        let largest =
            shape.iter().fold(c64::new(0.0, 0.0), |a, b| if b.norm_sqr() > a.norm_sqr() { *b } else { a });
        // A mode of the disk alone may leave the pin at rest.
        if largest.norm() > 0.0 {
            for value in &mut shape {
                *value /= largest;
            }
        }
        Mode {
            eigenvalue_per_s: found.value,
            eigenvalue_in_steps_per_s: found.value,
            residual: found.residual,
            growth_error_per_s: found.residual * found.value.norm(),
            is_converged: true,
            shape,
        }
    }

    /// The equilibrium by an active set: all nodes in contact slip, N ≥ 0, gap ≥ 0, one of them zero.
    fn settle(&self, model: &Model, drive: &Drive) -> Result<Settled, StabilityError> {
        let bodies = &self.bodies;
        let meetings = &bodies.meetings;
        let speeds: Vec<f64> = meetings.iter().map(|meeting| meeting.speed_per_rate).collect();
        let friction = SlidingFriction::new(&speeds, drive)?;
        let mu: Vec<f64> = (0..meetings.len()).map(|i| friction.mu_of(i)).collect();
        let mut load_n = vec![0.0; bodies.masses_kg.len()];
        for share in model.load() {
            load_n[share.dof] += share.share * drive.force_n;
        }
        let mut in_contact = vec![true; meetings.len()];
        for _ in 0..MOST_CHANGES {
            let system = System::new(bodies, &in_contact, &mu, &[]);
            let mut u = vec![0.0; load_n.len()];
            for (meeting, _) in meetings.iter().zip(&in_contact).filter(|(_, on)| **on) {
                u[3 * meeting.node + 2] = -meeting.initial_gap_m;
            }
            let forces: Vec<f64> =
                self.forces(&u).iter().zip(&load_n).map(|(elastic, load)| load - elastic).collect();
            let factors = system.matrices.factored(|[_, k, _]| *k)?;
            let q = factors.solve(&system.equations(&forces));
            for (u, more) in u.iter_mut().zip(system.displacements(&q)) {
                *u += more;
            }
            let elastic_n = self.forces(&u);
            let disk_z_m: Vec<f64> = meetings
                .iter()
                .map(|meeting| meeting.surface[2].iter().map(|(dof, share)| share * u[*dof]).sum())
                .collect();
            let normal_n: Vec<f64> = meetings
                .iter()
                .map(|meeting| elastic_n[3 * meeting.node + 2] - load_n[3 * meeting.node + 2])
                .collect();
            let next: Vec<bool> = (0..meetings.len())
                .map(|i| {
                    let gap_m = meetings[i].initial_gap_m + u[3 * meetings[i].node + 2] - disk_z_m[i];
                    if in_contact[i] { normal_n[i] >= 0.0 } else { gap_m < 0.0 }
                })
                .collect();
            if next != in_contact {
                in_contact = next;
                continue;
            }
            let normal_n: Vec<f64> =
                (0..meetings.len()).map(|i| if in_contact[i] { normal_n[i] } else { 0.0 }).collect();
            let nodes = normal_n.iter().zip(&friction.share).zip(meetings);
            let along_y: f64 =
                nodes.map(|((normal, share), meeting)| normal * share * meeting.forward[1]).sum();
            u.truncate(bodies.pin);
            return Ok(Settled {
                mu,
                equilibrium: Equilibrium {
                    mu_star: friction.mu * along_y / normal_n.iter().sum::<f64>(),
                    u_m: u,
                    normal_n,
                    in_contact,
                    disk_z_m,
                    mu: friction.mu,
                    mu_share: friction.share.clone(),
                },
                friction,
            });
        }
        Err(StabilityError::NoEquilibrium { mu: friction.mu })
    }

    /// K u with the springs of holders, which act on some of the displacements of a group.
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        let rows = self.bodies.rows.iter();
        let mut forces: Vec<f64> =
            rows.map(|row| row.iter().map(|(column, value)| value * u[*column]).sum()).collect();
        for (form, [_, stiffness, _]) in &self.bodies.holders {
            let way: f64 = form.iter().map(|(dof, factor)| factor * u[*dof]).sum();
            for (dof, factor) in form {
                forces[*dof] += factor * stiffness * way;
            }
        }
        forces
    }
}

struct Settled {
    mu: Vec<f64>,
    friction: SlidingFriction,
    equilibrium: Equilibrium,
}

impl Settled {
    /// Small vibrations about the equilibrium.
    fn vibrations(&self, bodies: &Bodies, model: &Model, drive: &Drive) -> System {
        let beta_r_s = model.scheme().beta_r_s;
        // The springs are in K, whose stiffness-proportional damping they do not have.
        let mut dampers: Vec<(f64, Form)> = bodies
            .holders
            .iter()
            .map(|(form, [_, stiffness, damping])| (damping - beta_r_s * stiffness, form.clone()))
            .collect();
        for (i, meeting) in
            bodies.meetings.iter().enumerate().filter(|(i, _)| self.equilibrium.in_contact[*i])
        {
            let slip = |[x, y]: [f64; 2]| -> Form {
                let mut form = vec![(3 * meeting.node, x), (3 * meeting.node + 1, y)];
                for (along, surface) in [x, y].iter().zip(&meeting.surface) {
                    form.extend(surface.iter().map(|(dof, share)| (*dof, -along * share)));
                }
                form
            };
            let [x, y] = meeting.forward;
            let normal_n = self.equilibrium.normal_n[i];
            let speed_m_s = meeting.speed_per_rate * drive.rate.abs();
            dampers.push((self.mu[i] * normal_n / speed_m_s, slip([-y, x])));
            if let Some((slope_s_m, _)) = &self.friction.slope {
                dampers.push((slope_s_m[i] * normal_n, slip([x, y])));
            }
        }
        System::new(bodies, &self.equilibrium.in_contact, &self.mu, &dampers)
    }
}
