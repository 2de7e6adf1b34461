//! `rigid_parts`: find which sensors move rigidly together, by subspace clustering (an extension; not in the paper).
//!
//! In: [`Tactile`](super::sense::Tactile) pressures of M sensors at T samples. Out: [`RigidParts`], the part of each sensor; the
//! number of parts is estimated, too.
//!
//! Velocity and angular velocity of a rigid part are six numbers. So the roots of the pressures on its sensors span a motion
//! subspace of rank six or less, where they are not censored at 0. That is motion segmentation (Costeira and Kanade 1998). The
//! censored matrix is completed first (Saul 2022); affinities between sensors follow from its right singular vectors; and
//! clusters of high affinity are merged by description length (Ma et al. 2007) and refined by K-subspaces (Bradley and
//! Mangasarian 2000). Without noise, clusters that one motion explains only nearly are separated into parts that hardly
//! move against each other. `docs/estimate.md` has the theory; the stage [`joints`](super::joints) continues with the result.

mod als;
mod cluster;
mod completion;
mod dispersal;
mod face_growth;
mod faces;
mod factorisation;
#[cfg(test)]
pub(crate) mod fixtures;
mod floor;
mod given;
mod growth;
mod halves;
mod loadings;
mod log_determinant;
mod medians;
mod memory;
mod moves;
mod parts;
mod pieces;
mod prepared;
mod regressions;
mod regrouping;
mod rest;
mod roots;
mod search;
mod separation;
mod splits;
mod stratified;
mod subspace;
#[cfg(test)]
mod testing;
mod weights;

pub(crate) use self::als::Als;
pub(crate) use self::faces::{opposite_pairs, similar};
pub(crate) use self::factorisation::MAX_RANK;
pub(crate) use self::given::motions_of_parts;
pub(crate) use self::medians::{median, typical_size};
pub use self::parts::{RigidParts, rigid_parts};
pub(crate) use self::roots::{Roots, is_signed};
pub use self::search::MIN_SENSORS;
pub(crate) use self::stratified::stratified;
pub(crate) use self::subspace::MotionSubspace;
