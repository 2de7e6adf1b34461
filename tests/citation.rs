//! `CITATION.cff` is valid by cffconvert (skipped with a message where it is not installed), and names this version.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

/// Whether cffconvert accepts a file; None if there is no cffconvert.
fn valid(file: &Path) -> Option<(bool, String)> {
    match Command::new("cffconvert").arg("--validate").arg("-i").arg(file).output() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            eprintln!("skipped: cffconvert is missing (pip install -r tests/requirements.txt)");
            None
        }
        output => {
            let output = output.unwrap();
            Some((output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned()))
        }
    }
}

fn citation() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("CITATION.cff")).unwrap()
}

#[test]
fn the_citation_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("CITATION.cff");
    fs::write(&file, citation()).unwrap();
    let Some((accepted, said)) = valid(&file) else { return };
    assert!(accepted, "{said}");
    fs::write(&file, citation().replace("type: article", "type: paper")).unwrap();
    assert!(!valid(&file).unwrap().0, "a type that does not exist");
}

#[test]
fn the_citation_names_this_version() {
    assert!(citation().contains(concat!("\nversion: ", env!("CARGO_PKG_VERSION"), "\n")));
}
