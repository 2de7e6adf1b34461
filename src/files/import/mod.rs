//! Read the description of a robot, MJCF (MuJoCo) or URDF (ROS), or a recorded skeleton as a body.
//!
//! `mjcf` and `urdf` read links: solids in the common frame, and how each link turns on its parent. `joined` makes parts of
//! them. `skeleton` makes links of the joints of a recording. `docs/reference.md` says what is read and what is not.

mod joined;
mod mjcf;
mod placed;
mod read;
mod skeleton;
mod units;
mod urdf;
mod xml;

pub use self::read::{Imported, SKIN, import};
pub(crate) use self::skeleton::names;
pub use self::skeleton::{Bones, body_of_skeleton};
