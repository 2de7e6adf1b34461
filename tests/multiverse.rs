//! Studies of drawn configurations: shards give the bytes of one run, what was stopped continues, a failure is a result, and what
//! cannot be done is refused in one line.

use std::collections::BTreeMap;
use std::fs;

use crate::support::folder::Folder;

/// Bodies of few sensors, for seconds. One of the two controllers is unstable.
const DESIGN: &str = r#"
title = "A multiverse"
seed = 100
groups = ["levels"]
[draws]
movements = 4
distances = 2
maps = 2
inferences = 1
[settings]
skin = { around = 8, along = 3 }
physics = { duration = 1000.0 }
schema = { chains = 3, sweeps = 30 }
experiment = { simulations = 2, dimensions = [2, 4], coordinations = [0.4], dimension = 4 }
[[claim]]
id = "number-of-parts"
experiment = "exp1"
label = "number\nof parts"
[[claim]]
id = "ari-unknown-number"
experiment = "exp1"
label = "ARI"
[[factor]]
name = "gains"
level = "movement"
paper = "nothing"
[[factor.option]]
label = "gentle"
why = "it is stable"
gains = { frequency = 1.0, spin_damping = 0.1 }
[[factor.option]]
label = "wild"
why = "it is not"
settings = { motion = { controller = "torque", stiffness = 1e5, damping = 1e5 } }
[[factor]]
name = "levels"
level = "distances"
paper = "N"
[[factor.option]]
label = "two"
why = "few"
settings = { quantise = { levels = 2 } }
[[factor.option]]
label = "four"
why = "more"
settings = { quantise = { levels = 4 } }
[[factor]]
name = "scaled"
level = "map"
paper = "the distances"
[[factor.option]]
label = "distances"
why = "as it says"
settings = { map = { of = "distances" } }
[[factor.option]]
label = "rows"
why = "as the code does"
settings = { map = { of = "rows" } }
[[factor]]
name = "start"
level = "inference"
paper = "nothing"
[[factor.option]]
label = "uniform"
why = "plain"
settings = { schema = { start = "uniform" } }
[[factor.option]]
label = "k-means"
why = "usual"
settings = { schema = { start = "k-means" } }
"#;

#[test]
fn shards_give_the_bytes_of_one_run_and_a_failure_is_a_result() {
    let folder = Folder::new();
    folder.write("design.toml", DESIGN);
    folder.done("study design.toml --jobs 1 --out whole");
    let whole = folder.files("whole");
    assert!(!folder.at("whole/checkpoints").exists());

    let configurations = folder.rows("whole/configurations.csv");
    assert!(configurations.len() > 8 && configurations.len() <= 16, "{}", configurations.len());
    for row in &configurations {
        // What is unstable has a reason, and no value.
        assert_eq!(row["gains"] == "wild", !row["failure"].is_empty(), "{row:?}");
        assert_eq!(row["gains"] == "wild", row["failed"] != "0");
    }
    // An even draw has both options of every factor, and of the first as often as can be.
    let wild = configurations.iter().filter(|row| row["gains"] == "wild").count();
    assert!((4..=configurations.len() - 4).contains(&wild), "{wild}");
    let claims = folder.rows("whole/study.csv");
    assert_eq!(claims.len(), 2 * configurations.len());
    assert_eq!(claims.iter().filter(|row| row["value"].is_empty()).count(), 2 * wild);
    let shares = folder.rows("whole/shares.csv");
    let all = shares.iter().find(|row| row["group"] == "all" && row["claim"] == "number-of-parts").unwrap();
    assert_eq!(all["n"].parse::<usize>().unwrap(), configurations.len());
    assert_eq!(all["with_value"].parse::<usize>().unwrap(), configurations.len() - wild);
    for name in ["study.md", "variance.csv", "figures/number-of-parts.svg"] {
        let text = String::from_utf8(whole[name].clone()).unwrap();
        assert!(!text.contains("NaN") && !text.is_empty(), "{name}");
    }

    // Shards, one of them stopped and run again, in any order and with any number of threads.
    let shard = |shard: &str, jobs: usize| {
        folder.done(&format!("study design.toml --shard {shard} --jobs {jobs} --out shards"));
    };
    shard("3/3", 2);
    let movements = folder.at("shards/checkpoints/movements");
    let finished = fs::read_dir(&movements).unwrap().map(|entry| entry.unwrap().path());
    fs::remove_file(finished.min().unwrap()).unwrap();
    // What a killed process may leave.
    fs::create_dir_all(folder.at("shards/checkpoints/of-a-killed-shard")).unwrap();
    fs::write(movements.join("half.json.bodyschema.partial"), "{").unwrap();
    // What a comment says is no part of a design.
    folder.write("design.toml", format!("# Four movements.\n{DESIGN}"));
    shard("1/3", 1);
    folder.refuse("study design.toml --gather --out shards", "lacks");
    for part in ["2/3", "3/3"] {
        shard(part, 3);
    }
    folder.done("study design.toml --gather --out shards");
    assert_eq!(folder.files("shards"), whole);
    assert!(!folder.at("shards/checkpoints").exists());

    // Its page can be made again from the folder alone.
    fs::remove_file(folder.at("shards/study.md")).unwrap();
    folder.done("plot shards");
    assert_eq!(folder.files("shards"), whole);

    // Any one can be run again by its number, and by its settings.
    folder.done("study design.toml --only 2 --out two");
    let second = |all: Vec<BTreeMap<String, String>>| {
        all.into_iter().filter(|row| row["configuration"] == "2").collect::<Vec<_>>()
    };
    assert_eq!(folder.rows("two/study.csv"), second(claims));
    assert_eq!(folder.rows("two/configurations.csv"), second(configurations));
    folder.done("simulate --settings two/settings.toml --out body");
    folder.done("verify whole");
}

