//! How the description of a robot or a recorded skeleton becomes a body, and what comes of it.

use crate::files::body::{BodyFile, SkinEntry};
use crate::files::front_end::FrontEnd;
use crate::stages::agent::Vector3;

/// Skin of each part of an imported body, if the user says nothing.
pub const SKIN: SkinEntry = SkinEntry { sensors: Some(40), per_area: None };
/// Length of a bone, m, from which on it carries skin, if the user says nothing: longer than most bones of fingers.
pub const MIN_LENGTH: f64 = 0.05;

/// How the description of a robot or a recorded skeleton becomes a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Skin of each part.
    pub skin: SkinEntry,
    /// Of a robot: whether what a body cannot have is refused, and not changed with a note.
    pub strict: bool,
    /// Of a robot: the body or link whose tree is the body; otherwise it is the largest tree.
    pub root: Option<String>,
    /// Of a skeleton: length of a unit of the recording, m; guessed if it is not given.
    pub scale: Option<f64>,
    /// Of a skeleton: length of a bone, m, from which on it carries skin; otherwise [`MIN_LENGTH`].
    pub min_length: Option<f64>,
    /// Whose words messages use.
    pub front_end: FrontEnd,
}

impl Options {
    /// With so many sensors on each part, or per m², if either is given.
    pub fn with_skin(self, sensors: Option<usize>, per_area: Option<f64>) -> Self {
        let is_given = sensors.is_some() || per_area.is_some();
        Self { skin: if is_given { SkinEntry { sensors, per_area } } else { self.skin }, ..self }
    }
}

impl Default for Options {
    fn default() -> Self {
        let front_end = FrontEnd::default();
        Self { skin: SKIN, strict: false, root: None, scale: None, min_length: None, front_end }
    }
}

/// A body that was read from the description of a robot or a recorded skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The body.
    pub file: BodyFile,
    /// What it has in another way than the description, in a line each.
    pub notes: Vec<String>,
    /// The surfaces of its parts that stand for meshes, to draw them.
    pub surfaces: Vec<Surface>,
}

/// The surface of a mesh for which a part stands: fewer triangles than the mesh has, where it is fine.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// The part.
    pub part: usize,
    /// The corners of its triangles in the frame of the part, m.
    pub triangles: Vec<[Vector3; 3]>,
}
