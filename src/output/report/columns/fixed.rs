//! The columns of a job and of its record: each quantity with its group, how figures and tables show it, its meaning, and how it is
//! read. Its unit is that at the end of its name.

use super::shown::{BY_MEANING, Digits, Last, titled};
use super::{ExportColumn, Group, detail, quantity};
use crate::analysis::program::Hysteresis;
use crate::analysis::sample::OBSERVED_NAMES;
use crate::analysis::{
    CoarseStart, ComplexMode, ElasticDisk, HolderMotion, JobRecord, ObservedNode, Obstacle, Outcome,
    PlasticFlow, Regime, SlidingStability, UnknownError,
};
use crate::publish::value::number;
use crate::report::row::{JobRow, RowState};
use Group::{Contact, Disk, Energies, Holder, Job, Nodes, Residuals, Result, Run, Stability};
use serde_json::Value;

/// μ\* has up to four decimals, three where only its statistical error is known, and always one.
const MU_STAR: Digits = Digits { last: Last::Place(-4), unmeasured: Last::Place(-3), coarsest: -1 };
/// A frequency has no decimals, and four significant digits where its error is not known.
const FREQUENCY: Digits = Digits { last: Last::Place(0), unmeasured: Last::Significant(4), ..Digits::FOUR };

/// The columns of every export.
#[rustfmt::skip]
pub static PLAIN: &[ExportColumn] = &[
    detail("study", Job, "name of the study", |row| row.study.as_str().into()),
    detail("job", Job, "key of the job", |row| row.job.as_str().into()),
    detail("omega_rpm", Job, "rotation speed ω of the disk", |row| row.parameters.omega_rpm().into()),
    detail("mu", Job, "local friction coefficient μ: the kinetic one, or that of the last speed of a table", |row| row.parameters.mu().into()),
    detail("status", Job, "how far the job is, or how its run ended: pending, running, cancelled, failed, unreadable (its result is damaged or of another version), periodic, decayed, not_periodic, completed, unstable", |row| row.status().into()),
    detail("regime", Result, "contact regime: stable, stick_slip, stick_slip_separation, slip_separation, undecided", |row| of(row, |record| record.regime.name())),
    quantity("mu_star", Result, titled("macroscopic friction coefficient μ*").symbol("μ*").digits(MU_STAR), "macroscopic friction coefficient μ* = ⟨T⟩/⟨F⟩ with the tangential force T at the clamp", |row| of(row, |record| record.mu_star)),
    quantity("mu_star_se", Result, BY_MEANING.error_of("mu_star"), "standard error of mu_star over the cycles (of a stable job, over equal parts of the window) with what it still drifts", |row| of(row, |record| record.mu_star_se)),
    quantity("mu_star_mesh_error", Result, titled("error of μ* by the mesh").mesh_error_of("mu_star"), "bound of the absolute error that the mesh makes in mu_star, from the run on a coarser mesh, and in steady sliding from the range of friction on the face; it is chosen to hold for 95 % of jobs, and is absent where the error is unknown", |row| row.mesh_error().map(|error| error.mu_star).into()),
    quantity("mu_star_contact", Result, titled("μ* from the contact forces"), "the same ratio from the contact forces; with a holder that moves it is mu_star", |row| of(row, |record| record.mu_star_contact)),
    quantity("frequency_hz", Result, titled("frequency").digits(FREQUENCY), "fundamental frequency of the total normal contact force N; of a run that is not periodic, the mean rate of its cycles", |row| of(row, |record| record.frequency_hz)),
    quantity("frequency_mesh_error_hz", Result, titled("error of the frequency by the mesh").mesh_error_of("frequency_hz"), "bound of the absolute error that the mesh makes in frequency_hz, likewise", |row| row.mesh_error().and_then(|error| error.frequency_hz).into()),
    quantity("stick_share", Contact, titled("share of stick"), "share of the node-time in stick", |row| of(row, |record| record.stick_share)),
    quantity("slip_share", Contact, titled("share of slip"), "share of the node-time in slip", |row| of(row, |record| record.slip_share)),
    quantity("separated_share", Contact, titled("share of separation"), "share of the node-time separated", |row| of(row, |record| record.separated_share)),
    quantity("n_over_f_min", Contact, titled("smallest normal force N/F"), "smallest N over the load F, smoothed", |row| of(row, |record| record.n_over_f_min)),
    quantity("n_over_f_max", Contact, titled("largest normal force N/F"), "largest N over the load F, smoothed", |row| of(row, |record| record.n_over_f_max)),
    quantity("sigma_n_max_pa", Contact, titled("largest normal contact stress"), "largest normal contact stress of a node, smoothed", |row| of(row, |record| record.sigma_n_max_pa)),
    quantity("slip_speed_max_m_s", Contact, titled("largest slip speed"), "largest slip speed of a node in contact", |row| of(row, |record| record.slip_speed_max_m_s)),
    quantity("cycles", Run, titled("limit cycles in the window"), "whole limit cycles in the window; 0 if sliding is stable", |row| of(row, |record| record.cycles)),
    quantity("simulated_s", Run, titled("simulated time"), "simulated time at the end of the run", |row| of(row, |record| record.simulated_s)),
    quantity("steps", Run, titled("time steps"), "time steps taken", |row| of(row, |record| record.steps)),
    quantity("time_step_s", Run, titled("time step").symbol("Δt"), "the time step used", |row| of(row, |record| record.time_step_s)),
    quantity("energy_residual", Residuals, titled("residual of the energy balance").signed(), "imbalance of the energies of the run over the energy put in", |row| of(row, |record| record.energy_residual)),
    quantity("identity_residual", Residuals, titled("residual of the identities").signed(), "the larger of the residuals of the two identities", |row| of(row, JobRecord::identity_residual)),
    quantity("wall_s", Run, BY_MEANING, "run time of the job: its share of its thread's time, because a thread advances up to eight jobs together", |row| row.wall_s.into()),
    detail("error", Job, "why the job failed", error),
];

