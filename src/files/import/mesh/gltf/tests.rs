//! Test what a glTF file may hold beside what `every_format_gives_the_same_mesh` has, and what is refused.

use super::*;

/// A square of 1 m in the plane y = 0, by its corners in order: 48 bytes, and then its corners 0 to 3 as bytes.
fn bytes() -> Vec<u8> {
    let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let places = corners.iter().flatten().flat_map(|number| number.to_le_bytes());
    places.chain([0, 1, 3, 2]).collect()
}

/// A file with this node, and this primitive of the accessors 0 (positions) and 1 (indices).
fn text(node: &str, primitive: &str, uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0{node}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}{primitive}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
        {{"bufferView":0,"byteOffset":48,"componentType":5121,"count":4,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":52}}],"buffers":[{{"byteLength":52,"uri":"{uri}"}}]}}"#
    )
}

fn read_as(text: &str) -> Result<Vec<[Column<f64>; 3]>, Wrong> {
    triangles(text.as_bytes(), Path::new("nowhere/m.gltf"), 1000)
}

fn embedded(node: &str, primitive: &str) -> Vec<[Column<f64>; 3]> {
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes()));
    read_as(&text(node, primitive, &uri)).unwrap()
}

/// The sum of twice the area of each triangle times its normal.
fn area(triangles: &[[Column<f64>; 3]]) -> Column<f64> {
    triangles.iter().map(|[a, b, c]| (b - a).cross(&(c - a))).sum()
}

#[test]
fn strips_and_fans_are_triangles_that_look_the_same_way() {
    // Seen from its y, which is up, the square goes round counterclockwise.
    for primitive in [r#","indices":1,"mode":5"#, r#","mode":6"#] {
        let found = embedded("", primitive);
        assert_eq!((found.len(), area(&found)), (2, Column::new(0.0, 0.0, 2.0)), "{primitive}");
    }
    // Four corners are one triangle, and one corner too many.
    assert_eq!(embedded("", "").len(), 1);
    assert!(embedded("", r#","mode":1"#).is_empty());
}

#[test]
fn nodes_move_turn_and_stretch() {
    let first = |node: &str| embedded(node, r#","mode":6"#)[0][1];
    // The second corner, (0, 0, 1) in the file.
    assert_eq!(first(""), Column::new(0.0, -1.0, 0.0));
    assert_eq!(first(r#","translation":[1,2,3],"scale":[1,1,5]"#), Column::new(1.0, -8.0, 2.0));
    let turned = first(r#","rotation":[1,0,0,1]"#);
    assert!((turned - Column::new(0.0, 0.0, -1.0)).norm() < 1e-12, "{turned}");
    assert_eq!(first(r#","matrix":[1,0,0,0,0,1,0,0,0,0,2,0,7,8,9,1]"#), Column::new(7.0, -11.0, 8.0));
}

#[test]
fn a_buffer_may_be_beside_the_file_and_nowhere_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    std::fs::write(folder.path().join("m one.bin"), bytes()).unwrap();
    let read_as = |uri: &str, most| triangles(text("", r#","mode":6"#, uri).as_bytes(), &path, most);
    for uri in ["m%20one.bin", "./m one.bin", "%6D%20one.bin"] {
        assert_eq!(read_as(uri, 1000).unwrap().len(), 2, "{uri}");
    }
    for (uri, most, wrong) in [
        ("m%20one.bin", 51, "has its buffer in m one.bin, which has 52 bytes, but at most 51 are read"),
        (".", 1000, "has its buffer in ., which is no file"),
        ("gone.bin", 1000, "has its buffer in gone.bin, which cannot be read"),
        ("../m.bin", 1000, "has its buffer in ../m.bin, which is not beside it"),
        ("%ff.bin", 1000, "whose name is no text"),
        ("/etc/passwd", 1000, "is not beside it"),
        ("data:text/plain,abc", 1000, "not in base64"),
        ("data:;base64,#", 1000, "no base64"),
    ] {
        let found = read_as(uri, most).unwrap_err();
        assert!(found.contains(wrong), "{uri}: {found}");
    }
}

#[test]
fn a_mirrored_node_looks_outward_still_and_looks_alone_may_need_extensions() {
    let square = area(&embedded("", r#","mode":6"#));
    let mirrored = area(&embedded(r#","scale":[-1,1,1]"#, r#","mode":6"#));
    assert_eq!((square, mirrored), (Column::new(0.0, 0.0, 2.0), Column::new(0.0, 0.0, 2.0)));
    let uri = format!("data:;base64,{}", STANDARD.encode(bytes()));
    let text = text("", r#","mode":6"#, &uri);
    let with = text.replacen(r#""asset""#, r#""extensionsRequired":["KHR_texture_basisu"],"asset""#, 1);
    assert_eq!(read_as(&with).unwrap(), read_as(&text).unwrap());
}

#[test]
fn what_cannot_be_read_is_named() {
    let whole = text("", "", &format!("data:;base64,{}", STANDARD.encode(bytes())));
    for (from, to, wrong) in [
        (r#""asset""#, r#""extensionsRequired":["KHR_draco"],"asset""#, "needs the extension KHR_draco"),
        (r#""asset""#, r#""scene":1,"asset""#, "a scene that is not there"),
        (r#""buffers":["#, r#""buffers":[{},"#, "a buffer without its bytes"),
        (r#""mesh":0"#, r#""mesh":3"#, "a mesh that is not there"),
        (r#""mesh":0"#, r#""mesh":0,"children":[1,1]"#, "a node that is not there"),
        (r#""nodes":[{"#, r#""nodes":[{"children":[1,1]},{"#, "a node in two places"),
        (r#""POSITION":0"#, r#""POSITION":9"#, "an accessor that is not there"),
        (r#""POSITION":0"#, r#""POSITION":1"#, "a VEC3 of a type that is not read"),
        ("\"count\":4", "\"count\":5", "a buffer that is cut off"),
        ("\"count\":4", "\"count\":0", "a buffer that is cut off"),
        ("\"count\":4", "\"count\":4611686018427387904", "more than 10000000 triangles"),
        ("\"byteLength\":52}],\"buffers\"", "\"byteLength\":53}],\"buffers\"", "a buffer that is cut off"),
        (
            "\"byteLength\":52}],\"buffers\"",
            "\"byteLength\":52,\"byteStride\":0}],\"buffers\"",
            "a buffer that is cut off",
        ),
        ("5126,", "5126,\"sparse\":{},", "sparse accessors"),
        ("[{", "[", "is no glTF 2.0"),
    ] {
        assert!(whole.contains(from), "{from}");
        let found = read_as(&whole.replacen(from, to, 1)).unwrap_err();
        assert!(found.contains(wrong), "{to}: {found}");
    }
}
