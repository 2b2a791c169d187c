//! What is observed of one lane at every step.

use crate::solver::Model;
use crate::solver::contact::ContactState;
use crate::solver::state::{Drive, State};

/// Totals and extremes over the contact face during one step (forces at `t_n`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// `t_n` [s].
    pub time_s: f64,
    /// Normal load F [N].
    pub load_n: f64,
    /// Total normal contact force N [N].
    pub normal_n: f64,
    /// N after the stress smoother [N].
    pub smooth_normal_n: f64,
    /// Total contact friction force on the pin in y [N].
    pub contact_tangential_n: f64,
    /// Total contact friction force on the pin in x [N].
    pub contact_sideways_n: f64,
    /// Σ N x/lx [N]: the normal contact force's first moment about the pin's axis, over its width.
    pub x_moment_n: f64,
    /// Σ N y/ly [N].
    pub y_moment_n: f64,
    /// Tangential force T [N] in y that the clamp carries.
    pub clamp_tangential_n: f64,
    /// Σ over sticking nodes of μN − t_y [N].
    pub stick_deficit_n: f64,
    /// Σ over slipping nodes of μN(1 − cos φ) [N], φ the angle of friction from +y.
    pub slip_deficit_n: f64,
    /// Number of nodes in stick.
    pub stick: usize,
    /// Number of nodes in slip.
    pub slip: usize,
    /// Number of separated nodes.
    pub separated: usize,
    /// Number of nodes that are in another state than in the step before.
    pub transitions: usize,
    /// Largest smoothed nodal normal stress [Pa].
    pub sigma_n_max_pa: f64,
    /// Largest slip speed [m/s] of a node in contact.
    pub slip_speed_max_m_s: f64,
    /// Largest gap [m] of a node.
    pub lift_max_m: f64,
    /// The observed nodes.
    pub nodes: [NodeSample; OBSERVED],
}

/// Number of observed nodes.
pub const OBSERVED: usize = 2;

/// Their names: the centre of the leading and of the trailing edge of the contact face.
pub const OBSERVED_NAMES: [&str; OBSERVED] = ["front_centre", "rear_centre"];

/// One observed contact node during a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeSample {
    /// Displacement [m].
    pub u_m: [f64; 3],
    /// Velocity in y over the step [m/s].
    pub y_velocity_m_s: f64,
    /// Gap [m].
    pub gap_m: f64,
    /// Contact force [N] on the pin: friction in x and y, N in z.
    pub force_n: [f64; 3],
    /// Smoothed normal stress [Pa].
    pub sigma_n_pa: f64,
    /// Slip speed [m/s]; 0 unless slipping.
    pub slip_speed_m_s: f64,
    /// Contact state.
    pub state: ContactState,
}

impl NodeSample {
    /// Equivalent friction coefficient `μ_eq` = |τ/σ_n|; 0 when separated (as in the paper's figure 2b).
    pub fn equivalent_friction(&self) -> f64 {
        let [x, y, n] = self.force_n;
        if n > 0.0 { (x * x + y * y).sqrt() / n } else { 0.0 }
    }
}

/// A first-order low-pass filter.
#[derive(Debug, Clone, Copy, Default)]
pub struct Smoother {
    value: f64,
}

impl Smoother {
    /// Advances by one step with the gain 1 − exp(−Δt/τ).
    pub fn push(&mut self, input: f64, gain: f64) -> f64 {
        self.value += gain * (input - self.value);
        self.value
    }
}

/// Gain of a first-order low-pass of time constant `tau_s` at the step `time_step_s`.
pub fn smoothing_gain(time_step_s: f64, tau_s: f64) -> f64 {
    1.0 - (-time_step_s / tau_s).exp()
}

/// Time constant of the stress smoother over the pressure-wave transit time of the pin's height.
///
/// A node that closes carries a one-step spike of about ρ c v/CFL, which is a property of the time
/// step, not of the contact. 0.15 transit times (2 µs in the reference scene) take it away and damp
/// the 16 kHz cycle by 2 %.
pub const STRESS_SMOOTHING: f64 = 0.15;

