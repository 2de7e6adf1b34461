//! The packages hold what a build needs and little more, nothing that they depend on needs a younger Rust than they say, and
//! tests and program are one build.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::support::repository::{read, repository};
use crate::support::said::Said;

/// Largest package, in bytes before it is compressed.
const BYTES: u64 = 2_100_000;

fn cargo(arguments: &str) -> String {
    let mut command = Command::new(env!("CARGO"));
    let said = Said::by(command.current_dir(repository("")).args(arguments.split(' ')));
    assert_eq!(said.status, Some(0), "{}", said.err);
    said.out
}

fn packaged(package: &str) -> BTreeSet<String> {
    let list = cargo(&format!("package --list --allow-dirty --offline --package {package}"));
    list.lines().map(str::to_owned).collect()
}

/// Sum of the sizes of files that are in the repository.
fn bytes(files: &BTreeSet<String>, folder: &Path) -> u64 {
    files.iter().filter_map(|file| fs::metadata(folder.join(file)).ok()).map(|file| file.len()).sum()
}

/// Files that a source file takes in, by their path in the package.
fn taken_in(file: &str) -> Vec<String> {
    let text = read(file);
    let names = text.split("include_str!(\"").skip(1).filter_map(|rest| rest.split_once('"')).map(|it| it.0);
    let folder = Path::new(file).parent().unwrap();
    let path = |name: &str| repository(folder).join(name).canonicalize().unwrap();
    let within =
        |name: &str| path(name).strip_prefix(repository("").canonicalize().unwrap()).unwrap().to_owned();
    names.map(|name| within(name).display().to_string()).collect()
}

#[test]
fn the_packages_hold_what_a_build_needs_and_little_more() {
    let of_program = packaged("bodyschema");
    let sources = of_program.iter().filter(|file| file.starts_with("src/") && file.ends_with(".rs"));
    let needed: Vec<String> = sources.flat_map(|file| taken_in(file)).collect();
    assert!(needed.contains(&"reproduce/paper.toml".to_owned()), "{needed:?}");
    let missing: Vec<&String> = needed.iter().filter(|file| !of_program.contains(*file)).collect();
    assert!(missing.is_empty(), "{missing:?}");

    let of_bindings = packaged("ode-sys");
    for (files, folder) in [(&of_program, repository("")), (&of_bindings, repository("ode-sys"))] {
        for file in ["Cargo.toml", "README.md", "LICENSE-MIT", "LICENSE-APACHE", "build.rs", "src/lib.rs"] {
            assert!(files.contains(file), "{file}: {files:?}");
        }
        assert!(bytes(files, &folder) < BYTES, "{} bytes", bytes(files, &folder));
    }
    let others = ["docs/", "tests/", "fuzz/", "article/", "benches/", "examples/"];
    let superfluous =
        |file: &&String| !needed.contains(file) && others.iter().any(|other| file.starts_with(other));
    assert_eq!(of_program.iter().find(superfluous), None);
    assert!(superfluous(&&"docs/reference.md".to_owned()));
}

/// A version of Rust as numbers; 0 where none is stated.
fn rust_version(package: &Value) -> Vec<u32> {
    let stated = package["rust_version"].as_str().unwrap_or("0");
    stated.split('.').map(|number| number.parse().unwrap()).collect()
}

/// Names of packages that need a younger Rust than `oldest`.
fn younger(packages: &[Value], oldest: &[u32]) -> Vec<String> {
    let needs_younger = |package: &&Value| rust_version(package) > oldest.to_vec();
    packages.iter().filter(needs_younger).map(|package| package["name"].to_string()).collect()
}

/// Clippy sees what the code itself uses of the standard library (`incompatible_msrv`).
#[test]
fn no_dependency_needs_a_younger_rust() {
    // Without the Python package, whose dependencies need not be there.
    let folder = tempfile::tempdir().unwrap();
    for name in ["src", "ode-sys", "build.rs", "benches", "examples", "tests"] {
        std::os::unix::fs::symlink(repository(name).canonicalize().unwrap(), folder.path().join(name))
            .unwrap();
    }
    let manifest =
        read("Cargo.toml").replace(r#"members = ["ode-sys", "python"]"#, r#"members = ["ode-sys"]"#);
    fs::write(folder.path().join("Cargo.toml"), manifest).unwrap();
    fs::copy(repository("Cargo.lock"), folder.path().join("Cargo.lock")).unwrap();
    let text = cargo(&format!(
        "metadata --format-version 1 --offline --filter-platform x86_64-unknown-linux-gnu --manifest-path {}",
        folder.path().join("Cargo.toml").display()
    ));
    let metadata: Value = serde_json::from_str(&text).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let own = packages.iter().find(|package| package["name"] == "bodyschema").unwrap();
    assert!(packages.len() > 50 && packages.iter().all(|package| package["name"] != "pyo3"));
    assert_eq!(younger(packages, &rust_version(own)), [""; 0]);
    assert!(younger(packages, &[1, 70]).contains(&"\"bodyschema\"".to_owned()), "what is younger is seen");
}

/// The packages of the program and their features, as a build of the program or of its tests has them.
fn features(edges: &str) -> BTreeSet<String> {
    let tree = cargo(&format!(
        "tree --package bodyschema --locked --offline --edges {edges} --prefix none --no-dedupe --format {{p}}[{{f}}]"
    ));
    tree.lines().map(str::to_owned).collect()
}

/// Otherwise whoever runs an experiment after the tests, or the other way round, waits for a second build of all that differs.
#[test]
fn tests_ask_no_package_of_the_program_for_other_features() {
    let (program, tests) = (features("normal,build"), features("normal,build,dev"));
    assert!(program.len() > 50 && tests.len() > program.len());
    assert_eq!(program.difference(&tests).collect::<Vec<_>>(), [""; 0], "give Cargo.toml the same features");
}
