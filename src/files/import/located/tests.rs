//! Test where the files of a description are looked for.

use std::fs;

use super::*;

#[test]
fn files_are_found_beside_the_description_and_in_packages() {
    let folder = tempfile::tempdir().unwrap();
    let at = |path: &str| folder.path().join(path);
    for path in
        ["a/b/c/d/robot/urdf/r.urdf", "a/b/c/d/robot/meshes/m.stl", "a/b/c/d/hand/meshes/h.stl", "a/far.stl"]
    {
        fs::create_dir_all(at(path).parent().unwrap()).unwrap();
        fs::write(at(path), "").unwrap();
    }
    let files = Located::beside(&at("a/b/c/d/robot/urdf/r.urdf"));
    let found = |name: &str| files.find("", name).unwrap().map(|path| path.file_name().unwrap().to_owned());
    for name in [
        "../meshes/m.stl",
        "package://robot/meshes/m.stl",
        "package://renamed/meshes/m.stl",
        "..\\meshes\\m.stl",
    ] {
        assert_eq!(found(name).unwrap(), "m.stl", "{name}");
    }
    assert_eq!(found("package://hand/meshes/h.stl").unwrap(), "h.stl");
    assert_eq!(files.find("../meshes", "m.stl").unwrap(), files.find("", "../meshes/m.stl").unwrap());
    assert!(found("m.stl").is_none() && found("package://robot").is_none());
    // An umlaut in Latin-1 on the disk.
    fs::write(at("a/b/c/d/robot/meshes").join(OsString::from_vec(b"t\xfcr.stl".to_vec())), "").unwrap();
    for name in ["../meshes/tür.stl", "package://robot/meshes/tür.stl"] {
        assert_eq!(found(name).unwrap().into_vec(), b"t\xfcr.stl", "{name}");
    }
    assert!(found("../meshes/t\u{3c9}r.stl").is_none());
    let far = files.find("", "../../../../../far.stl").unwrap_err();
    assert!(far.contains("far.stl`, more than 4 folders above") && far.contains("copy it beside"), "{far}");
    assert!(files.find("", "https://x/m.stl").unwrap_err().contains("https:// is not read"));
}
