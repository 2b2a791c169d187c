//! Code for the vector instructions of the machine that runs it.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::number::Number;
use fearless_simd::{Simd, prelude::*};

/// Runs `$op` with the widest vectors of `$level`. Every level gives the same bits.
///
/// `fearless_simd::dispatch!` does the same, but compiles `$op` for SSE4.2, too. Its code was more
/// than a third of all vector code, and SSE4.2 has no wider vectors than SSE2.
macro_rules! dispatch {
    (@vectorized $simd:ident => $op:expr) => {
        $simd.vectorize(
            #[inline(always)]
            || $op,
        )
    };
    ($level:expr, $simd:ident => $op:expr) => {{
        let level: fearless_simd::Level = $level;
        #[cfg(target_arch = "x86_64")]
        {
            use fearless_simd::Simd as _;
            if let Some($simd) = level.as_avx512() {
                $crate::solver::simd::dispatch!(@vectorized $simd => $op)
            } else if let Some($simd) = level.as_avx2() {
                $crate::solver::simd::dispatch!(@vectorized $simd => $op)
            } else {
                let $simd = level.as_sse2().expect("every machine of this architecture has SSE2");
                $crate::solver::simd::dispatch!(@vectorized $simd => $op)
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!(level, $simd => $op)
        }
    }};
    ($simd:ident => $op:expr) => {
        $crate::solver::simd::dispatch!(fearless_simd::Level::new(), $simd => $op)
    };
}

pub(crate) use dispatch;

/// Loads a row as a vector.
#[inline(always)]
pub(crate) fn load<R: Number, S: Simd>(simd: S, row: &R::Row) -> R::Vector<S> {
    R::Vector::<S>::load_array_ref(simd, row)
}

/// Loads three rows as vectors. `map` on the array would compile to a call, across which vectors do not stay in
/// registers.
#[inline(always)]
pub(crate) fn load_all<R: Number, S: Simd>(simd: S, rows: &[R::Row; 3]) -> [R::Vector<S>; 3] {
    [load::<R, S>(simd, &rows[0]), load::<R, S>(simd, &rows[1]), load::<R, S>(simd, &rows[2])]
}

/// The same number in all slots of a vector.
#[inline(always)]
pub(crate) fn splat<R: Number, S: Simd>(simd: S, value: f64) -> R::Vector<S> {
    R::Vector::<S>::splat(simd, R::from_f64(value))
}
