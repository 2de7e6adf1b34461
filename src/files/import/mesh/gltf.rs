//! Read the triangles of a glTF 2.0 file (Khronos 2021): .gltf, with its buffers in it or beside it, and .glb.
//!
//! glTF's y-axis points up, and that of a robot's description is its z-axis; so, as Drake does, y becomes z.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Component, Path};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3 as Column};
use serde::Deserialize;

use super::{MOST_TRIANGLES, look_outward, too_many};
use crate::files::import::document::Wrong;

/// Types of numbers in buffers.
const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;
/// How extensions begin that change only what a surface looks like.
const ONLY_LOOKS: [&str; 3] = ["KHR_texture_", "KHR_materials_", "KHR_lights_"];
/// What three successive corners are: a triangle each, a strip of triangles, or a fan of them. All else has no surface.
const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Document {
    extensions_required: Vec<String>,
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: Vec<Buffer>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    mesh: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    /// By columns.
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    /// x, y, z, w.
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    shape: String,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
struct Buffer {
    uri: Option<String>,
}

/// The triangles of the scene that is shown, in m. `path` is that of the file, whose buffers may be beside it.
pub(super) fn triangles(bytes: &[u8], path: &Path, most_bytes: u64) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
    let (text, own) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let document: Document =
        serde_json::from_slice(text).map_err(|error| format!("is no glTF 2.0: {error}"))?;
    let is_seen_only = |extension: &&String| ONLY_LOOKS.iter().any(|start| extension.starts_with(start));
    if let Some(extension) = document.extensions_required.iter().find(|one| !is_seen_only(one)) {
        return Err(format!("needs the extension {extension}, which is not read; export it without"));
    }
    let (mut buffers, mut left) = (Vec::new(), most_bytes);
    for (at, buffer) in document.buffers.iter().enumerate() {
        let bytes = match &buffer.uri {
            Some(uri) => Cow::Owned(buffer_at(uri, path, left)?),
            None => Cow::Borrowed(own.filter(|_| at == 0).ok_or("has a buffer without its bytes")?),
        };
        left = left.saturating_sub(bytes.len() as u64);
        buffers.push(bytes);
    }
    Reader { buffers, document, triangles: Vec::new() }.read()
}

/// The two chunks of a .glb: its text, and its bytes, if it has any.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Wrong> {
    let short = || "is cut off, or no glTF 2.0".to_owned();
    let number = |at: usize| {
        let word = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes(word.try_into().ok()?) as usize)
    };
    let chunk = |at: usize| {
        let end = number(at)?.checked_add(at + 8)?;
        Some((bytes.get(at + 8..end)?, end))
    };
    let (text, end) = (number(4) == Some(2)).then(|| chunk(12)).flatten().ok_or_else(short)?;
    if end == bytes.len() {
        return Ok((text, None));
    }
    let (own, _) = chunk(end).ok_or_else(short)?;
    Ok((text, Some(own)))
}

/// A buffer that the text holds itself, or that is in a file beside it.
fn buffer_at(uri: &str, path: &Path, most_bytes: u64) -> Result<Vec<u8>, Wrong> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, code) =
            data.split_once(";base64,").ok_or("has a buffer that is not in base64; export it anew")?;
        return STANDARD.decode(code).map_err(|error| format!("has a buffer that is no base64: {error}"));
    }
    let name = decoded(uri).ok_or("has a buffer whose name is no text")?;
    let wrong = |what: String| format!("has its buffer in {}, which {what}", name.escape_debug());
    let is_beside =
        Path::new(&name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !is_beside {
        return Err(wrong("is not beside it; copy it there".to_owned()));
    }
    let file = path.parent().unwrap_or(Path::new("")).join(&name);
    let found = file.metadata().map_err(|error| wrong(format!("cannot be read: {error}")))?;
    if !found.is_file() {
        return Err(wrong("is no file".to_owned()));
    }
    let size = found.len();
    if size > most_bytes {
        return Err(wrong(format!("has {size} bytes, but at most {most_bytes} are read; simplify the mesh")));
    }
    std::fs::read(&file).map_err(|error| wrong(format!("cannot be read: {error}")))
}

/// A name in which `%20` and the like stand for a byte each; none if it is no text.
fn decoded(uri: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), uri.as_bytes());
    while let Some((&first, others)) = rest.split_first() {
        let code = others.get(..2).filter(|_| first == b'%').and_then(|code| std::str::from_utf8(code).ok());
        let byte = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(byte.unwrap_or(first));
        rest = if byte.is_some() { &others[2..] } else { others };
    }
    String::from_utf8(bytes).ok()
}

struct Reader<'a> {
    document: Document,
    buffers: Vec<Cow<'a, [u8]>>,
    triangles: Vec<[Column<f64>; 3]>,
}

