//! `bodyschema verify`: what it finds in results that are whole, damaged, of another run or of another machine.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use bodyschema::files::{npy, sha256};

/// Experiment 1 in a second or two.
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
coordinations = [0.9]
simulations = 1
seed = 5
";

fn bodyschema(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bodyschema")).args(arguments.split(' ')).output().unwrap()
}

/// Exit status and all that is printed.
fn verify(arguments: &str) -> (i32, String) {
    let output = bodyschema(&format!("verify {arguments}"));
    let printed = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap(), String::from_utf8(printed).unwrap())
}

/// A small experiment in a folder of its own.
fn experiment(folder: &Path, name: &str, settings: &str) -> String {
    let (file, out) = (folder.join(format!("{name}.toml")), folder.join(name));
    fs::write(&file, settings).unwrap();
    let arguments = format!("reproduce exp1 --settings {} --out {}", file.display(), out.display());
    assert!(bodyschema(&arguments).status.code().unwrap() <= 1);
    out.display().to_string()
}

#[test]
fn a_finished_run_is_compared_with_its_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let run = experiment(folder.path(), "run", SMALL);
    let (status, printed) = verify(&run);
    assert_eq!(status, 0, "{printed}");
    assert!(printed.ends_with("0 within tolerance, 0 not\n") && printed.lines().count() == 1, "{printed}");

    let samples = Path::new(&run).join("samples.csv");
    let whole = fs::read_to_string(&samples).unwrap();
    fs::write(&samples, whole.replacen("1,", "2,", 1)).unwrap();
    fs::remove_file(Path::new(&run).join("simulation-1/body-map.npy")).unwrap();
    let (status, printed) = verify(&run);
    assert_eq!(status, 1, "{printed}");
    assert!(printed.contains("differs           samples.csv: its SHA-256 is not"), "{printed}");
    assert!(printed.contains("missing           simulation-1/body-map.npy\n"), "{printed}");
    assert!(printed.ends_with("0 within tolerance, 2 not\n"), "{printed}");

    let described = Path::new(&run).join("ro-crate-metadata.json");
    let text = fs::read_to_string(&described).unwrap();
    let hash = sha256(&Path::new(&run).join("claims.csv")).unwrap();
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
        fs::write(&described, content).unwrap();
        let (found, printed) = verify(&run);
        assert!(found == status && printed.contains(expected), "{printed}");
        assert_eq!(printed.lines().filter(|line| line.contains("ro-crate")).count(), 1, "{printed}");
    }
    // Results of programs before there were crates.
    fs::remove_file(&described).unwrap();
    assert!(verify(&run).1.ends_with("0 within tolerance, 2 not\n"));

    let manifest = Path::new(&run).join("manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    for (content, expected) in [
        (text.replace("\"samples.csv\"", "\"../samples.csv\""), "which is not a file within its folder"),
        (text.replace("\"samples.csv\"", "\"/etc/hostname\""), "which is not a file within its folder"),
        (text[..text.len() / 2].to_owned(), "is not a manifest"),
        ("[]".to_owned(), "is not a manifest"),
    ] {
        fs::write(&manifest, content).unwrap();
        let (status, printed) = verify(&run);
        assert_eq!(status, 2, "{printed}");
        assert!(printed.contains(expected) && printed.lines().count() == 1, "{printed}");
    }
    fs::remove_file(&manifest).unwrap();
    let (status, printed) = verify(&run);
    assert!(status == 2 && printed.contains("a run writes its manifest when it is finished"), "{printed}");
}

