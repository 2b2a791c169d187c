//! The numbers of nodal fields: f64 in double precision, f32 in single precision.
//!
//! Fields, the product with K, the contact solve on a rigid disk and the sums along a mesh line use these numbers. Time, the
//! drive, the totals of a step, energies, works and statistics are f64 in both precisions.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::real::Real;
use fearless_simd::{Simd, f32x4, f32x8, f32x16, f64x2, f64x4, f64x8, mask32x16, mask64x8, prelude::*};
use std::fmt::Debug;
use std::ops::{Add, Index, IndexMut, Mul};

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

    /// Eight lanes of a node.
    type Eight<S: Simd>: LaneVector<S, Self>;
    /// Four lanes of a node.
    type Four<S: Simd>: LaneVector<S, Self>;
    /// Two lanes of a node.
    type Two<S: Simd>: LaneVector<S, Self>;

    /// The nearest such number.
    fn from_f64(value: f64) -> Self;
    /// The same value in f64.
    fn to_f64(self) -> f64;
    /// Adds the numbers of a vector to totals, slot by slot.
    fn add_to_totals<S: Simd>(totals: &mut Self::Totals, vector: Self::Vector<S>);
    /// The numbers themselves in double precision; returns `None` in single precision.
    fn doubles(numbers: &mut [Self]) -> Option<&mut [f64]>;
    /// The same, to read them.
    fn as_doubles(numbers: &[Self]) -> Option<&[f64]>;
    /// The form of a table in these numbers. The rounded one is made when it is needed.
    fn of_both<'a, const N: usize>(
        double: &'a [[f64; N]],
        single: impl FnOnce() -> &'a [[f32; N]],
    ) -> &'a [[Self; N]];
}

/// All lanes of a node as one value.
pub trait LaneVector<S: Simd, R>: Copy + Add<Output = Self> + Mul<Output = Self> {
    /// Number of lanes.
    const LANES: usize;
    /// The same number in all lanes.
    fn all(simd: S, value: R) -> Self;
    /// The lanes from a slice of as many numbers.
    fn read(simd: S, from: &[R]) -> Self;
    /// Stores the lanes in a slice of as many numbers.
    fn write(self, to: &mut [R]);
}

/// Lanes without a vector of their number.
#[derive(Debug, Clone, Copy)]
pub struct Few<R, const L: usize>([R; L]);

impl<R: Copy + Add<Output = R>, const L: usize> Add for Few<R, L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] + other.0[lane]))
    }
}

impl<R: Copy + Mul<Output = R>, const L: usize> Mul for Few<R, L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|lane| self.0[lane] * other.0[lane]))
    }
}

impl<S: Simd, R: Copy + Add<Output = R> + Mul<Output = R>, const L: usize> LaneVector<S, R> for Few<R, L> {
    const LANES: usize = L;

    #[inline(always)]
    fn all(_simd: S, value: R) -> Self {
        Self([value; L])
    }

    #[inline(always)]
    fn read(_simd: S, from: &[R]) -> Self {
        Self(std::array::from_fn(|lane| from[lane]))
    }

    #[inline(always)]
    fn write(self, to: &mut [R]) {
        to.copy_from_slice(&self.0);
    }
}

/// Implements [`LaneVector`] for a vector.
macro_rules! lane_vector {
    ($vector:ident, $number:ty, $lanes:literal) => {
        impl<S: Simd> LaneVector<S, $number> for $vector<S> {
            const LANES: usize = $lanes;

            #[inline(always)]
            fn all(simd: S, value: $number) -> Self {
                Self::splat(simd, value)
            }

            #[inline(always)]
            fn read(simd: S, from: &[$number]) -> Self {
                Self::from_slice(simd, from)
            }

            #[inline(always)]
            fn write(self, to: &mut [$number]) {
                self.store_slice(to);
            }
        }
    };
}

lane_vector!(f64x8, f64, 8);
lane_vector!(f64x4, f64, 4);
lane_vector!(f64x2, f64, 2);
lane_vector!(f32x8, f32, 8);
lane_vector!(f32x4, f32, 4);

impl Number for f64 {
    const WIDTH: usize = 8;
    type Row = [Self; 8];
    type Totals = [f64; 8];
    type VectorMask<S: Simd> = mask64x8<S>;
    type Vector<S: Simd> = f64x8<S>;
    type Eight<S: Simd> = f64x8<S>;
    type Four<S: Simd> = f64x4<S>;
    type Two<S: Simd> = f64x2<S>;

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

    fn doubles(numbers: &mut [f64]) -> Option<&mut [f64]> {
        Some(numbers)
    }

    fn as_doubles(numbers: &[f64]) -> Option<&[f64]> {
        Some(numbers)
    }

    fn of_both<'a, const N: usize>(
        double: &'a [[f64; N]],
        _single: impl FnOnce() -> &'a [[f32; N]],
    ) -> &'a [[Self; N]] {
        double
    }
}

impl Number for f32 {
    const WIDTH: usize = 16;
    type Row = [Self; 16];
    type Totals = [f64; 16];
    type VectorMask<S: Simd> = mask32x16<S>;
    type Vector<S: Simd> = f32x16<S>;
    type Eight<S: Simd> = f32x8<S>;
    type Four<S: Simd> = f32x4<S>;
    type Two<S: Simd> = Few<f32, 2>;

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

    fn doubles(_: &mut [f32]) -> Option<&mut [f64]> {
        None
    }

    fn as_doubles(_: &[f32]) -> Option<&[f64]> {
        None
    }

    fn of_both<'a, const N: usize>(
        _double: &'a [[f64; N]],
        single: impl FnOnce() -> &'a [[f32; N]],
    ) -> &'a [[Self; N]] {
        single()
    }
}
