//! Read files of meshes: STL and OBJ, COLLADA (.dae), and MuJoCo's MSH.

use std::path::Path;

use mesh_loader::{Loader, Scene};
use nalgebra::Vector3 as Column;

use super::{Mesh, dae};
use crate::files::import::document::Wrong;

/// Most bytes of a file.
const MOST_BYTES: u64 = 512 << 20;

/// Reads a mesh, in the unit of its file (COLLADA: in m).
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
    let bytes = std::fs::read(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let kind = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    // Materials, which an OBJ may name, are of no interest.
    let loader = Loader::default().custom_reader(|_| Ok(Vec::new()));
    let scene = match &*kind {
        "stl" => loader.load_stl_from_slice(&bytes, name),
        "obj" => loader.load_obj_from_slice(&bytes, name),
        "dae" => {
            let text = String::from_utf8_lossy(&bytes);
            return dae::triangles(&text).and_then(Mesh::new).map_err(wrong);
        }
        "msh" => return msh(&bytes).map_err(wrong),
        _ => return Err(wrong("is none of .stl, .obj, .dae and .msh; convert it to one of them".to_owned())),
    };
    scene.map_err(|error| error.to_string()).and_then(|scene| Mesh::new(triangles(&scene)?)).map_err(wrong)
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
