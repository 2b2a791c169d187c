//! Jobs that begin with the motion in which another one ended.
//!
//! A job stores its last motion as displacements and velocities. That is all that a run on a rigid disk needs, if the law of
//! friction does not use the past. So a run that continues in the same conditions stays in its limit cycle. The displacements are
//! those at the time of the velocities, so that its beginning is off by less than a time step.

use super::nested::Beginning;
use crate::solver::Model;
pub use crate::solver::PinMotion;
use crate::spec::{Continuation, JobSpec};

/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// A motion as bytes: displacements, then velocities.
pub fn to_bytes(motion: &PinMotion) -> Vec<u8> {
    motion.u_m.iter().chain(&motion.velocity_m_s).flat_map(|number| number.to_le_bytes()).collect()
}

/// The motion that [`to_bytes`] wrote; none if the bytes are none.
pub fn from_bytes(bytes: &[u8]) -> Option<PinMotion> {
    let (numbers, rest) = bytes.as_chunks::<BYTES>();
    if !rest.is_empty() || numbers.len() % 6 != 0 {
        return None;
    }
    let numbers: Vec<f64> = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let (u_m, velocity_m_s) = numbers.split_at(numbers.len() / 2);
    let motion = PinMotion { u_m: u_m.to_vec(), velocity_m_s: velocity_m_s.to_vec() };
    numbers.iter().all(|number| number.is_finite()).then_some(motion)
}

/// What a job begins from that continues the motion `of_parent`; none if that is a motion of another mesh.
pub(super) fn beginning(spec: &JobSpec, model: &Model, of_parent: PinMotion) -> Option<Beginning> {
    let mut motion = of_parent;
    if motion.u_m.len() != 3 * model.mesh().node_count() {
        return None;
    }
    if let Some(continuation) = spec.continuation.as_deref().filter(|own| own.kick_m_s > 0.0) {
        let kick = kick(continuation, model);
        motion.velocity_m_s.iter_mut().zip(kick).for_each(|(velocity, kick)| *velocity += kick);
    }
    Some(Beginning { motion: Some(motion), start: None })
}

/// Velocities that vary linearly in space, so that they move the lowest modes and are not lost in the damping of the highest.
/// Their 12 coefficients follow from the seed.
fn kick(continuation: &Continuation, model: &Model) -> Vec<f64> {
    let mesh = model.mesh();
    let positions: Vec<[f64; 3]> = (0..mesh.node_count()).map(|node| mesh.coordinates_m(node)).collect();
    let mut stream = blake3::Hasher::new().update(&continuation.kick_seed.to_le_bytes()).finalize_xof();
    let mut number = || {
        let mut bytes = [0; BYTES];
        stream.fill(&mut bytes);
        (u64::from_le_bytes(bytes) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let extent = |axis: usize| {
        let values = || positions.iter().map(|position| position[axis]);
        let (low, high) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        (0.5 * (low + high), 0.5 * (high - low))
    };
    let extents = [0, 1, 2].map(extent);
    let coefficients: [[f64; 4]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| number()));
    let velocity = |position: &[f64; 3], of: &[f64; 4]| {
        let linear = (0..3).map(|axis| of[axis + 1] * (position[axis] - extents[axis].0) / extents[axis].1);
        of[0] + linear.sum::<f64>()
    };
    let kick: Vec<f64> =
        positions.iter().flat_map(|position| coefficients.map(|of| velocity(position, &of))).collect();
    let mean_square = kick.iter().map(|value| value * value).sum::<f64>() / kick.len() as f64;
    let scale = continuation.kick_m_s / mean_square.sqrt();
    kick.into_iter().map(|value| value * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::{from_bytes, kick, to_bytes};
    use crate::solver::{Model, PinMotion};
    use crate::spec::{Continuation, JobSpec};

    /// Protects: a motion is read as it was written, and other bytes are refused.
    #[test]
    fn a_motion_survives_its_bytes() {
        let motion =
            PinMotion { u_m: vec![1.0e-6, -0.0, 3.5], velocity_m_s: vec![f64::MIN_POSITIVE, 2.0, -1.0] };
        let bytes = to_bytes(&motion);
        assert_eq!(from_bytes(&bytes), Some(motion));
        assert_eq!(from_bytes(&bytes[1..]), None);
        assert_eq!(from_bytes(&bytes[16..]), None);
        let infinite = PinMotion { u_m: vec![f64::INFINITY; 3], velocity_m_s: vec![0.0; 3] };
        assert_eq!(from_bytes(&to_bytes(&infinite)), None);
    }

    /// Protects: a kick has its size, and another seed is another kick.
    #[test]
    fn a_kick_has_its_size() {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = [4, 5, 3];
        spec.scene.clamp.width_m = 0.003;
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let with =
            |kick_seed| kick(&Continuation { kick_m_s: 0.02, kick_seed, ..Continuation::ROOT }, &model);
        let first = with(1);
        let mean_square = first.iter().map(|value| value * value).sum::<f64>() / first.len() as f64;
        assert!((mean_square.sqrt() / 0.02 - 1.0).abs() < 1.0e-12);
        assert_eq!(first, with(1));
        assert_ne!(first, with(2));
    }
}
