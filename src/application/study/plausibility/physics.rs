//! Jobs outside of what the model and its elements describe.

use super::{Doubt, owned, percent, short};
use crate::spec::elasticity::{self, LOCKING_POISSON_RATIO};
use crate::spec::{ClampSide, DiskKind, Element, FieldError, JobSpec, Shape, Start, Strains};
use std::f64::consts::PI;

/// Mean strain of the pin from which on the linear model is in doubt.
const LARGE_STRAIN: f64 = 0.01;
/// Mean strain at which no material is linear elastic.
const HUGE_STRAIN: f64 = 0.1;
/// Mean strain at which a linear spring of the pin's stiffness is compressed to nothing. No study with more is taken.
const TOTAL_STRAIN: f64 = 1.0;
/// Mean strain from which on the laws of large strains are in doubt.
const BEYOND_LAWS: f64 = 0.5;
/// Elastic strain at the yield stress from which on no metal is meant.
const MOST_ELASTIC: f64 = 0.05;
/// Sliding speed as a fraction of the speed of surface waves from which on the linear model is in doubt. A node that sticks
/// moves with the disk, and this fraction is of the order of the strain in the wave that it sends out.
const FAST: f64 = 0.1;
/// Change of the clamp's width by the mesh from which on it is named.
const MOVED: f64 = 0.01;
/// A run must be so many times as long as what its cycles have to cover, because it does not begin with a limit cycle.
const SWINGS: f64 = 2.0;
/// The time step with damping over the one without, below which damping decides about the cost.
const SHORT_STEP: f64 = 0.5;

pub(super) fn doubts(spec: &JobSpec) -> Vec<Doubt> {
    let (pin, disk) = (&spec.scene.pin, &spec.scene.disk);
    let mut found = Vec::new();

    let strain = mean_strain(spec);
    let is_linear = pin.strains == Strains::Small;
    if strain > if is_linear { LARGE_STRAIN } else { BEYOND_LAWS } {
        let meaning = if !is_linear {
            "few materials follow such a simple law that far"
        } else if strain > HUGE_STRAIN {
            "no material is linear elastic at this strain, so the result means nothing"
        } else {
            "the model is linear elastic and holds for small strains"
        };
        found.push(Doubt {
            kind: "strain",
            fields: owned(&[
                "scene.load.force_n",
                "scene.pin.young_modulus_pa",
                "scene.pin.size_m",
                "scene.pin.size_m[0]",
                "scene.pin.size_m[1]",
                "scene.pin.diameter_m",
            ]),
            size: strain,
            message: format!("the mean strain F/(E A) of the pin is {}; {meaning}", percent(strain)),
            help: format!(
                "check the units of the load [N], Young's modulus [Pa] and the size [m]{}",
                if is_linear { "; scene.pin.strains = finite computes large strains" } else { "" }
            ),
        });
    }

    found.extend(flow(spec));

    let speed_m_s = disk.omega_rpm * 2.0 * PI / 60.0 * disk.track_radius_m;
    let mut wave_m_s = surface_wave_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
    if disk.kind == DiskKind::Elastic {
        let ring = &disk.ring;
        wave_m_s =
            wave_m_s.min(surface_wave_m_s(ring.young_modulus_pa, ring.poisson_ratio, ring.density_kg_m3));
    }
    if speed_m_s > FAST * wave_m_s {
        found.push(Doubt {
            kind: "speed",
            fields: owned(&[
                "scene.disk.omega_rpm",
                "scene.disk.track_radius_m",
                "scene.pin.young_modulus_pa",
                "scene.pin.density_kg_m3",
            ]),
            size: speed_m_s / wave_m_s,
            message: format!(
                "the disk's surface moves at {} m/s, {} of the speed of surface waves ({} m/s)",
                short(speed_m_s),
                percent(speed_m_s / wave_m_s),
                short(wave_m_s)
            ),
            help: format!(
                "a node that sticks moves with the disk and sends out a wave with a strain of that order{}",
                if is_linear { ", which is outside the linear model" } else { "" }
            ),
        });
    }

    if pin.poisson_ratio >= LOCKING_POISSON_RATIO && pin.element != Element::Selective {
        found.push(locking("scene.pin.poisson_ratio", pin.poisson_ratio));
    }
    if disk.kind == DiskKind::Elastic && disk.ring.poisson_ratio >= LOCKING_POISSON_RATIO {
        found.push(locking("scene.disk.ring.poisson_ratio", disk.ring.poisson_ratio));
    }

    // With the damping β_R ω/2 of the fastest oscillation, ω = 2 c_p/h, the limit of the step is (√(1 + ζ²) − ζ) 2/ω.
    let wave_m_s =
        elasticity::pressure_wave_speed_m_s(pin.young_modulus_pa, pin.poisson_ratio, pin.density_kg_m3);
    let shortest_m = pin.element_edges_m().into_iter().fold(f64::INFINITY, f64::min);
    let zeta = spec.numerics.beta_r_s * wave_m_s / shortest_m;
    let step = (1.0 + zeta * zeta).sqrt() - zeta;
    if step < SHORT_STEP {
        found.push(Doubt {
            kind: "damping",
            fields: owned(&[
                "damping.loss_factor",
                "damping.ratio",
                "numerics.beta_r_s",
                "scene.pin.elements",
                "scene.pin.young_modulus_pa",
                "scene.pin.density_kg_m3",
            ]),
            size: zeta,
            message: format!(
                "damping shortens the time step to {} of the step without damping, because β_R c/h is {}",
                percent(step),
                short(zeta)
            ),
            help: "a smaller β_R or a coarser mesh makes the run shorter".to_owned(),
        });
    }
    found.extend(two_dampings(spec));
    found.extend(no_coarser_mesh(spec));
    found.extend(disk_mesh(spec));
    found.extend(clamp(spec));
    found.extend(cylinder(spec));
    found.extend(friction(spec));
    found.extend(too_short_for_the_holder(spec));
    found
}