/// Two meanings of an eligible sample judge the same samples, a reading overrides what it brings itself, and what is finished can be
/// joined.
#[test]
fn an_evaluation_takes_no_new_samples_and_ranges_are_joined() {
    let folder = Folder::new();
    let more = r#"
[[factor]]
name = "reading"
level = "inference"
paper = "both"
[[factor.option]]
label = "equations"
weight = 3
why = "the text"
[[factor.option]]
label = "code"
why = "the code"
settings = { schema = { sampler = "authors-code", start = "stick-breaking" } }
[[factor]]
name = "counts"
level = "evaluation"
paper = "1.00"
[[factor.option]]
label = "exact"
why = "exact"
settings = { evaluate = { eligible_ari = 1.0 } }
[[factor.option]]
label = "lenient"
why = "lenient"
settings = { evaluate = { eligible_ari = 0.2 } }
"#;
    let claim = "[[claim]]\nid = \"baseline-tree\"\nexperiment = \"exp1\"\nlabel = \"tree\"\n[[factor]]\nname = \"gains\"";
    let design = DESIGN.replacen("[[factor]]\nname = \"gains\"", claim, 1) + more;
    let design = design
        .replace(
            "movements = 4\ndistances = 2\nmaps = 2\ninferences = 1",
            "movements = 2\ndistances = 1\nmaps = 1\ninferences = 4",
        )
        // As many components as parts, so that the number of parts is often right.
        .replace("chains = 3, sweeps = 30", "chains = 8, sweeps = 60, components = 5");
    folder.write("design.toml", design);
    folder.done("study design.toml --out whole");
    let configurations = folder.rows("whole/configurations.csv");
    let claims = folder.rows("whole/study.csv");
    let n = |configuration: &str, claim: &str| -> usize {
        let row = claims.iter().find(|row| row["configuration"] == configuration && row["claim"] == claim);
        row.unwrap()["n"].parse().unwrap()
    };
    let mut more = 0;
    for pair in configurations.chunks(2) {
        let [exact, lenient] = pair else { panic!("{pair:?}") };
        assert_eq!((&*exact["counts"], &*lenient["counts"]), ("exact", "lenient"));
        let (exact_n, lenient_n) =
            (n(&exact["configuration"], "baseline-tree"), n(&lenient["configuration"], "baseline-tree"));
        assert!(exact_n <= lenient_n);
        more += lenient_n - exact_n;
        assert_eq!(exact["reading"] == "code", exact["start"].is_empty(), "{exact:?}");
    }
    assert!(more > 0, "some samples count only leniently: {claims:?}");

    // Ranges of movements, in any order, give the same tables.
    let half = configurations.iter().filter(|row| row["movement"] == "1").count();
    let ranges = ["movements-2-2", "movements-1-1"];
    for range in ranges {
        folder.done(&format!("study design.toml --only {range} --out parts/{range}"));
    }
    folder.done("study design.toml --join parts --out joined");
    let (whole, joined) = (folder.files("whole"), folder.files("joined"));
    assert_eq!(joined, whole);
    // What is there is joined, and says how much it is; twice the same is refused.
    fs::remove_dir_all(folder.at(format!("parts/{}", ranges[0]))).unwrap();
    folder.done("study design.toml --join parts --out some");
    assert_eq!(folder.rows("some/configurations.csv").len(), half);
    let page = folder.text("some/study.md");
    assert!(page.contains(&format!("{half} of the {} of the design", configurations.len())), "{page}");
    folder.done("study design.toml --only 1 --out parts/again");
    folder.refuse("study design.toml --join parts --out twice", "two of one configuration");
}

