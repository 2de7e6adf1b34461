//! Studies: what they write, that they continue where they were, and how they refuse what is no design.

use std::collections::BTreeMap;
use std::fs;

use crate::support::folder::Folder;

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

fn one_at_a_time() -> String {
    format!(
        "title = \"Levels and gains\"
seed = 3
vary = \"one-at-a-time\"
[settings]
{SMALL}
[[factor]]
name = \"levels\"
title = \"Levels\"
paper = \"N (4.1)\"
settings = [\"quantise.levels\"]
why = \"Chosen\"
option = [{{ settings = {{ quantise = {{ levels = 3 }} }} }}]
[[factor]]
name = \"gains\"
title = \"Gains\"
paper = \"Linear (5.1)\"
settings = [\"motion.stiffness\", \"motion.controller\"]
why = \"Chosen\"
option = [{{ settings = {{ motion = {{ controller = \"torque\", stiffness = 0.2 }} }} }}, {{ settings = {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }} }}]
"
    )
}

/// Two gains and two ways to weigh edges, all combinations, ranked.
fn ranked() -> String {
    format!(
        "title = \"A search\"
seed = 1
vary = \"grid\"
sections = [\"ranking\", \"trade-offs\", \"shares\"]
[settings]
{SMALL}
[[claim]]
id = \"number-of-parts\"
experiment = \"exp1\"
label = \"parts\"
weight = 1
slack = 5
[[claim]]
id = \"best-coordination\"
experiment = \"exp2\"
label = \"best p\"
weight = 1
slack = 0.5
[[factor]]
name = \"gains\"
paper = \"Linear (5.1)\"
option = [{{ label = \"gentle\", settings = {{ quantise = {{ levels = 3 }}, motion = {{ controller = \"torque\", stiffness = 0.07, damping = 0.03 }} }} }}, {{ label = \"unstable\", settings = {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }} }}]
[[factor]]
name = \"edges\"
paper = \"(13)\"
option = [{{ settings = {{ schema = {{ edge_weight = \"collapsed\" }} }} }}, {{ settings = {{ schema = {{ edge_weight = \"pairwise\" }} }} }}]
"
    )
}

fn named() -> String {
    let gentle = "motion = { controller = \"torque\", stiffness = 0.07, damping = 0.03 }";
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
settings = {{ {gentle} }}
[[configuration]]
name = \"three\"
settings = {{ quantise = {{ levels = 3 }}, {gentle} }}
[[configuration]]
name = \"the same\"
settings = {{ {gentle} }}
[[configuration]]
name = \"unstable\"
settings = {{ motion = {{ controller = \"torque\", stiffness = 1e5, damping = 1e5 }} }}
"
    )
}

#[test]
fn a_study_of_one_factor_at_a_time_says_what_each_value_does_and_continues_where_it_was() {
    let folder = Folder::new();
    folder.write("design.toml", one_at_a_time());
    folder.done("study design.toml --jobs 1 --out one");
    let one = folder.files("one");
    assert_eq!(
        one.keys().map(String::as_str).collect::<Vec<_>>(),
        [
            "configurations.csv",
            "design.toml",
            "figures/gains.svg",
            "figures/levels.svg",
            "manifest.json",
            "measures.csv",
            "study.csv",
            "study.md"
        ]
    );
    let page = folder.text("one/study.md");
    assert!(page.contains("| levels = 3 |") && page.contains("2 simulations failed: "), "{page}");
    assert!(!page.contains("NaN"));
    let rows = folder.rows("one/measures.csv");
    // Of the default and three values: two mixtures at two d, and another p; five measures each.
    assert_eq!(rows.len(), 4 * 5 * 5);
    for row in &rows {
        let same = |other: &&BTreeMap<String, String>| {
            other["configuration"] == "1"
                && ["coordination", "dimension", "model", "measure"]
                    .iter()
                    .all(|key| other[*key] == row[*key])
        };
        let base = rows.iter().find(same).unwrap();
        let no_change = row["configuration"] == "1" || row["value"].is_empty() || base["value"].is_empty();
        assert_eq!(row["change"].is_empty(), no_change, "{row:?}");
        assert_eq!(row["failed"] == "2", row["configuration"] == "4", "{row:?}");
    }

    // A finished study is not run again, and not lost to a part of it.
    assert!(folder.run("study design.toml --out one").out.contains("already"));
    folder.refuse("study design.toml --only levels --out one", "holds the tables of 4 configurations");
    assert_eq!(folder.files("one"), one);

    // A factor is the same alone, and what is run after it continues from there.
    folder.done("study design.toml --only levels --jobs 3 --out part");
    let part = folder.text("part/study.md");
    assert!(part.contains("| levels = 3 |") && !part.contains("Gains"), "{part}");
    let told = folder.done("study design.toml --jobs 3 --out part").err;
    assert!(told.contains("continuing"), "{told}");
    assert_eq!(folder.files("part"), one);

    fs::remove_file(folder.at("one/study.md")).unwrap();
    fs::remove_dir_all(folder.at("one/figures")).unwrap();
    folder.done("plot one");
    assert_eq!(folder.files("one"), one);
}

#[test]
fn a_ranking_has_the_settings_of_the_best_and_shows_which_claims_hold_together() {
    let folder = Folder::new();
    folder.write("design.toml", ranked());
    folder.done("study design.toml --jobs 2 --out one");
    let ranking = folder.rows("one/ranking.csv");
    assert_eq!(ranking.len(), 4);
    // What is unstable is last, and has no score.
    let names: Vec<&str> = ranking.iter().map(|row| row["name"].as_str()).collect();
    assert!(names[2].starts_with("unstable") && names[3].starts_with("unstable"), "{names:?}");
    assert!(ranking[3]["score"] == "0.0" && ranking[0]["score"] != "0.0" && ranking[0]["claims"] == "2");
    let page = folder.text("one/study.md");
    assert!(page.contains("configurations that reproduce both claims") && !page.contains("NaN"), "{page}");
    folder.done("verify one");
    let best = folder.text("one/best.toml");
    assert!(best.contains("levels = 3"), "{best}");
    folder.done("simulate --settings one/best.toml --out body");
}

#[test]
fn a_study_of_named_configurations_says_how_far_each_claim_is_from_the_first_one_s() {
    let folder = Folder::new();
    folder.write("design.toml", named());
    folder.done("study design.toml --jobs 1 --out one");
    let one = folder.files("one");
    let expected = [
        "configurations.csv",
        "design.toml",
        "figures/claims-1.svg",
        "manifest.json",
        "study.csv",
        "study.md",
    ];
    assert_eq!(one.keys().map(String::as_str).collect::<Vec<_>>(), expected);
    let claims = folder.rows("one/study.csv");
    assert_eq!(claims.len(), 4 * 2);
    let parts = |name: &str| {
        claims.iter().find(|row| row["name"] == name && row["claim"] == "number-of-parts").unwrap()
    };
    let number = |name: &str, column: &str| parts(name)[column].parse::<f64>().unwrap();
    // What is the same differs by nothing, whatever the simulations that are drawn.
    assert_eq!(number("the same", "change"), 0.0);
    let change = number("three", "value") - number("gentle", "value");
    assert!((number("three", "change") - change).abs() < 1e-12 && change != 0.0);
    // Two simulations are too few for an interval of a change.
    assert!(parts("three")["change_low"].is_empty() && !parts("three")["low"].is_empty());
    assert!(parts("gentle")["change"].is_empty() && parts("unstable")["value"].is_empty());
    let configurations = folder.rows("one/configurations.csv");
    assert!(configurations[0]["resolved"] == "true" && configurations[3]["failed"] == "4");
    let page = String::from_utf8(one["study.md"].clone()).unwrap();
    assert!(page.contains("4 movements failed: ") && !page.contains("NaN"), "{page}");

    // Shards of any design.
    for shard in ["2/2", "1/2"] {
        folder.done(&format!("study design.toml --shard {shard} --jobs 3 --out two"));
    }
    folder.done("study design.toml --gather --out two");
    assert_eq!(folder.files("two"), one);
    folder.done("verify one");
}

#[test]
fn what_is_no_design_is_refused_in_one_line() {
    let folder = Folder::new();
    let refused = |arguments: &str, design: String, expected: &str| {
        folder.write("design.toml", design);
        folder.refuse(&format!("study design.toml {arguments} --out out"), expected);
    };
    let study = one_at_a_time();
    refused("", "seed = 3".to_owned(), "design.toml: ");
    refused("", "title = \"a\"\nseed = 3\nbeauty = 1".to_owned(), "unknown field `beauty`, expected one of");
    refused(
        "--only fins",
        study.clone(),
        "no configuration `fins`; give a number from 1 to 4, a name, or a factor: levels, gains",
    );
    refused("", study.replace("\"gains\"", "\"levels\""), "two of `levels`");
    refused("", study.replace("\"gains\"", "\"../gains\""), "`../gains` cannot name a factor");
    refused("", study.replace("quantise.levels", "quantise.layers"), "`quantise.layers`");
    refused("", study.replace("levels = 3", "levels = 1"), "quantise.levels");
    refused("", study.replace("levels = 3", "layers = 3"), "unknown setting `quantise.layers`");
    let search = ranked();
    refused("", search.replace("number-of-parts", "beauty"), "names `beauty` of exp1");
    refused("", search.replace("slack = 5", "slack = 0"), "must both be there and positive");
    refused("", search.replace("weight = 1\nslack = 5", "weight = 1"), "must both be there and positive");
    refused("", search.replace("1e5", "-1.0"), "motion.stiffness");
    refused("", search.clone() + "[next]\nkeep = 2\n", "unknown field `next`, expected one of");
    refused(
        "",
        search.replace("weight = 1\nslack = 5\n", "").replace("weight = 1\nslack = 0.5\n", ""),
        "needs a [[claim]] with",
    );
    refused(
        "",
        search.replace("dimension = 4 }", "dimension = 4, seed = 9 }"),
        "`experiment.seed`; use the key `seed`",
    );
    let comparison = named();
    refused("", comparison.replace("\"three\"", "\"gentle\""), "two of `gentle` among configurations");
    refused("", comparison.replace("number-of-parts", "beauty"), "names `beauty` of exp1");
    refused("", comparison.replace("levels = 3", "levels = 1"), "quantise.levels");
    let fewer = "levels = 3 }, experiment = { simulations = 1 }";
    refused("", comparison.replace("levels = 3 }", fewer), "another number of simulations");
    refused(
        "",
        comparison.replace("number-of-parts", "ari-too-few-clusters"),
        "names `ari-too-few-clusters`",
    );
    fs::create_dir_all(folder.at("other/checkpoints")).unwrap();
    folder.write("design.toml", &comparison);
    folder.refuse("study design.toml --out other", "another command");
    let said = folder.run("study nothing.toml --out out");
    said.is_refused("nothing.toml: no such file");
    said.is_refused("multiverse");
}