/// Makes [`Sample`]s of one lane.
#[derive(Debug, Clone)]
pub struct Sampler {
    lane: usize,
    gain: f64,
    sigma_n: Vec<Smoother>,
    normal: Smoother,
    observed: [usize; OBSERVED],
    states: Vec<ContactState>,
    /// x/lx and y/ly of every slave node.
    places: Vec<[f64; 2]>,
}

impl Sampler {
    /// A sampler of `lane`.
    pub fn new(model: &Model, lane: usize) -> Self {
        let mesh = model.mesh();
        let [nx, ny, _] = mesh.elements();
        let transit_s = mesh.size_m()[2] / model.material().pressure_wave_speed_m_s();
        Self {
            lane,
            gain: smoothing_gain(model.time_step_s(), STRESS_SMOOTHING * transit_s),
            sigma_n: vec![Smoother::default(); model.slaves().len()],
            normal: Smoother::default(),
            observed: [mesh.node(nx / 2, 0, 0), mesh.node(nx / 2, ny, 0)],
            states: vec![ContactState::Separated; model.slaves().len()],
            places: model
                .slaves()
                .iter()
                .map(|slave| {
                    let [x, y, _] = mesh.coordinates_m(slave.node);
                    [x / mesh.size_m()[0], y / mesh.size_m()[1]]
                })
                .collect(),
        }
    }

    /// The sample of the step that `state` has just done.
    pub fn sample<const L: usize>(&mut self, model: &Model, drive: &Drive, state: &State<L>) -> Sample {
        let l = self.lane;
        let dt = model.time_step_s();
        let contacts = &state.contacts;
        let mut sample = Sample {
            time_s: (state.step - 1) as f64 * dt,
            load_n: state.load_n[l],
            // The clamp's reaction acts on the pin against the friction of the disk.
            clamp_tangential_n: -state.reaction_n[1][l],
            ..Sample::default()
        };
        for (slave, slave_node) in model.slaves().iter().enumerate() {
            let force: [f64; 3] = std::array::from_fn(|c| contacts.force_n[slave][c][l]);
            let contact_state = contacts.state[slave][l];
            let sigma_n = self.sigma_n[slave].push(force[2] / slave_node.area_m2, self.gain);
            sample.normal_n += force[2];
            sample.contact_tangential_n += force[1];
            sample.contact_sideways_n += force[0];
            sample.x_moment_n += force[2] * self.places[slave][0];
            sample.y_moment_n += force[2] * self.places[slave][1];
            sample.transitions += usize::from(contact_state != self.states[slave]);
            self.states[slave] = contact_state;
            sample.sigma_n_max_pa = sample.sigma_n_max_pa.max(sigma_n);
            sample.lift_max_m = sample.lift_max_m.max(contacts.gap_m[slave][l]);
            let mut slip_speed = 0.0;
            match contact_state {
                ContactState::Separated => sample.separated += 1,
                ContactState::Stick => {
                    sample.stick += 1;
                    sample.stick_deficit_n += drive.mu * force[2] - force[1];
                }
                ContactState::Slip => {
                    sample.slip += 1;
                    let [x, y] = [0, 1].map(|c| contacts.relative_increment_m[slave][c][l]);
                    let slipped = (x * x + y * y).sqrt();
                    slip_speed = slipped / dt;
                    if slipped > 0.0 {
                        // Friction points along −slip, so cos φ = −s_y/|s|.
                        sample.slip_deficit_n += drive.mu * force[2] * (1.0 + y / slipped);
                    }
                    sample.slip_speed_max_m_s = sample.slip_speed_max_m_s.max(slip_speed);
                }
            }
            for (node, observed) in sample.nodes.iter_mut().zip(self.observed) {
                if observed == slave_node.node {
                    let increment = contacts.relative_increment_m[slave][1][l];
                    *node = NodeSample {
                        u_m: std::array::from_fn(|c| state.u[(3 * observed + c) * L + l]),
                        y_velocity_m_s: increment / dt + slave_node.surface_motion[1] * drive.rate,
                        gap_m: contacts.gap_m[slave][l],
                        force_n: force,
                        sigma_n_pa: sigma_n,
                        slip_speed_m_s: slip_speed,
                        state: contact_state,
                    };
                }
            }
        }
        sample.smooth_normal_n = self.normal.push(sample.normal_n, self.gain);
        sample
    }
}
