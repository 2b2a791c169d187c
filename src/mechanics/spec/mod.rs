//! What a job is: everything that determines its result, as plain data.
//!
//! A [`JobSpec`] has four parts: the [`Scene`] (bodies, contact, boundary conditions, load), the
//! [`Numerics`] (integrator and time step), the [`RunControl`] (how long) and the [`Detection`]
//! (when a state counts as periodic or decayed). All of them default to the reference scene of
//! Baillet, d'Errico and Berthier (2005). [`JobSpec::check`] says which values are not physical.
//!
//! # Conventions
//! * SI units, with the unit in the name of every bare number.
//! * The pin's base is the plane z = 0; x is the disk's radial direction (outwards), y the sliding
//!   direction. **The disk's surface moves towards +y**, so the pin meets fresh disk surface at its
//!   −y end: −y is the *leading* end (the pin's front), +y the *trailing* end (its rear).

#![warn(clippy::disallowed_methods)]

mod accuracy;
mod base;
mod check;
mod contact;
mod continuation;
mod detection;
mod disk;
pub mod elasticity;
mod holder;
mod limit;
mod mesh;
mod mu_of_speed;
mod numerics;
mod pin;
mod plasticity;
mod program;
mod ring;
mod roughness;
mod scene;
mod stability;
mod strains;

pub use accuracy::Accuracy;
pub use base::Base;
pub(crate) use check::short;
pub use check::{FieldError, Violations};
pub use contact::{COEFFICIENTS, Coefficient, Contact, FrictionLaw, Memory, Rise};
pub use continuation::Continuation;
pub use detection::Detection;
pub use disk::{Disk, DiskKind};
pub use holder::{Holder, HolderDirection, SlowTimes};
pub use limit::{End, LIMITS, Limit};
pub use mesh::{MeshContent, MeshFile};
pub use mu_of_speed::{MOST_PAIRS, MuOfSpeed, Segment};
pub use numerics::{Numerics, Precision, RunControl, Start};
pub use pin::{Element, FEWEST_ACROSS, Pin, Region, Shape, core_elements};
pub use plasticity::Plasticity;
pub use program::MOST_POINTS;
pub use program::{Change, Program, Table};
pub use ring::{DiskTimeStep, Ring, TargetSurface};
pub use roughness::MOST_HEIGHTS;
pub use roughness::{HeightMap, Roughness};
pub use scene::{Clamp, ClampSide, Load, Scene, TopFace};
pub use stability::StabilityMethod;
pub use strains::{MaterialLaw, Strains};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Everything that determines the result of one job.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct JobSpec {
    /// Bodies, contact law, boundary conditions and load.
    pub scene: Scene,
    /// Integrator and time step.
    pub numerics: Numerics,
    /// How long the run lasts and what it averages over.
    pub run: RunControl,
    /// When a state counts as periodic or as decayed.
    pub detection: Detection,
    /// How the job finds out whether its steady sliding is stable.
    pub stability: StabilityMethod,
    /// How exact its result is to be; none if it is solved on one mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// The job that it continues, and whether others can continue it; none for most jobs.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub continuation: Option<Box<Continuation>>,
}

/// Shortest observation of a decay, in transit times of shear waves over the pin's height (2.5 ms in the reference
/// scene): the squeal's frequency must lie well above the lowest frequency that the observation resolves.
const SHORTEST_OBSERVATION: f64 = 100.0;

/// Swings of a holder in an observation of a decay. The first line that is judged has 7 periods in 10/16 of it, which is 11.2.
const SWINGS_OBSERVED: f64 = 14.0;