/// The rest of the record.
#[rustfmt::skip]
pub static FURTHER: &[ExportColumn] = &[
    quantity("growth_rate_per_s", Result, titled("growth rate").signed(), "growth rate of the fastest growing strong line, if the run ended in steady sliding, and of the leading mode without a run; negative: sliding is stable", |row| of(row, |record| record.growth_rate_per_s)),
    quantity("mu_star_extrapolated", Result, titled("μ* extrapolated to fine meshes"), "mu_star extrapolated to fine meshes from both meshes; absent where that is not better than mu_star", |row| row.mesh_error().and_then(|error| error.mu_star_extrapolated).into()),
    detail("mesh_error_unknown", Result, "why the mesh error is unknown", |row| of(row, |record| record.mesh_error().err().map(UnknownError::reason))),
    detail("obstacle", Result, "why the run is not periodic", |row| of(row, |record| record.obstacle.as_ref().map(in_words))),
    detail("obstacle_figure", Result, "the figure that is not the same from cycle to cycle", |row| unsteady(row, |figure, _, _| figure.into())),
    detail("obstacle_spread", Result, "its largest minus its smallest value over the cycles; of period, stress and amplitude, over the mean", |row| unsteady(row, |_, spread, _| spread.into())),
    detail("obstacle_drift", Result, "the difference of its means over the two halves of the cycles, likewise", |row| unsteady(row, |_, _, drift| drift.into())),
    detail("obstacle_cycles_found", Result, "section crossings of a run that has too few of them", |row| few_cycles(row, |found, _| found)),
    detail("obstacle_cycles_needed", Result, "section crossings that would have to repeat in such a run", |row| few_cycles(row, |_, needed| needed)),
    quantity("mu_reduction_stick", Result, titled("reduction of μ* by stick"), "part of μ − μ* that is due to sticking nodes", |row| of(row, |record| record.mu_reduction_stick)),
    quantity("mu_reduction_slip", Result, titled("reduction of μ* by sideways slip"), "part of μ − μ* that is due to nodes that slip sideways or backwards", |row| of(row, |record| record.mu_reduction_slip)),
    quantity("hysteresis", Result, BY_MEANING, "largest difference of μ* between the way up and the way down of a program at the same speed or load, up minus down", |row| hysteresis(row, |found| found.difference)),
    quantity("hysteresis_at", Result, BY_MEANING, "the speed in rpm or the load in N at that difference", |row| hysteresis(row, |found| found.at)),
    detail("decided_by", Stability, "what decided the status: run, or eigenvalues, and then there was no run", |row| of(row, decided_by)),
    quantity("mode_frequency_hz", Stability, BY_MEANING, "frequency of the leading mode of steady sliding, which grows fastest or decays most slowly", |row| mode(row, |mode| mode.frequency_hz)),
    quantity("mode_growth_rate_per_s", Stability, BY_MEANING.signed(), "growth rate of the leading mode; negative: it decays", |row| mode(row, |mode| mode.growth_rate_per_s)),
    quantity("mode_damping_ratio", Stability, BY_MEANING.signed(), "damping ratio ζ of the leading mode; negative: it grows", |row| mode(row, |mode| mode.damping_ratio)),
    quantity("mode_residual", Stability, BY_MEANING.signed(), "relative residual of the leading mode in the full problem", |row| mode(row, |mode| mode.residual)),
    quantity("contact_nodes", Stability, BY_MEANING, "nodes of the contact face that are in contact in steady sliding", |row| sliding(row, |sliding| sliding.contact_nodes)),
    quantity("lifted_nodes", Stability, BY_MEANING, "nodes of the contact face that are lifted in steady sliding", |row| sliding(row, |sliding| sliding.lifted_nodes)),
    quantity("lift_max_m", Contact, titled("largest gap"), "largest gap of a node, with the initial gap of a base that is not flat", |row| of(row, |record| record.lift_max_m)),
    quantity("contact_loss_share", Residuals, titled("contact loss over the work of the drive"), "contact loss in the window over the work of the drive", |row| of(row, |record| record.contact_loss_share)),
    quantity("macroscopic_identity_residual", Residuals, BY_MEANING.signed(), "residual of the identity μ − μ* = mean friction deficit of the nodes over F", |row| of(row, |record| record.macroscopic_identity_residual)),
    quantity("energy_identity_residual", Residuals, BY_MEANING.signed(), "residual of the energy identity over the window, relative to the work of the drive", |row| of(row, |record| record.energy_identity_residual)),
    quantity("window_start_s", Run, BY_MEANING, "simulated time at which the window of all averages begins; it ends with the run", |row| of(row, |record| record.window_start_s)),
    quantity("crossings_per_cycle", Run, titled("section crossings per limit cycle"), "crossings of N = F in one limit cycle", |row| of(row, |record| record.crossings_per_cycle)),
    quantity("time_step_limit_s", Run, BY_MEANING, "stability limit of the time step", |row| of(row, |record| record.time_step_limit_s)),
    detail("accuracy_reached", Result, "whether the job ran on two meshes and mu_star_mesh_error is as small as it asks for, where it asks for an accuracy", |row| of(row, |record| record.accuracy_reached)),
    quantity("mesh_elements_x", Run, BY_MEANING, "elements in x of the mesh that the result is from", |row| elements(row, 0)),
    quantity("mesh_elements_y", Run, BY_MEANING, "elements in y of that mesh", |row| elements(row, 1)),
    quantity("mesh_elements_z", Run, BY_MEANING, "elements in z of that mesh", |row| elements(row, 2)),
    quantity("clamp_width_on_mesh_m", Run, BY_MEANING, "width of the clamp's strip on the mesh, which may differ from the given one", |row| of(row, |record| record.clamp_width_m)),
    detail("start_outcome", Run, "how the run on a coarser mesh ended, from which the run was to start: periodic, and otherwise it started from rest", |row| start(row, coarse_outcome)),
    quantity("start_elements_x", Run, BY_MEANING, "elements of the coarser mesh in x", |row| start(row, |start| start.elements[0])),
    quantity("start_elements_y", Run, BY_MEANING, "elements of the coarser mesh in y", |row| start(row, |start| start.elements[1])),
    quantity("start_elements_z", Run, BY_MEANING, "elements of the coarser mesh in z", |row| start(row, |start| start.elements[2])),
    quantity("start_simulated_s", Run, BY_MEANING, "simulated time on the coarser mesh, which simulated_s does not contain", |row| start(row, |start| start.simulated_s)),
    detail("start_regime", Run, "contact regime on the coarser mesh", |row| start(row, |start| start.regime.map(Regime::name))),
    quantity("start_mu_star", Run, BY_MEANING, "μ* on the coarser mesh", |row| start(row, |start| start.mu_star)),
    quantity("start_frequency_hz", Run, BY_MEANING, "fundamental frequency on the coarser mesh", |row| start(row, |start| start.frequency_hz)),
    quantity("energy_kinetic_j", Energies, titled("kinetic energy at the end"), "kinetic energy at the end of the run, ½ v·M·v of the velocities half a step before and after: it may be slightly negative where the velocity changes its sign", |row| of(row, |record| record.energy.kinetic_j)),
    quantity("energy_elastic_j", Energies, titled("elastic energy at the end"), "elastic energy at the end of the run, with that of a contact layer", |row| of(row, |record| record.energy.elastic_j)),
    quantity("energy_load_work_j", Energies, BY_MEANING, "work of the load since the start", |row| of(row, |record| record.energy.load_work_j)),
    quantity("energy_drive_work_j", Energies, titled("work of the drive"), "work of the disk's drive on the pin since the start", |row| of(row, |record| record.energy.drive_work_j)),
    quantity("energy_friction_j", Energies, titled("energy dissipated by friction"), "dissipated by friction since the start", |row| of(row, |record| record.energy.friction_j)),
    quantity("energy_damping_j", Energies, titled("energy dissipated by damping"), "dissipated by the damping β_R and by β₂ > ½ since the start, added up from samples of the steps: where next to nothing is dissipated, it may be slightly negative", |row| of(row, |record| record.energy.damping_j)),
    quantity("energy_contact_loss_j", Energies, titled("energy lost in contact impacts"), "lost since the start by nodes that close or begin to stick, and by a contact layer", |row| of(row, |record| record.energy.contact_loss_j)),
    detail("plastic_state", Result, "plastic flow of a pin that may yield: elastic (nothing has yielded), shaken_down (plastic_share is at most 0.0001), yielding", |row| plastic(row, PlasticFlow::state)),
    quantity("plastic_strain_max", Result, titled("largest plastic strain"), "largest plastic strain of the pin at the end of the run", |row| plastic(row, |plastic| plastic.strain_max)),
    quantity("plastic_share", Result, titled("share of plastic work"), "plastic work within the window over the sum of it and the work of friction there", |row| plastic(row, |plastic| plastic.share)),
    quantity("energy_plastic_j", Energies, titled("plastic work"), "plastic work of the pin since the start, by the stress without that of dampers", |row| plastic(row, |plastic| plastic.work_j)),
    quantity("front_centre_y_peak_to_peak_m", Nodes, BY_MEANING, "centre of the leading end: peak-to-peak displacement in y", |row| front(row, |node| node.y_peak_to_peak_m)),
    quantity("front_centre_lift_max_m", Nodes, BY_MEANING, "centre of the leading end: largest gap", |row| front(row, |node| node.lift_max_m)),
    quantity("front_centre_sigma_n_max_pa", Nodes, BY_MEANING, "centre of the leading end: largest normal contact stress, smoothed", |row| front(row, |node| node.sigma_n_max_pa)),
    quantity("front_centre_slip_speed_max_m_s", Nodes, BY_MEANING, "centre of the leading end: largest slip speed in contact", |row| front(row, |node| node.slip_speed_max_m_s)),
    quantity("rear_centre_y_peak_to_peak_m", Nodes, BY_MEANING, "centre of the trailing end: peak-to-peak displacement in y", |row| rear(row, |node| node.y_peak_to_peak_m)),
    quantity("rear_centre_lift_max_m", Nodes, BY_MEANING, "centre of the trailing end: largest gap", |row| rear(row, |node| node.lift_max_m)),
    quantity("rear_centre_sigma_n_max_pa", Nodes, BY_MEANING, "centre of the trailing end: largest normal contact stress, smoothed", |row| rear(row, |node| node.sigma_n_max_pa)),
    quantity("rear_centre_slip_speed_max_m_s", Nodes, BY_MEANING, "centre of the trailing end: largest slip speed in contact", |row| rear(row, |node| node.slip_speed_max_m_s)),
    quantity("holder_x_peak_to_peak_m", Holder, BY_MEANING, "peak-to-peak displacement of the holder in x, where it moves in x", |row| holder(row, "x", |motion| motion.peak_to_peak_m)),
    quantity("holder_x_acceleration_rms_m_s2", Holder, BY_MEANING, "root mean square of its acceleration in x", |row| holder(row, "x", |motion| motion.acceleration_rms_m_s2)),
    quantity("holder_y_peak_to_peak_m", Holder, BY_MEANING, "peak-to-peak displacement of the holder in y, where it moves in y", |row| holder(row, "y", |motion| motion.peak_to_peak_m)),
    quantity("holder_y_acceleration_rms_m_s2", Holder, BY_MEANING, "root mean square of its acceleration in y", |row| holder(row, "y", |motion| motion.acceleration_rms_m_s2)),
    quantity("holder_z_peak_to_peak_m", Holder, BY_MEANING, "peak-to-peak displacement of the holder in z, where it moves in z", |row| holder(row, "z", |motion| motion.peak_to_peak_m)),
    quantity("holder_z_acceleration_rms_m_s2", Holder, BY_MEANING, "root mean square of its acceleration in z", |row| holder(row, "z", |motion| motion.acceleration_rms_m_s2)),
    quantity("disk_elements_theta", Disk, BY_MEANING, "elements of the elastic disk around the axis", |row| disk(row, |disk| disk.elements[0])),
    quantity("disk_elements_r", Disk, BY_MEANING, "elements of the elastic disk along the radius", |row| disk(row, |disk| disk.elements[1])),
    quantity("disk_elements_z", Disk, BY_MEANING, "elements of the elastic disk through its thickness", |row| disk(row, |disk| disk.elements[2])),
    quantity("disk_track_element_theta_m", Disk, BY_MEANING, "longest edge of the elements under the track around the axis", |row| disk(row, |disk| disk.track_element_m[0])),
    quantity("disk_track_element_r_m", Disk, BY_MEANING, "longest edge of the elements under the track along the radius", |row| disk(row, |disk| disk.track_element_m[1])),
    quantity("disk_track_element_z_m", Disk, BY_MEANING, "longest edge of the elements under the track through the thickness", |row| disk(row, |disk| disk.track_element_m[2])),
    quantity("disk_longest_edge_m", Disk, BY_MEANING, "longest edge of the elements elsewhere", |row| disk(row, |disk| disk.longest_edge_m)),
    quantity("disk_stages", Disk, BY_MEANING, "stages that the disk takes in a time step", |row| disk(row, |disk| disk.stages)),
    quantity("disk_sweeps_mean", Disk, BY_MEANING, "mean number of sweeps of a contact solve", |row| disk(row, |disk| disk.sweeps_mean)),
    quantity("disk_sweeps_max", Disk, BY_MEANING, "largest number of sweeps of a contact solve", |row| disk(row, |disk| disk.sweeps_max)),
    quantity("disk_residual_max", Disk, BY_MEANING, "largest residual of a contact solve over the largest force", |row| disk(row, |disk| disk.residual_max)),
];