/// A limit of time in which hardly any run can become periodic: its cycles must cover a swing of the holder.
fn too_short_for_the_holder(spec: &JobSpec) -> Option<Doubt> {
    // Friction that rises with the speed is slow without a holder, too.
    let slow = spec.scene.slow_times().filter(|_| !spec.scene.holder.is_ideal())?;
    let covered_s = slow.swing_s + slow.relaxation_s;
    let is_short = spec.run.limit_s < SWINGS * covered_s;
    (spec.has_run() && spec.scene.program.is_constant() && is_short).then(|| Doubt {
        kind: "holder_time",
        fields: owned(&["run.limit_s", "scene.holder.mass_kg", "scene.holder.stiffness_x_n_m", "scene.holder.stiffness_y_n_m"]),
        size: covered_s / spec.run.limit_s,
        message: format!(
            "the run is at most {} s long, and with its holder the pin takes up to {} s to swing once and to settle, so that hardly any run can become \
             periodic",
            short(spec.run.limit_s),
            short(covered_s)
        ),
        help: "give a run.limit_s that is several times as long, or check the units of the holder: N/m and kg, and N m/rad and kg m² of one that rocks".to_owned(),
    })
}

/// An error that is asked for where there is nothing to compare with.
fn no_coarser_mesh(spec: &JobSpec) -> Option<Doubt> {
    let is_asked = spec.accuracy.is_some() && spec.has_run() || spec.run.start == Start::Compared;
    let why = if spec.scene.pin.own_elements().is_none() {
        "the program makes no coarser mesh of one from a file"
    } else if !spec.scene.program.is_constant() {
        "a run with a program has no steady state to compare"
    } else if !spec.has_measured_elements() {
        "nobody measured mesh errors with large strains or another element than `full`"
    } else {
        "half as many elements in each direction are too few"
    };
    (is_asked && spec.coarser_elements().is_empty()).then(|| Doubt {
        kind: "mesh_error",
        fields: owned(&["accuracy.mu_star", "run.start", "scene.pin.elements"]),
        size: 1.0,
        message: format!("the mesh error stays unknown: {why}"),
        help: "a finer mesh, or a comparison of two meshes by hand, says how large it is".to_owned(),
    })
}

/// Elements of the disk that are larger than the pin's base. docs/evidence/elastic_disk.md has the numbers of the advice.
fn disk_mesh(spec: &JobSpec) -> Option<Doubt> {
    let (disk, [x, y, _]) = (&spec.scene.disk, spec.scene.pin.extent_m());
    let (element_m, base_m) = (disk.ring.element_size_m, x.min(y));
    (disk.kind == DiskKind::Elastic && element_m > base_m).then(|| Doubt {
        kind: "disk_mesh",
        fields: owned(&["scene.disk.ring.element_size_m"]),
        size: element_m / base_m,
        message: format!(
            "the disk's elements under the pin are larger than the pin's base of {} m, so how the disk bends there is not resolved",
            short(base_m)
        ),
        help: "measured on the reference pin: elements of a fifth of its base give μ* within 0.0001 of elements half as large; for another \
               pin compare two sizes"
            .to_owned(),
    })
}

