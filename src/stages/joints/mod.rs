//! `joints`: find how the parts of a body are joined, from the speeds of joints (an extension; not in the paper).
//!
//! In: [`Tactile`](super::sense::Tactile) pressures of M sensors at T samples, and the part of each sensor. Out: [`Joints`], a
//! tree over the parts with the bootstrap support of each edge, given the parts. `docs/estimate.md` has the theory.
//!
//! A joint is a point of both of its parts, so that both feel its speed |v + ω × l|: v and ω are velocity and angular velocity
//! of either part, and l is the place of the joint in its frame. However the joint bends, the two speeds are equal, and their
//! squares are quadratic forms of the motion of either part. For each pair of parts, the correlation of the two best such forms
//! says whether they share a joint, and the tree of most information, mostly that of these speeds, is the estimate. Parts that
//! are joined have motion subspaces that intersect (Yan and Pollefeys 2006, 2008). Here the frames rotate against each other, and
//! only speeds agree.

mod assign;
mod correlation;
mod cross_moments;
#[cfg(test)]
mod fixtures;
mod information;
mod moments;
mod refine;
mod tree;

pub(crate) use self::information::of_correlation;
pub(crate) use self::refine::{refine, refine_tree};
pub use self::tree::{Joints, Pair, Rival, joints};
pub(crate) use self::tree::{blocks, joint_tree};
