//! Run tasks: simulate each movement once, infer from it as often as asked, keep what is finished.

mod artifacts;
pub(crate) mod batch;
pub(crate) mod beginning;
pub(crate) mod cache;
pub(crate) mod error;
mod prefetch;
pub(crate) mod progress;
pub(crate) mod seeds;
pub(crate) mod shard;
pub(crate) mod task;
