//! The number type of the projection and the laws: one number, or a vector of eight.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use std::ops::{Add, Div, Mul};

/// A number, or a vector of eight. The operations of both round alike.
pub(in crate::solver) trait Real:
    Copy + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
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

impl<S: Simd> Real for f64x8<S> {
    type Mask = mask64x8<S>;

    #[inline(always)]
    fn zero(self) -> Self {
        f64x8::splat(self.simd, 0.0)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> mask64x8<S> {
        self.simd_le(other)
    }

    #[inline(always)]
    fn choose(mask: mask64x8<S>, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }
}
