//! Run the paper's experiments and the benchmark of bodies.

pub mod bodies;
pub mod reproduce;
