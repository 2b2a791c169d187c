//! The peak performance of one core of this machine.

use crate::timing::fastest;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use serde::Serialize;
use std::hint::black_box;

/// Peak performance of one core.
#[derive(Debug, Serialize)]
pub struct Machine {
    /// The vector instructions that the solver chooses.
    pub vectors: String,
    /// Fused multiply-adds [GFLOP/s, two for each].
    pub fused_gflops: f64,
    /// As many plain multiplications as additions [GFLOP/s]. The solver's rounding rule allows only these.
    pub plain_gflops: f64,
    /// Bandwidth of reading and writing arrays of several sizes, from the L1 cache to memory.
    pub bandwidth: Vec<Bandwidth>,
}

/// Speed of `x = x + c` over an array.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Bandwidth {
    pub bytes: usize,
    pub gb_per_s: f64,
}

/// Number of independent chains of operations. It is above latency times number of units of any core.
const CHAINS: usize = 16;
const ROUNDS: usize = 4096;

#[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
#[inline(always)]
fn fused<S: Simd>(simd: S, start: f64) -> f64 {
    let (factor, term) = (f64x8::splat(simd, 0.999), f64x8::splat(simd, 0.001));
    let mut chains = [f64x8::splat(simd, start); CHAINS];
    for _ in 0..ROUNDS {
        for i in 0..CHAINS {
            chains[i] = chains[i].mul_add(factor, term);
        }
    }
    let mut total = 0.0;
    for chain in chains {
        total += chain[0];
    }
    total
}

#[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
#[inline(always)]
fn plain<S: Simd>(simd: S, start: f64) -> f64 {
    let (factor, term) = (f64x8::splat(simd, 0.999), f64x8::splat(simd, 0.001));
    let mut products = [f64x8::splat(simd, start); CHAINS / 2];
    let mut sums = [f64x8::splat(simd, start); CHAINS / 2];
    for _ in 0..ROUNDS {
        for i in 0..CHAINS / 2 {
            products[i] *= factor;
            sums[i] += term;
        }
    }
    let mut total = 0.0;
    for i in 0..CHAINS / 2 {
        total += products[i][0] + sums[i][0];
    }
    total
}

#[expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]
#[inline(always)]
fn sweep<S: Simd>(simd: S, array: &mut [[f64; 8]]) {
    let term = f64x8::splat(simd, 1.0e-9);
    for row in array {
        (f64x8::from_slice(simd, row) + term).store_slice(row);
    }
}

/// Measures this machine.
pub fn measure() -> Machine {
    let level = Level::new();
    let fused_s = fastest("machine_fused", || {
        black_box(dispatch!(level, simd => fused(simd, black_box(1.0))));
    });
    let plain_s = fastest("machine_plain", || {
        black_box(dispatch!(level, simd => plain(simd, black_box(1.0))));
    });
    let bandwidth = [1 << 14, 1 << 19, 1 << 23, 1 << 28].map(|bytes: usize| {
        let mut array = vec![[0.0; 8]; bytes / 64];
        let sweep_s = fastest(&format!("machine_bandwidth_{bytes}"), || {
            dispatch!(level, simd => sweep(simd, black_box(&mut array)));
        });
        Bandwidth { bytes, gb_per_s: 2.0 * bytes as f64 / sweep_s * 1e-9 }
    });
    let name = format!("{level:?}");
    Machine {
        vectors: name.split('(').next().unwrap_or_default().to_owned(),
        fused_gflops: (2 * 8 * CHAINS * ROUNDS) as f64 / fused_s * 1e-9,
        plain_gflops: (8 * CHAINS * ROUNDS) as f64 / plain_s * 1e-9,
        bandwidth: bandwidth.to_vec(),
    }
}

impl Machine {
    /// Bandwidth [GB/s] for a working set of so many bytes. It is that of the smallest measured array that is
    /// not smaller.
    pub fn gb_per_s(&self, bytes: f64) -> f64 {
        let level = self.bandwidth.iter().find(|level| bytes <= level.bytes as f64);
        level.or(self.bandwidth.last()).expect("levels were measured").gb_per_s
    }

    pub fn print(&self) {
        println!("\nOne core, {} vectors", self.vectors);
        println!("  fused multiply-add          {:8.1} GFLOP/s", self.fused_gflops);
        println!("  plain multiplies and adds   {:8.1} GFLOP/s", self.plain_gflops);
        for level in &self.bandwidth {
            let Bandwidth { bytes, gb_per_s } = level;
            println!("  read and write {:>7} kB    {gb_per_s:8.1} GB/s", bytes >> 10);
        }
    }
}
