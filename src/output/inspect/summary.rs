//! The numbers of an inspection, as one JSON document.

use super::inspection::{Inspection, NodeFindings, loop_area_m2, node_loop};
use super::limit::limit;
use super::loops::{self, LoopSummary};
use super::phases::Phase;
use super::waves::{Wave, stations, waves};
use crate::analysis::JobRecord;
use crate::solver::interface::ContactState;
use crate::spec::JobSpec;
use serde::Serialize;

/// The file with all numbers.
pub(super) const SUMMARY: &str = "inspection.json";

/// The numbers of an inspection.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The job's key; empty if it is not known.
    pub key: String,
    /// Everything that determines the run.
    pub job: JobSpec,
    /// The job's record.
    pub record: JobRecord,
    /// Whether there are cycles. Otherwise the period is that of the pin as a quarter-wave resonator in shear.
    pub cycles: bool,
    /// Duration \[s\] of a cycle.
    pub period_s: f64,
    /// Start and end \[s\] of the time in which the observed nodes are shown.
    pub shown_s: [f64; 2],
    /// Start and end \[s\] of the cycle in which the contact face and the pin are shown.
    pub cycle_s: [f64; 2],
    /// The observed nodes in the time in which they are shown.
    pub nodes: Vec<NodeSummary>,
    /// All nodes of the contact face over the cycle.
    pub face: FaceSummary,
    /// Energies of the hysteresis loops over a cycle.
    pub loops: LoopSummary,
    /// The waves of state changes along the middle of the contact face, one for each run of neighbouring nodes with the
    /// change.
    pub waves: Vec<Wave>,
    /// The largest lines of the total normal force, frequency \[Hz\] and amplitude \[N\].
    pub spectrum_peaks: Vec<(f64, f64)>,
}

/// An observed node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeSummary {
    /// Its name.
    pub name: String,
    /// Its name and coordinates for a reader.
    pub title: String,
    /// Its x and y [m] from the pin's axis.
    pub at_m: [f64; 2],
    /// Velocity [m/s] of the target under it in y.
    pub target_velocity_m_s: f64,
    /// Peak-to-peak displacement [m] in x, y and z.
    pub peak_to_peak_m: [f64; 3],
    /// Largest gap [m].
    pub lift_max_m: f64,
    /// Largest smoothed normal contact stress [Pa].
    pub sigma_n_max_pa: f64,
    /// Largest velocity [m/s] relative to the target, in contact or not.
    pub relative_speed_max_m_s: f64,
    /// Largest slip speed [m/s] in contact.
    pub slip_speed_max_m_s: f64,
    /// Largest |v_y − target| [m/s] while it sticks: 0 up to rounding on a rigid disk.
    pub stick_speed_error_m_s: f64,
    /// Largest difference of μ_eq from the limit of the friction law while it slips: 0 up to rounding.
    pub slip_friction_error: f64,
    /// Shares of the time in stick, slip and separation.
    pub shares: [f64; 3],
    /// Frequency [Hz] of its separations, or of its stick phases if it does not separate: the number of phases that are at
    /// least half as long as the longest one, over the duration of the cycles that are shown. It is a multiple of the
    /// cycle's frequency if the limit cycle has several such phases.
    pub frequency_hz: Option<f64>,
    /// The instants of a cycle [s].
    pub instants: Option<InstantsSummary>,
}

/// The instants of a cycle of a node that exist, and the state of the node at each of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InstantsSummary {
    /// Name (`t_A` … `t_F`), time [s], normal stress [Pa] after a zero-phase low-pass filter, velocity [m/s] relative to the
    /// target in y, and state.
    pub at: Vec<(String, f64, f64, f64, String)>,
    /// Normal stress [Pa] at its maximum, t_C.
    pub peak_pa: f64,
    /// Largest slip speed [m/s] between t_D and t_E.
    pub slip_before_separation_m_s: Option<f64>,
}

/// The contact face over a cycle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaceSummary {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of nodes that separate. The others stay in the plane of a rigid disk, and have no loop.
    pub separating: usize,
    /// Number of these whose loop in the y–z plane goes counter-clockwise, seen with y to the right and z upwards.
    pub counter_clockwise: usize,
    /// Largest gap [m].
    pub lift_max_m: f64,
    /// Largest slip speed [m/s].
    pub slip_speed_max_m_s: f64,
    /// Largest smoothed normal stress [Pa].
    pub sigma_n_max_pa: f64,
}

