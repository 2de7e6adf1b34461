//! Runs that are killed, interrupted or damaged end with the same files as one that is left alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use bodyschema::numerics::rng::stream;
use rand::RngExt;

/// Both experiments in a second or two.
const SMALL: &str = "
[skin]
around = 8
along = 3
[physics]
duration = 1000.0
[schema]
chains = 6
sweeps = 100
[experiment]
dimensions = [2, 4]
coordinations = [0.5, 0.9]
dimension = 4
simulations = 2
seed = 5
";

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new() -> Self {
        Self::of(SMALL)
    }

    fn of(settings: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("small.toml"), settings).unwrap();
        Self { folder }
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn start(&self, experiment: &str, out: &str, settings: &str) -> Child {
        Command::new(env!("CARGO_BIN_EXE_bodyschema"))
            .current_dir(self.folder.path())
            .args(["reproduce", experiment, "--settings", settings, "--out", out])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Runs to the end, and returns what it said of trouble.
    fn finish(&self, experiment: &str, out: &str) -> String {
        let output = self.start(experiment, out, "small.toml").wait_with_output().unwrap();
        assert!(output.status.code().unwrap() <= 1, "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    }
}

/// All files of a run but those that tell runs apart.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !["run.json", "ro-crate-metadata.json"]
                .contains(&path.file_name().unwrap().to_str().unwrap())
            {
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

fn same(found: &Path, expected: &BTreeMap<PathBuf, Vec<u8>>, what: &str) {
    let found = files(found);
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(expected), "{what}");
    for (name, bytes) in expected {
        assert!(found[name] == *bytes, "{what}: {} differs", name.display());
    }
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
    let place = Place::new();
    let mut rng = stream(1, 1, "kills", 0);
    // `BODYSCHEMA_ROUNDS=40 cargo test --test resume -- --nocapture` kills for some minutes.
    let rounds: usize = std::env::var("BODYSCHEMA_ROUNDS").map_or(2, |rounds| rounds.parse().unwrap());
    let mut all_kills = 0;
    for experiment in ["exp1", "exp2"] {
        assert_eq!(place.finish(experiment, experiment), "");
        let expected = files(&place.out(experiment));
        assert!(
            expected.keys().all(|name| !name.starts_with("checkpoints")),
            "they go when a run is finished"
        );
        for round in 0..rounds {
            let out = format!("{experiment}-{round}");
            let mut kills = 0;
            loop {
                let mut child = place.start(experiment, &out, "small.toml");
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
            same(&place.out(&out), &expected, &format!("{experiment} after {kills} kills"));
            all_kills += kills;
        }
    }
    println!("{all_kills} kills in {} runs", 2 * rounds);
}

#[test]
fn a_full_disk_is_an_error_and_the_run_goes_on_when_there_is_room() {
    let place = Place::new();
    place.finish("exp1", "whole");
    // The shell's limit on the size of a file fails a write as a full disk does.
    for kilobytes in [0, 1, 4, 20, 60] {
        let program = env!("CARGO_BIN_EXE_bodyschema");
        let limited = format!(
            "trap '' XFSZ; ulimit -f {kilobytes}; exec {program} reproduce exp1 --settings small.toml --out full"
        );
        let output = Command::new("bash")
            .args(["-c", &limited])
            .current_dir(place.folder.path())
            .stdout(Stdio::null())
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{kilobytes} kB: {said}");
        assert!(said.lines().last().unwrap().contains("cannot be written"), "{kilobytes} kB: {said}");
        assert!(
            files(&place.out("full")).keys().all(|name| name.extension().unwrap() != "partial"),
            "{said}"
        );
    }
    place.finish("exp1", "full");
    same(&place.out("full"), &files(&place.out("whole")), "after a full disk");
}

/// Starts experiment 1 and leaves it once it has this part.
fn leave_after(place: &Place, out: &str, part: &str, signal: &str) -> ExitStatus {
    let mut child = place.start("exp1", out, "small.toml");
    let part = place.out(out).join("checkpoints").join(part);
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
    let place = Place::new();
    place.finish("exp1", "whole");
    let expected = files(&place.out("whole"));
    let parts = |out: &str| place.out(out).join("checkpoints/simulation-1");

    leave_after(&place, "cut", "simulation-1/dpgmm-lj-2.json", "-KILL");
    let path = parts("cut").join("dpgmm-2.json");
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    let said = place.finish("exp1", "cut");
    assert!(said.contains("dpgmm-2.json: is not a checkpoint; this part is run again"), "{said}");
    assert!(said.contains("continuing from what an earlier run finished"), "{said}");
    same(&place.out("cut"), &expected, "a part cut short");

    leave_after(&place, "swapped", "simulation-1/dpgmm-lj-2.json", "-KILL");
    let map = place.out("swapped").join("simulation-1/body-map.npy");
    fs::write(&map, fs::read(place.out("whole").join("simulation-2/body-map.npy")).unwrap()).unwrap();
    let said = place.finish("exp1", "swapped");
    assert!(said.contains("body-map.npy: has changed or is missing; it is computed again"), "{said}");
    same(&place.out("swapped"), &expected, "a body map of another simulation");

    leave_after(&place, "other", "simulation-1/dpgmm-lj-2.json", "-KILL");
    fs::write(place.out("other.toml"), SMALL.replace("seed = 5", "seed = 6")).unwrap();
    let output = place.start("exp1", "other", "other.toml").wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("other settings or of another version of the program are ignored"), "{said}");
    let whole = place.start("exp1", "whole-other", "other.toml").wait_with_output().unwrap();
    assert!(whole.status.code().unwrap() <= 1);
    same(&place.out("other"), &files(&place.out("whole-other")), "another seed");
    // A run that is finished is made anew.
    assert_eq!(place.finish("exp1", "whole"), "");
    same(&place.out("whole"), &expected, "twice");
}

#[test]
fn a_map_for_each_dimension_is_taken_up_again() {
    let place = Place::of(&format!("{SMALL}[map]\nmethod = \"nonmetric\""));
    assert_eq!(place.finish("exp1", "whole"), "");
    let expected = files(&place.out("whole"));
    let map = |d: usize| PathBuf::from(format!("simulation-1/body-map-{d}.npy"));
    assert!(expected.contains_key(&map(2)) && expected.contains_key(&map(4)), "{:?}", expected.keys());
    assert!(!expected.contains_key(Path::new("simulation-1/body-map.npy")));
    let manifest: serde_json::Value = serde_json::from_slice(&expected[Path::new("manifest.json")]).unwrap();
    let improvements = manifest["bodies"][0]["facts"]["improvements"].as_array().unwrap();
    assert_eq!(improvements.len(), 2);
    assert!(improvements.iter().all(|d| d["stress"].as_f64().unwrap() < d["start"].as_f64().unwrap()));

    leave_after(&place, "left", "simulation-1/dpgmm-2.json", "-KILL");
    let said = place.finish("exp1", "left");
    assert!(said.contains("continuing from") && !said.contains("again"), "{said}");
    same(&place.out("left"), &expected, "maps taken up");
    leave_after(&place, "lost", "simulation-1/dpgmm-2.json", "-KILL");
    fs::remove_file(place.out("lost").join(map(2))).unwrap();
    let said = place.finish("exp1", "lost");
    assert!(said.contains("body-map-2.npy: has changed or is missing; it is computed again"), "{said}");
    same(&place.out("lost"), &expected, "a map that is missing");
}

#[test]
fn ctrl_c_leaves_with_130_and_the_run_goes_on() {
    let place = Place::new();
    place.finish("exp1", "whole");
    let status = leave_after(&place, "left", "simulation-1/dpgmm-2.json", "-INT");
    assert_eq!(status.code(), Some(130));
    place.finish("exp1", "left");
    same(&place.out("left"), &files(&place.out("whole")), "after Ctrl-C");
}
