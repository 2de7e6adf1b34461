//! Run the paper's experiments and the benchmark of bodies.

mod artifacts;
pub mod batch;
mod beginning;
pub mod bodies;
pub mod cache;
pub mod error;
mod prefetch;
pub mod progress;
pub mod reproduce;
mod seeds;
pub mod task;
pub mod verify;
