//! Run a multiverse: many reasonable readings of the paper, drawn evenly from all, each a replication of its own.

mod design;
mod draw;
mod evaluation;
mod gather;
mod page;
mod specification;
mod work;

pub use self::design::Design;
pub use self::gather::{gather, is_multiverse, redraw};
pub use self::work::{Shard, rerun, work};
