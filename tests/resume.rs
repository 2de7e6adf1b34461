//! Runs that are killed, interrupted or damaged end with the same files as one that is left alone.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::LazyLock;
use std::time::Duration;

use bodyschema::numerics::rng::stream;
use rand::RngExt;

use crate::support::folder::Folder;
use crate::support::said::Said;
use crate::support::small::small;

/// Both experiments in a second or two, in more parts.
const PARTS: &str = "
schema.sweeps = 100
experiment.coordinations = [0.5, 0.9]
experiment.dimension = 4
experiment.simulations = 2
";

/// The files of experiment 1 that is left alone.
static WHOLE: LazyLock<BTreeMap<String, Vec<u8>>> = LazyLock::new(|| {
    let folder = folder_with_settings();
    assert_eq!(finish(&folder, "exp1", "whole"), "");
    folder.files("whole")
});

fn folder_with_settings() -> Folder {
    let folder = Folder::new();
    folder.write("small.toml", small(PARTS));
    folder
}

fn start(folder: &Folder, arguments: &str) -> Child {
    let mut command = folder.command(&format!("reproduce {arguments}"));
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Runs to the end, and returns what it said of trouble.
fn finish(folder: &Folder, experiment: &str, out: &str) -> String {
    folder.reproduce(&format!("{experiment} --settings small.toml --out {out}")).err
}

fn ended(child: &mut Child, within: Duration) -> Option<ExitStatus> {
    const STEP: Duration = Duration::from_millis(2);
    for _ in 0..=within.as_millis() / STEP.as_millis() {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        std::thread::sleep(STEP);
    }
    None
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_files() {
    let folder = folder_with_settings();
    let mut rng = stream(1, 1, "kills", 0);
    // `BODYSCHEMA_ROUNDS=40 cargo test --test suite resume -- --nocapture` kills for some minutes.
    let rounds: usize = std::env::var("BODYSCHEMA_ROUNDS").map_or(2, |rounds| rounds.parse().unwrap());
    let mut all_kills = 0;
    for experiment in ["exp1", "exp2"] {
        assert_eq!(finish(&folder, experiment, experiment), "");
        let expected = folder.files(experiment);
        assert!(
            expected.keys().all(|name| !name.starts_with("checkpoints/")),
            "they go when a run is finished"
        );
        for round in 0..rounds {
            let out = format!("{experiment}-{round}");
            let mut kills = 0;
            loop {
                let mut child = start(&folder, &format!("{experiment} --settings small.toml --out {out}"));
                // Ever longer, so that even a slow machine finishes at last.
                let longest = 400 << (kills / 3);
                let moment = Duration::from_millis(rng.random_range(1..longest));
                if let Some(status) = ended(&mut child, moment) {
                    assert!(status.code().unwrap() <= 1, "{status:?}");
                    break;
                }
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
            }
            assert!(kills > 0, "at least one kill is well before the end");
            println!("{kills} kills");
            folder.has_files(&out, &expected);
            all_kills += kills;
        }
    }
    println!("{all_kills} kills in {} runs", 2 * rounds);
}

#[test]
fn a_full_disk_is_an_error_and_the_run_goes_on_when_there_is_room() {
    let folder = folder_with_settings();
    // The shell's limit on the size of a file fails a write as a full disk does.
    for kilobytes in [0, 1, 4, 20, 60] {
        let program = env!("CARGO_BIN_EXE_bodyschema");
        let limited = format!(
            "trap '' XFSZ; ulimit -f {kilobytes}; exec {program} reproduce exp1 --settings small.toml --out full"
        );
        let said = Said::by(Command::new("bash").args(["-c", &limited]).current_dir(folder.path()));
        assert_eq!(said.status, Some(2), "{kilobytes} kB: {said:?}");
        assert!(said.err.lines().last().unwrap().contains("cannot be written"), "{kilobytes} kB: {said:?}");
        assert!(folder.files("full").keys().all(|name| !name.ends_with(".partial")), "{said:?}");
    }
    finish(&folder, "exp1", "full");
    folder.has_files("full", &WHOLE);
}

/// Starts experiment 1 and leaves it once it has this part.
fn leave_after(folder: &Folder, out: &str, part: &str, signal: &str) -> ExitStatus {
    let mut child = start(folder, &format!("exp1 --settings small.toml --out {out}"));
    let part = folder.at(out).join("checkpoints").join(part);
    while !part.exists() {
        assert!(child.try_wait().unwrap().is_none(), "{} was there before the end", part.display());
        std::thread::sleep(Duration::from_millis(1));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args([signal, &pid]).status().unwrap().success());
    child.wait().unwrap()
}

#[test]
fn damaged_and_foreign_parts_are_done_again_with_a_line_that_says_so() {
    let folder = folder_with_settings();
    leave_after(&folder, "cut", "simulation-1/dpgmm-lj-2.json", "-KILL");
    let part = "cut/checkpoints/simulation-1/dpgmm-2.json";
    let bytes = folder.bytes(part);
    folder.write(part, &bytes[..bytes.len() / 2]);
    let said = finish(&folder, "exp1", "cut");
    assert!(said.contains("dpgmm-2.json: is not a checkpoint; this part is run again"), "{said}");
    assert!(said.contains("continuing from what an earlier run finished"), "{said}");
    folder.has_files("cut", &WHOLE);
    // A run that is finished is made anew.
    assert_eq!(finish(&folder, "exp1", "cut"), "");
    folder.has_files("cut", &WHOLE);

    // A body map of another simulation.
    leave_after(&folder, "swapped", "simulation-1/dpgmm-lj-2.json", "-KILL");
    folder.write("swapped/simulation-1/body-map.npy", &WHOLE["simulation-2/body-map.npy"]);
    let said = finish(&folder, "exp1", "swapped");
    assert!(said.contains("body-map.npy: has changed or is missing; it is computed again"), "{said}");
    folder.has_files("swapped", &WHOLE);

    leave_after(&folder, "other", "simulation-1/dpgmm-lj-2.json", "-KILL");
    folder.write("other.toml", small(&format!("{PARTS}experiment.seed = 6")));
    let said = folder.reproduce("exp1 --settings other.toml --out other").err;
    assert!(said.contains("other settings or of another version of the program are ignored"), "{said}");
    folder.reproduce("exp1 --settings other.toml --out whole-other");
    folder.has_files("other", &folder.files("whole-other"));
}

#[test]
fn a_map_for_each_dimension_is_taken_up_again() {
    let folder = Folder::new();
    folder.write("small.toml", small(&format!("{PARTS}map.method = \"nonmetric\"")));
    assert_eq!(finish(&folder, "exp1", "whole"), "");
    let expected = folder.files("whole");
    for (map, is_there) in [("body-map-2", true), ("body-map-4", true), ("body-map", false)] {
        assert_eq!(expected.contains_key(&format!("simulation-1/{map}.npy")), is_there, "{map}");
    }
    let manifest: serde_json::Value = serde_json::from_slice(&expected["manifest.json"]).unwrap();
    let improvements = manifest["bodies"][0]["facts"]["improvements"].as_array().unwrap();
    assert_eq!(improvements.len(), 2);
    assert!(improvements.iter().all(|d| d["stress"].as_f64().unwrap() < d["start"].as_f64().unwrap()));

    leave_after(&folder, "left", "simulation-1/dpgmm-2.json", "-KILL");
    let said = finish(&folder, "exp1", "left");
    assert!(said.contains("continuing from") && !said.contains("again"), "{said}");
    folder.has_files("left", &expected);
    leave_after(&folder, "lost", "simulation-1/dpgmm-2.json", "-KILL");
    fs::remove_file(folder.at("lost/simulation-1/body-map-2.npy")).unwrap();
    let said = finish(&folder, "exp1", "lost");
    assert!(said.contains("body-map-2.npy: has changed or is missing; it is computed again"), "{said}");
    folder.has_files("lost", &expected);
}

#[test]
fn ctrl_c_leaves_with_130_and_the_run_goes_on() {
    let folder = folder_with_settings();
    let status = leave_after(&folder, "left", "simulation-1/dpgmm-2.json", "-INT");
    assert_eq!(status.code(), Some(130));
    finish(&folder, "exp1", "left");
    folder.has_files("left", &WHOLE);
}
