//! The numbers of nodal fields: f64 in double precision, f32 in single precision.
//!
//! Fields, the product with K, the contact solve on a rigid disk and the sums along a mesh line use these numbers. Time, the
//! drive, the totals of a step, energies, works and statistics are f64 in both precisions.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::real::Real;
use fearless_simd::{Simd, f32x16, f64x8, mask32x16, mask64x8, prelude::*};
use std::fmt::Debug;
use std::ops::{Index, IndexMut};

/// The numbers of nodal fields.
pub trait Number: SimdFloatElement + Send + Sync + 'static {
    /// Number of numbers in a SIMD vector of 64 bytes.
    const WIDTH: usize;
    /// The numbers of a vector.
    type Row: Copy
        + Default
        + Debug
        + PartialEq
        + Send
        + Sync
        + AsRef<[Self]>
        + AsMut<[Self]>
        + Index<usize, Output = Self>
        + IndexMut<usize>;
    /// Sums of the numbers of a vector.
    type Totals: Copy + Default + Debug + Send + Sync + AsRef<[f64]> + AsMut<[f64]>;
    /// A result of a comparison of vectors.
    type VectorMask<S: Simd>: SimdMask<S> + Select<Self::Vector<S>>;
    /// A vector.
    type Vector<S: Simd>: SimdFloat<S, Element = Self, Array = Self::Row, Mask = Self::VectorMask<S>>
        + Real<Mask = Self::VectorMask<S>>;

    /// The nearest such number.
    fn from_f64(value: f64) -> Self;
    /// The same value in f64.
    fn to_f64(self) -> f64;
    /// Adds the numbers of a vector to totals, slot by slot.
    fn add_to_totals<S: Simd>(totals: &mut Self::Totals, vector: Self::Vector<S>);
}

impl Number for f64 {
    const WIDTH: usize = 8;
    type Row = [Self; 8];
    type Totals = [f64; 8];
    type VectorMask<S: Simd> = mask64x8<S>;
    type Vector<S: Simd> = f64x8<S>;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline(always)]
    fn add_to_totals<S: Simd>(totals: &mut [f64; 8], vector: f64x8<S>) {
        (f64x8::load_array_ref(vector.simd, totals) + vector).store_array(totals);
    }
}

impl Number for f32 {
    const WIDTH: usize = 16;
    type Row = [Self; 16];
    type Totals = [f64; 16];
    type VectorMask<S: Simd> = mask32x16<S>;
    type Vector<S: Simd> = f32x16<S>;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn add_to_totals<S: Simd>(totals: &mut [f64; 16], vector: f32x16<S>) {
        let row: [f32; 16] = vector.to_array();
        for i in 0..16 {
            totals[i] += f64::from(row[i]);
        }
    }
}
