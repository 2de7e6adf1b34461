//! The article says what the committed results say: its numbers are those of `article/values.toml`, which
//! `article/values.py` takes out of the results, and no number is typed by hand.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use toml::Table;

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("article").join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

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
    let pairs =
        [("```", "```"), ("`", "`"), ("#val(\"", "\")"), ("#pictures(", ")["), ("#bibliography(", ")")];
    let bare = pairs.iter().fold(lines.join(" "), |text, (open, close)| without(&text, open, close));
    // Citations, the usual level of intervals, and equations of the paper.
    let words: Vec<String> = without_conditions(&bare).split_whitespace().map(str::to_owned).collect();
    let known = |index: usize| {
        let next = words.get(index + 1).map_or("", String::as_str);
        let after = words.get(index + 2).map_or("", String::as_str);
        words[index].starts_with('@')
            || (words[index] == "95" && next == "%" && after.starts_with("interval"))
            || (index > 0 && ["equation", "section"].contains(&words[index - 1].as_str()))
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

/// Names of the values that the article takes.
fn taken(text: &str) -> BTreeSet<&str> {
    text.split("#val(\"").skip(1).filter_map(|rest| rest.split_once("\")")).map(|(name, _)| name).collect()
}

#[test]
fn no_number_is_typed_by_hand() {
    let text = read("content.typ");
    assert_eq!(typed(&text), [""; 0]);
    for (wrong, number) in [
        ("it is 65.2 % by the code", "65.2"),
        ("$84.6 %$ of the cases", "84.6"),
        ("20 bodies, see @table", "20"),
        ("#val(\"a\") of 19", "19"),
        ("a rate of 95 % at best", "95"),
    ] {
        assert_eq!(typed(wrong), [number]);
    }
    for right in [
        "$d = 14$ and $p <= 0.4$",
        "95 % intervals",
        "equation 22.",
        "#val(\"d14\")",
        "```sh\nexp1\n``` `a1` @a2017.",
    ] {
        assert_eq!(typed(right), [""; 0]);
    }
}

#[test]
fn every_value_has_a_source_and_is_used() {
    let (text, values) = (read("content.typ"), read("values.toml").parse::<Table>().unwrap());
    let names: BTreeSet<&str> = values.keys().map(String::as_str).filter(|name| *name != "table").collect();
    assert_eq!(taken(&text), names, "numbers of content.typ and of values.toml");
    assert_eq!(taken("#val(\"a\") and #val(\"b\")"), BTreeSet::from(["a", "b"]));
}

#[test]
fn numbers_of_the_abstract_are_values() {
    let values = read("values.toml").parse::<Table>().unwrap();
    let texts: BTreeSet<&str> = values.values().filter_map(|value| value.get("text")?.as_str()).collect();
    let metadata = read("metadata.yaml");
    let (_, rest) = metadata.split_once("abstract: \"").expect("an abstract");
    let unknown = |text: &str| -> Vec<String> {
        let words = text.split_whitespace().map(|word| word.trim_end_matches([',', '.', ':']));
        let numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit()));
        let known = |word: &str| texts.contains(word) || texts.contains(format!("{word} %").as_str());
        numbers.filter(|word| !known(word)).map(str::to_owned).collect()
    };
    assert_eq!(unknown(rest.split_once('"').unwrap().0), [""; 0]);
    assert_eq!(unknown("right in 12.3 % of 1,025 bodies"), ["12.3", "1,025"]);
}

/// Skipped with a message where there is no Python 3.11.
#[test]
fn values_are_those_of_the_committed_results() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("article/values.py");
    let modern = Command::new("python3").args(["-c", "import tomllib"]).output();
    if !modern.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: Python 3.11 is missing");
        return;
    }
    let output = Command::new("python3").arg(script).arg("--check").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