impl JobSpec {
    /// Checks every value against its physical or numerical limits.
    ///
    /// # Errors
    /// All violations found, each with the field's path below the job (`scene.contact.mu`), the
    /// value and what would be right.
    pub fn check(&self) -> Result<(), Violations> {
        let mut found = Violations::default();
        self.scene.check(&mut found);
        self.numerics.check(&mut found);
        self.run.check(&mut found);
        self.detection.check(&mut found);
        self.scene.check_program(self.run.limit_s, &mut found);
        self.check_strains(&mut found);
        self.check_plasticity(&mut found);
        if self.has_run() {
            self.check_run(&mut found);
        } else {
            self.check_modes(&mut found);
        }
        if self.scene.disk.kind == DiskKind::Elastic {
            self.check_elastic_disk(&mut found);
        }
        if self.numerics.precision == Precision::Single {
            self.check_single_precision(&mut found);
        }
        if !self.scene.holder.is_ideal() && self.numerics.beta2 != 0.5 {
            found.add(
                "numerics.beta2",
                self.numerics.beta2,
                "0.5 with a holder that moves, whose energies are kept for the central difference only",
            );
        }
        if let Some(accuracy) = self.accuracy {
            accuracy.check(&mut found);
            if self.has_run() {
                self.check_levels(&mut found);
            }
        }
        if let Some(continuation) = &self.continuation {
            continuation.check(&mut found);
            if !self.keeps_no_past() || self.scene.disk.kind == DiskKind::Elastic {
                let right = "absent here: displacements and velocities alone continue a run only on a rigid plane disk without \
                             a holder that moves, a layer, a law that uses the past, or a speed or load that changes";
                found.add("continue", "given", right);
            }
        }
        found.into_result()
    }

    /// Whether the modes of steady sliding depend on the time step: β₂ > ½ damps like (β₂ − ½)Δt.
    pub fn modes_need_time_step(&self) -> bool {
        self.numerics.beta2 != 0.5
    }

    /// The numbers of elements that a coarser mesh may have on which the job runs first, the best ones first; empty if it runs on none.
    ///
    /// A mesh of half as many elements in each direction is best. It may have no row of nodes at the clamp's edge, and two thirds one.
    pub fn coarser_elements(&self) -> Vec<[usize; 3]> {
        // An elastic disk has a mesh of its own, so that the coarser run of the pin says less and takes nearly as long.
        let is_rigid = self.scene.disk.kind == DiskKind::Rigid;
        let is_asked = match self.run.start {
            _ if self.accuracy.is_some() && self.has_run() => true,
            Start::Rest => false,
            Start::Nested => is_rigid || self.starts_in_motion(),
            Start::Compared => is_rigid || self.has_run(),
        };
        let has_steady_state = !self.has_run() || self.scene.program.is_constant();
        // A job that continues another one has its beginning on its own mesh, and can be compared with a run from rest on another.
        let is_continued = self.continuation.is_some() && self.run.start != Start::Compared;
        if !is_asked || !has_steady_state || is_continued || !self.has_measured_elements() {
            return Vec::new();
        }
        let Some(own) = self.scene.pin.own_elements() else { return Vec::new() };
        let [half, two_thirds] = [(1, 2), (2, 3)].map(|(share, of)| own.map(|n| (share * n).div_ceil(of)));
        let is_level = self.accuracy.is_some() && self.has_run();
        let fewest = if is_level || self.starts_in_motion() { FEWEST_TO_START } else { FEWEST_TO_COMPARE };
        let is_enough = half.iter().all(|&n| n >= fewest);
        if is_enough { vec![half, two_thirds] } else { Vec::new() }
    }

    /// Whether the mesh errors were measured with the elements and the strains of the pin and of its disk. What two meshes say of each other was not
    /// compared with finer ones for the others.
    pub fn has_measured_elements(&self) -> bool {
        let Scene { pin, disk, .. } = &self.scene;
        let of_disk = if disk.kind == DiskKind::Elastic { disk.ring.element } else { Element::Full };
        pin.element == Element::Full && of_disk == Element::Full && pin.strains == Strains::Small
    }

    /// Whether the run starts from the limit cycle of the coarser mesh, and not from rest.
    pub fn starts_in_motion(&self) -> bool {
        self.run.start == Start::Nested && self.carries_motion()
    }

    /// Whether a motion on a coarser mesh is enough to start from. It is not for a law that uses the past, a holder that moves, a surface
    /// that is not flat, or a layer. It is carried over between upright blocks of one material.
    fn carries_motion(&self) -> bool {
        self.keeps_no_past() && self.scene.pin.base.is_flat() && self.scene.pin.is_plain_block()
    }

    /// Whether there is a run. Modes alone have none, and nothing that only a run needs can forbid them.
    pub fn has_run(&self) -> bool {
        self.stability != StabilityMethod::Modes
    }

    /// The time limit \[s\] of the run; 0 without a run.
    pub fn limit_of_run_s(&self) -> f64 {
        if self.has_run() { self.run.limit_s } else { 0.0 }
    }