impl Summary {
    /// The numbers of an inspection.
    pub fn of(inspection: &Inspection) -> Self {
        let windows = &inspection.survey.windows;
        Self {
            key: String::new(),
            job: inspection.spec.clone(),
            record: inspection.survey.record.clone(),
            cycles: windows.has_cycles,
            period_s: windows.period_s,
            shown_s: windows.shown_s,
            cycle_s: windows.cycle_s,
            nodes: (0..inspection.observed.len()).map(|number| node(inspection, number)).collect(),
            face: face(inspection),
            loops: loops::summary(inspection),
            waves: waves(&stations(inspection), windows.cycle_s[0], windows.period_s),
            spectrum_peaks: inspection.spectrum.peaks(5),
        }
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

fn node(inspection: &Inspection, number: usize) -> NodeSummary {
    let NodeFindings { node, target_velocity_m_s, phases, instants } = &inspection.observed[number];
    let steps = &inspection.capture.nodes[number];
    let relative = |velocity_m_s: f64| velocity_m_s - target_velocity_m_s;
    let in_state = |state: ContactState| steps.iter().filter(move |step| step.node.state == state);
    let share = |state| in_state(state).count() as f64 / steps.len().max(1) as f64;
    let peak_to_peak = |c: usize| {
        let values = steps.iter().map(|step| step.node.u_m[c]);
        let [low, high] =
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        if low <= high { high - low } else { 0.0 }
    };
    NodeSummary {
        name: node.name.clone(),
        title: node.title.clone(),
        at_m: node.at_m,
        target_velocity_m_s: *target_velocity_m_s,
        peak_to_peak_m: [0, 1, 2].map(peak_to_peak),
        lift_max_m: largest(steps.iter().map(|step| step.node.gap_m)),
        sigma_n_max_pa: largest(steps.iter().map(|step| step.node.sigma_n_pa)),
        relative_speed_max_m_s: largest(steps.iter().map(|step| relative(step.node.y_velocity_m_s).abs())),
        slip_speed_max_m_s: largest(steps.iter().map(|step| step.node.slip_speed_m_s)),
        stick_speed_error_m_s: largest(
            in_state(ContactState::Stick).map(|step| relative(step.node.y_velocity_m_s).abs()),
        ),
        slip_friction_error: largest(
            in_state(ContactState::Slip)
                .map(|step| (step.node.equivalent_friction() - limit(&inspection.spec, &step.node)).abs()),
        ),
        shares: [ContactState::Stick, ContactState::Slip, ContactState::Separated].map(share),
        frequency_hz: own_frequency_hz(inspection, phases),
        instants: instants.as_ref().map(|instants| {
            let nearest = |time_s: f64| {
                let distance = |at: &f64| (at - time_s).abs();
                steps.iter().min_by(|a, b| distance(&a.time_s).total_cmp(&distance(&b.time_s)))
            };
            let named = instants.named().into_iter().filter_map(|(letter, time_s)| {
                let step = nearest(time_s)?;
                let velocity_m_s = relative(step.node.y_velocity_m_s);
                let state = step.node.state.name().to_owned();
                Some((format!("t_{letter}"), time_s, step.stress_pa[2], velocity_m_s, state))
            });
            let slipping = instants.slip_s.zip(instants.separation_s).map(|(from_s, to_s)| {
                let within = steps.iter().filter(|step| step.time_s >= from_s && step.time_s <= to_s);
                largest(within.map(|step| step.node.slip_speed_m_s))
            });
            InstantsSummary {
                at: named.collect(),
                peak_pa: nearest(instants.peak_s).map_or(0.0, |step| step.stress_pa[2]),
                slip_before_separation_m_s: slipping,
            }
        }),
    }
}

/// Frequency of the separations, or of the stick phases, of a node. The start and the end of the recording cut a phase in
/// two. The two parts count as one phase if they have the same state, because the recording has whole cycles.
fn own_frequency_hz(inspection: &Inspection, phases: &[Phase]) -> Option<f64> {
    let windows = &inspection.survey.windows;
    let count = |state: ContactState| {
        let mut durations_s: Vec<f64> = Vec::new();
        for (number, phase) in phases.iter().enumerate().filter(|(_, phase)| phase.state == state) {
            let continues_first = number > 0 && number + 1 == phases.len() && phases[0].state == state;
            match durations_s.first_mut() {
                Some(first) if continues_first => *first += phase.duration_s(),
                _ => durations_s.push(phase.duration_s()),
            }
        }
        let longest_s = largest(durations_s.iter().copied());
        durations_s.iter().filter(|duration_s| **duration_s >= 0.5 * longest_s).count()
    };
    let separations = count(ContactState::Separated);
    let times = if separations > 0 { separations } else { count(ContactState::Stick) };
    let duration_s = windows.shown_s[1] - windows.shown_s[0];
    (windows.has_cycles && times > 0).then(|| times as f64 / duration_s)
}

fn face(inspection: &Inspection) -> FaceSummary {
    let face = &inspection.capture.face;
    let nodes = inspection.capture.model.slaves().len();
    let all = || face.iter().flat_map(|step| &step.nodes);
    let separates =
        |slave: &usize| face.iter().any(|step| step.nodes[*slave].state == ContactState::Separated);
    FaceSummary {
        nodes,
        separating: (0..nodes).filter(separates).count(),
        counter_clockwise: (0..nodes)
            .filter(separates)
            .filter(|&slave| loop_area_m2(&node_loop(face, slave)) > 0.0)
            .count(),
        lift_max_m: largest(all().map(|node| node.gap_m)),
        slip_speed_max_m_s: largest(all().map(|node| node.slip_speed_m_s)),
        sigma_n_max_pa: largest(all().map(|node| node.sigma_n_pa)),
    }
}
