//! Run the paper's experiments and the benchmark of bodies.

pub(crate) mod bodies;
pub(crate) mod reproduce;