    /// What a run needs: windows, a ramp and an observation that fit into it, and a disk that is fine wherever the pin passes.
    fn check_run(&self, found: &mut Violations) {
        if self.run.window_s.is_some() && self.scene.program.is_constant() {
            let right =
                "absent without scene.program: a run with a constant speed and load is not cut into windows";
            found.add("run.window_s", "given", right);
        }
        if self.scene.load.ramp_s >= self.run.limit_s {
            found.add(
                "scene.load.ramp_s",
                self.scene.load.ramp_s,
                format!("less than the run's time limit (run.limit_s = {})", self.run.limit_s),
            );
        }
        let observation_s = self.detection.decay_observation_s;
        let shortest_s = SHORTEST_OBSERVATION * self.scene.pin.shear_transit_s();
        if observation_s < shortest_s {
            found.add(
                "detection.decay_observation_s",
                check::readable(observation_s),
                format!(
                    "at least {shortest_s:e} s, {SHORTEST_OBSERVATION} transit times of shear waves over the pin's \
                     height: slower oscillations would not be seen to grow"
                ),
            );
        }
        if self.scene.disk.kind == DiskKind::Elastic {
            let swept_deg = self.scene.disk.omega_rpm * 6.0 * self.run.limit_s;
            let arc_deg = self.scene.disk.ring.track_arc_deg;
            if arc_deg < 360.0 && swept_deg > arc_deg * ring::ROUNDING {
                found.add(
                    "scene.disk.ring.track_arc_deg",
                    arc_deg,
                    format!(
                        "{}, the arc that the pin sweeps at {} rpm during run.limit_s = {} s",
                        if swept_deg < 360.0 {
                            format!("360, or at least {swept_deg:.4}")
                        } else {
                            "360".to_owned()
                        },
                        self.scene.disk.omega_rpm,
                        self.run.limit_s
                    ),
                );
            }
        }
    }

    /// Whether displacements and velocities are all that the future of a run depends on, apart from that of an elastic disk.
    fn keeps_no_past(&self) -> bool {
        self.scene.contact.law.memory() == Memory::None
            && self.scene.holder.is_ideal()
            && self.scene.disk.is_plane()
            && self.scene.contact.layer().is_none()
            && self.scene.program.is_constant()
    }

    /// The key of the job that it continues, if it continues one.
    pub fn parent(&self) -> Option<&str> {
        self.continuation.as_deref()?.parent.as_deref()
    }

    /// Whether the scene is of the kind on which the errors of presets, of single precision and of eigenvalues were measured:
    /// Coulomb's law without a layer, a rigid plane disk, an ideal clamp and a flat base of an upright block of one material.
    pub fn is_of_measured_kind(&self) -> bool {
        self.scene.contact.law == FrictionLaw::Coulomb
            && self.scene.disk.kind == DiskKind::Rigid
            && self.scene.holder.is_ideal()
            && self.scene.pin.base.is_flat()
            && self.scene.pin.is_plain_block()
            && self.has_sliding_modes()
    }

    /// Whether the equations of steady sliding cover the scene.
    pub fn has_sliding_modes(&self) -> bool {
        let mut found = Violations::default();
        self.check_modes(&mut found);
        found.into_result().is_ok()
    }

    /// Whether eigenvalues may decide the job without its run. If friction of slow slip is larger than that of fast slip, a limit
    /// cycle of stick and slip can exist beside stable sliding at any distance from the threshold. Then the run decides.
    pub fn eigenvalues_may_decide(&self) -> bool {
        self.scene.contact.law.is_largest_in_slip()
            && self.scene.disk.kind == DiskKind::Rigid
            && self.scene.pin.is_plain_block()
            && !self.scene.holder.rotates()
            && self.run.stop_early
            && self.has_sliding_modes()
    }

