//! The article says what the committed results say: its numbers are those of `article/values.toml`, which
//! `article/values.py` takes out of the results, and no number is typed by hand. The committed PDF is made from the
//! committed sources, by the hashes of `article/article.sha256`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use sha2::{Digest, Sha256};
use toml::Table;

use crate::support::repository::{entries, read, repository};
use crate::support::said::Said;
use crate::support::tools::python;

/// Removes what lies between `open` and the next `close`, both included.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(open) {
        kept.push_str(before);
        rest = after.split_once(close).map_or("", |(_, rest)| rest);
    }
    kept + rest
}

/// What lies between `open` and the next `close`, another mark, each time.
fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(open).skip(1).filter_map(move |rest| rest.split_once(close)).map(|(inner, _)| inner)
}

/// Formulas that state a condition, such as `d = 14`, which no result can be.
fn without_conditions(text: &str) -> String {
    let condition = |formula: &str| {
        let words: Vec<&str> = formula.split(' ').collect();
        matches!(words.as_slice(), [symbol, "=" | "<=", number]
            if ["d", "p", "K"].contains(symbol) && number.parse::<f64>().is_ok())
    };
    let piece =
        |(index, piece): (usize, &str)| (index % 2 == 0 || !condition(piece)).then(|| piece.to_owned());
    text.split('$').enumerate().filter_map(piece).collect::<Vec<_>>().join(" ")
}

/// The prose of the article: what is neither code, nor a path, nor taken from the results, nor a condition.
fn prose(text: &str) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("//")).collect();
    let pairs = [
        ("```", "```"),
        ("`", "`"),
        ("#val(\"", "\")"),
        ("#either(\"", "\")"),
        ("#pictures(", ")["),
        ("#bibliography(", ")"),
    ];
    let bare = pairs.iter().fold(lines.join(" "), |text, (open, close)| without(&text, open, close));
    // Citations, the usual level of intervals, the paper's algorithm, and its equations.
    let words: Vec<String> = without_conditions(&bare).split_whitespace().map(str::to_owned).collect();
    let known = |index: usize| {
        let next = words.get(index + 1).map_or("", String::as_str);
        let after = words.get(index + 2).map_or("", String::as_str);
        let before = if index > 0 { words[index - 1].as_str() } else { "" };
        words[index].starts_with('@')
            || (words[index] == "95" && next == "%" && after.starts_with("interval"))
            || ["equation", "Equation", "section", "Algorithm"].contains(&before)
    };
    (0..words.len())
        .filter(|&index| !known(index))
        .map(|index| words[index].as_str())
        .collect::<Vec<_>>()
        .join(" ")
}

/// Words of the article that are numbers typed by hand.
fn typed(text: &str) -> Vec<String> {
    let prose = prose(text);
    prose.split(' ').filter(|word| word.contains(|c: char| c.is_ascii_digit())).map(str::to_owned).collect()
}

#[test]
fn no_number_is_typed_by_hand() {
    let text = read("article/content.typ");
    assert_eq!(typed(&text), [""; 0]);
    for (wrong, number) in [
        ("it is 65.2 % by the code", "65.2"),
        ("$84.6 %$ of the cases", "84.6"),
        ("20 simulations, see @table", "20"),
        ("#val(\"a\") of 19", "19"),
        ("a rate of 95 % at best", "95"),
        ("#either(\"a\")[12][twelve]", "[12][twelve]"),
    ] {
        assert_eq!(typed(wrong), [number]);
    }
    for right in [
        "$d = 14$ and $p <= 0.4$",
        "95 % intervals",
        "equation 22.",
        "#val(\"d14\") #either(\"d14\")[one][another]",
        "```sh\nexp1\n``` `a1` @a2017.",
    ] {
        assert_eq!(typed(right), [""; 0]);
    }
}

#[test]
fn every_value_has_a_source_and_is_used() {
    let (text, values) = (read("article/content.typ"), read("article/values.toml").parse::<Table>().unwrap());
    let holds: BTreeSet<&str> = values["holds"].as_table().unwrap().keys().map(String::as_str).collect();
    assert_eq!(between(&text, "#either(\"", "\")").collect::<BTreeSet<_>>(), holds, "choices of content.typ");
    let sourced = |(name, value): (&String, &toml::Value)| value.get("from").map(|_| name.to_owned());
    let names: BTreeSet<String> = values.iter().filter_map(sourced).collect();
    // The abstract takes values, too.
    let (abstract_, script) = (["of(\"", "of('"], read("article/abstract.py"));
    let taken = between(&text, "#val(\"", "\")").chain(between(&script, abstract_[0], "\")")).chain(between(
        &script,
        abstract_[1],
        "')",
    ));
    assert_eq!(
        taken.map(str::to_owned).collect::<BTreeSet<_>>(),
        names,
        "numbers of content.typ and of values.toml"
    );
    let two: Vec<&str> = between("#val(\"a\") and #val(\"b\")", "#val(\"", "\")").collect();
    assert_eq!(two, ["a", "b"]);
}

