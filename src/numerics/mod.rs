//! Numerical tools of all stages: random numbers, logarithms, vector instructions, eigenvalues, clusters, partitions, and ranges of settings.

pub(crate) mod eigen;
pub mod interrupt;
pub(crate) mod linkage;
pub(crate) mod log_sum;
pub mod partition;
pub mod range;
pub mod rng;
pub(crate) mod simd;
#[doc(hidden)]
pub mod testing;
