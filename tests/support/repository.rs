//! Files of the repository.

use std::fs;
use std::path::{Path, PathBuf};

/// Path of a file or folder of the repository.
pub fn repository(name: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Text of a file of the repository.
#[track_caller]
pub fn read(name: impl AsRef<Path>) -> String {
    let path = repository(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// What is in a folder of the repository, in order.
pub fn entries(folder: &str) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(repository(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// The pages in Markdown that a reader comes to; generated ones stand in folders of `docs/shown`.
pub fn pages() -> Vec<PathBuf> {
    let named = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "tests/README.md",
        "benches/README.md",
        "python/README.md",
        "python/examples/README.md",
        "docs/shown/claims.md",
    ];
    let docs = entries("docs")
        .into_iter()
        .chain(entries("docs/shown/examples"))
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let shown =
        entries("docs/shown").into_iter().map(|path| path.join("README.md")).filter(|path| path.is_file());
    named.into_iter().map(repository).chain(docs).chain(shown).collect()
}
