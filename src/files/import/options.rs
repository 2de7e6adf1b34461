//! How the description of a robot becomes a body, and what comes of it.

use crate::files::body::{BodyFile, SkinEntry};

/// Skin of each part of an imported body, if the user says nothing.
pub const SKIN: SkinEntry = SkinEntry { sensors: Some(40), per_area: None };

/// How the description of a robot becomes a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Skin of each part.
    pub skin: SkinEntry,
    /// Whether what a body cannot have is refused, and not changed with a note.
    pub strict: bool,
    /// The body or link whose tree is the body; otherwise it is the largest tree.
    pub root: Option<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self { skin: SKIN, strict: false, root: None }
    }
}

/// A body that was read from the description of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The body.
    pub file: BodyFile,
    /// What it has in another way than the description, in a line each.
    pub notes: Vec<String>,
}
