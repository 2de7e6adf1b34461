//! `bodyschema verify`: what it finds in results that are whole, damaged, of another run or of another machine.

use std::fs;

use bodyschema::files::{npy, sha256};

use crate::support::folder::Folder;
use crate::support::repository::repository;
use crate::support::said::Said;
use crate::support::small::small;

/// All that is printed, with this exit status.
#[track_caller]
fn verify(folder: &Folder, arguments: &str, status: i32) -> String {
    let said = folder.run(&format!("verify {arguments}"));
    assert_eq!(said.status, Some(status), "{said:?}");
    said.out + &said.err
}

/// A small experiment.
fn experiment(folder: &Folder, out: &str, over: &str) {
    folder.write(format!("{out}.toml"), small(over));
    folder.reproduce(&format!("exp1 --settings {out}.toml --out {out}"));
}

#[test]
fn a_finished_run_is_compared_with_its_manifest() {
    let folder = Folder::new();
    experiment(&folder, "run", "");
    let printed = verify(&folder, "run", 0);
    assert!(printed.ends_with("0 within tolerance, 0 not\n") && printed.lines().count() == 1, "{printed}");

    folder.write("run/samples.csv", folder.text("run/samples.csv").replacen("1,", "2,", 1));
    fs::remove_file(folder.at("run/simulation-1/body-map.npy")).unwrap();
    let printed = verify(&folder, "run", 1);
    assert!(printed.contains("differs           samples.csv: its SHA-256 is not"), "{printed}");
    assert!(printed.contains("missing           simulation-1/body-map.npy\n"), "{printed}");
    assert!(printed.ends_with("0 within tolerance, 2 not\n"), "{printed}");

    let described = "run/ro-crate-metadata.json";
    let text = folder.text(described);
    let hash = sha256(&folder.at("run/claims.csv")).unwrap();
    let other = hash.chars().rev().collect::<String>();
    for (content, status, expected) in [
        (
            text.replace(&hash, &other),
            1,
            "differs           ro-crate-metadata.json: states another SHA-256 of claims.csv",
        ),
        (
            text.replace("\"claims.csv\"", "\"clams.csv\""),
            1,
            "a SHA-256 of clams.csv, which manifest.json does not list",
        ),
        (
            text.replace("sha256\": ", "sha512\": "),
            1,
            "states no SHA-256 of simulation-1/labels.csv, which manifest",
        ),
        (text[..text.len() / 2].to_owned(), 2, "is not a crate of results"),
    ] {
        folder.write(described, content);
        let printed = verify(&folder, "run", status);
        assert!(printed.contains(expected), "{printed}");
        assert_eq!(printed.lines().filter(|line| line.contains("ro-crate")).count(), 1, "{printed}");
    }
    // Results of programs before there were crates.
    fs::remove_file(folder.at(described)).unwrap();
    assert!(verify(&folder, "run", 1).ends_with("0 within tolerance, 2 not\n"));

    let manifest = "run/manifest.json";
    let text = folder.text(manifest);
    for (content, expected) in [
        (text.replace("\"samples.csv\"", "\"../samples.csv\""), "which is not a file within its folder"),
        (text.replace("\"samples.csv\"", "\"/etc/hostname\""), "which is not a file within its folder"),
        (text[..text.len() / 2].to_owned(), "is not a manifest"),
        ("[]".to_owned(), "is not a manifest"),
    ] {
        folder.write(manifest, content);
        folder.refuse("verify run", expected);
    }
    fs::remove_file(folder.at(manifest)).unwrap();
    folder.refuse("verify run", "a run writes its manifest when it is finished");
}