    /// What the equations of steady sliding do not cover.
    fn check_modes(&self, found: &mut Violations) {
        if self.scene.pin.strains == Strains::Finite {
            let right = "small: the complex modes of steady sliding are those of the undeformed pin";
            found.add("scene.pin.strains", "finite", right);
        }
        let law = self.scene.contact.law;
        if law.memory() == Memory::Limit {
            let right = "another law: the complex modes of steady sliding have no state of friction";
            found.add("scene.contact.law", law.name(), right);
        }
        let axes = ["x", "y"].into_iter().zip(self.scene.holder.directions());
        for (axis, _) in axes.filter(|(_, way)| way.is_some_and(|way| way.stiffness_n_m == 0.0)) {
            found.add(
                &format!("scene.holder.stiffness_{axis}_n_m"),
                0.0,
                "a stiffness > 0 N/m: friction pushes a holder without a spring away, so that steady sliding has no equilibrium",
            );
        }
        for (axis, _) in ["x", "y"]
            .into_iter()
            .zip(self.scene.holder.rotations())
            .filter(|(_, way)| way.is_some_and(|way| way.stiffness_n_m == 0.0))
        {
            found.add(
                &format!("scene.holder.rotational_stiffness_{axis}_nm_rad"),
                0.0,
                "a stiffness > 0 N m/rad: without a spring the disk alone guides the pin, and steady sliding may have no equilibrium",
            );
        }
        if let Some([stiffness, ..]) = self.scene.contact.layer() {
            let right = "absent: the complex modes of steady sliding are those of a rigid contact";
            found.add("scene.contact.stiffness_pa_m", check::readable(stiffness), right);
        }
        if !self.scene.disk.is_plane() {
            found.add(
                "scene.disk",
                "run-out or waviness",
                "a plane disk: there is no steady sliding on another surface",
            );
        }
        if !self.scene.program.is_constant() {
            found.add(
                "scene.program",
                "a speed or a load that changes",
                "absent: the complex modes of steady sliding are those of a constant speed and load",
            );
        }
    }

    /// Whether single precision is known to keep the figures of the job (docs/solving.md): a scene of
    /// [`Self::is_of_measured_kind`], ν below 0.48, at least a tenth of the reference scene's damping in proportion to the pin, at
    /// least 0.1 rpm of the reference scene in proportion to the load, and numbers within the range of f32.
    pub fn suits_single_precision(&self) -> bool {
        let Scene { pin, disk, load, .. } = &self.scene;
        let shear_m_s =
            elasticity::shear_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
        let pressure_pa = load.force_n / pin.base_area_m2();
        let speed_m_s = disk.omega_rpm * std::f64::consts::TAU / 60.0 * disk.track_radius_m;
        let mut found = Violations::default();
        self.check_single_precision(&mut found);
        self.is_of_measured_kind()
            && pin.poisson_ratio < 0.48
            && self.numerics.beta_r_s >= LEAST_SINGLE_DAMPING * pin.shear_transit_s()
            && speed_m_s * pin.density_kg_m3 * shear_m_s >= LEAST_SINGLE_SPEED * pressure_pa
            && found.into_result().is_ok()
    }

    /// Limits that the range of f32 sets: forces and stiffnesses must not overflow, and displacements must keep their digits.
    fn check_single_precision(&self, found: &mut Violations) {
        let pin = &self.scene.pin;
        let (lz, young_modulus_pa) = (pin.size_m[2], pin.young_modulus_pa);
        if young_modulus_pa > STIFFEST_SINGLE_PA {
            let right = format!("at most {STIFFEST_SINGLE_PA:e} in single precision");
            found.add("scene.pin.young_modulus_pa", check::readable(young_modulus_pa), right);
        }
        let law = self.scene.contact.law;
        if law.memory() == Memory::Limit {
            let right = "another law, or numerics.precision = double: its changes in a step are below the digits of single precision";
            found.add("scene.contact.law", law.name(), right);
        }
        if self.scene.holder.rotates() {
            let right = "double with a holder that rotates: roundings of its nodes add up";
            found.add("numerics.precision", self.numerics.precision.name(), right);
        }
        let force_n = self.scene.program.force_n.as_ref().map_or(self.scene.load.force_n, Table::least);
        let compression_m = force_n * lz / (young_modulus_pa * pin.base_area_m2());
        if compression_m < LEAST_SINGLE_M {
            let least_n = LEAST_SINGLE_M / compression_m * force_n;
            let right = format!(
                "at least {least_n:.1e} in single precision, which presses the pin by {LEAST_SINGLE_M:e} m"
            );
            found.add("scene.load.force_n", check::readable(force_n), right);
        }
    }