#[test]
fn another_seed_gives_other_movements_and_is_kept_with_the_design() {
    let folder = Folder::new();
    folder.write("base.toml", DESIGN);
    let over = "extends = \"base.toml\"\n[draws]\nmovements = 1\ndistances = 1\n";
    folder.write("small.toml", over);
    folder.done("study small.toml --only 1 --out first");
    folder.done("study small.toml --only 1 --seed 200 --out second");
    assert_ne!(folder.bytes("first/study.csv"), folder.bytes("second/study.csv"));
    folder.done("study second/design.toml --only 1 --out third");
    assert_eq!(folder.bytes("second/study.csv"), folder.bytes("third/study.csv"));
}

#[test]
fn what_cannot_be_done_is_refused_in_one_line() {
    let folder = Folder::new();
    let refused = |design: &str, arguments: &str, expected: &str| {
        folder.write("design.toml", design);
        folder.refuse(&format!("study design.toml {arguments}"), expected);
    };
    let empty = DESIGN.split("[[factor.option]]\nlabel = \"uniform\"").next().unwrap();
    refused(&format!("{empty}option = []\n"), "--out out", "`start` without an option");
    refused(&DESIGN.replace("movements = 4", "movements = 0"), "--out out", "draws nothing");
    refused(&DESIGN.replace("number-of-parts", "beauty"), "--out out", "names `beauty`");
    refused(&DESIGN.replace("levels = 2 }", "levels = 1 }"), "--out out", "quantise.levels");
    refused(&DESIGN.replace("[\"levels\"]", "[\"fins\"]"), "--out out", "groups by `fins`");
    refused(
        &DESIGN.replace("level = \"map\"", "level = \"mop\""),
        "--out out",
        "`movement`, `distances`, `map`",
    );
    refused(&DESIGN.replace("level = \"map\"\n", ""), "--out out", "`scaled` without `level`");
    refused(&DESIGN.replace("seed = 100", "seed = 100\nvary = \"grid\""), "--out out", "one of these");
    refused(
        &DESIGN.replace("seed = 100", "seed = 100\nsections = [\"factors\"]"),
        "--out out",
        "one-at-a-time",
    );
    refused(&DESIGN.replace("seed = 100", "seed = 100\nsections = [\"beauty\"]"), "--out out", "`values`");
    refused(DESIGN, "--only 99 --out out", "there is no configuration `99`; give a number from 1 to");
    refused(&DESIGN.replace("movements = 4", "movements = 70000"), "--out out", "more than 65536");
    refused(&DESIGN.replace("name = \"start\"", "name = \"failed\""), "--out out", "two of `failed`");
    refused(&DESIGN.replace("label = \"four\"", "label = \"two\""), "--out out", "two of `two`");
    refused(&DESIGN.replace("simulations = 2", "simulations = 1"), "--out out", "one simulation");
    refused(&DESIGN.replace("maps = 2", "maps = 2\nkeep = 1.5"), "--out out", "`draws.keep` = 1.5");
    refused(&DESIGN.replace("why = \"few\"", "why = \"few\"\nweight = 0"), "--out out", "weight 0");
    let judged = DESIGN.replace("level = \"distances\"", "level = \"evaluation\"");
    refused(&judged, "--out out", "`two` at the level evaluation");
    let left_out =
        DESIGN.replace("[draws]", "[[left_out]]\nwhat = [\"agent.beauty\"]\nwhy = \"no\"\n[draws]");
    refused(&left_out, "--out out", "leaves out `agent.beauty`");
    let twice = DESIGN
        .replace("spin_damping = 0.1 }", "spin_damping = 0.1 }\nsettings = { motion = { error = \"raw\" } }");
    refused(&twice, "--out out", "gains are those of a torque");
    folder.write("design.toml", DESIGN);
    for shard in ["3/2", "0/2", "1/0", "x", "-1/2"] {
        let said = folder.run(&format!("study design.toml --shard={shard} --out out"));
        assert!(said.status == Some(2) && said.err.contains("a shard is I/N"), "{said:?}");
    }
    folder.write("other/design.toml", "seed = 1");
    refused(DESIGN, "--out other", "another design");
    refused(DESIGN, "--gather --out other", "another design");
    refused(DESIGN, "--gather --out empty", "design.toml");
    folder.done("study design.toml --only 1 --out damaged");
    let cut = folder.text("damaged/study.csv").lines().take(2).collect::<Vec<_>>().join("\n");
    folder.write("damaged/study.csv", cut);
    folder.refuse("plot damaged", "study.csv: is not of the design");
}