/// The scheme's own damping, (β₂ − ½) Δt, beside that of the material.
fn two_dampings(spec: &JobSpec) -> Option<Doubt> {
    let numerics = &spec.numerics;
    let excess = numerics.beta2 - 0.5;
    let of_scheme =
        numerics.time_step_s.map_or_else(String::new, |step_s| format!(" = {} s", short(excess * step_s)));
    (excess > 0.0 && numerics.beta_r_s > 0.0).then(|| Doubt {
        kind: "two_dampings",
        fields: owned(&["numerics.beta2", "damping.beta2", "numerics.beta_r_s"]),
        size: excess,
        message: format!(
            "the scheme's own damping (β₂ − ½) Δt{of_scheme} is added to that of the material, β_R = {} s",
            short(numerics.beta_r_s)
        ),
        help: "set numerics.beta_r_s to 0 for the scheme's damping alone, or numerics.beta2 to 0.5 for that of the material \
               alone"
            .to_owned(),
    })
}

fn mean_strain(spec: &JobSpec) -> f64 {
    let pin = &spec.scene.pin;
    spec.scene.load.force_n / (pin.young_modulus_pa * pin.base_area_m2())
}

/// Why no new study can have the job: the load compresses the pin by more than its height.
pub(in crate::study) fn refused_strain(spec: &JobSpec) -> Option<FieldError> {
    let strain = mean_strain(spec);
    (strain > TOTAL_STRAIN).then(|| FieldError {
        field: "scene.load.force_n".to_owned(),
        value: short(spec.scene.load.force_n),
        expected: format!(
            "a mean strain F/(E A) of the pin far below 1; it is {}, with E = {} Pa and A = {} m²",
            short(strain),
            short(spec.scene.pin.young_modulus_pa),
            short(spec.scene.pin.base_area_m2())
        ),
    })
}

/// Edges that do not belong to the cylinder, which uses none of them.
fn cylinder(spec: &JobSpec) -> Option<Doubt> {
    let pin = &spec.scene.pin;
    let diameter_m = pin.diameter_m.filter(|_| pin.shape == Shape::Cylinder)?;
    let differs = |edge_m: f64| (edge_m / diameter_m - 1.0).abs() > 1.0e-9;
    let [x, y, _] = pin.size_m;
    (differs(x) || differs(y)).then(|| Doubt {
        kind: "size",
        fields: owned(&["scene.pin.size_m", "scene.pin.size_m[0]", "scene.pin.size_m[1]"]),
        size: (x / diameter_m - 1.0).abs().max((y / diameter_m - 1.0).abs()),
        message: format!(
            "a cylinder uses the height size_m[2] alone; the edges of {} m and {} m have no effect beside diameter_m = {} m",
            short(x),
            short(y),
            short(diameter_m)
        ),
        help: "write the diameter in both places".to_owned(),
    })
}

/// A law whose friction rises as soon as a node slips.
fn friction(spec: &JobSpec) -> Option<Doubt> {
    let contact = spec.scene.contact.in_use();
    let mu_static = contact.mu_static.filter(|mu_static| *mu_static < contact.mu)?;
    Some(Doubt {
        kind: "friction",
        fields: owned(&["scene.contact.mu_static", "scene.contact.mu"]),
        size: contact.mu - mu_static,
        message: format!(
            "less than mu = {}, so that friction rises as soon as a node slips; are the two exchanged?",
            short(contact.mu)
        ),
        help: "mu_static is the coefficient without slip, and mu that of fast slip; if measured friction rises with the speed, this is right"
            .to_owned(),
    })
}

