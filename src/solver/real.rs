//! The number type of the projection and the laws: one number, or a vector.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f32x16, f64x8, mask32x16, mask64x8, prelude::*};
use std::ops::{Add, Div, Mul};

/// A number, or a vector. The operations of a number and of a vector of f64 round alike.
pub trait Real: Copy + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// Result of a comparison.
    type Mask: Copy;

    /// Zero in every element.
    fn zero(self) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// self ≤ other; false where either is NaN.
    fn at_most(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is set, otherwise `no`.
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn zero(self) -> Self {
        0.0
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// Implements [`Real`] for vectors.
macro_rules! real_vector {
    ($vector:ident, $mask:ident) => {
        impl<S: Simd> Real for $vector<S> {
            type Mask = $mask<S>;

            #[inline(always)]
            fn zero(self) -> Self {
                $vector::splat(self.simd, 0.0)
            }

            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn at_most(self, other: Self) -> $mask<S> {
                self.simd_le(other)
            }

            #[inline(always)]
            fn choose(mask: $mask<S>, yes: Self, no: Self) -> Self {
                mask.select(yes, no)
            }
        }
    };
}

real_vector!(f64x8, mask64x8);
real_vector!(f32x16, mask32x16);
