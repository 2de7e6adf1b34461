//! Studies: what they write, that they go on where they were, and how they refuse what is no design.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Bodies of few sensors, for a second or two, and what else the designs below rest on.
const SMALL: &str = "
agent = { part_length = 0.3, part_radius = 0.05, gap = 0.0 }
skin = { around = 8, along = 3 }
physics = { duration = 1000.0 }
quantise = { scheme = \"pooled\" }
map = { of = \"distances\" }
schema = { sampler = \"equations\", prior = \"fraley-raftery\", start = \"uniform\", chains = 4, sweeps = 60 }
experiment = { simulations = 2, dimensions = [2, 4], coordinations = [0.5], dimension = 4 }
baselines = { clusters = [5] }
";

fn sensitivity_design() -> String {
    format!(
        "seed = 3
[settings]
{SMALL}
[[part]]
name = \"levels\"
title = \"Levels\"
paper = \"N (4.1)\"
settings = [\"quantise.levels\"]
why = \"Chosen\"
values = [{{ quantise = {{ levels = 3 }} }}]
[[part]]
name = \"gains\"
title = \"Gains\"
paper = \"Linear (5.1)\"
settings = [\"motion.stiffness\", \"motion.controller\"]
why = \"Chosen\"
values = [{{ motion = {{ controller = \"torque\", stiffness = 0.2 }} }}, {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }}]
"
    )
}

fn search_design() -> String {
    let round = |candidates: usize, simulations: usize| {
        let settings = SMALL.replace("simulations = 2", &format!("simulations = {simulations}"));
        format!("[[round]]\ncandidates = {candidates}\n[round.settings]\n{settings}")
    };
    format!(
        "seed = 1
[draws]
movements = 1
distances = 2
inferences = 1
[[score]]
claim = \"number-of-parts\"
experiment = \"exp1\"
weight = 1
slack = 5
[[score]]
claim = \"best-coordination\"
experiment = \"exp2\"
weight = 1
slack = 0.5
{}{}
[[start]]
name = \"gentle\"
settings = {{ quantise = {{ levels = 3 }}, motion = {{ controller = \"torque\", stiffness = 0.07, damping = 0.03 }} }}
[[start]]
name = \"unstable\"
settings = {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }}
[[factor]]
name = \"gains\"
decides = \"movement\"
options = [{{ motion = {{ controller = \"torque\", stiffness = 1.1, damping = 0.5 }} }}]
[[factor]]
name = \"edges\"
decides = \"inference\"
options = [{{ schema = {{ edge_weight = \"collapsed\" }} }}]
",
        round(4, 1),
        round(2, 2)
    )
}

fn comparison_design() -> String {
    format!(
        "title = \"Levels\"
about = \"How many levels.\"
seed = 1
[settings]
{SMALL}
[[claim]]
id = \"number-of-parts\"
experiment = \"exp1\"
label = \"parts\"
[[claim]]
id = \"best-coordination\"
experiment = \"exp2\"
label = \"best p\"
[[configuration]]
name = \"gentle\"
settings = {{ motion = {{ controller = \"torque\", stiffness = 0.07, damping = 0.03 }} }}
[[configuration]]
name = \"three\"
settings = {{ quantise = {{ levels = 3 }} }}
[[configuration]]
name = \"the same\"
settings = {{}}
[[configuration]]
name = \"unstable\"
settings = {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }}
"
    )
}

fn bodyschema(folder: &Path, arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bodyschema"))
        .current_dir(folder)
        .args(arguments.split(' '))
        .output()
        .unwrap()
}

fn succeed(folder: &Path, arguments: &str) -> String {
    let output = bodyschema(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// The files of a folder but its checkpoints, by name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if name == "ro-crate-metadata.json" {
            // Tells runs apart.
            continue;
        }
        if entry.path().is_file() {
            all.insert(name, fs::read(entry.path()).unwrap());
        } else if name != "checkpoints" {
            all.extend(
                files(&entry.path()).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)),
            );
        }
    }
    all
}

#[test]
fn a_study_says_what_each_value_does_goes_on_where_it_was_and_hangs_on_no_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("design.toml"), sensitivity_design()).unwrap();
    succeed(folder.path(), "sensitivity --design design.toml --jobs 1 --out one");
    let one = files(&at("one"));
    assert_eq!(
        one.keys().map(String::as_str).collect::<Vec<_>>(),
        [
            "design.toml",
            "figures/gains.svg",
            "figures/levels.svg",
            "manifest.json",
            "sensitivity.csv",
            "sensitivity.md"
        ]
    );
    let page = fs::read_to_string(at("one/sensitivity.md")).unwrap();
    assert!(page.contains("| levels = 3 |") && page.contains("2 simulations failed: "), "{page}");
    assert!(!page.contains("NaN"));
    let mut table = csv::Reader::from_path(at("one/sensitivity.csv")).unwrap();
    let rows: Vec<BTreeMap<String, String>> = table.deserialize().map(Result::unwrap).collect();
    // Of the default and three values: two mixtures at two d, and another p; five measures each.
    assert_eq!(rows.len(), 4 * 5 * 5);
    for row in &rows {
        assert_eq!(
            row["difference"].is_empty(),
            row["part"] == "default" || row["estimate"].is_empty() || {
                let same = |other: &&BTreeMap<String, String>| {
                    other["part"] == "default"
                        && ["coordination", "dimension", "model", "measure"]
                            .iter()
                            .all(|key| other[*key] == row[*key])
                };
                rows.iter().find(same).unwrap()["estimate"].is_empty()
            }
        );
        assert_eq!(row["failed"] == "2", row["value"].contains("damping"));
    }

    // A part is the same alone; what it shares with the whole study is taken from there.
    let told = succeed(folder.path(), "sensitivity --design design.toml --only levels --jobs 3 --out one");
    assert!(told.contains("continuing"), "{told}");
    let part = fs::read_to_string(at("one/sensitivity.md")).unwrap();
    assert!(part.contains("| levels = 3 |") && !part.contains("Gains"));
    // Half of the checkpoints are lost.
    let tasks = fs::read_dir(at("one/checkpoints")).unwrap().map(Result::unwrap);
    tasks.step_by(2).for_each(|task| fs::remove_dir_all(task.path()).unwrap());
    succeed(folder.path(), "sensitivity --design design.toml --jobs 3 --out one");
    assert_eq!(files(&at("one")), one);

    fs::remove_file(at("one/sensitivity.md")).unwrap();
    fs::remove_dir_all(at("one/figures")).unwrap();
    succeed(folder.path(), "plot one");
    assert_eq!(files(&at("one")), one);
}

#[test]
fn a_search_keeps_the_best_and_shows_which_claims_hold_together() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("design.toml"), search_design()).unwrap();
    succeed(folder.path(), "search --design design.toml --jobs 1 --out one");
    let one = files(&at("one"));
    assert_eq!(
        one.keys().map(String::as_str).collect::<Vec<_>>(),
        ["best.toml", "credits.csv", "design.toml", "manifest.json", "next.toml", "scores.csv", "search.md"]
    );
    let scores = String::from_utf8(one["scores.csv"].clone()).unwrap();
    let row = |start: &str| scores.lines().find(|line| line.starts_with(start)).unwrap().to_owned();
    // The two random draws are the same, and count once; what is unstable is last.
    assert_eq!(scores.lines().count(), 1 + 3 + 2);
    assert!(row("1,3,").contains("unstable,0.0,"), "{scores}");
    assert!(!scores.contains("\n2,3,") && !row("2,1,").contains("unstable"), "{scores}");
    // As many terms as rows for each candidate and round.
    assert_eq!(String::from_utf8(one["credits.csv"].clone()).unwrap().lines().count(), 1 + 2 * 5);
    assert!(
        String::from_utf8(one["search.md"].clone())
            .unwrap()
            .contains("candidates that reproduce both claims")
    );
    succeed(folder.path(), "verify one");
    succeed(folder.path(), "search --design design.toml --jobs 2 --out two");
    assert_eq!(files(&at("two")), one);
    // Its second part alone, as another machine would run it, with the candidates that the first part left.
    succeed(folder.path(), "search --design design.toml --from one/next.toml --out three");
    let second = |files: &BTreeMap<String, Vec<u8>>| {
        let scores = String::from_utf8(files["scores.csv"].clone()).unwrap();
        scores.lines().filter(|line| line.starts_with("2,")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(second(&files(&at("three"))), second(&one));
    let best = fs::read_to_string(at("one/best.toml")).unwrap();
    // The others turn too far in a step.
    assert!(best.contains("levels = 3") && row("2,1,").contains("gentle"), "{best}");
    fs::write(at("short.toml"), format!("{best}\n[physics]\nduration = 10.0\n")).unwrap();
    succeed(folder.path(), "simulate --settings short.toml --out body");
}

#[test]
fn a_comparison_says_how_far_each_claim_is_from_the_first_configuration_s() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("design.toml"), comparison_design()).unwrap();
    succeed(folder.path(), "compare --design design.toml --jobs 1 --out one");
    let one = files(&at("one"));
    let expected =
        ["comparison.csv", "comparison.md", "design.toml", "figures/claims-1.svg", "manifest.json"];
    assert_eq!(one.keys().map(String::as_str).collect::<Vec<_>>(), expected);
    let mut table = csv::Reader::from_path(at("one/comparison.csv")).unwrap();
    let rows: Vec<BTreeMap<String, String>> = table.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 4 * 2);
    let parts = |name: &str| {
        rows.iter().find(|row| row["configuration"] == name && row["claim"] == "number-of-parts").unwrap()
    };
    let number = |name: &str, column: &str| parts(name)[column].parse::<f64>().unwrap();
    // What is the same differs by nothing, whatever the simulations that are drawn.
    assert_eq!(number("the same", "change"), 0.0);
    let change = number("three", "value") - number("gentle", "value");
    assert!((number("three", "change") - change).abs() < 1e-12 && change != 0.0);
    // Two simulations are too few for an interval of a change.
    assert!(parts("three")["change_low"].is_empty() && !parts("three")["low"].is_empty());
    assert!(parts("gentle")["change"].is_empty() && parts("gentle")["resolved"] == "true");
    assert!(parts("unstable")["value"].is_empty() && parts("unstable")["failed"] == "4");
    let page = String::from_utf8(one["comparison.md"].clone()).unwrap();
    assert!(page.contains("4 movements failed: ") && !page.contains("NaN"), "{page}");

    succeed(folder.path(), "compare --design design.toml --jobs 3 --out two");
    assert_eq!(files(&at("two")), one);
    fs::remove_file(at("one/comparison.md")).unwrap();
    fs::remove_dir_all(at("one/figures")).unwrap();
    succeed(folder.path(), "plot one");
    assert_eq!(files(&at("one")), one);
    succeed(folder.path(), "verify one");
}

#[test]
fn what_is_no_design_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |command: &str, design: String, expected: &str| {
        fs::write(folder.path().join("design.toml"), design).unwrap();
        let output = bodyschema(folder.path(), &format!("{command} --design design.toml --out out"));
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message:?} lacks {expected:?}");
        assert_eq!(message.lines().count(), 1, "{message}");
    };
    let (study, search) = (sensitivity_design(), search_design());
    refused("sensitivity", "seed = 3".to_owned(), "design.toml: ");
    refused("sensitivity --only fins", study.clone(), "has no [[part]] named `fins`; it has levels, gains");
    refused("sensitivity", study.replace("\"gains\"", "\"levels\""), "`levels` cannot name a [[part]]");
    refused("sensitivity", study.replace("\"gains\"", "\"../gains\""), "`../gains` cannot name a [[part]]");
    refused("sensitivity", study.replace("quantise.levels", "quantise.layers"), "`quantise.layers`");
    refused("sensitivity", study.replace("levels = 3", "levels = 1"), "quantise.levels");
    refused("sensitivity", study.replace("levels = 3", "layers = 3"), "unknown setting `quantise.layers`");
    refused("search", study.clone(), "design.toml: ");
    refused("search", search.replace("number-of-parts", "beauty"), "no claim `beauty`");
    refused("search", search.replace("slack = 5", "slack = 0"), "must be positive");
    refused("search", search.replace("1e5", "-1.0"), "motion.stiffness");
    let comparison = comparison_design();
    refused("compare", search.clone(), "design.toml: ");
    refused("compare", comparison.replace("\"three\"", "\"gentle\""), "two configurations `gentle`");
    refused("compare", comparison.replace("number-of-parts", "beauty"), "names `beauty` of exp1");
    refused("compare", comparison.replace("levels = 3", "levels = 1"), "quantise.levels");
    let fewer = "levels = 3 }, experiment = { simulations = 1 }";
    refused("compare", comparison.replace("levels = 3 }", fewer), "another number of simulations");
    refused(
        "compare",
        comparison.replace("number-of-parts", "ari-too-few-clusters"),
        "names `ari-too-few-clusters`",
    );
    let output = bodyschema(folder.path(), "search --design nothing.toml --out out");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("nothing.toml"));
}
