//! `ro-crate-metadata.json`: that roc-validator accepts it for an experiment and a study (skipped with a message where it is
//! not installed), and that it says what happened.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde_json::{Value, json};

const CRATE: &str = "ro-crate-metadata.json";

/// An experiment in a second or two.
const SMALL: &str = "
[skin]
around = 8
along = 3
[physics]
duration = 1000.0
[schema]
chains = 6
sweeps = 60
[experiment]
dimensions = [2, 4]
simulations = 1
seed = 5
";

/// A study in a second or two.
fn design() -> String {
    let chain = Path::new(env!("CARGO_MANIFEST_DIR")).join("bodies/chain-3.toml");
    format!(
        "seed = 4\nmovements = 1\nchains = 2\ncoordinations = [0.5]\nbodies = [{chain:?}]\n\
         [[recording]]\nsamples = 500\nnoise = 0.0\n"
    )
}

/// The crate that a command writes into the folder that it is given after `--out`.
fn crate_of(folder: &Path, arguments: &str) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
    let output = command.current_dir(folder).args(arguments.split(' ')).output().unwrap();
    assert!(output.status.code().unwrap() <= 1, "{output:?}");
    read(&folder.join(arguments.rsplit(' ').next().unwrap()).join(CRATE))
}

fn read(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn entity<'a>(of: &'a Value, id: &str) -> &'a Value {
    of["@graph"].as_array().unwrap().iter().find(|entity| entity["@id"] == id).unwrap()
}

/// Whether the validator accepts a folder, and what it says; `None` without a validator.
fn accepted(folder: &Path) -> Option<(bool, String)> {
    let here = |bin: PathBuf| bin.join("rocrate-validator").is_file().then(|| bin.join("python3"));
    let python = env::split_paths(&env::var_os("PATH").unwrap()).find_map(here);
    let Some(python) = python else {
        eprintln!("skipped: rocrate-validator is missing (pip install -r tests/requirements.txt)");
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ro_crate.py");
    let output = Command::new(python).arg(script).arg(folder).output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    Some((output.status.success(), String::from_utf8_lossy(&said).into_owned()))
}

#[test]
fn the_validator_accepts_an_experiment_and_a_study_and_no_broken_crate() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    fs::write(folder.path().join("bodies.toml"), design()).unwrap();
    crate_of(folder.path(), "bodies --design bodies.toml --out study");
    let whole = crate_of(folder.path(), "reproduce exp1 --settings small.toml --out run");
    for name in ["study", "run"] {
        let Some((accepted, said)) = accepted(&folder.path().join(name)) else { return };
        assert!(accepted, "{name}: {said}");
    }

    let broken = |id: &str, property: &str, complaint: &str| {
        let mut broken = whole.clone();
        let graph = broken["@graph"].as_array_mut().unwrap();
        let entity = graph.iter_mut().find(|entity| entity["@id"] == id).unwrap();
        entity.as_object_mut().unwrap().remove(property).unwrap();
        fs::write(folder.path().join("run").join(CRATE), broken.to_string()).unwrap();
        let (accepted, said) = accepted(&folder.path().join("run")).unwrap();
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!accepted && said.contains(complaint), "{id} without {property}: {said}");
    };
    broken("#run", "instrument", "MUST have an instrument property");
    broken("./", "datePublished", "MUST have a `datePublished` property");
    fs::write(folder.path().join("run").join(CRATE), whole.to_string()).unwrap();
    fs::remove_file(folder.path().join("run/samples.csv")).unwrap();
    let (accepted, said) = accepted(&folder.path().join("run")).unwrap();
    assert!(!accepted && said.contains("samples.csv"), "a file that is missing: {said}");
}

#[test]
fn a_crate_says_what_was_run_when_with_which_files_and_hashes() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    let seconds = |time: SystemTime| time.duration_since(UNIX_EPOCH).unwrap().as_secs();
    let stated = |of: &Value, name: &str| {
        let text = entity(of, "#run")[name].as_str().unwrap().replace("+00:00", "Z");
        seconds(humantime::parse_rfc3339(&text).unwrap())
    };
    let before = seconds(SystemTime::now());
    let one = crate_of(folder.path(), "reproduce exp2 --quick --settings small.toml --out one");
    let after = seconds(SystemTime::now());
    let times = [before, stated(&one, "startTime"), stated(&one, "endTime"), after];
    assert!(times.is_sorted(), "{times:?}");

    let run = entity(&one, "#run");
    let command = run["description"].as_str().unwrap();
    assert!(command.ends_with("reproduce exp2 --quick --settings small.toml --out one"), "{command}");
    assert_eq!(run["object"], json!([{ "@id": "settings.toml" }, { "@id": "#seed" }]));
    assert_eq!(entity(&one, "#seed")["value"], 5);
    let caution = entity(&one, "./")["description"].as_str().unwrap();
    assert!(caution.contains("Quick run: its numbers are no replication."), "{caution}");
    let manifest = read(&folder.path().join("one/manifest.json"));
    for output in manifest["outputs"].as_array().unwrap() {
        let file = entity(&one, output["file"].as_str().unwrap());
        assert_eq!((&file["@type"], &file["sha256"]), (&json!("File"), &output["sha256"]));
    }

    // The settings file repeats the run: all is the same but what tells runs apart.
    let mut again = crate_of(folder.path(), "reproduce exp2 --quick --settings one/settings.toml --out two");
    let mut one = one;
    for described in [&mut one, &mut again] {
        for entity in described["@graph"].as_array_mut().unwrap() {
            match entity["@id"].as_str().unwrap() {
                "./" => assert!(entity.as_object_mut().unwrap().remove("datePublished").is_some()),
                "#run" => ["startTime", "endTime", "description"].iter().for_each(|name| {
                    assert!(entity.as_object_mut().unwrap().remove(*name).is_some());
                }),
                _ => {}
            }
        }
    }
    assert_eq!(one, again);
}

#[test]
fn a_folder_whose_name_is_no_text_gets_its_crate() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("design.toml"), design()).unwrap();
    let out = OsStr::from_bytes(b"r\xff");
    let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
    let command =
        command.current_dir(folder.path()).args(["bodies", "--design", "design.toml", "--out"]).arg(out);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let run = entity(&read(&folder.path().join(out).join(CRATE)), "#run").clone();
    assert!(run["description"].as_str().unwrap().ends_with("r\u{fffd}"), "{run}");
}
