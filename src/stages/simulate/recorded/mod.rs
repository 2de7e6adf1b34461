//! Play a recorded movement: poses of a body's parts from a skeleton and its channels, without a physics engine.
//!
//! In: a [`RecordedMovement`], as motion capture has it, and a body whose parts are [`Attached`] to its joints. Out: the
//! [`Trajectory`](super::Trajectory) that [`simulate`](super::simulate) would give, for the same stage 2.

mod angles;
mod attach;
mod between;
mod jumps;
mod play;
mod rotation;
mod skeleton;

pub use self::attach::{Attached, Misfit};
pub use self::jumps::{Stretch, longest_stretch};
pub use self::play::{play, samples, still_on};
pub use self::skeleton::{Channel, RecordedJoint, RecordedMovement};
