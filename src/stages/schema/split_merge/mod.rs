//! The split–merge sampler of the Dirichlet-process mixture, with joints and trees integrated out: an extension beside the
//! published sampler.

mod chain;
mod clusters;
mod collapsed;
mod division;
mod edges;
mod neighbours;

pub(crate) use self::chain::{SplitMerge, Target};
pub use self::clusters::graph;
pub use self::edges::TreePosterior;
pub(crate) use self::edges::tree_given;
pub(crate) use self::neighbours::Neighbours;
