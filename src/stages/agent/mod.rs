//! Describe the body: parts, joints and tactile sensors, with the true part of each sensor and the true tree.
//!
//! `paper` builds the body of the paper from its settings (section 5.1 and figure 4); any other [`Agent`] is read from a
//! file.

mod body;
mod inertia;
mod paper;
mod shape;

pub use self::body::{Agent, Freedom, Joint, Part, Site, across};
pub use self::inertia::Inertia;
pub use self::paper::{Geometry, Morphology, Skin};
pub use self::shape::{Shape, Spot, Vector3};
