//! Run code with the widest vector instructions of this processor.

use pulp::{Arch, Simd, WithSimd};

/// Runs `work`, which is compiled once for each set of vector instructions; the set is chosen at run time.
///
/// The closure, and all it calls in its loops, must be `#[inline(always)]`, and it must change what it
/// captures: one that does not is called through a shim of the compiler, which is not inlined. If its lanes
/// never mix and it multiplies and adds by `mul_add`, which rounds once on any machine, then every set of
/// instructions gives the same bits.
#[inline(always)]
pub(crate) fn vectorised<R>(work: impl FnMut() -> R) -> R {
    Arch::new().dispatch(Work(work))
}

struct Work<F>(F);

impl<R, F: FnMut() -> R> WithSimd for Work<F> {
    type Output = R;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> R {
        (self.0)()
    }
}
