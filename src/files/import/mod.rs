//! Read the description of a robot, MJCF (MuJoCo) or URDF (ROS), as a body.
//!
//! `mjcf` and `urdf` read links: solids in the common frame, and how each link turns on its parent. `joined` makes parts of
//! them. `docs/reference.md` says what is read and what is not.

mod joined;
mod mjcf;
mod placed;
mod read;
mod urdf;
mod xml;

pub use self::read::{Imported, import};