/// Paths of the repository that a text names as code.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2).filter(|name| name.contains('/'))
}

#[test]
fn every_path_in_the_text_exists() {
    let text = read("article/content.typ");
    let lost: Vec<&str> = paths(&text).filter(|name| !repository(name).exists()).collect();
    assert_eq!(lost, [""; 0], "paths that content.typ names");
    assert_eq!(paths("`a` is in `b/c`, not in `d/e`").collect::<Vec<_>>(), ["b/c", "d/e"]);
}

/// The text of a key of `metadata.yaml` that is a folded block.
fn folded(text: &str, key: &str) -> String {
    let (_, rest) = text.split_once(&format!("\n{key}: >-\n")).unwrap_or_else(|| panic!("no {key}"));
    rest.lines().take_while(|line| line.starts_with("  ")).map(str::trim).collect::<Vec<_>>().join(" ")
}

#[test]
fn numbers_of_the_abstract_are_values() {
    let values = read("article/values.toml").parse::<Table>().unwrap();
    let texts = values.values().filter_map(|value| value.get("text")?.as_str());
    let known: BTreeSet<&str> = texts.flat_map(str::split_whitespace).collect();
    let unknown = |text: &str| -> Vec<String> {
        let words: Vec<&str> =
            text.split_whitespace().map(|word| word.trim_end_matches([',', '.', ':'])).collect();
        let usual = |index: usize| words[index..].starts_with(&["95", "%", "interval"]);
        let numbers =
            (0..words.len()).filter(|&index| words[index].starts_with(|c: char| c.is_ascii_digit()));
        numbers
            .filter(|&index| !known.contains(words[index]) && !usual(index))
            .map(|index| words[index].to_owned())
            .collect()
    };
    assert_eq!(unknown(&folded(&read("article/metadata.yaml"), "abstract")), [""; 0]);
    assert_eq!(unknown("the 95 % interval is right in 12.3 % of 1,025 bodies"), ["12.3", "1,025"]);
}

#[test]
fn values_are_those_of_the_committed_results() {
    let Some(mut script) = python(&repository("article/values.py")) else { return };
    let said = Said::by(script.arg("--check"));
    assert_eq!(said.status, Some(0), "{said:?}");
}

// ---- The committed PDF

const PDF: &str = "article/article.pdf";

fn digest(data: &[u8]) -> String {
    Sha256::digest(data).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Files of which the hash differs from that of `hashes`, which has a line for each, as `sha256sum` writes it.
fn stale(hashes: &str, data: impl Fn(&str) -> Vec<u8>) -> Vec<&str> {
    let lines = hashes.lines().map(|line| line.split_once("  ").expect("a hash and a path"));
    lines.filter(|(hash, name)| digest(&data(name)) != *hash).map(|(_, name)| name).collect()
}

/// What the PDF is made from, by the text of the article: all files of its folder that are no scripts of the numbers,
/// and the pictures that the text names and that exist (experiment 2 of the confirmation may be unfinished).
fn sources(text: &str) -> BTreeSet<String> {
    let scripts = ["abstract.py", "choices.toml", "committed.py", "tables.py", "values.py"];
    let made = ["article.pdf", "article.sha256"];
    let names =
        entries("article").into_iter().map(|path| path.file_name().unwrap().to_str().unwrap().to_owned());
    let own = names.filter(|name| !scripts.contains(&name.as_str()) && !made.contains(&name.as_str()));
    let pictures = between(text, "\"/docs/", "\"").map(|name| format!("docs/{name}"));
    let pictures = pictures.filter(|name| repository(name).exists());
    own.map(|name| format!("article/{name}")).chain(pictures).collect()
}

#[test]
fn the_pdf_is_made_from_the_committed_sources() {
    let hashes = read("article/article.sha256");
    let advice = "run reproduce/article.sh --write, and commit article/";
    let listed: BTreeSet<String> = hashes.lines().map(|line| line[66..].to_owned()).collect();
    let mut expected = sources(&read("article/content.typ"));
    expected.insert(PDF.to_owned());
    assert_eq!(listed, expected, "article/article.sha256 lists other files; {advice}");
    let data =
        |name: &str| fs::read(repository(name)).unwrap_or_else(|error| panic!("{name}: {error}; {advice}"));
    let changed = stale(&hashes, data);
    assert!(changed.is_empty(), "{PDF} is stale: {} changed since it was made; {advice}", changed.join(", "));
    let pdf = data(PDF);
    assert!(pdf.starts_with(b"%PDF-") && pdf.len() < 400_000, "{PDF} has {} bytes", pdf.len());
}

#[test]
fn a_changed_source_is_found() {
    let files = BTreeMap::from([("a", b"one".to_vec()), ("b", b"two".to_vec())]);
    let hashes: String = files.iter().map(|(name, data)| format!("{}  {name}\n", digest(data))).collect();
    assert_eq!(stale(&hashes, |name| files[name].clone()), [""; 0]);
    let other = |name: &str| if name == "b" { b"tWo".to_vec() } else { files[name].clone() };
    assert_eq!(stale(&hashes, other), ["b"]);
}