#[test]
fn two_runs_are_compared_number_by_number() {
    let folder = tempfile::tempdir().unwrap();
    let run = experiment(folder.path(), "run", SMALL);
    let again = experiment(folder.path(), "again", SMALL);
    let (status, printed) = verify(&format!("{again} --against {run}"));
    assert_eq!(status, 0, "{printed}");
    assert_eq!(printed.lines().count(), 2, "{printed}");

    // Another class of CPU: last digits.
    fs::remove_file(Path::new(&again).join("manifest.json")).unwrap();
    let path = Path::new(&again).join("simulation-1/body-map.npy");
    let map = npy::read_body_map(&path).unwrap();
    let changed = |change: f64| {
        let mut map = map.clone();
        map.coordinates[7] += change;
        npy::write_body_map(&path, &map).unwrap();
        verify(&format!("{again} --against {run}"))
    };
    let (status, printed) = changed(1e-9);
    assert_eq!(status, 0, "{printed}");
    assert!(printed.contains(
        "within tolerance  simulation-1/body-map.npy: largest difference 1.0e-9, in row 1, column 3"
    ));
    let (status, printed) = changed(1e-3);
    assert_eq!(status, 1, "{printed}");
    assert!(
        printed.contains("differs           simulation-1/body-map.npy: largest difference 1.0e-3"),
        "{printed}"
    );

    let other = experiment(
        folder.path(),
        "other",
        &SMALL.replace("seed = 5", "seed = 6\n[motion]\ncoordination = 0.5"),
    );
    let (status, printed) = verify(&format!("{other} --against {run}"));
    assert_eq!(status, 1, "{printed}");
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
    let folder = tempfile::tempdir().unwrap();
    let (own, reference) = (folder.path().join("own"), folder.path().join("reference"));
    for folder in [&own, &reference] {
        fs::create_dir(folder).unwrap();
    }
    fs::write(reference.join("samples.csv"), draws(80, 60)).unwrap();
    let compare = |table: String| {
        fs::write(own.join("samples.csv"), table).unwrap();
        verify(&format!("{} --against {}", own.display(), reference.display()))
    };
    assert_eq!(compare(draws(80, 60)).0, 0);
    let (status, printed) = compare(draws(75, 62));
    assert_eq!(status, 0, "{printed}");
    assert!(printed.contains("same rates        samples.csv: line 2, log_posterior"), "{printed}");
    let (status, printed) = compare(draws(50, 45));
    assert_eq!(status, 1, "{printed}");
    assert!(
        printed.contains("eligible 50 of 100, reference 80 of 100: 4.4 standard errors apart"),
        "{printed}"
    );
    let (status, printed) = compare(draws(80, 30));
    assert_eq!(status, 1, "{printed}");
    assert!(
        printed.contains("correct trees 30 of 80, reference 60 of 80: 4.8 standard errors apart"),
        "{printed}"
    );
    let (status, printed) = compare(draws(80, 60).replace("chain,parts", "chain,pieces"));
    assert_eq!(status, 1, "{printed}");
    assert!(printed.contains("columns chain,pieces"), "{printed}");
    let (status, printed) = compare(draws(80, 60).replace("chain,parts", "\"ch\nain\",parts"));
    assert!(status == 1 && printed.contains("columns ch ain,parts"), "{printed}");
    let (status, printed) = compare(String::new());
    assert!(status == 2 && printed.contains("samples.csv: is empty"), "{printed}");

    fs::remove_file(reference.join("samples.csv")).unwrap();
    let (status, printed) = compare(draws(80, 60));
    assert!(status == 2 && printed.contains("has no .csv or .npy file"), "{printed}");
}

/// The body maps of the full experiments, which are committed with the draws that were made of them. The second
/// is drawn from by the C library's functions for older processors, which round some results otherwise.
#[test]
fn the_reference_body_maps_give_the_reference_draws() {
    let folder = tempfile::tempdir().unwrap();
    for (experiment, processor) in [("exp1", ""), ("exp2", "glibc.cpu.hwcaps=-AVX2,-FMA")] {
        let reference = format!("{}/reproduce/reference/{experiment}", env!("CARGO_MANIFEST_DIR"));
        let out = folder.path().join(experiment).display().to_string();
        let arguments = format!(
            "infer {reference}/body-map.npy --labels {reference}/labels.csv --tree {reference}/tree.csv --out {out} \
             --settings {}/reproduce/equations.toml",
            env!("CARGO_MANIFEST_DIR")
        );
        let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
        let inferred = command.args(arguments.split(' ')).env("GLIBC_TUNABLES", processor).output().unwrap();
        assert!(inferred.status.success(), "{inferred:?}");
        let (status, printed) = verify(&format!("{out} --against {reference}/schema"));
        assert_eq!(status, 0, "{printed}");
    }
}

/// A movement that is too short for chaos, simulated by the C library's functions for newer and for older processors.
#[test]
fn the_reference_movement_is_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let reference = format!("{}/reproduce/reference/movement", env!("CARGO_MANIFEST_DIR"));
    let simulated = |name: &str, seed: u64, processor: &str| {
        let out = folder.path().join(name).display().to_string();
        let arguments = format!("simulate --settings {reference}/settings.toml --seed {seed} --out {out}");
        let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
        let output = command.args(arguments.split(' ')).env("GLIBC_TUNABLES", processor).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        verify(&format!("{out} --against {reference}"))
    };
    for (name, processor) in [("new", ""), ("old", "glibc.cpu.hwcaps=-AVX2,-FMA")] {
        let (status, printed) = simulated(name, 3141, processor);
        assert_eq!(status, 0, "{printed}");
    }
    let (status, printed) = simulated("other", 3142, "");
    assert_eq!(status, 1, "{printed}");
}