    /// Limits that an elastic disk sets: its mesh is fine only where the pin passes, its energy balance holds for the
    /// central difference only, and it has double precision only.
    fn check_elastic_disk(&self, found: &mut Violations) {
        if let Some([stiffness, ..]) = self.scene.contact.layer() {
            let right = "absent with an elastic disk; a layer is for rigid disks";
            found.add("scene.contact.stiffness_pa_m", check::readable(stiffness), right);
        }
        if self.numerics.beta2 != 0.5 {
            found.add(
                "numerics.beta2",
                self.numerics.beta2,
                "0.5 with an elastic disk, whose energies are kept for the central difference only; damp with beta_r_s",
            );
        }
        if let Some(alpha_r_per_s) = self.numerics.alpha_r_per_s.filter(|own| *own != 0.0) {
            found.add(
                "numerics.alpha_r_per_s",
                check::readable(alpha_r_per_s),
                "0 with an elastic disk, which would have no such damping; damp with beta_r_s",
            );
        }
        if self.run.start != Start::Rest {
            found.add(
                "run.start",
                self.run.start.name(),
                "rest with an elastic disk, whose motion is not carried over from one mesh to another",
            );
        }
        if self.numerics.precision == Precision::Single {
            found.add(
                "numerics.precision",
                self.numerics.precision.name(),
                "double with an elastic disk; single precision is for rigid disks",
            );
        }
    }

    /// The length \[s\] of the windows of a run with a program: `run.window_s` or its default, changed a little so that the
    /// run has a whole number of them.
    pub fn window_length_s(&self) -> f64 {
        let limit_s = self.run.limit_s;
        let shortest_s = SHORTEST_WINDOW * self.scene.pin.shear_transit_s();
        let about_s = self.run.window_s.unwrap_or(shortest_s.max(limit_s / WINDOWS));
        limit_s / (limit_s / about_s).round().max(1.0)
    }

    /// The time \[s\] of uninterrupted sliding over which a decay is measured: that of the study, or what shows the line of the
    /// holder's slowest swing, if that is longer.
    pub fn observation_s(&self) -> f64 {
        let shortest_s = self.scene.slow_times().map_or(0.0, |slow| SWINGS_OBSERVED * slow.swing_s);
        self.detection.decay_observation_s.max(shortest_s)
    }

    /// The part of the job that all jobs of one batch share, because they are advanced with one model: bodies, meshes,
    /// clamp, friction law, integrator and time step. Its coefficients, load, speed, run length and detection have their
    /// defaults in it.
    #[must_use]
    pub fn shared_part(&self) -> Self {
        let mut scene = self.scene.clone();
        scene.contact = self.scene.contact.shared_part();
        scene.load = Load::default();
        scene.program = Program::default();
        scene.disk.omega_rpm = Disk::default().omega_rpm;
        if scene.disk.kind == DiskKind::Rigid {
            scene.disk.ring = Ring::default();
        }
        Self {
            scene,
            numerics: self.numerics.clone(),
            run: RunControl::default(),
            detection: Detection::default(),
            stability: StabilityMethod::default(),
            accuracy: None,
            continuation: None,
        }
    }
}

/// Usual number of windows of a run with a program.
const WINDOWS: f64 = 100.0;

/// Shortest usual window, in transit times of shear waves over the pin's height: about 20 cycles of the first shear modes.
const SHORTEST_WINDOW: f64 = 50.0;

/// Fewest elements of a coarser mesh in each direction. From 6 × 8 × 5 elements to 12 × 15 × 10 the start saved hardly any
/// time: the limit cycles differ too much.
const FEWEST_TO_START: usize = 6;
/// The same where the coarser mesh gives no start and only an error.
const FEWEST_TO_COMPARE: usize = 5;

/// Largest Young's modulus in single precision.
const STIFFEST_SINGLE_PA: f64 = 1.0e16;

/// Least β_R over the time in which a shear wave crosses the pin's height, for [`JobSpec::suits_single_precision`].
const LEAST_SINGLE_DAMPING: f64 = 2.0e-4;

/// Least speed of the disk over p/(ρ c_s), with the mean pressure p, likewise.
const LEAST_SINGLE_SPEED: f64 = 5.0e-3;

/// Least compression of the pin in single precision. What a step adds to a displacement can be 10⁻⁷ of it, and f32 ends at 10⁻³⁸.
const LEAST_SINGLE_M: f64 = 1.0e-28;
