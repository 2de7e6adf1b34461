//! `CITATION.cff` is valid by cffconvert (skipped with a message where it is not installed), names this version, and says what the
//! article and the committed confirmation say.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Whether cffconvert accepts a file; None if there is no cffconvert.
fn valid(file: &Path) -> Option<(bool, String)> {
    match Command::new("cffconvert").arg("--validate").arg("-i").arg(file).output() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            eprintln!("skipped: cffconvert is missing (pip install -r tests/requirements.txt)");
            None
        }
        output => {
            let output = output.unwrap();
            Some((output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned()))
        }
    }
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn read(name: &str) -> String {
    fs::read_to_string(path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn citation() -> String {
    read("CITATION.cff")
}

/// The value of a key on a line of its own, without quotation marks.
fn line<'a>(text: &'a str, key: &str) -> &'a str {
    let found = text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    found.unwrap_or_else(|| panic!("no {key}")).trim_matches('"')
}

/// The indented lines below a key.
fn below<'a>(text: &'a str, key: &str) -> Vec<&'a str> {
    let rest = text.split_once(&format!("\n{key}\n")).unwrap_or_else(|| panic!("no {key}")).1;
    rest.lines().take_while(|line| line.starts_with("  ")).map(str::trim).collect()
}

#[test]
fn the_citation_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("CITATION.cff");
    fs::write(&file, citation()).unwrap();
    let Some((accepted, said)) = valid(&file) else { return };
    assert!(accepted, "{said}");
    fs::write(&file, citation().replace("type: article", "type: paper")).unwrap();
    assert!(!valid(&file).unwrap().0, "a type that does not exist");
}

#[test]
fn the_citation_names_this_version() {
    assert!(citation().contains(concat!("\nversion: ", env!("CARGO_PKG_VERSION"), "\n")));
}

#[test]
fn the_citation_agrees_with_the_article() {
    let (citation, article) = (citation(), read("article/metadata.yaml"));
    assert_eq!(line(&citation, "title"), format!("bodyschema: {}", line(&article, "title")));
    assert_eq!(below(&citation, "abstract: >-"), below(&article, "abstract: >-"), "abstracts");
    let keywords: Vec<&str> =
        below(&citation, "keywords:").iter().filter_map(|line| line.strip_prefix("- ")).collect();
    assert_eq!(keywords.join(", "), line(&article, "keywords"), "keywords");
}

/// What the abstract must say of a row of claims: its rate, its interval, and whether the interval lies within the range.
fn said(row: &[f64; 5]) -> [String; 3] {
    let [value, low, high, accepted_low, accepted_high] = row;
    let confirmed = accepted_low <= low && high <= accepted_high;
    [
        format!("{:.1} % of the eligible samples.", 100.0 * value),
        format!("The 95 % interval is {:.1} to {:.1} %", 100.0 * low, 100.0 * high),
        format!("It {} the published rate", if confirmed { "confirms" } else { "does not confirm" }),
    ]
}

#[test]
fn the_abstract_has_the_confirmation() {
    let mut table = csv::Reader::from_path(path("docs/shown/confirm/exp1/claims.csv")).unwrap();
    let names = table.headers().unwrap().clone();
    let column = |name: &str| names.iter().position(|other| other == name).unwrap();
    let (id, counting, reading) = (column("id"), column("counting"), column("reading"));
    let row = table
        .records()
        .map(Result::unwrap)
        .find(|row| [&row[id], &row[counting], &row[reading]] == ["tree-accuracy", "all-draws", "equations"]);
    let row = row.expect("the headline");
    let numbers = ["value", "low", "high", "accepted_low", "accepted_high"]
        .map(|name| row[column(name)].parse().unwrap());
    let text = below(&citation(), "abstract: >-").join(" ");
    for words in said(&numbers) {
        assert!(text.contains(&words), "the abstract lacks: {words}");
    }
    let other = said(&[0.79, 0.73, 0.84, 0.746, 0.946]);
    assert_eq!(other[2], "It does not confirm the published rate");
}

/// Whether an abstract says of experiment 2 of the confirmation what is so: that it is not finished, or nothing.
fn says_what_ran(text: &str, finished: bool) -> bool {
    let unfinished = text.contains("The second experiment of the confirmation is not finished")
        && text.contains(
            "claims over the ratio p of motor coordination are those of the run of seed 1414, 20 simulations",
        );
    let all = text.contains("Of all 23 claims, ");
    (all, unfinished) == (finished, !finished)
}

#[test]
fn the_abstract_says_whether_experiment_2_of_the_confirmation_is_finished() {
    let text = below(&citation(), "abstract: >-").join(" ");
    let finished = path("docs/shown/confirm/exp2/claims.csv").exists();
    assert!(
        says_what_ran(&text, finished),
        "experiment 2 is{} finished: {text}",
        if finished { "" } else { " not" }
    );
    assert!(!says_what_ran(&text, !finished), "an abstract of the other case");
}