/// A figure of the record; null without a record, without that figure, and if it is not finite.
fn of<'a, T: Into<Value>>(row: &'a JobRow, read: impl FnOnce(&'a JobRecord) -> T) -> Value {
    row.record().map_or(Value::Null, |record| read(record).into())
}

fn error(row: &JobRow) -> Value {
    match &row.state {
        RowState::Failed { error } => error.as_str().into(),
        RowState::Unreadable { reason } => reason.as_str().into(),
        _ => Value::Null,
    }
}

fn front(row: &JobRow, read: impl FnOnce(&ObservedNode) -> f64) -> Value {
    node(row, OBSERVED_NAMES[0], read)
}

fn rear(row: &JobRow, read: impl FnOnce(&ObservedNode) -> f64) -> Value {
    node(row, OBSERVED_NAMES[1], read)
}

fn node(row: &JobRow, name: &str, read: impl FnOnce(&ObservedNode) -> f64) -> Value {
    of(row, |record| record.nodes.iter().find(|node| node.name == name).map(read))
}

fn holder(row: &JobRow, direction: &str, read: impl FnOnce(&HolderMotion) -> f64) -> Value {
    of(row, |record| record.holder.iter().find(|motion| motion.direction == direction).map(read))
}

fn decided_by(record: &JobRecord) -> &'static str {
    let is_decided = record.stability.as_ref().is_some_and(|sliding| sliding.decided);
    if is_decided { "eigenvalues" } else { "run" }
}

