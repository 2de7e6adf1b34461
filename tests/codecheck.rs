//! `codecheck.yml` names what `reproduce/codecheck.toml` has rerun, and `reproduce/codecheck.py` tells results that agree from
//! those that do not. The runs of codecheck.py need Python 3.11.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use toml::{Table, Value};

use crate::support::folder::Folder;
use crate::support::repository::{read, repository};
use crate::support::said::Said;
use crate::support::tools::python;

fn rules() -> Table {
    read("reproduce/codecheck.toml").parse().unwrap()
}

fn list<'a>(table: &'a Value, key: &str) -> Vec<&'a Value> {
    table.get(key).and_then(Value::as_array).map_or_else(Vec::new, |values| values.iter().collect())
}

fn text<'a>(table: &'a Value, key: &str) -> Option<&'a str> {
    table.get(key).and_then(Value::as_str)
}

/// Name of the file at the end of a path.
fn name(path: &str) -> &str {
    path.rsplit('/').next().unwrap()
}

/// Where a rerun writes each file of a part, within the results, and where the committed one is.
fn files(part: &Value) -> Vec<(String, String)> {
    let folder = |key: &str| text(part, key).unwrap_or_default();
    let both = list(part, "table").into_iter().chain(list(part, "picture"));
    both.map(|file| {
        let made = text(file, "made").unwrap();
        let committed = text(file, "committed").unwrap_or_else(|| name(made));
        (format!("{}/{made}", folder("made")), format!("{}/{committed}", folder("committed")))
    })
    .collect()
}

#[test]
fn the_manifest_is_what_is_rerun() {
    let rules = rules();
    let parts = rules["part"].as_array().unwrap();
    let compared = parts.iter().flat_map(files).map(|(_, committed)| committed);
    let by_themselves = parts.iter().flat_map(|part| list(part, "compares_itself"));
    let rerun: BTreeSet<String> =
        compared.chain(by_themselves.map(|file| file.as_str().unwrap().to_owned())).collect();
    let manifest = read("codecheck.yml");
    assert!(manifest.starts_with("---\n"), "the explicit document marker");
    let named: BTreeSet<String> =
        manifest.lines().filter_map(|line| line.strip_prefix("  - file: ")).map(str::to_owned).collect();
    assert_eq!(named, rerun);
    assert!(named.iter().all(|file| repository(file).is_file()), "{named:?}");
}

/// The minutes of codecheck.toml are also in the manifest and in the table of docs/check.md.
#[test]
fn minutes_are_the_same_everywhere() {
    let rules = rules();
    let (manifest, page) = (read("codecheck.yml"), read("docs/check.md"));
    let build = rules["build_minutes"].as_integer().unwrap();
    assert!(page.contains(&format!("| build | {build} |")), "{build}");
    let mut total = build;
    for part in rules["part"].as_array().unwrap() {
        let (name, minutes) = (text(part, "name").unwrap(), part["minutes"].as_integer().unwrap());
        let line = format!("--only {name}; {minutes} min");
        assert!(manifest.contains(&line), "{line}");
        let on_request = part.get("on_request").is_some();
        let row = format!("| `{name}`{} | {minutes} |", if on_request { ", only if named" } else { "" });
        assert!(page.contains(&row), "{row}");
        total += if on_request { 0 } else { minutes };
    }
    assert!(manifest.contains(&format!("this takes {total} min in all")), "{total}");
    assert!(page.contains(&format!("| all of these | {total} |")), "{total}");
}

#[test]
fn commands_exist() {
    for part in rules()["part"].as_array().unwrap() {
        let command = list(part, "command")[0].as_str().unwrap();
        assert!(repository(command).is_file(), "{command}");
    }
}

/// A folder with the committed results of experiment 2, once as committed and once as if made anew.
fn rerun() -> Folder {
    let folder = Folder::new();
    let put = |from: &str, to: &str| folder.write(to, fs::read(repository(from)).unwrap());
    for file in ["reproduce/codecheck.py", "reproduce/codecheck.toml", "docs/shown/exp2/manifest.json"] {
        put(file, file);
    }
    let rules = rules();
    let part =
        rules["part"].as_array().unwrap().iter().find(|part| text(part, "name") == Some("exp2")).unwrap();
    for (made, committed) in files(part) {
        put(&committed, &committed);
        put(&committed, &made);
    }
    folder
}

/// Status and what is printed; none without Python 3.11.
fn compare(folder: &Path, only: &str) -> Option<(Option<i32>, String)> {
    let mut script = python(&folder.join("reproduce/codecheck.py"))?;
    let Said { status, out, err } = Said::by(script.args(["--compare-only", "--only", only]));
    Some((status, out + &err))
}

