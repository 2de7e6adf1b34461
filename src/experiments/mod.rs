//! Run the paper's experiments, the search for a default, and the study of what the paper leaves open.

mod artifacts;
mod batch;
mod beginning;
pub mod bodies;
mod cache;
pub mod compare;
mod compared;
mod configurations;
pub mod design;
mod draws;
mod error;
pub mod multiverse;
mod prefetch;
pub mod progress;
pub mod reproduce;
pub mod search;
mod seeds;
pub mod sensitivity;
mod task;
pub mod verify;
