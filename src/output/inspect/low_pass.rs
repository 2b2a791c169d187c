//! A zero-phase low-pass filter, for stresses that are shown together with contact states.

use crate::analysis::sample::Smoother;

/// Filters values with a first-order low-pass forwards and then backwards, so that nothing is delayed.
///
/// `gain` is that of the job's own low-pass, 1 − exp(−Δt/τ), which goes forwards only. Each direction here has the time
/// constant τ/√2, so that slow oscillations lose the same part of their amplitude as in the job's own filter: ω²τ²/2.
pub fn zero_phase_low_pass(values: &[f64], gain: f64) -> Vec<f64> {
    let each_way = 1.0 - (1.0 - gain).powf(std::f64::consts::SQRT_2);
    let pass = |values: &mut dyn Iterator<Item = f64>, first: f64| -> Vec<f64> {
        let mut smoother = Smoother::at(first);
        values.map(|value| smoother.push(value, each_way)).collect()
    };
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return Vec::new() };
    let forwards = pass(&mut values.iter().copied(), first);
    let mut both = pass(&mut forwards.into_iter().rev(), last);
    both.reverse();
    both
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Protects: a spike keeps its time and its sum. An oscillation keeps its phase, and loses the same part of its
    /// amplitude as in the job's own filter.
    #[test]
    fn nothing_is_delayed() {
        let gain = 1.0 - (-0.1_f64).exp();
        let mut spike = vec![0.0; 401];
        spike[200] = 1.0;
        let smooth = zero_phase_low_pass(&spike, gain);
        let largest = (0..401).max_by(|a, b| smooth[*a].total_cmp(&smooth[*b])).unwrap();
        assert_eq!(largest, 200);
        for k in 1..100 {
            assert!((smooth[200 - k] - smooth[200 + k]).abs() < 1e-9, "symmetric");
        }
        assert!((smooth.iter().sum::<f64>() - 1.0).abs() < 1e-9);

        // ωτ = 0.2: a low-pass in one direction reduces the amplitude by 2 % and delays by τ, which is ten steps.
        let omega = 0.2 / 10.0;
        let wave: Vec<f64> = (0..2000).map(|i| (omega * f64::from(i)).sin()).collect();
        let smooth = zero_phase_low_pass(&wave, gain);
        let amplitude = 1.0 / (1.0 + 0.2 * 0.2 / 2.0);
        for i in 800..1200 {
            // The error is of second order in Δt/τ = 0.1 and in ωΔt.
            assert!(
                (smooth[i] - amplitude * wave[i]).abs() < 1e-3,
                "{i}: {} {}",
                smooth[i],
                amplitude * wave[i]
            );
        }
        assert!((TAU / omega) as usize * 2 < 800, "away from the ends");
        assert!(zero_phase_low_pass(&[], gain).is_empty());
    }
}