/// The committed tree accuracy at p = 0.9 and d = 14, as it is written.
fn committed_rate() -> String {
    let table = read("docs/shown/exp2/fig11b-tree.csv");
    let row = table.lines().find_map(|line| line.strip_prefix("dpgmm-lj,,all-draws,0.9,14,")).unwrap();
    row.split(',').next().unwrap().to_owned()
}

/// Changes one file of the rerun.
fn change(folder: &Folder, file: &str, from: &str, to: &str) {
    let text = folder.text(file);
    assert!(text.contains(from), "{file} has no {from}");
    folder.write(file, text.replace(from, to));
}

#[test]
fn results_agree_if_they_are_the_same_or_within_their_tolerance() {
    let folder = rerun();
    let Some((status, said)) = compare(folder.path(), "exp2") else { return };
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("5 same bytes, 0 within tolerance"), "{said}");

    // The rate at p = 0.9: within its interval, and beyond any.
    let rate = committed_rate();
    let near = (rate.parse::<f64>().unwrap() - 0.01).to_string();
    change(&folder, "results/exp2/figures/fig11b-tree.csv", &rate, &near);
    let (status, said) = compare(folder.path(), "exp2").unwrap();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("4 same bytes, 1 within tolerance"), "{said}");
    change(&folder, "results/exp2/figures/fig11b-tree.csv", &near, "0.0138");
    let (status, said) = compare(folder.path(), "exp2").unwrap();
    assert_eq!(status, Some(1), "{said}");
    let differs = format!("0.9/14: 0.0138, committed {}", &rate[..5]);
    assert!(said.contains("differs") && said.contains(&differs), "{said}");
}

#[test]
fn accepted_ranges_are_the_same_and_no_file_is_missing() {
    let folder = rerun();
    let Some((_, said)) = compare(folder.path(), "exp2") else { return };
    assert!(said.ends_with("0 differs\n"), "{said}");
    change(&folder, "results/exp2/claims.csv", ",0.746,0.946,", ",0.6,0.946,");
    fs::remove_file(folder.at("results/exp2/figures/fig11a-ari.csv")).unwrap();
    let (status, said) = compare(folder.path(), "exp2").unwrap();
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("accepted_low is '0.6', committed '0.746'") && said.contains("missing"), "{said}");
}

/// The witness says that the machine is of the same kind, where nothing but the same bytes agrees.
#[test]
fn on_a_machine_of_the_same_kind_bytes_are_the_same() {
    let folder = rerun();
    let witness = "results/exp2/p-0.9/simulation-1/body-map.npy";
    folder.write(witness, "map");
    let hash = "60be9861750facbfad8758254a2f76c0cfe78d54459a3bc187d49b1401fcd8e8";
    let hashed = r#"{"outputs": [{"file": "p-0.9/simulation-1/body-map.npy", "sha256": "HASH"}]}"#;
    folder.write("docs/shown/exp2/manifest.json", hashed.replace("HASH", hash));
    let rate = committed_rate();
    change(&folder, "results/exp2/figures/fig11b-tree.csv", &rate, &format!("{rate}1"));
    let Some((status, said)) = compare(folder.path(), "exp2") else { return };
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("on a machine of the same kind the bytes must be the same"), "{said}");
    folder.write(witness, "another map");
    assert_eq!(compare(folder.path(), "exp2").unwrap().0, Some(0));
}

/// The confirmation has the files of both experiments, in folders of their names. Here it has those of experiment 2.
#[test]
fn a_part_that_is_like_others_is_compared_as_they_are() {
    let folder = rerun();
    change(&folder, "reproduce/codecheck.toml", r#"like = ["exp1", "exp2"]"#, r#"like = ["exp2"]"#);
    let Some((status, said)) = compare(folder.path(), "confirm") else { return };
    assert_eq!((status, said.lines().count()), (Some(2), 1), "{said}");
    assert!(said.contains("docs/shown/confirm/exp2 is missing"), "{said}");

    for base in ["docs/shown", "results"] {
        let base = folder.at(base);
        fs::create_dir(base.join("confirm")).unwrap();
        fs::rename(base.join("exp2"), base.join("confirm/exp2")).unwrap();
    }
    let (status, said) = compare(folder.path(), "confirm").unwrap();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("confirm/exp2/claims.csv") && said.contains("5 same bytes"), "{said}");
}

#[test]
fn an_unknown_part_is_one_line_and_status_2() {
    let Some((status, said)) = compare(&repository(""), "exp3") else { return };
    assert_eq!((status, said.lines().count()), (Some(2), 1), "{said}");
    assert!(said.contains("there is no part 'exp3'; the parts are inference, exp1"), "{said}");
}