impl Reader<'_> {
    /// The triangles of all nodes of the scene, or of all nodes that are in no other one if there is no scene.
    fn read(mut self) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
        let Document { nodes, scenes, scene, .. } = &self.document;
        let roots = match (scenes.get(scene.unwrap_or(0)), scene) {
            (Some(scene), _) => scene.nodes.clone(),
            (None, Some(_)) => return Err("has a scene that is not there".to_owned()),
            (None, None) => {
                let inner: BTreeSet<usize> =
                    nodes.iter().flat_map(|node| node.children.iter().copied()).collect();
                (0..nodes.len()).filter(|node| !inner.contains(node)).collect()
            }
        };
        // y becomes z.
        let upright = Matrix4::new(1., 0., 0., 0., 0., 0., -1., 0., 0., 1., 0., 0., 0., 0., 0., 1.);
        let mut open: Vec<(usize, Matrix4<f64>)> = roots.into_iter().map(|node| (node, upright)).collect();
        let mut seen = BTreeSet::new();
        while let Some((at, outer)) = open.pop() {
            let node = self.document.nodes.get(at).ok_or("has a node that is not there")?;
            if !seen.insert(at) {
                return Err("has a node in two places".to_owned());
            }
            let place = outer * place_of(node);
            open.extend(node.children.iter().map(|&child| (child, place)));
            if let Some(mesh) = node.mesh {
                self.add(mesh, &place)?;
            }
        }
        Ok(self.triangles)
    }

    /// Adds the triangles of a mesh at a place.
    fn add(&mut self, mesh: usize, place: &Matrix4<f64>) -> Result<(), Wrong> {
        let mesh = self.document.meshes.get(mesh).ok_or("has a node with a mesh that is not there")?;
        let mut new = Vec::new();
        for primitive in &mesh.primitives {
            let mode = primitive.mode.unwrap_or(TRIANGLES);
            let Some(position) = primitive.attributes.position.filter(|_| (TRIANGLES..=FAN).contains(&mode))
            else {
                continue;
            };
            let ends = self.document.accessors.get(primitive.indices.unwrap_or(position));
            let ends = ends.map_or(0, |accessor| accessor.count);
            let count = if mode == TRIANGLES { ends / 3 } else { ends.saturating_sub(2) };
            if self.triangles.len().saturating_add(new.len()).saturating_add(count) > MOST_TRIANGLES {
                return Err(too_many());
            }
            let corners: Vec<Column<f64>> = self
                .corners(position)?
                .into_iter()
                .map(|at| place.transform_point(&at.into()).coords)
                .collect();
            let order = match primitive.indices {
                Some(indices) => self.indices(indices)?,
                None => (0..corners.len()).collect(),
            };
            let corner = |at: usize| {
                let corner = corners.get(order[at]).copied();
                corner.ok_or_else(|| "has a triangle without a corner".to_owned())
            };
            for at in 0..count {
                let [a, b, c] = match mode {
                    STRIP => [at, at + 1 + at % 2, at + 2 - at % 2],
                    FAN => [0, at + 1, at + 2],
                    _ => [3 * at, 3 * at + 1, 3 * at + 2],
                };
                new.push([corner(a)?, corner(b)?, corner(c)?]);
            }
        }
        look_outward(&mut new, place);
        self.triangles.extend(new);
        Ok(())
    }

    /// The positions of an accessor.
    fn corners(&self, accessor: usize) -> Result<Vec<Column<f64>>, Wrong> {
        let values = self.values(accessor, "VEC3", |kind| (kind == F32).then_some(12))?;
        let number = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
        Ok(values.map(|own| Column::new(number(own), number(&own[4..]), number(&own[8..]))).collect())
    }

    /// The numbers of corners of an accessor.
    fn indices(&self, accessor: usize) -> Result<Vec<usize>, Wrong> {
        let size = |kind| match kind {
            U8 => Some(1),
            U16 => Some(2),
            U32 => Some(4),
            _ => None,
        };
        let values = self.values(accessor, "SCALAR", size)?;
        Ok(values.map(|own| own.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte))).collect())
    }

    /// The bytes of each value of an accessor, of this shape; `size` is how many bytes one has, if its type is read.
    fn values(
        &self,
        accessor: usize,
        shape: &str,
        size: impl Fn(u32) -> Option<usize>,
    ) -> Result<impl Iterator<Item = &[u8]>, Wrong> {
        let Document { accessors, buffer_views, .. } = &self.document;
        let accessor = accessors.get(accessor).ok_or("has an accessor that is not there")?;
        let view = accessor.buffer_view.filter(|_| accessor.sparse.is_none());
        let view = view.ok_or("has sparse accessors, which are not read; export it without")?;
        let view = buffer_views.get(view).ok_or("has a view of a buffer that is not there")?;
        let size = size(accessor.component_type).filter(|_| accessor.shape == shape);
        let size = size.ok_or_else(|| format!("has a {shape} of a type that is not read"))?;
        let stride = view.byte_stride.unwrap_or(size);
        let (start, count) = (accessor.byte_offset, accessor.count);
        let within = || -> Option<&[u8]> {
            let end = view.byte_offset.checked_add(view.byte_length)?;
            let bytes = self.buffers.get(view.buffer)?.get(view.byte_offset..end)?;
            let last = stride.checked_mul(count.checked_sub(1)?)?.checked_add(size)?;
            bytes.get(start..start.checked_add(last)?)
        };
        let bytes = within().filter(|_| stride >= size).ok_or("has a buffer that is cut off")?;
        Ok((0..count).map(move |at| &bytes[stride * at..][..size]))
    }
}

/// The place of a node in the frame of the one around it.
fn place_of(node: &Node) -> Matrix4<f64> {
    if let Some(matrix) = &node.matrix {
        return Matrix4::from_column_slice(matrix);
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    Matrix4::new_translation(&node.translation.unwrap_or_default().into())
        * UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&node.scale.unwrap_or([1.0; 3]).into())
}

#[cfg(test)]
mod tests;
