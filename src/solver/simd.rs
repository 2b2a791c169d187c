//! Code for the vector instructions of the machine that runs it.

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
