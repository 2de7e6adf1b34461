//! Stamps provenance into the binary: the git revision, the compiler, and ODE's version.

use std::process::Command;

fn main() {
    for path in ["src", "reproduce", "ode-sys", "Cargo.toml", "Cargo.lock", ".git/HEAD", ".git/index"] {
        println!("cargo:rerun-if-changed={path}");
    }
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let revision =
        packaged_revision().or_else(|| output("git", &["describe", "--always", "--dirty", "--abbrev=40"]));
    let rustc = output(&std::env::var("RUSTC").unwrap_or("rustc".into()), &["--version"]);
    let ode = std::env::var("DEP_ODE_VERSION").expect("ode-sys's build script reports ODE's version");
    println!("cargo:rustc-env=BODYSCHEMA_REVISION={}", revision.as_deref().unwrap_or("unknown"));
    println!("cargo:rustc-env=BODYSCHEMA_RUSTC={}", rustc.as_deref().unwrap_or("unknown"));
    println!("cargo:rustc-env=BODYSCHEMA_ODE_VERSION={ode}");
}

/// The revision that cargo wrote into a package. A repository that the package was unpacked into is another one.
fn packaged_revision() -> Option<String> {
    let text = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let (_, rest) = text.split_once("\"sha1\": \"")?;
    let (revision, _) = rest.split_once('"')?;
    let dirty = if text.contains("\"dirty\": true") { "-dirty" } else { "" };
    Some(format!("{revision}{dirty}"))
}
