//! The number type of the projection and the laws: one number, or a vector.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f32x16, f64x8, mask32x16, mask64x8, prelude::*};
use std::ops::{Add, Div, Mul, Sub};

/// A number, or a vector. The operations of a number and of a vector of f64 round alike.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Result of a comparison.
    type Mask: Copy;

    /// The number nearest to `value` in every element.
    fn constant(self, value: f64) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// self ≤ other; false where either is NaN.
    fn at_most(self, other: Self) -> Self::Mask;
    /// self ≥ other; false where either is NaN.
    #[inline(always)]
    fn at_least(self, other: Self) -> Self::Mask {
        other.at_most(self)
    }
    /// `yes` where the mask is set, otherwise `no`.
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
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
            fn constant(self, value: f64) -> Self {
                $vector::splat(self.simd, value as _)
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

/// Argument beyond which [`decay`] no longer falls: e⁻⁴⁰ = 4·10⁻¹⁸.
const LARGEST: f64 = 40.0;

/// Squarings in [`decay`].
const SQUARINGS: u32 = 5;

/// Terms of the series in [`decay`]. The first that is left out is at most (40/32)¹⁷/17! = 1.2·10⁻¹³.
const TERMS: u32 = 16;

/// e⁻ˣ for x ≥ 0, with the same bits at every SIMD level.
///
/// The series of e^(x/32) has positive terms only, so nothing cancels. Five squarings multiply its rounding error by 32: the
/// relative error is below 10⁻¹¹, and in single precision below 10⁻⁵.
#[inline(always)]
pub(super) fn decay<R: Real>(x: R) -> R {
    let one = x.constant(1.0);
    let largest = x.constant(LARGEST);
    let y = R::choose(x.at_most(largest), x, largest) * x.constant(f64::from(1 << SQUARINGS).recip());
    let mut sum = one;
    for term in (1..=TERMS).rev() {
        sum = one + sum * y * x.constant(f64::from(term).recip());
    }
    for _ in 0..SQUARINGS {
        sum = sum * sum;
    }
    one / sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::simd::dispatch;

    /// Protects: the exponential function of the friction laws, for one number and for vectors of both precisions, from tiny to
    /// huge arguments.
    #[test]
    fn decay_is_the_exponential_function() {
        for i in -60..=60 {
            let x = libm::pow(10.0, f64::from(i) / 20.0);
            let exact = libm::exp(-x.min(LARGEST));
            let one = decay(x);
            assert!((one / exact - 1.0).abs() < 1.0e-11, "{x}: {one}, not {exact}");
            dispatch!(simd => {
                assert_eq!(decay(f64x8::splat(simd, x))[5].to_bits(), one.to_bits());
                let single = f64::from(decay(f32x16::splat(simd, x as f32))[3]);
                let rounding_of_x = x.min(LARGEST) * f64::from(f32::EPSILON);
                assert!((single / exact - 1.0).abs() < 1.0e-5 + rounding_of_x, "{x}: {single}, not {exact}");
            });
        }
        assert_eq!(decay(0.0), 1.0);
    }
}
