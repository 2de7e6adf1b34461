//! Read a file of any kind, and check that it is a body.

use std::path::Path;

use super::document::Wrong;
use super::document::parsed;
use super::joined::{Joined, joined};
use super::located::Located;
use super::notes::at_one_place;
use super::options::{Imported, Options};
use super::placed::Read;
use super::skeleton::body_of_skeleton;
use super::text::written_out;
use super::{mjcf, urdf};
use crate::files::body::{BodyFile, write_body};
use crate::files::bvh::read_bvh;
use crate::files::error::FileError;
use crate::files::whole::is_same_file;
use crate::stages::agent::{Agent, Part};

/// Extent of a body, m, from which on a note asks for its unit.
const LARGE: f64 = 20.0;

/// Reads MJCF or URDF, or the skeleton of a BVH file, which its name tells, as a body.
///
/// # Errors
/// If the file cannot be read, or is no body, or an option is for another kind: the message says what is wrong and what to do.
pub fn import(path: &Path, options: &Options) -> Result<Imported, FileError> {
    let is_skeleton = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bvh"));
    let Options { root, strict, scale, min_length, front_end, .. } = options;
    let alien = if is_skeleton {
        [root.is_some().then_some("root"), strict.then_some("strict")]
    } else {
        [scale.map(|_| "scale"), min_length.map(|_| "min-length")]
    };
    let made = if let Some(option) = alien.into_iter().flatten().next() {
        let [own, other] =
            ["recorded movements, whose names end in .bvh", "robots, and this is a recorded movement"];
        let kind = if is_skeleton { other } else { own };
        Err(format!("{} is for {kind}; leave it out", front_end.name(option)))
    } else if is_skeleton {
        body_of_skeleton(&read_bvh(path)?, options)
    } else {
        let files = Located::beside(path);
        written_out(path, &files).and_then(|text| imported(&text, &files, options))
    };
    made.map_err(|message| FileError::new(path, message))
}

/// Reads a body as [`import`] does, and writes it into the file `out`.
///
/// # Errors
/// As [`import`], or if the file cannot be written or is the one that is read.
pub fn import_into(path: &Path, out: &Path, options: &Options) -> Result<Imported, FileError> {
    if is_same_file(path, out) {
        let message = format!("is the input file; give another {}", options.front_end.name("out"));
        return Err(FileError::new(out, message));
    }
    let imported = import(path, options)?;
    let name = path.file_name().unwrap_or_default();
    write_body(out, &format!("Imported from {name:?}."), &imported.file)?;
    Ok(imported)
}

fn imported(text: &str, files: &Located, options: &Options) -> Result<Imported, Wrong> {
    let document = parsed(text)?;
    let root = document.root_element();
    let (word, Read { links, mut notes }) = match root.tag_name().name() {
        "mujoco" => ("body", mjcf::links(root, files, options.strict)?),
        "robot" => ("link", urdf::links(root, files, options.strict)?),
        other => {
            return Err(format!("its root is <{other}>, but must be <mujoco> (MJCF) or <robot> (URDF)"));
        }
    };
    let Joined { parts, surfaces, notes: more } = joined(word, links, options)?;
    notes.extend(more);
    let file = BodyFile { density: None, skin: Some(options.skin), parts };
    let body = file.body()?;
    notes.extend(far(&body.agent));
    notes.extend(at_one_place(&body.agent.truth(), Some(&body.rigid_names())));
    Ok(Imported { file, notes, surfaces })
}

/// Says if a body is larger than any robot: then its lengths may be in another unit.
fn far(agent: &Agent) -> Option<String> {
    let reach = |axis: usize| {
        let along = |part: &Part| part.centre[axis];
        let most = agent.parts.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
        let largest = agent.parts.iter().map(|part| part.shape.half_length()).fold(0.0, f64::max);
        most - agent.parts.iter().map(along).fold(f64::INFINITY, f64::min) + largest
    };
    let span = (0..3).map(reach).fold(0.0, f64::max);
    (span > LARGE).then(|| {
        format!("the body spans {span:.0} m; if its lengths or meshes are in millimetres, give them in m (scale=\"0.001 0.001 0.001\")")
    })
}

#[cfg(test)]
mod tests;