#[test]
fn two_runs_are_compared_number_by_number() {
    let folder = Folder::new();
    experiment(&folder, "run", "");
    experiment(&folder, "again", "");
    let printed = verify(&folder, "again --against run", 0);
    assert_eq!(printed.lines().count(), 2, "{printed}");

    // Another class of CPU: last digits.
    fs::remove_file(folder.at("again/manifest.json")).unwrap();
    let path = folder.at("again/simulation-1/body-map.npy");
    let map = npy::read_body_map(&path).unwrap();
    let changed = |change: f64, status: i32| {
        let mut map = map.clone();
        map.coordinates[7] += change;
        npy::write_body_map(&path, &map).unwrap();
        verify(&folder, "again --against run", status)
    };
    let printed = changed(1e-9, 0);
    assert!(printed.contains(
        "within tolerance  simulation-1/body-map.npy: largest difference 1.0e-9, in row 1, column 3"
    ));
    let printed = changed(1e-3, 1);
    assert!(
        printed.contains("differs           simulation-1/body-map.npy: largest difference 1.0e-3"),
        "{printed}"
    );

    experiment(&folder, "other", "experiment.seed = 6\nmotion.coordination = 0.5");
    let printed = verify(&folder, "other --against run", 1);
    assert!(printed.contains("seed is 6, reference 5"), "{printed}");
    assert!(printed.contains("settings.motion.coordination is 0.5, reference 0.9"), "{printed}");
    assert!(printed.contains("differs           simulation-1/distance.npy"), "{printed}");
}

/// 100 draws, of which some are eligible, and some of those have the right tree.
fn draws(eligible: usize, right: usize) -> String {
    let row = |at: usize| format!("{at},5,{}.5,1.0,{},{}\n", at + eligible, at < eligible, at < right);
    let rows: String = (0..100).map(row).collect();
    format!("chain,parts,log_posterior,ari,eligible,tree_correct\n{rows}")
}

#[test]
fn other_draws_are_compared_by_their_rates() {
    let folder = Folder::new();
    folder.write("reference/samples.csv", draws(80, 60));
    let compare = |table: String, status: i32| {
        folder.write("own/samples.csv", table);
        verify(&folder, "own --against reference", status)
    };
    compare(draws(80, 60), 0);
    for (table, status, expected) in [
        (draws(75, 62), 0, "same rates        samples.csv: line 2, log_posterior"),
        (draws(50, 45), 1, "eligible 50 of 100, reference 80 of 100: 4.4 standard errors apart"),
        (draws(80, 30), 1, "correct trees 30 of 80, reference 60 of 80: 4.8 standard errors apart"),
        (draws(80, 60).replace("chain,parts", "chain,pieces"), 1, "columns chain,pieces"),
        (draws(80, 60).replace("chain,parts", "\"ch\nain\",parts"), 1, "columns ch ain,parts"),
        (String::new(), 2, "samples.csv: is empty"),
    ] {
        let printed = compare(table, status);
        assert!(printed.contains(expected), "{printed}");
    }
    fs::remove_file(folder.at("reference/samples.csv")).unwrap();
    let printed = compare(draws(80, 60), 2);
    assert!(printed.contains("has no .csv or .npy file"), "{printed}");
}

/// The C library's functions of this processor, and those for older ones, which round some results otherwise.
const PROCESSORS: [&str; 2] = ["", "glibc.cpu.hwcaps=-AVX2,-FMA"];

fn succeed_on(processor: &str, folder: &Folder, arguments: &str) {
    let said = Said::by(folder.command(arguments).env("GLIBC_TUNABLES", processor));
    assert_eq!(said.status, Some(0), "{said:?}");
}

/// The body maps of the full experiments, which are committed with the draws that were made of them.
#[test]
fn the_reference_body_maps_give_the_reference_draws() {
    let folder = Folder::new();
    let equations = repository("reproduce/equations.toml").display().to_string();
    for (experiment, processor) in ["exp1", "exp2"].into_iter().zip(PROCESSORS) {
        let reference = repository("reproduce/reference").join(experiment).display().to_string();
        let truth = format!("--labels {reference}/labels.csv --tree {reference}/tree.csv");
        let infer =
            format!("infer {reference}/body-map.npy {truth} --settings {equations} --out {experiment}");
        succeed_on(processor, &folder, &infer);
        verify(&folder, &format!("{experiment} --against {reference}/schema"), 0);
    }
}

/// A movement that is too short for chaos.
#[test]
fn the_reference_movement_is_repeated() {
    let folder = Folder::new();
    let reference = repository("reproduce/reference/movement").display().to_string();
    let simulated = |seed: u64, processor: &str, status: i32| {
        let simulate = format!("simulate --settings {reference}/settings.toml --seed {seed} --out moved");
        succeed_on(processor, &folder, &simulate);
        verify(&folder, &format!("moved --against {reference}"), status);
    };
    for processor in PROCESSORS {
        simulated(3141, processor, 0);
    }
    simulated(3142, "", 1);
}
