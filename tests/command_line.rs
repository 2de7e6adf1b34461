//! The program as a user meets it: every stage by hand, and a small experiment.

use std::collections::BTreeMap;

use bodyschema::files::{npy, sha256};
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::distance::Distances;
use bodyschema::stages::sense::Tactile;

use crate::support::folder::Folder;
use crate::support::repository::{read, repository};
use crate::support::small::{separated_clusters, small};

/// The small body for longer, so that its parts and tree are found.
const LONGER: &str = "physics.duration = 1500.0\nexperiment.seed = 11\n";

fn folder_with_settings() -> Folder {
    let folder = Folder::new();
    folder.write("small.toml", small(&format!("{LONGER}experiment.simulations = 2")));
    folder
}

fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

fn header(text: &str) -> &str {
    text.lines().next().unwrap()
}

/// Pressures of a body, of which 2 % are missing, with a sensor that is dead, one that is constant and one that is missing half of the
/// time, all in the beginning.
fn with_faults(folder: &Folder, tactile: &str, out: &str) {
    let mut tactile = npy::read_tactile(&folder.at(tactile)).unwrap();
    let samples = tactile.samples;
    tactile.pressures.iter_mut().step_by(53).for_each(|pressure| *pressure = f32::NAN);
    tactile.pressures[..samples].fill(0.0);
    tactile.pressures[samples..2 * samples].fill(7.0);
    tactile.pressures[2 * samples..2 * samples + samples / 2].fill(f32::NAN);
    npy::write_tactile(&folder.at(out), &tactile).unwrap();
}

#[test]
fn one_command_finds_parts_and_tree() {
    let folder = Folder::new();
    folder.write("moving.toml", small(&format!("{LONGER}motion.coordination = 0.5")));
    folder.succeed("simulate --settings moving.toml --out body");
    with_faults(&folder, "body/tactile.npy", "own.npy");
    let said =
        folder.run("estimate own.npy --labels body/labels.csv --tree body/tree.csv --repeats 2 --out found");
    assert_eq!(said.status, Some(0), "{said:?}");
    assert!(said.out.starts_with("fit: good: rigid motions explain "), "{said:?}");
    assert!(said.out.contains("5 parts of 117 sensors") && !said.out.contains("16 and more"), "{said:?}");
    assert!(said.out.contains("adjusted Rand index 1.000, true tree recovered"), "{said:?}");
    assert!(said.err.contains("3 of 120 sensors are left out (the first, 0, is dead)"), "{said:?}");
    assert!(said.err.contains("(1.89 %) are missing of the sensors that are used; they are not"), "{said:?}");
    let faults: Vec<String> =
        folder.rows("found/dropped.csv").iter().map(|row| row["fault"].clone()).collect();
    assert_eq!(faults, ["dead", "constant", "missing"]);
    assert!(said.out.contains("estimated again 2 times from resampled times"), "{said:?}");
    let parts = folder.rows("found/parts.csv");
    assert_eq!(parts.len(), 117);
    // Most sensors are found again on their parts, and all parts with their joints.
    assert!(parts.iter().filter(|row| row["repeated"] == "1.0").count() > 100);
    let repeats = folder.rows("found/repeats.csv");
    assert_eq!(repeats.iter().filter(|row| row["joined_to"].is_empty()).count(), 5);
    assert!(repeats.len() == 9 && repeats.iter().all(|row| row["repeated"] == "1.0"), "{repeats:?}");
    assert_eq!(folder.rows("found/tree.csv").len(), 4);
    assert_eq!(folder.text("found/tree.dot").matches(" -- ").count(), 4);
    assert_eq!(folder.text("found/tree.graphml").matches("<edge ").count(), 4);
    let summary = folder.text("found/summary.json");
    assert!(summary.contains("\"parts\": 5") && summary.contains("\"dropped\": 3"), "{summary}");
    // The parts that were found are parts for `tree`.
    folder.succeed("tree body/tactile.npy --parts found/parts.csv --out joined");
    let edges = |file: &str| -> Vec<[String; 2]> {
        folder.rows(file).iter().map(|row| ["child", "parent"].map(|column| row[column].clone())).collect()
    };
    assert_eq!(edges("joined/tree.csv"), edges("found/tree.csv"));

    let mut silent = npy::read_tactile(&folder.at("body/tactile.npy")).unwrap();
    silent.pressures.fill(0.0);
    npy::write_tactile(&folder.at("silent.npy"), &silent).unwrap();
    for command in ["estimate silent.npy --out s", "tree silent.npy --parts body/labels.csv --out s"] {
        let said = folder.run(command);
        assert!(said.status == Some(2) && said.err.contains("feel"), "{said:?}");
    }
    let said = folder.run("tree body/tactile.npy --parts body/tree.csv --out s");
    assert_eq!(said.status, Some(2), "{said:?}");

    // Contact pads feel no speeds. A tree of before goes, unless one is wanted all the same.
    let felt = npy::read_tactile(&folder.at("body/tactile.npy")).unwrap();
    let samples = felt.samples / 4;
    let pressures = felt.series().flat_map(|series| &series[..samples]);
    let pads = Tactile { samples, pressures: pressures.map(|pressure| f32::from(*pressure > 0.2)).collect() };
    npy::write_tactile(&folder.at("pads.npy"), &pads).unwrap();
    let said = folder.run("estimate pads.npy --out found --force");
    assert_eq!(said.status, Some(0), "{said:?}");
    assert!(folder.text("found/report.html").contains("parts and tree mean nothing"));
    let said = folder.run("estimate pads.npy --out found");
    assert_eq!(said.status, Some(1), "{said:?}");
    assert!(said.out.contains("does not fit") && said.out.contains("contact pads"), "{said:?}");
    let summary = folder.text("found/summary.json");
    assert!(summary.contains("\"fit\": \"does not fit\"") && summary.contains("\"doubts\": []"), "{summary}");
    assert!(summary.contains("\"cause\": \"most sensors have a few levels only"), "{summary}");
    assert!(!folder.at("found/tree.csv").exists() && !folder.at("found/report.html").exists());
    assert!(!folder.at("found/repeats.csv").exists());
    assert!(folder.at("found/parts.csv").exists());
}

