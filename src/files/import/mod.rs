//! Read the description of a robot, MJCF (MuJoCo) or URDF (ROS), or a recorded skeleton as a body.
//!
//! `text` gathers the text, and `located` finds files. `mjcf` and `urdf` read links: solids in the common frame, and how each link
//! turns on its parent. `mesh` puts a box around a mesh, and sensors on it. `prepared` holds, leaves out and
//! weighs what a body cannot have as it is; `joined` makes parts of links. `skeleton` makes links of the joints of a recording.
//! `docs/reference.md` says what is read and what is not.

mod document;
mod inertia;
mod joined;
mod joints;
mod known;
mod located;
mod mesh;
mod mjcf;
mod notes;
mod options;
mod placed;
mod prepared;
mod read;
mod rounding;
mod shares;
mod skeleton;
mod text;
mod tree;
mod units;
mod urdf;
mod xml;

pub(crate) use self::notes::{at_one_place, names};
pub use self::options::{Imported, MIN_LENGTH, Options, SKIN, Surface};
pub use self::read::{import, import_into};
pub use self::skeleton::body_of_skeleton;
