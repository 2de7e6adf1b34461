//! What README and docs say of files and settings is so: links lead somewhere, equations have files, and docs/settings.md
//! has the values of `reproduce/paper.toml`.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::support::repository::{pages, read, repository};
use crate::support::said::Said;
use crate::support::tools::python;

/// Numbered equations of the paper.
const EQUATIONS: usize = 27;

/// Targets of the links and pictures of a page, without those to other sites.
fn links(text: &str) -> Vec<String> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target);
    targets.filter(|target| !target.contains("://")).map(str::to_owned).collect()
}

/// Links that lead to no file, or to no heading or anchor of it.
fn broken(page: &Path, text: &str) -> Vec<String> {
    let leads = |target: &String| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let path = if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) };
        path.exists() && (anchor.is_empty() || anchors(&fs::read_to_string(&path).unwrap()).contains(anchor))
    };
    links(text).into_iter().filter(|target| !leads(target)).collect()
}

fn anchors(text: &str) -> BTreeSet<String> {
    let explicit =
        text.split("id=\"").skip(1).filter_map(|rest| rest.split_once('"')).map(|(id, _)| id.to_owned());
    let plain = |heading: &str| -> String {
        let kept = |letter: char| match letter {
            letter if letter.is_alphanumeric() || letter == '-' || letter == '_' => {
                Some(letter.to_ascii_lowercase())
            }
            ' ' => Some('-'),
            _ => None,
        };
        heading.trim_start_matches('#').trim().chars().filter_map(kept).collect()
    };
    explicit.chain(text.lines().filter(|line| line.starts_with('#')).map(plain)).collect()
}

#[test]
fn every_link_leads_somewhere() {
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        assert_eq!(broken(&page, &text), [""; 0], "{}", page.display());
    }
    let page = repository("README.md");
    let text = "[a](docs/nowhere.md) [b](README.md#no-such-heading) ![c](docs/reference.md) [d](https://example.org)";
    assert_eq!(broken(&page, text), ["docs/nowhere.md", "README.md#no-such-heading"]);
}

/// Equations that a table names in its first column, as `3`, `3, 4` or `3 to 5`.
fn equations(table: &str) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for line in table.lines().filter(|line| line.starts_with('|')) {
        let cell = line.trim_matches('|').split('|').next().unwrap().trim();
        for range in cell.split(',') {
            let ends: Vec<usize> =
                range.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok()).collect();
            if let (Some(first), Some(last)) = (ends.first(), ends.last()) {
                found.extend(*first..=*last);
            }
        }
    }
    found
}

#[test]
fn every_equation_of_the_paper_has_a_file_that_exists() {
    let page = read("docs/method.md");
    let (_, rest) = page.split_once("\n## Equations in the code\n").expect("the section with the table");
    // Tables of other sections may begin with other numbers.
    let table = rest.split("\n## ").next().unwrap();
    let missing: Vec<usize> = (1..=EQUATIONS).filter(|number| !equations(table).contains(number)).collect();
    assert_eq!(missing, [0; 0], "equations without a row");
    let files: Vec<String> = links(table).into_iter().filter(|target| target.ends_with(".rs")).collect();
    assert!(files.len() >= 15, "{files:?}");
    assert!(files.iter().all(|file| repository("docs").join(file).exists()), "{files:?}");
    assert_eq!(equations("| 3 | a |\n| 5 to 7, 9 | b |\nnine 11"), BTreeSet::from([3, 5, 6, 7, 9]));
}

#[test]
fn the_page_of_settings_has_every_setting_that_is_ours_with_its_value() {
    let page = read("docs/settings.md");
    let mut section = String::new();
    let mut ours = 0;
    for line in read("reproduce/paper.toml").lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']').to_owned();
        } else if let Some((assignment, comment)) = line.split_once('#')
            && let Some((name, value)) = assignment.split_once('=')
            && ["ours", "extension:"].iter().any(|source| comment.contains(source))
        {
            let (name, value) = (name.trim(), value.trim().trim_matches('"'));
            let row = page.lines().find(|row| row.contains(&format!("`{section}.{name}`")));
            let row = row.unwrap_or_else(|| panic!("docs/settings.md has no row of {section}.{name}"));
            assert!(row.contains(value), "{section}.{name} is {value}, but docs/settings.md says {row}");
            ours += 1;
        }
    }
    assert!(ours >= 30, "{ours}");
}

#[test]
fn the_page_of_numbers_has_the_constants_of_the_code() {
    let Some(mut script) = python(&repository("reproduce/constants.py")) else { return };
    let said = Said::by(script.arg("--check"));
    assert_eq!(said.status, Some(0), "{said:?}");
}