/// A strip that is no strip: the outermost row of nodes, or the whole face. The mesh of a block says which rows are held. On other
/// meshes rows are at many distances.
fn clamp(spec: &JobSpec) -> Option<Doubt> {
    let (pin, clamp) = (&spec.scene.pin, &spec.scene.clamp);
    let axis = clamp.side.axis_across().filter(|_| pin.shape != Shape::Mesh)?;
    let is_collet = clamp.side == ClampSide::Collet;
    let strips = if matches!(clamp.side, ClampSide::BothSides | ClampSide::BothEnds) { 2.0 } else { 1.0 };
    // The rows of a cylinder are at equal distances along its height only.
    let (width_m, whole_m) = if pin.shape == Shape::Block || is_collet {
        let edge_m = pin.element_edges_m()[axis];
        let rows = (clamp.width_m / edge_m).round();
        // A collet leaves the contact face free.
        let held_m = if is_collet { rows.min(pin.elements[axis] as f64 - 1.0) } else { rows } * edge_m;
        // Of two strips, the last rows are neighbours, and an element lies between them.
        (held_m, pin.extent_m()[axis] - (strips - 1.0) * edge_m)
    } else {
        (clamp.width_m, pin.extent_m()[axis])
    };
    let share = strips * width_m / whole_m;
    let doubt = |fields, message: &str| Doubt {
        kind: "clamp",
        fields: owned(fields),
        size: share,
        message: message.to_owned(),
        help: if is_collet {
            "expected the length in metres that the collet grips".to_owned()
        } else {
            "expected the width in metres of the strip that the holder holds".to_owned()
        },
    };
    if clamp.width_m == 0.0 {
        let message = "only the outermost row of nodes is held, so that what is held depends on the mesh";
        return Some(doubt(&["scene.clamp.width_m"], message));
    }
    if share > 1.0 - 1.0e-9 && !is_collet {
        let message = "the whole top face is held, as with the side `whole_top`";
        return Some(doubt(&["scene.clamp.width_m", "scene.clamp.side"], message));
    }
    // A width that is too far from every row is refused when the model is made.
    let moved = width_m / clamp.width_m - 1.0;
    (moved.abs() > MOVED && width_m > 0.0).then(|| Doubt {
        size: moved.abs(),
        ..doubt(
            &["scene.clamp.width_m", "scene.pin.elements"],
            &format!(
                "this mesh holds {} of {} m, up to its nearest row of nodes",
                if is_collet { "a length" } else { "a strip" },
                short(width_m)
            ),
        )
    })
}

/// A pin that flows as a whole under its load, and a yield stress that no metal has. Returns the first doubt of all materials.
fn flow(spec: &JobSpec) -> Option<Doubt> {
    let pin = &spec.scene.pin;
    let own = (String::from("scene.pin"), &pin.plasticity, pin.young_modulus_pa);
    let regions = pin.regions.iter().enumerate().map(|(number, region)| {
        (format!("scene.pin.regions[{number}]"), &region.plasticity, region.young_modulus_pa)
    });
    std::iter::once(own).chain(regions).find_map(|(at, plasticity, young_modulus_pa)| {
        let yield_stress_pa = plasticity.as_ref()?.yield_stress_pa?;
        let pressure = spec.scene.load.force_n / (pin.base_area_m2() * yield_stress_pa);
        let elastic = yield_stress_pa / young_modulus_pa;
        let own = format!("{at}.plasticity.yield_stress_pa");
        let doubt = |other: &str, size, message: String, help: &str| Doubt {
            kind: "yield",
            fields: owned(&[own.as_str(), other]),
            size,
            message,
            help: help.to_owned(),
        };
        if pressure > 1.0 {
            let message = format!(
                "the mean pressure is {} times the yield stress: without hardening the whole section flows",
                short(pressure)
            );
            let help = "check the units of the load [N], the yield stress [Pa] and the size [m]";
            return Some(doubt("scene.load.force_n", pressure, message, help));
        }
        (elastic > MOST_ELASTIC).then(|| {
            let message = format!("the material yields at an elastic strain of {}", percent(elastic));
            let modulus = format!("{at}.young_modulus_pa");
            doubt(&modulus, elastic, message, "check the units [Pa]; metals yield at 0.01 % to 1 %")
        })
    })
}

/// Speed of Rayleigh waves \[m/s\], by the approximation of Viktorov, which is within 0.5 % for ν from 0 to ½.
fn surface_wave_m_s(young_modulus_pa: f64, poisson_ratio: f64, density_kg_m3: f64) -> f64 {
    let shear_m_s = elasticity::shear_wave_speed_m_s(young_modulus_pa, poisson_ratio, density_kg_m3);
    shear_m_s * (0.87 + 1.12 * poisson_ratio) / (1.0 + poisson_ratio)
}

fn locking(field: &str, nu: f64) -> Doubt {
    Doubt {
        kind: "locking",
        fields: owned(&[field]),
        size: nu,
        message: "close to ½, where the elements are too stiff (volumetric locking)".to_owned(),
        help: "measured on the reference pin: on 12 × 15 × 10 elements it deflects 5.9 % too little at ν = 0.3, 9.1 % at \
               0.48 and 13.2 % at 0.499, on 24 × 30 × 20 elements 2.0 %, 3.3 % and 6.0 %; μ* differs by 6 to 10 % between \
               these meshes at 0.48, by 2 to 4 % at 0.3 (docs/evidence/accuracy.md); compare two meshes, or give a pin scene.pin.element = selective"
            .to_owned(),
    }
}
