//! Test that every setting has its source.

use super::super::file::PAPER;
use super::*;

/// Keys of `reproduce/paper.toml`, each with its comment.
fn comments() -> Vec<(String, String)> {
    let (mut section, mut found) = ("", Vec::<(String, String)>::new());
    for line in PAPER.lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']');
        } else if let Some((assignment, comment)) = line.split_once('#') {
            match assignment.split_once('=') {
                Some((name, _)) => {
                    found.push((format!("{section}.{}", name.trim()), comment.trim().to_owned()));
                }
                // A comment that goes on, and not that of a section.
                None if line.starts_with(' ') => {
                    let (_, begun) = found.last_mut().expect("a setting before it");
                    *begun += &format!(" {}", comment.trim());
                }
                None => (),
            }
        }
    }
    found
}

#[test]
fn every_setting_has_the_source_and_the_meaning_that_its_comment_gives() {
    let in_words = |Described { key, source, meaning, .. }| {
        assert!(
            ["ours", "extension"].contains(&source.as_str()) || source.starts_with("stated ("),
            "{key}: {source}"
        );
        (key, format!("{source}: {meaning}"))
    };
    let described: Vec<_> = described().into_iter().map(in_words).collect();
    assert_eq!(described, comments());
    let sources: toml::Table = SOURCES.parse().unwrap();
    fn count(table: &toml::Table) -> usize {
        let tables = table.values().filter_map(toml::Value::as_table);
        tables.map(|inner| if inner.contains_key("meaning") { 1 } else { count(inner) }).sum()
    }
    assert_eq!(count(&sources), described.len(), "a source of no setting");
}