fn sliding<T: Into<Value>>(row: &JobRow, read: impl FnOnce(&SlidingStability) -> T) -> Value {
    of(row, |record| record.stability.as_ref().map(read))
}

fn mode(row: &JobRow, read: impl FnOnce(&ComplexMode) -> f64) -> Value {
    of(row, |record| record.stability.as_ref().and_then(|sliding| sliding.modes.first()).map(read))
}

fn elements(row: &JobRow, axis: usize) -> Value {
    of(row, |record| record.elements.map(|elements| elements[axis]))
}

fn start<T: Into<Value>>(row: &JobRow, read: impl FnOnce(&CoarseStart) -> T) -> Value {
    of(row, |record| record.start.as_ref().map(read))
}

/// The name of the outcome on the coarser mesh.
fn coarse_outcome(start: &CoarseStart) -> &'static str {
    start.outcome.map_or("failed", Outcome::name)
}

fn disk<T: Into<Value>>(row: &JobRow, read: impl FnOnce(&ElasticDisk) -> T) -> Value {
    of(row, |record| record.disk.as_ref().map(read))
}

fn plastic<T: Into<Value>>(row: &JobRow, read: impl FnOnce(&PlasticFlow) -> T) -> Value {
    of(row, |record| record.plastic.as_ref().map(read))
}

