//! `tree`: how the parts are joined, from what they feel of their joints (an extension; not in the paper).
//!
//! In: [`Tactile`](super::sense::Tactile) pressures of M sensors at T times, and the part of each sensor. Out: a
//! [`CoMotion`], a tree over the parts with a confidence for each edge. `docs/estimate.md` has the theory. What a part feels
//! of its motion also says [which sensors are on one part](rigid_parts()).
//!
//! A joint belongs to both of its parts, so that both know its speed: |v + ω × l|, from the velocity v, the rate ω and the
//! place l of the joint in the frame of either. It is the same number, however the joint is bent, and in each frame its
//! square is a quadratic form of what the part [feels of its motion](Motion). So [each pair of parts](correlations) is
//! asked for the two quadratic forms that agree best, and the tree of greatest agreement is the answer.

mod censored;
mod faces;
#[cfg(test)]
mod fixtures;
mod joint_speed;
mod motion;
mod owners;
mod regressions;
mod rigid;
mod settle;
mod tree;
mod turns;

pub use self::censored::MAX_COMPONENTS;
pub use self::joint_speed::{Moments, correlations};
pub use self::motion::{Motion, is_signed, spread};
pub use self::rigid::{MIN_SENSORS, RigidParts, rigid_parts};
pub use self::settle::settle;
pub use self::tree::{CoMotion, Pair, co_motion, co_motion_tree};
