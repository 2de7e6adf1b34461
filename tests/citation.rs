//! `CITATION.cff` is valid by cffconvert (skipped without it), names this version, and says what the
//! article and the committed confirmation say.

use std::process::Command;

use crate::support::folder::{Folder, rows};
use crate::support::repository::{read, repository};
use crate::support::said::Said;
use crate::support::tools::{python, run};

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
    let folder = Folder::new();
    let validate = |citation: String| -> Option<Said> {
        folder.write("CITATION.cff", citation);
        let mut command = Command::new("cffconvert");
        run(command.arg("--validate").arg("-i").arg(folder.at("CITATION.cff")))
    };
    let Some(said) = validate(citation()) else { return };
    assert_eq!(said.status, Some(0), "{said:?}");
    let said = validate(citation().replace("type: article", "type: paper")).unwrap();
    assert_ne!(said.status, Some(0), "a type that does not exist");
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
    let claims = rows(&repository("docs/shown/confirm/exp1/claims.csv"));
    let headline = ["tree-accuracy", "all-draws", "equations"];
    let row =
        claims.iter().find(|row| ["id", "counting", "reading"].map(|name| &row[name]) == headline).unwrap();
    let numbers =
        ["value", "low", "high", "accepted_low", "accepted_high"].map(|name| row[name].parse().unwrap());
    let text = below(&citation(), "abstract: >-").join(" ");
    for words in said(&numbers) {
        assert!(text.contains(&words), "the abstract lacks: {words}");
    }
    let other = said(&[0.79, 0.73, 0.84, 0.746, 0.946]);
    assert_eq!(other[2], "It does not confirm the published rate");
}

#[test]
fn the_registered_values_are_still_those_that_were_frozen() {
    let Some(mut check) = python(&repository("reproduce/confirm.py")) else { return };
    let said = Said::by(check.arg("--check"));
    assert_eq!((said.status, &*said.err), (Some(0), ""), "{said:?}");
}