#[test]
fn a_part_of_few_sensors_is_named() {
    let folder = Folder::new();
    folder.write("small.toml", read("bodies/chain-3.toml").replace("sensors = 40", "sensors = 14"));
    folder.write("random.toml", "motion.coordination = 0.0\n");
    folder.succeed("simulate --body small.toml --settings random.toml --duration 100 --seed 1 --out body");
    let said = folder.succeed("estimate body/tactile.npy --out found");
    let expected =
        "part 0, the first of 3 such parts, has 14 sensors; 16 and more are needed to rely on a part";
    assert!(said.contains(expected), "{said}");
    assert!(said.starts_with("fit: doubtful: "), "{said}");
    for file in ["found/summary.json", "found/report.html"] {
        assert!(folder.text(file).contains(expected), "{file}");
    }
}

#[test]
fn stages_by_hand_repeat_the_experiment() {
    let folder = folder_with_settings();
    folder.succeed("simulate --settings small.toml --out body");
    folder.succeed("distance body/tactile.npy --settings small.toml --out distance.npy");
    let map = folder.succeed("map distance.npy --dims 4 --out body-map.npy");
    assert!(map.contains("its eigenvalues make up"), "{map}");
    let truth = "--labels body/labels.csv --tree body/tree.csv";
    let summary = folder.succeed(&format!("infer body-map.npy --settings small.toml {truth} --out schema"));
    assert!(summary.contains("eligible samples that recover the true tree"), "{summary}");
    let told = folder.succeed(&format!("tree body/tactile.npy --parts body/labels.csv {truth} --out joined"));
    assert!(told.contains("adjusted Rand index 1.000, true tree recovered"), "{told}");

    for (table, expected) in [
        ("joined/tree.csv", "child,parent,support"),
        ("joined/edges.csv", "part,other,correlation,information,support,in_tree"),
        ("body/labels.csv", "sensor,part"),
        ("body/tree.csv", "child,parent"),
        ("schema/samples.csv", "chain,parts,log_posterior,ari,eligible,tree_correct"),
        ("schema/trees.csv", "chain,child,parent,x1,x2,x3,x4"),
    ] {
        assert_eq!(header(&folder.text(table)), expected, "{table}");
    }
    assert_eq!(folder.rows("joined/tree.csv").len(), 4);
    assert_eq!(folder.rows("joined/edges.csv").len(), 10);
    assert_eq!(folder.rows("body/joint-angles.csv").len(), 15_001);
    let tactile = npy::read_tactile(&folder.at("body/tactile.npy")).unwrap();
    assert_eq!((tactile.samples, tactile.sensors()), (15_000, 120));

    folder.reproduce("exp1 --settings small.toml --out exp1");
    for (by_hand, whole) in [
        ("distance.npy", "exp1/simulation-1/distance.npy"),
        ("body-map.npy", "exp1/simulation-1/body-map.npy"),
        ("body/labels.csv", "exp1/simulation-1/labels.csv"),
        ("body/tree.csv", "exp1/simulation-1/tree.csv"),
    ] {
        assert!(folder.bytes(by_hand) == folder.bytes(whole), "{by_hand}");
    }
    let height = |row: &BTreeMap<String, String>| row["log_posterior"].clone();
    let by_hand: Vec<String> = folder.rows("schema/samples.csv").iter().map(height).collect();
    let own = |row: &&BTreeMap<String, String>| {
        ["simulation", "dimension", "model"].map(|column| row[column].as_str()) == ["1", "4", "dpgmm-lj"]
    };
    let whole: Vec<String> = folder.rows("exp1/samples.csv").iter().filter(own).map(height).collect();
    assert_eq!(by_hand, whole);
}

