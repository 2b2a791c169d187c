//! The spectrum of the total normal force.

use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// The amplitude spectrum of a signal.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spectrum {
    /// Distance \[Hz\] of the frequencies. The first one is 0.
    pub resolution_hz: f64,
    /// Amplitude at each frequency. A sine over the whole signal with one of these frequencies has its own amplitude.
    pub amplitudes: Vec<f64>,
}

impl Spectrum {
    /// The spectrum of samples at a distance of `time_step_s` \[s\], without their mean, with a Hann window.
    ///
    /// # Panics
    /// Never, because the buffers are those of the transform.
    pub fn of(samples: &[f64], time_step_s: f64) -> Self {
        let n = samples.len();
        if n < 4 {
            return Self::default();
        }
        let mean = samples.iter().sum::<f64>() / n as f64;
        let hann = |i: usize| 1.0 - (2.0 * PI * i as f64 / n as f64).cos();
        let transform = RealFftPlanner::new().plan_fft_forward(n);
        let mut windowed: Vec<f64> = samples.iter().enumerate().map(|(i, x)| (x - mean) * hann(i)).collect();
        let mut lines = transform.make_output_vec();
        transform.process(&mut windowed, &mut lines).expect("buffers of the transform's own sizes");
        let amplitudes = lines.iter().map(|line| 2.0 * line.norm() / n as f64).collect();
        Self { resolution_hz: 1.0 / (n as f64 * time_step_s), amplitudes }
    }

    /// Frequency \[Hz\] and amplitude of every line.
    pub fn lines(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.amplitudes.iter().enumerate().map(|(k, amplitude)| (k as f64 * self.resolution_hz, *amplitude))
    }

    /// The `count` largest local maxima, frequency \[Hz\] and amplitude, largest first.
    pub fn peaks(&self, count: usize) -> Vec<(f64, f64)> {
        let lines: Vec<_> = self.lines().collect();
        let mut peaks: Vec<_> = lines
            .windows(3)
            .filter(|three| three[1].1 > three[0].1 && three[1].1 >= three[2].1)
            .map(|three| three[1])
            .collect();
        peaks.sort_by(|a, b| b.1.total_cmp(&a.1));
        peaks.truncate(count);
        peaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: frequencies and amplitudes are those of the signal: two sines with an offset.
    #[test]
    fn sines_have_their_own_amplitudes() {
        let dt = 1e-6;
        let signal: Vec<f64> = (0..1000)
            .map(|i| {
                let t = f64::from(i) * dt;
                30.0 + 12.0 * (2.0 * PI * 15e3 * t).sin() + 3.0 * (2.0 * PI * 30e3 * t).cos()
            })
            .collect();
        let spectrum = Spectrum::of(&signal, dt);
        let peaks = spectrum.peaks(2);
        for ((frequency_hz, amplitude), (f, a)) in peaks.iter().zip([(15e3, 12.0), (30e3, 3.0)]) {
            // The transform rounds; lines of a whole number of periods leak into their neighbours alone.
            assert!(
                (frequency_hz / f - 1.0).abs() < 1e-12 && (amplitude / a - 1.0).abs() < 1e-9,
                "{peaks:?}"
            );
        }
        assert!(spectrum.amplitudes[0] < 1e-9);
        assert_eq!(Spectrum::of(&[1.0; 3], dt).amplitudes.len(), 0);
    }
}
