//! Stage 1, `simulate`: move an [agent](super::agent) at random in Open Dynamics Engine (section 5.1), or in a rhythm.
//!
//! In: a body, settings of its [`Motion`] and of the [`Physics`] engine. Out: a [`Trajectory`], the pose of every part
//! and the angles of every joint every Δt, with how well the step resolved the movement. [`recorded`] plays a movement that
//! was recorded instead.

#[cfg(test)]
pub(crate) mod fixtures;
mod motor;
mod movement;
pub mod recorded;
mod rhythm;
mod settings;
#[allow(unsafe_code, reason = "the physics engine is a C library")]
mod world;

pub use self::movement::{Instants, Resolution, Trajectory, simulate};
pub use self::settings::{
    AngleError, AngularMomentum, Controller, Motion, Movement, Physics, Rhythm, Targets,
};
pub use self::world::{Pose, Unstable, engine};