#[test]
fn maps_of_less_stress_by_hand_repeat_the_experiment() {
    let folder = Folder::new();
    for method in ["smacof", "nonmetric"] {
        let over = "motion.targets = \"shared\"\nschema.start = \"k-means\"";
        folder.write("mine.toml", small(&format!("{LONGER}{over}\nmap.method = \"{method}\"")));
        folder.reproduce(&format!("exp1 --settings mine.toml --out {method}"));
        for option in [format!("--method {method}"), "--settings mine.toml".to_owned()] {
            let distance = format!("{method}/simulation-1/distance.npy");
            let said = folder.succeed(&format!("map {distance} --dims 4 {option} --out map.npy"));
            assert!(
                said.contains("its stress-1 is 0.") && said.contains("for the start, the classical map"),
                "{said}"
            );
            let whole = folder.bytes(format!("{method}/simulation-1/body-map-4.npy"));
            assert!(folder.bytes("map.npy") == whole, "{method}");
        }
        assert!(!folder.rows(format!("{method}/figures/fig06a-map-2d.csv")).is_empty());
    }
}

#[test]
fn an_experiment_is_the_same_on_any_number_of_threads_and_complete() {
    let folder = folder_with_settings();
    let files = |jobs: usize| {
        let out = format!("jobs-{jobs}");
        let said = folder.reproduce(&format!("exp1 --settings small.toml --jobs {jobs} --out {out}"));
        assert!(header(&said.out).contains("the paper reports 84.6 %"), "{said:?}");
        assert!(folder.text(format!("{out}/report.html")).contains("the paper reports 84.6 %"));

        assert_eq!(folder.json(format!("{out}/run.json"))["threads"], jobs);
        let manifest = folder.json(format!("{out}/manifest.json"));
        assert_eq!(manifest["inputs"][0]["sha256"], sha256(&folder.at("small.toml")).unwrap());
        for output in manifest["outputs"].as_array().unwrap() {
            let name = output["file"].as_str().unwrap();
            assert_eq!(output["sha256"], sha256(&folder.at(&out).join(name)).unwrap(), "{name}");
        }
        folder.files(&out)
    };
    let one = files(1);
    for jobs in [2, 7] {
        files(jobs);
        folder.has_files(&format!("jobs-{jobs}"), &one);
    }

    for (name, bytes) in one.iter().filter(|(name, _)| name.ends_with(".csv")) {
        let text = String::from_utf8(bytes.clone()).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
    assert_eq!(
        header(&folder.text("jobs-1/claims.csv")),
        "id,counting,reading,figure,place,statement,unit,published,wording,value,n,low,high,simulations,lowest,highest,\
         accepted_low,accepted_high,verdict,found,bodies,bodies_share,bodies_low,bodies_high,bodies_together,one_body"
    );
    let claims = folder.rows("jobs-1/claims.csv");
    let first = ["id", "counting", "unit", "published", "wording"].map(|column| claims[0][column].as_str());
    assert_eq!(first, ["tree-accuracy", "all-draws", "rate", "0.846", "84.6 %"]);
    // d = 14 was not run, so there is no rate, and that is what the table says.
    assert_eq!((claims[0]["value"].as_str(), claims[0]["verdict"].as_str()), ("", "not testable"));
    for name in ["fig07-parts.csv", "fig08a-ari-baselines.csv", "fig08b-ari.csv", "fig10b-tree.csv"] {
        assert!(!folder.rows(format!("jobs-1/figures/{name}")).is_empty(), "{name}");
    }
    let counted: usize = folder
        .rows("jobs-1/figures/fig07-parts.csv")
        .iter()
        .filter(|row| row["counting"] == "all-draws")
        .map(|row| row["count"].parse::<usize>().unwrap())
        .sum();
    assert_eq!(counted, 2 * 2 * 6, "two dimensions, two simulations, six chains");
    judged_again(&folder, "jobs-1");
}

/// `plot` judges a finished experiment again from its samples: nothing changes, and other samples change the claims.
fn judged_again(folder: &Folder, out: &str) {
    let before = folder.files(out);
    let plot = format!("plot {out}");
    folder.succeed(&plot);
    folder.has_files(out, &before);
    folder.succeed(&format!("verify {out}"));

    let parts =
        |row: &BTreeMap<String, String>| row["id"] == "number-of-parts" && row["counting"] == "all-draws";
    let claims = format!("{out}/claims.csv");
    let value = || folder.rows(&claims).iter().find(|row| parts(row)).unwrap()["value"].clone();
    let found = value();
    let samples = folder.text(format!("{out}/samples.csv"));
    let mut lines = samples.lines();
    let header = lines.next().unwrap();
    let column = header.split(',').position(|name| name == "parts").unwrap();
    let nine = |line: &str| {
        let cells = line.split(',').enumerate().map(|(at, cell)| if at == column { "9" } else { cell });
        cells.collect::<Vec<_>>().join(",")
    };
    let changed: Vec<String> = std::iter::once(header.to_owned()).chain(lines.map(nine)).collect();
    folder.write(format!("{out}/samples.csv"), changed.join("\n") + "\n");
    folder.succeed(&plot);
    assert!(found != "9.0" && value() == "9.0", "{found} {}", value());
}

#[test]
fn foreign_data_is_clustered_and_every_draw_can_be_kept() {
    let folder = Folder::new();
    separated_clusters(&folder);
    let equations = repository("reproduce/equations.toml");
    let shared = format!(
        "--settings {} --seed 2718 --chains 20 --sweeps 400 --labels labels.csv --tree tree.csv",
        equations.display()
    );
    for model in ["dpgmm", "dpgmm-lj"] {
        folder.succeed(&format!("infer clusters.npy --model {model} {shared} --out {model}"));
        let samples = folder.rows(format!("{model}/samples.csv"));
        let best =
            samples.iter().max_by(|a, b| number(a, "log_posterior").total_cmp(&number(b, "log_posterior")));
        let found = ["parts", "ari", "tree_correct"].map(|column| best.unwrap()[column].as_str());
        assert_eq!(found, ["5", "1.0", "true"], "{model}");
    }

    for start in ["uniform", "k-means", "single"] {
        folder.succeed(&format!("infer clusters.npy --start {start} {shared} --out start-{start}"));
    }
    let draws = |out: &str| folder.bytes(format!("{out}/assignments.npy"));
    assert!(draws("start-uniform") == draws("dpgmm-lj"), "that of equations.toml");
    assert!(draws("start-k-means") != draws("dpgmm-lj"));
    assert!(draws("start-single") != draws("dpgmm-lj"));

    folder.succeed("infer clusters.npy --chains 2 --sweeps 12 --keep all --burn-in 4 --out all");
    assert_eq!(header(&folder.text("all/samples.csv")), "chain,sweep,parts,log_posterior");
    let all = folder.rows("all/samples.csv");
    let draws: Vec<_> = all.iter().map(|row| (row["chain"].as_str(), row["sweep"].as_str())).collect();
    assert_eq!((draws.len(), draws[0], draws[15]), (16, ("0", "5"), ("1", "12")));
}

/// Five parts of 40 points, each along an axis of its own, and joined at their ends.
fn staircase(folder: &Folder) {
    let wave = |at: usize| (at as f64 * 12.9898).sin() * 0.3;
    let coordinate = |i: usize, axis: usize| {
        let along = match axis.cmp(&(i / 40)) {
            std::cmp::Ordering::Less => 10.0,
            std::cmp::Ordering::Equal => 10.0 * ((i % 40) as f64 + 0.5) / 40.0,
            std::cmp::Ordering::Greater => 0.0,
        };
        along + wave(i * (3 + 2 * axis) + axis)
    };
    let coordinates = (0..200).flat_map(|i| (0..5).map(move |axis| coordinate(i, axis))).collect();
    npy::write_body_map(&folder.at("stairs.npy"), &BodyMap { dims: 5, coordinates }).unwrap();
    let labels: String = (0..200).map(|i| format!("{i},{}\n", i / 40)).collect();
    folder.write("labels.csv", format!("sensor,part\n{labels}"));
    folder.write("tree.csv", "child,parent\n1,0\n2,1\n3,2\n4,3\n");
    folder.write("one.toml", "schema.scale = 1.0");
}

#[test]
fn the_split_merge_sampler_gives_a_posterior_of_parts_and_edges() {
    let folder = Folder::new();
    staircase(&folder);
    let command = "infer stairs.npy --sampler split-merge --settings one.toml --seed 2718 --labels labels.csv \
                   --tree tree.csv --out out";
    let told = folder.succeed(command);
    assert!(told.contains("number of parts: 5 (100.0 %)") && told.contains("true tree recovered"), "{told}");
    assert!(told.contains("└─ "), "a drawing of the tree: {told}");
    for (table, expected) in [
        ("posterior.csv", "parts,probability"),
        ("parts.csv", "sensor,part,probability"),
        ("edges.csv", "part,other,probability,in_tree"),
        ("diagnostics.csv", "quantity,r_hat,ess"),
    ] {
        assert_eq!(header(&folder.text(format!("out/{table}"))), expected, "{table}");
    }
    let total: f64 = folder.rows("out/posterior.csv").iter().map(|row| number(row, "probability")).sum();
    assert!((total - 1.0).abs() < 1e-12);
    let parts = folder.rows("out/parts.csv");
    assert_eq!(parts.len(), 200);
    let ends = [&parts[0], &parts[199]].map(|row| row["part"].as_str());
    assert_eq!(ends, ["0", "4"], "named by their first sensors");
    let edges = folder.rows("out/edges.csv");
    assert_eq!(edges.len(), 5 * 4 / 2);
    let expected: f64 = edges.iter().map(|row| number(row, "probability")).sum();
    assert!((expected - 4.0).abs() < 1e-9, "every tree has four edges");
    assert_eq!(edges.iter().filter(|row| row["in_tree"] == "true").count(), 4);
    // Chains name their components as they like; the files do not.
    let children = folder.rows("out/trees.csv");
    assert!(children.iter().all(|row| row["child"].parse::<usize>().unwrap() < 5), "{children:?}");
    // The same settings and seed give the same bytes; another sampler has no posterior.
    folder.succeed(&command.replace("out out", "out again"));
    folder.has_files("again", &folder.files("out"));
    folder.succeed(&command.replace("split-merge", "equations --chains 2").replace("out out", "out other"));
    assert!(!folder.at("other/posterior.csv").exists());
}

#[test]
fn symbols_are_taken_as_they_are_and_constant_sensors_reported() {
    let folder = Folder::new();
    // Two sensors: one bit, and a constant. As symbols: H(X|Y) = 1 bit.
    let tactile = Tactile { samples: 4, pressures: vec![0.0, 1.0, 0.0, 1.0, 3.0, 3.0, 3.0, 3.0] };
    npy::write_tactile(&folder.at("symbols.npy"), &tactile).unwrap();
    let said = folder.run("distance symbols.npy --symbols --out distance.npy");
    assert_eq!(said.status, Some(0));
    assert!(said.err.contains("1 of 2 sensors never change") && said.err.contains("sensor 1"), "{said:?}");
    let distances = npy::read_distances(&folder.at("distance.npy")).unwrap();
    assert_eq!(distances, Distances { sensors: 2, values: vec![0.0, 1.0, 1.0, 0.0] });
}

#[test]
fn symbols_that_are_all_the_same_are_no_distance() {
    let folder = Folder::new();
    let tactile = Tactile { samples: 3, pressures: vec![0.0; 6] };
    npy::write_tactile(&folder.at("zero.npy"), &tactile).unwrap();
    assert_eq!(folder.run("distance zero.npy --symbols --out distance.npy").status, Some(0));
    let distances = npy::read_distances(&folder.at("distance.npy")).unwrap();
    assert_eq!(distances.values, [0.0; 4]);
}