fn hysteresis(row: &JobRow, read: impl FnOnce(&Hysteresis) -> f64) -> Value {
    of(row, |record| Hysteresis::of(&record.windows).as_ref().map(read))
}

fn unsteady(row: &JobRow, read: impl FnOnce(&str, f64, f64) -> Value) -> Value {
    match row.record().and_then(|record| record.obstacle.as_ref()) {
        Some(Obstacle::Unsteady { figure, spread, drift }) => read(figure, *spread, *drift),
        _ => Value::Null,
    }
}

fn few_cycles(row: &JobRow, read: impl FnOnce(usize, usize) -> usize) -> Value {
    match row.record().and_then(|record| record.obstacle.as_ref()) {
        Some(&Obstacle::FewCycles { found, needed }) => read(found, needed).into(),
        _ => Value::Null,
    }
}

/// The obstacle in words, with its numbers as they are.
fn in_words(obstacle: &Obstacle) -> String {
    match obstacle {
        Obstacle::FewCycles { found, needed } => format!("few cycles: {found} of {needed}"),
        Obstacle::SlipOnly => "all nodes slip all the time".to_owned(),
        Obstacle::Unsteady { figure, spread, drift } => {
            format!("{figure} is not steady: spread {}, drift {}", number(*spread), number(*drift))
        }
        Obstacle::Swing { imbalance, .. } => {
            format!("something still swings or creeps: clamp and contact differ by {}", number(*imbalance))
        }
        Obstacle::Flow { share } => {
            format!("the share of plastic work is neither constant nor negligible: {}", number(*share))
        }
        Obstacle::Creep { still_to_come, .. } => {
            format!("the mean friction creeps: {} still to come", number(*still_to_come))
        }
    }
}
