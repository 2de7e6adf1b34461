//! Read files of meshes: STL, OBJ, COLLADA (.dae), glTF (.gltf, .glb), and MuJoCo's MSH.

use std::path::Path;

use mesh_loader::{Loader, Scene};
use nalgebra::Vector3 as Column;

use super::{MOST_TRIANGLES, Mesh, dae, gltf, too_many};
use crate::files::import::document::Wrong;

/// Most bytes of a file.
const MOST_BYTES: u64 = 512 << 20;

/// Reads a mesh, in the unit of its file (COLLADA, glTF: in m).
///
/// # Errors
/// If the file cannot be read, or holds no mesh of a known format.
pub(super) fn read(path: &Path) -> Result<Mesh, Wrong> {
    let name = Path::new(path.file_name().unwrap_or_default());
    let wrong = |what: String| format!("{}: {what}", name.display());
    let size = path.metadata().map_err(|error| wrong(format!("cannot be read: {error}")))?.len();
    if size > MOST_BYTES {
        return Err(wrong(format!("has {size} bytes, but at most {MOST_BYTES} are read; simplify it")));
    }
    let mut bytes = std::fs::read(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let kind = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if kind == "stl" {
        mark_binary(&mut bytes);
    }
    let text = || String::from_utf8_lossy(&bytes);
    let scene = match &*kind {
        "stl" => Loader::default().load_stl_from_slice(&bytes, name),
        "obj" => return obj(&text()).and_then(Mesh::new).map_err(wrong),
        "dae" => return dae::triangles(&text()).and_then(Mesh::new).map_err(wrong),
        "gltf" | "glb" => {
            return gltf::triangles(&bytes, path, MOST_BYTES).and_then(Mesh::new).map_err(wrong);
        }
        "msh" => return msh(&bytes).map_err(wrong),
        _ => {
            return Err(wrong(
                "is none of .stl, .obj, .dae, .gltf, .glb and .msh; convert it to one of them".to_owned(),
            ));
        }
    };
    scene.map_err(|error| error.to_string()).and_then(|scene| Mesh::new(triangles(&scene)?)).map_err(wrong)
}

/// Many binary STL begin with `solid`, as text does. Their length tells them apart: a header of 80 bytes, the number of triangles, and 50
/// bytes for each.
fn mark_binary(bytes: &mut [u8]) {
    let Some((header, rest)) = bytes.split_first_chunk_mut::<80>() else { return };
    let Some((count, triangles)) = rest.split_first_chunk::<4>() else { return };
    if triangles.len() as u64 == 50 * u64::from(u32::from_le_bytes(*count)) {
        header.fill(0);
    }
}

fn triangles(scene: &Scene) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
    let mut triangles = Vec::new();
    for mesh in &scene.meshes {
        for face in &mesh.faces {
            let corner = |at: u32| {
                let place = mesh.vertices.get(at as usize).ok_or("has a triangle without a corner")?;
                Ok::<_, Wrong>(Column::from(place.map(f64::from)))
            };
            let [a, b, c] = *face;
            triangles.push([corner(a)?, corner(b)?, corner(c)?]);
        }
    }
    Ok(triangles)
}

/// Vertices and faces of an OBJ; all else that it has is of no interest. A face of more than three corners is cut into a fan.
fn obj(text: &str) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
    let (mut places, mut triangles) = (Vec::new(), Vec::new());
    for (line, words) in text.lines().enumerate() {
        let wrong = |what: &str| format!("line {}: {what}", line + 1);
        let mut words = words.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Option<Vec<f64>> = words.take(3).map(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers.unwrap_or_default()[..] else {
                    return Err(wrong("a vertex (v) needs three numbers"));
                };
                places.push(Column::new(x, y, z));
            }
            Some("f") => {
                // The index of a vertex comes first, from 1 on, or from -1 backwards.
                let corner = |word: &str| {
                    let index: i64 = word.split('/').next()?.parse().ok()?;
                    let at = if index < 0 { places.len() as i64 + index } else { index - 1 };
                    places.get(usize::try_from(at).ok()?).copied()
                };
                let corners: Option<Vec<Column<f64>>> = words.map(corner).collect();
                let corners =
                    corners.ok_or_else(|| wrong("a face (f) has a corner that is no vertex before it"))?;
                triangles.extend((2..corners.len()).map(|at| [corners[0], corners[at - 1], corners[at]]));
                if triangles.len() > MOST_TRIANGLES {
                    return Err(too_many());
                }
            }
            _ => {}
        }
    }
    Ok(triangles)
}

/// MuJoCo's own format: the numbers of vertices, normals, texture coordinates and faces, then these.
fn msh(bytes: &[u8]) -> Result<Mesh, Wrong> {
    let short = || "is cut off, or no MSH".to_owned();
    let (words, _) = bytes.as_chunks::<4>();
    let (counts, rest) = words.split_first_chunk::<4>().ok_or_else(short)?;
    let [vertices, normals, textures, faces] = counts.map(|word| u64::from(u32::from_le_bytes(word)));
    let (first, last) = (3 * vertices, 3 * (vertices + normals) + 2 * textures);
    if last + 3 * faces != rest.len() as u64 {
        return Err(short());
    }
    let [first, last] = [first, last].map(|at| at as usize);
    let places: Vec<Column<f64>> = rest[..first]
        .as_chunks()
        .0
        .iter()
        .map(|words: &[[u8; 4]; 3]| Column::from(words.map(|word| f64::from(f32::from_le_bytes(word)))))
        .collect();
    let corner = |word: [u8; 4]| {
        let place = places.get(u32::from_le_bytes(word) as usize).copied();
        place.ok_or_else(|| "has a triangle without a corner".to_owned())
    };
    let triangle = |[a, b, c]: &[[u8; 4]; 3]| Ok([corner(*a)?, corner(*b)?, corner(*c)?]);
    Mesh::new(rest[last..].as_chunks().0.iter().map(triangle).collect::<Result<_, Wrong>>()?)
}
