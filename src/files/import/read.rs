//! Read a file of either kind, and check that it is a body.

use std::path::Path;

use roxmltree::Document;

use super::joined::joined;
use super::xml::Wrong;
use super::{mjcf, urdf};
use crate::files::body::{BodyFile, SkinEntry};
use crate::files::error::FileError;
use crate::files::whole::read_text;

/// Skin of each part of an imported body, if the user says nothing.
pub const SKIN: SkinEntry = SkinEntry { sensors: Some(40), per_area: None };

/// A body that was read from the description of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The body.
    pub file: BodyFile,
    /// What it has in another way than the description, in a line each.
    pub notes: Vec<String>,
}

/// Reads MJCF or URDF, whichever it is, as a body with this skin.
///
/// # Errors
/// If the file cannot be read, or is no body: the message says what is wrong and what to do.
pub fn import(path: &Path, skin: SkinEntry) -> Result<Imported, FileError> {
    imported(&read_text(path)?, skin).map_err(|message| FileError::new(path, message))
}

fn imported(text: &str, skin: SkinEntry) -> Result<Imported, Wrong> {
    let document = Document::parse(text)
        .map_err(|error| format!("this is not well-formed XML, as MJCF and URDF must be: {error}"))?;
    let root = document.root_element();
    let (parts, notes) = match root.tag_name().name() {
        "mujoco" => joined("body", &mjcf::links(root)?)?,
        "robot" => joined("link", &urdf::links(root)?)?,
        other => {
            return Err(format!("its root is <{other}>, but must be <mujoco> (MJCF) or <robot> (URDF)"));
        }
    };
    let file = BodyFile { density: None, skin: Some(skin), parts };
    file.body()?;
    Ok(Imported { file, notes })
}

#[cfg(test)]
mod tests;
