//! `placement`: place estimated joints on the body, where position and normal of each sensor are known (an extension; not in the
//! paper).
//!
//! In: [`Tactile`](super::sense::Tactile) pressures, the part of each sensor, the tree, and a [`Site`](super::agent::Site) for each
//! sensor. Out: a [`Placement`], with a place for each joint and a box for each part.
//!
//! With position l and outward normal n, a sensor's loadings are known: root of pressure = max(0, n · (v + ω × l)). So the velocity v
//! and the angular velocity ω of each part follow by censored least squares, in the frame of the part. A joint is a point of both of
//! its parts, which feel the same speed |v + ω × q| there. So q is where both speeds agree best. Touch alone does not tell how the
//! frames of two parts are rotated against each other, only the rotation that agrees best over all samples.

mod boxes;
mod joint;
mod motion;
mod notes;
mod place;

pub use self::boxes::OrientedBox;
pub use self::joint::JointPlace;
pub use self::place::{PartPlace, Placement, place};
