//! Stamps provenance into the binary: the git revision, the compiler, and ODE's version.

use std::path::Path;
use std::process::Command;

fn main() {
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    // A path that is watched but missing would make every build a new one, and so would git's index, which git itself writes
    // again when it looks at files. The log of HEAD changes with each commit and checkout, and with nothing else.
    let log = output("git", &["rev-parse", "--git-path", "logs/HEAD"]);
    for path in ["src", "reproduce", "ode-sys", "Cargo.toml", "Cargo.lock"].into_iter().chain(log.as_deref())
    {
        if Path::new(path).exists() {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    let revision = packaged_revision().or_else(|| {
        output(
            "git",
            &["--no-optional-locks", "describe", "--always", "--exclude=*", "--dirty", "--abbrev=40"],
        )
    });
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
