//! `ro-crate-metadata.json`: that roc-validator accepts it for an experiment and a study (skipped without it), and that it says
//! what happened.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde_json::{Value, json};

use crate::support::folder::Folder;
use crate::support::repository::repository;
use crate::support::said::Said;
use crate::support::small::small;
use crate::support::tools::skipped;

/// A study in a second or two.
fn design() -> String {
    let chain = repository("bodies/chain-3.toml");
    format!(
        "seed = 4\nmovements = 1\nchains = 2\ncoordinations = [0.5]\nbodies = [{chain:?}]\n\
         [[recording]]\nsamples = 500\nnoise = 0.0\n"
    )
}

fn entity<'a>(of: &'a Value, id: &str) -> &'a Value {
    of["@graph"].as_array().unwrap().iter().find(|entity| entity["@id"] == id).unwrap()
}

/// Whether the validator accepts a folder, and what it says; `None` without a validator.
fn accepted(folder: &Path) -> Option<(bool, String)> {
    let here = |bin: PathBuf| bin.join("rocrate-validator").is_file().then(|| bin.join("python3"));
    let python = env::split_paths(&env::var_os("PATH").unwrap()).find_map(here);
    let Some(python) = python else {
        skipped("rocrate-validator is missing");
        return None;
    };
    let said = Said::by(Command::new(python).arg(repository("tests/ro_crate.py")).arg(folder));
    Some((said.status == Some(0), said.out + &said.err))
}

#[test]
fn the_validator_accepts_an_experiment_and_a_study_and_no_broken_crate() {
    let folder = Folder::new();
    folder.write("small.toml", small(""));
    folder.write("bodies.toml", design());
    folder.succeed("bodies --design bodies.toml --out study");
    folder.reproduce("exp1 --settings small.toml --out run");
    let whole = folder.json("run/ro-crate-metadata.json");
    for name in ["study", "run"] {
        let Some((accepted, said)) = accepted(&folder.at(name)) else { return };
        assert!(accepted, "{name}: {said}");
    }

    let broken = |id: &str, property: &str, complaint: &str| {
        let mut broken = whole.clone();
        let graph = broken["@graph"].as_array_mut().unwrap();
        let entity = graph.iter_mut().find(|entity| entity["@id"] == id).unwrap();
        entity.as_object_mut().unwrap().remove(property).unwrap();
        folder.write("run/ro-crate-metadata.json", broken.to_string());
        let (accepted, said) = accepted(&folder.at("run")).unwrap();
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!accepted && said.contains(complaint), "{id} without {property}: {said}");
    };
    broken("#run", "instrument", "MUST have an instrument property");
    broken("./", "datePublished", "MUST have a `datePublished` property");
    folder.write("run/ro-crate-metadata.json", whole.to_string());
    fs::remove_file(folder.at("run/samples.csv")).unwrap();
    let (accepted, said) = accepted(&folder.at("run")).unwrap();
    assert!(!accepted && said.contains("samples.csv"), "a file that is missing: {said}");
}

#[test]
fn a_crate_says_what_was_run_when_with_which_files_and_hashes() {
    let folder = Folder::new();
    folder.write("small.toml", small(""));
    let seconds = |time: SystemTime| time.duration_since(UNIX_EPOCH).unwrap().as_secs();
    let stated = |of: &Value, name: &str| {
        let text = entity(of, "#run")[name].as_str().unwrap().replace("+00:00", "Z");
        seconds(humantime::parse_rfc3339(&text).unwrap())
    };
    let before = seconds(SystemTime::now());
    folder.reproduce("exp2 --quick --settings small.toml --out one");
    let mut one = folder.json("one/ro-crate-metadata.json");
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
    let manifest = folder.json("one/manifest.json");
    for output in manifest["outputs"].as_array().unwrap() {
        let file = entity(&one, output["file"].as_str().unwrap());
        assert_eq!((&file["@type"], &file["sha256"]), (&json!("File"), &output["sha256"]));
    }

    // The settings file repeats the run: all is the same but what tells runs apart.
    folder.reproduce("exp2 --quick --settings one/settings.toml --out two");
    let mut again = folder.json("two/ro-crate-metadata.json");
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
    let folder = Folder::new();
    folder.write("bodies.toml", design());
    let out = OsStr::from_bytes(b"r\xff");
    let said = Said::by(folder.command("bodies --design bodies.toml --out").arg(out));
    assert_eq!(said.status, Some(0), "{said:?}");
    let described = folder.json(Path::new(out).join("ro-crate-metadata.json"));
    let run = entity(&described, "#run");
    assert!(run["description"].as_str().unwrap().ends_with("r\u{fffd}"), "{run}");
}
