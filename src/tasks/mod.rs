//! Run tasks: simulate each movement once, infer from it as often as asked, keep what is finished.

mod artifacts;
pub mod batch;
pub mod beginning;
pub mod cache;
pub mod error;
mod prefetch;
pub mod progress;
pub mod seeds;
pub mod task;
