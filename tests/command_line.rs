//! The program as a user meets it: every stage by hand, a small experiment, and mistakes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bodyschema::files::{npy, sha256};
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::distance::Distances;

/// A small body that still shows its parts: 5 parts of 24 sensors, 1500 s.
const SMALL: &str = "
[skin]
around = 8
along = 3
[physics]
duration = 1500.0
[schema]
chains = 6
sweeps = 60
[experiment]
dimensions = [2, 4]
simulations = 2
seed = 11
";

fn bodyschema(folder: &Path, arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bodyschema"))
        .current_dir(folder)
        .args(arguments.split_whitespace())
        .output()
        .expect("the program starts")
}

fn succeed(folder: &Path, arguments: &str) -> String {
    let output = bodyschema(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {errors}");
    assert!(errors.is_empty(), "nothing but results off a terminal: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

fn folder_with_settings() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

/// Rows of a CSV file by column name.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_path(path).unwrap().deserialize().map(Result::unwrap).collect()
}

fn header(path: &Path) -> String {
    fs::read_to_string(path).unwrap().lines().next().unwrap().to_owned()
}

/// Pressures of a body, with a sensor that is dead, one that is constant and one that is no number, all in the beginning.
fn with_faults(folder: &Path, tactile: &str, out: &str) {
    let mut tactile = npy::read_tactile(&folder.join(tactile)).unwrap();
    let samples = tactile.samples;
    tactile.pressures[..samples].fill(0.0);
    tactile.pressures[samples..2 * samples].fill(7.0);
    tactile.pressures[2 * samples] = f32::NAN;
    npy::write_tactile(&folder.join(out), &tactile).unwrap();
}

#[test]
fn one_command_finds_parts_and_tree() {
    let folder = folder_with_settings();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("moving.toml"), format!("{SMALL}[motion]\ncoordination = 0.5\n")).unwrap();
    succeed(folder.path(), "simulate --settings moving.toml --out body");
    with_faults(folder.path(), "body/tactile.npy", "own.npy");
    let truth = "--labels body/labels.csv --tree body/tree.csv";
    let output = bodyschema(folder.path(), &format!("estimate own.npy {truth} --out found"));
    assert!(output.status.success(), "{output:?}");
    let (told, warned) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(told.starts_with("5 parts of 117 sensors"), "{told}");
    assert!(told.contains("adjusted Rand index 1.000, true tree recovered"), "{told}");
    assert!(warned.contains("3 of 120 sensors are left out (the first, 0, is dead)"), "{warned}");
    let faults: Vec<String> = rows(&at("found/dropped.csv")).iter().map(|row| row["fault"].clone()).collect();
    assert_eq!(faults, ["dead", "constant", "not a number"]);
    assert_eq!(rows(&at("found/parts.csv")).len(), 117);
    assert_eq!(rows(&at("found/tree.csv")).len(), 4);
    let summary = fs::read_to_string(at("found/summary.json")).unwrap();
    assert!(summary.contains("\"parts\": 5") && summary.contains("\"dropped\": 3"), "{summary}");
    // The parts that were found are parts for `tree`.
    succeed(folder.path(), "tree body/tactile.npy --parts found/parts.csv --out joined");
    assert_eq!(fs::read(at("joined/tree.csv")).unwrap(), fs::read(at("found/tree.csv")).unwrap());

    let mut silent = npy::read_tactile(&at("body/tactile.npy")).unwrap();
    silent.pressures.fill(0.0);
    npy::write_tactile(&at("silent.npy"), &silent).unwrap();
    for command in ["estimate silent.npy --out s", "tree silent.npy --parts body/labels.csv --out s"] {
        let output = bodyschema(folder.path(), command);
        let warned = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && warned.contains("feel"), "{warned}");
    }
    let output = bodyschema(folder.path(), "tree body/tactile.npy --parts body/tree.csv --out s");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

#[test]
fn stages_by_hand_repeat_the_experiment() {
    let folder = folder_with_settings();
    let at = |name: &str| folder.path().join(name);
    let run = |arguments: &str| succeed(folder.path(), arguments);

    run("simulate --settings small.toml --out body");
    run("distance body/tactile.npy --settings small.toml --out distance.npy");
    let map = run("map distance.npy --dims 4 --out body-map.npy");
    assert!(map.contains("its eigenvalues make up"), "{map}");
    let summary = run(
        "infer body-map.npy --settings small.toml --labels body/labels.csv --tree body/tree.csv --out schema",
    );
    let told = succeed(
        folder.path(),
        "tree body/tactile.npy --parts body/labels.csv --labels body/labels.csv --tree body/tree.csv --out joined",
    );
    assert!(told.contains("adjusted Rand index 1.000, true tree recovered"), "{told}");
    assert_eq!(header(&folder.path().join("joined/tree.csv")), "child,parent,support");
    assert_eq!(rows(&folder.path().join("joined/tree.csv")).len(), 4);
    assert_eq!(header(&folder.path().join("joined/edges.csv")), "part,other,correlation,support,in_tree");
    assert_eq!(rows(&folder.path().join("joined/edges.csv")).len(), 10);
    assert!(summary.contains("eligible samples that recover the true tree"), "{summary}");

    assert_eq!(header(&at("body/labels.csv")), "sensor,part");
    assert_eq!(header(&at("body/tree.csv")), "child,parent");
    assert_eq!(header(&at("schema/samples.csv")), "chain,parts,log_posterior,ari,eligible,tree_correct");
    assert_eq!(header(&at("schema/trees.csv")), "chain,child,parent,x1,x2,x3,x4");
    assert_eq!(fs::read_to_string(at("body/joint-angles.csv")).unwrap().lines().count(), 1 + 15_001);
    let tactile = npy::read_tactile(&at("body/tactile.npy")).unwrap();
    assert_eq!((tactile.samples, tactile.sensors()), (15_000, 120));

    let experiment = bodyschema(folder.path(), "reproduce exp1 --settings small.toml --out exp1");
    assert!(experiment.status.code().unwrap() <= 1, "{experiment:?}");
    let same =
        |by_hand: &str, whole: &str| assert_eq!(fs::read(at(by_hand)).unwrap(), fs::read(at(whole)).unwrap());
    same("distance.npy", "exp1/simulation-1/distance.npy");
    same("body-map.npy", "exp1/simulation-1/body-map.npy");
    same("body/labels.csv", "exp1/simulation-1/labels.csv");
    same("body/tree.csv", "exp1/simulation-1/tree.csv");
    let by_hand: Vec<_> =
        rows(&at("schema/samples.csv")).iter().map(|row| row["log_posterior"].clone()).collect();
    let whole: Vec<_> = rows(&at("exp1/samples.csv"))
        .iter()
        .filter(|row| row["simulation"] == "1" && row["dimension"] == "4" && row["model"] == "dpgmm-lj")
        .map(|row| row["log_posterior"].clone())
        .collect();
    assert_eq!(by_hand, whole);
}

#[test]
fn maps_of_less_stress_by_hand_repeat_the_experiment() {
    let folder = folder_with_settings();
    for method in ["smacof", "nonmetric"] {
        let only = "simulations = 1\n[motion]\ntargets = \"shared\"\n[map]\nmethod = ";
        let settings = format!("{SMALL}{only}\"{method}\"").replace("simulations = 2\n", "");
        let settings = settings.replace("sweeps = 60", "sweeps = 60\nstart = \"k-means\"");
        fs::write(folder.path().join("mine.toml"), settings).unwrap();
        let experiment =
            bodyschema(folder.path(), &format!("reproduce exp1 --settings mine.toml --out {method}"));
        assert!(experiment.status.code().unwrap() <= 1, "{experiment:?}");
        for option in [format!("--method {method}"), "--settings mine.toml".to_owned()] {
            let distance = format!("{method}/simulation-1/distance.npy");
            let said = succeed(folder.path(), &format!("map {distance} --dims 4 {option} --out map.npy"));
            assert!(
                said.contains("its stress-1 is 0.") && said.contains("for the start, the classical map"),
                "{said}"
            );
            let whole = folder.path().join(method).join("simulation-1/body-map-4.npy");
            assert_eq!(fs::read(folder.path().join("map.npy")).unwrap(), fs::read(whole).unwrap());
        }
        assert!(!rows(&folder.path().join(method).join("figures/fig06a-map-2d.csv")).is_empty());
    }
}

#[test]
fn an_experiment_is_the_same_on_any_number_of_threads_and_complete() {
    let folder = folder_with_settings();
    let files = |jobs: usize| {
        let out = folder.path().join(format!("jobs-{jobs}"));
        let arguments = format!("reproduce exp1 --settings small.toml --jobs {jobs} --out {}", out.display());
        let output = bodyschema(folder.path(), &arguments);
        assert!(output.status.code().unwrap() <= 1, "{output:?}");
        let screen = String::from_utf8(output.stdout).unwrap();
        let first = screen.lines().next().unwrap();
        assert!(first.contains("the paper reports 84.6 %"), "{first}");
        let report = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(report.contains("the paper reports 84.6 %"));

        let json = |name: &str| -> serde_json::Value {
            serde_json::from_str(&fs::read_to_string(out.join(name)).unwrap()).unwrap()
        };
        assert_eq!(json("run.json")["threads"], jobs);
        let manifest = json("manifest.json");
        assert_eq!(manifest["inputs"][0]["sha256"], sha256(&folder.path().join("small.toml")).unwrap());
        let outputs: BTreeMap<String, Vec<u8>> = manifest["outputs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|entry| {
                let name = entry["file"].as_str().unwrap();
                assert_eq!(entry["sha256"], sha256(&out.join(name)).unwrap(), "{name}");
                (name.to_owned(), fs::read(out.join(name)).unwrap())
            })
            .collect();
        outputs
    };
    let one = files(1);
    assert_eq!(one, files(2));
    assert_eq!(one, files(7));

    for (name, bytes) in one.iter().filter(|(name, _)| name.ends_with(".csv")) {
        let text = String::from_utf8(bytes.clone()).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
    let out = folder.path().join("jobs-1");
    assert_eq!(
        header(&out.join("claims.csv")),
        "id,counting,reading,figure,place,statement,unit,published,wording,value,n,low,high,simulations,lowest,highest,\
         accepted_low,accepted_high,verdict,found,bodies,bodies_share,bodies_low,bodies_high,bodies_together,one_body"
    );
    let claims = rows(&out.join("claims.csv"));
    let first = ["id", "counting", "unit", "published", "wording"].map(|column| claims[0][column].as_str());
    assert_eq!(first, ["tree-accuracy", "all-draws", "rate", "0.846", "84.6 %"]);
    // d = 14 was not run, so there is no rate, and that is what the table says.
    assert_eq!((claims[0]["value"].as_str(), claims[0]["verdict"].as_str()), ("", "not testable"));
    for name in ["fig07-parts.csv", "fig08a-ari-baselines.csv", "fig08b-ari.csv", "fig10b-tree.csv"] {
        assert!(!rows(&out.join("figures").join(name)).is_empty(), "{name}");
    }
    let counted: usize = rows(&out.join("figures/fig07-parts.csv"))
        .iter()
        .filter(|row| row["counting"] == "all-draws")
        .map(|row| row["count"].parse::<usize>().unwrap())
        .sum();
    assert_eq!(counted, 2 * 2 * 6, "two dimensions, two simulations, six chains");
    judged_again(folder.path(), &out);
}

/// `plot` judges a finished experiment again from its samples: nothing changes, and other samples change the claims.
fn judged_again(folder: &Path, out: &Path) {
    let files = [
        "claims.csv",
        "claims.md",
        "manifest.json",
        "report.html",
        "figures/fig07-parts.csv",
        "figures/fig07-parts.svg",
    ];
    let read = || files.map(|name| fs::read(out.join(name)).unwrap());
    let before = read();
    let plot = format!("plot {}", out.display());
    succeed(folder, &plot);
    assert_eq!(before, read());
    succeed(folder, &format!("verify {}", out.display()));

    let parts =
        |row: &BTreeMap<String, String>| row["id"] == "number-of-parts" && row["counting"] == "all-draws";
    let value = || rows(&out.join("claims.csv")).iter().find(|row| parts(row)).unwrap()["value"].clone();
    let found = value();
    let samples = fs::read_to_string(out.join("samples.csv")).unwrap();
    let mut lines = samples.lines();
    let header = lines.next().unwrap();
    let column = header.split(',').position(|name| name == "parts").unwrap();
    let nine = |line: &str| {
        let cells = line.split(',').enumerate().map(|(at, cell)| if at == column { "9" } else { cell });
        cells.collect::<Vec<_>>().join(",")
    };
    let changed: Vec<String> = std::iter::once(header.to_owned()).chain(lines.map(nine)).collect();
    fs::write(out.join("samples.csv"), changed.join("\n") + "\n").unwrap();
    succeed(folder, &plot);
    assert!(found != "9.0" && value() == "9.0", "{found} {}", value());
}

/// Five Gaussian clusters in a row, far apart, so that any working sampler finds them.
fn separated_clusters(folder: &Path) -> PathBuf {
    let wave = |at: usize| (at as f64 * 12.9898).sin() * 0.3;
    let coordinates = (0..100).flat_map(|i| [10.0 * (i / 20) as f64 + wave(i), wave(7 * i + 3)]).collect();
    let path = folder.join("clusters.npy");
    npy::write_body_map(&path, &BodyMap { dims: 2, coordinates }).unwrap();
    let labels: String = (0..100).map(|i| format!("{i},{}\n", i / 20)).collect();
    fs::write(folder.join("labels.csv"), format!("sensor,part\n{labels}")).unwrap();
    fs::write(folder.join("tree.csv"), "child,parent\n1,0\n2,1\n3,2\n4,3\n").unwrap();
    path
}

#[test]
fn foreign_data_is_clustered_and_every_draw_can_be_kept() {
    let folder = tempfile::tempdir().unwrap();
    separated_clusters(folder.path());
    let shared = format!(
        "--settings {}/reproduce/equations.toml --seed 2718 --chains 20 --sweeps 400 --labels labels.csv --tree tree.csv",
        env!("CARGO_MANIFEST_DIR")
    );
    for model in ["dpgmm", "dpgmm-lj"] {
        succeed(folder.path(), &format!("infer clusters.npy --model {model} {shared} --out {model}"));
        let rows = rows(&folder.path().join(model).join("samples.csv"));
        let best = rows
            .iter()
            .max_by(|a, b| {
                a["log_posterior"].parse::<f64>().unwrap().total_cmp(&b["log_posterior"].parse().unwrap())
            })
            .unwrap();
        let found = (best["parts"].as_str(), best["ari"].as_str(), best["tree_correct"].as_str());
        assert_eq!(found, ("5", "1.0", "true"), "{model}");
    }

    for start in ["uniform", "k-means", "single"] {
        succeed(folder.path(), &format!("infer clusters.npy --start {start} {shared} --out start-{start}"));
    }
    let draws = |out: &str| fs::read(folder.path().join(out).join("assignments.npy")).unwrap();
    assert_eq!(draws("start-uniform"), draws("dpgmm-lj"), "that of equations.toml");
    assert_ne!(draws("start-k-means"), draws("dpgmm-lj"));
    assert_ne!(draws("start-single"), draws("dpgmm-lj"));

    succeed(folder.path(), "infer clusters.npy --chains 2 --sweeps 12 --keep all --burn-in 4 --out all");
    let all = rows(&folder.path().join("all/samples.csv"));
    assert_eq!(header(&folder.path().join("all/samples.csv")), "chain,sweep,parts,log_posterior");
    let draws: Vec<_> = all.iter().map(|row| (row["chain"].as_str(), row["sweep"].as_str())).collect();
    assert_eq!((draws.len(), draws[0], draws[15]), (16, ("0", "5"), ("1", "12")));
}

/// Five parts of 40 points, each along an axis of its own, and joined at their ends.
fn staircase(folder: &Path) {
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
    npy::write_body_map(&folder.join("stairs.npy"), &BodyMap { dims: 5, coordinates }).unwrap();
    let labels: String = (0..200).map(|i| format!("{i},{}\n", i / 40)).collect();
    fs::write(folder.join("labels.csv"), format!("sensor,part\n{labels}")).unwrap();
    fs::write(folder.join("tree.csv"), "child,parent\n1,0\n2,1\n3,2\n4,3\n").unwrap();
    fs::write(folder.join("one.toml"), "[schema]\nscale = 1.0\n").unwrap();
}

#[test]
fn the_split_merge_sampler_gives_a_posterior_of_parts_and_edges() {
    let folder = tempfile::tempdir().unwrap();
    staircase(folder.path());
    let at = |name: &str| folder.path().join("out").join(name);
    let command = "infer stairs.npy --sampler split-merge --settings one.toml --seed 2718 --labels labels.csv \
                   --tree tree.csv --out out";
    let told = succeed(folder.path(), command);
    assert!(told.contains("number of parts: 5 (100.0 %)") && told.contains("true tree recovered"), "{told}");
    assert!(told.contains("└─ "), "a drawing of the tree: {told}");
    assert_eq!(header(&at("posterior.csv")), "parts,probability");
    let total: f64 =
        rows(&at("posterior.csv")).iter().map(|row| row["probability"].parse::<f64>().unwrap()).sum();
    assert!((total - 1.0).abs() < 1e-12);
    assert_eq!(header(&at("parts.csv")), "sensor,part,probability");
    let parts = rows(&at("parts.csv"));
    assert_eq!(parts.len(), 200);
    assert_eq!(
        (parts[0]["part"].as_str(), parts[199]["part"].as_str()),
        ("0", "4"),
        "named by their first sensors"
    );
    assert_eq!(header(&at("edges.csv")), "part,other,probability,in_tree");
    let edges = rows(&at("edges.csv"));
    assert_eq!(edges.len(), 5 * 4 / 2);
    let expected: f64 = edges.iter().map(|row| row["probability"].parse::<f64>().unwrap()).sum();
    assert!((expected - 4.0).abs() < 1e-9, "every tree has four edges");
    let tree: Vec<_> = edges.iter().filter(|row| row["in_tree"] == "true").collect();
    assert_eq!(tree.len(), 4);
    assert_eq!(header(&at("diagnostics.csv")), "quantity,r_hat,ess");
    // Chains name their components as they like; the files do not.
    let draws = rows(&at("trees.csv"));
    let ends: BTreeSet<&str> = draws.iter().map(|row| row["child"].as_str()).collect();
    assert!(ends.iter().all(|part| part.parse::<usize>().unwrap() < 5), "{ends:?}");
    // The same settings and seed give the same bytes; another sampler has no posterior.
    succeed(folder.path(), &command.replace("out out", "out again"));
    for file in ["posterior.csv", "parts.csv", "edges.csv", "diagnostics.csv", "samples.csv", "trees.csv"] {
        let again = folder.path().join("again").join(file);
        assert_eq!(fs::read(at(file)).unwrap(), fs::read(again).unwrap(), "{file}");
    }
    succeed(
        folder.path(),
        &command.replace("split-merge", "equations --chains 2").replace("out out", "out other"),
    );
    assert!(!folder.path().join("other/posterior.csv").exists());
}

#[test]
fn symbols_are_taken_as_they_are_and_constant_sensors_reported() {
    let folder = tempfile::tempdir().unwrap();
    // Two sensors: one bit, and a constant. As symbols: H(X|Y) = 1 bit.
    let tactile = bodyschema::stages::sense::Tactile {
        samples: 4,
        pressures: vec![0.0, 1.0, 0.0, 1.0, 3.0, 3.0, 3.0, 3.0],
    };
    npy::write_tactile(&folder.path().join("symbols.npy"), &tactile).unwrap();
    let output = bodyschema(folder.path(), "distance symbols.npy --symbols --out distance.npy");
    let (errors, status) = (String::from_utf8(output.stderr).unwrap(), output.status.code());
    assert_eq!(status, Some(0));
    assert!(errors.contains("1 of 2 sensors never change") && errors.contains("sensor 1"), "{errors}");
    let distances = npy::read_distances(&folder.path().join("distance.npy")).unwrap();
    assert_eq!(distances, Distances { sensors: 2, values: vec![0.0, 1.0, 1.0, 0.0] });
}

#[test]
fn symbols_that_are_all_the_same_are_no_distance() {
    let folder = tempfile::tempdir().unwrap();
    let tactile = bodyschema::stages::sense::Tactile { samples: 3, pressures: vec![0.0; 6] };
    npy::write_tactile(&folder.path().join("zero.npy"), &tactile).unwrap();
    assert!(bodyschema(folder.path(), "distance zero.npy --symbols --out distance.npy").status.success());
    let distances = npy::read_distances(&folder.path().join("distance.npy")).unwrap();
    assert_eq!(distances.values, [0.0; 4]);
}

#[test]
fn a_mistake_is_one_line_that_says_what_and_where_and_status_2() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    separated_clusters(folder.path());
    npy::write_distances(
        &at("line.npy"),
        &Distances { sensors: 3, values: vec![0., 1., 2., 1., 0., 1., 2., 1., 0.] },
    )
    .unwrap();
    npy::write_body_map(&at("wide.npy"), &BodyMap { dims: 3, coordinates: vec![1.0; 6] }).unwrap();
    fs::write(at("fraley.toml"), "schema = { prior = \"fraley-raftery\" }").unwrap();
    npy::write_body_map(&at("flat.npy"), &BodyMap { dims: 2, coordinates: vec![1., 5., 2., 5., 4., 5.] })
        .unwrap();
    let wide = bodyschema::stages::sense::Tactile { samples: 1, pressures: vec![1.0; 20_001] };
    npy::write_tactile(&at("transposed.npy"), &wide).unwrap();
    let same = Distances { sensors: 2, values: vec![0.0; 4] };
    npy::write_distances(&at("same.npy"), &same).unwrap();
    let tiny = BodyMap { dims: 1, coordinates: vec![1e-160, 2e-160, 4e-160] };
    npy::write_body_map(&at("tiny.npy"), &tiny).unwrap();
    npy::write_body_map(&at("nan.npy"), &BodyMap { dims: 1, coordinates: vec![1.0, f64::NAN] }).unwrap();
    fs::write(at("text.npy"), "hello").unwrap();
    fs::write(at("unknown.toml"), "[motion]\nspeed = 1").unwrap();
    fs::write(at("broken.toml"), "[motion\n").unwrap();
    fs::write(at("zero.toml"), "[schema]\ncomponents = 0").unwrap();
    fs::write(at("method.toml"), "[map]\nmethod = \"sammon\"").unwrap();
    fs::write(at("start.toml"), "[schema]\nstart = \"random\"").unwrap();
    fs::write(
        at("wild.toml"),
        "[motion]\ncoordination = 0.0\ncontroller = \"torque\"\nstiffness = 1e6\n[physics]\nduration = 60.0",
    )
    .unwrap();
    fs::write(at("heavy.toml"), "[agent]\ndensity = 1e300").unwrap();
    fs::write(at("long.toml"), "[physics]\nduration = 1e7").unwrap();
    fs::write(at("deep.toml"), "[experiment]\ndimensions = [2, 900]").unwrap();
    fs::write(at("steps.toml"), "[physics]\nstep = 1e-6\n[sense]\ninterval = 1000.0").unwrap();
    fs::write(at("vast.toml"), "[skin]\naround = 1000\nalong = 20").unwrap();
    fs::write(at("endless.toml"), "[schema]\nsweeps = 1000000000000").unwrap();
    fs::write(at("long-file.toml"), "#".repeat(2_000_000)).unwrap();
    fs::write(at("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    npy::write_body_map(&at("broad.npy"), &BodyMap { dims: 200_000, coordinates: vec![1.0; 400_000] })
        .unwrap();
    let wave = |at: usize| (at as f64 * 12.9898).sin();
    let deep = BodyMap { dims: 200, coordinates: (0..300 * 200).map(wave).collect() };
    npy::write_body_map(&at("deep.npy"), &deep).unwrap();
    let far = Distances { sensors: 2, values: vec![0.0, 1e200, 1e200, 0.0] };
    npy::write_distances(&at("far.npy"), &far).unwrap();
    for (folder, name, text) in [
        ("no-figure", "README.md", ""),
        ("bad-figure", "fig07-parts.csv", "dimension,counting\n2,\"all\ndraws\"\n"),
        ("binary-figure", "fig07-parts.csv", "\0\0\0"),
        ("bad-claims", "../claims.csv", "id,figure\na,b\n"),
        ("bad-claims", "../manifest.json", "{}"),
        ("bad-manifest", "../claims.csv", "id\n"),
        ("bad-manifest", "../manifest.json", "{\"settings\": "),
        ("deep-manifest", "../claims.csv", "id\n"),
        ("deep-manifest", "../manifest.json", &"[".repeat(100_000)),
    ] {
        let figures = at(folder).join("figures");
        fs::create_dir_all(&figures).unwrap();
        fs::write(figures.join(name), text).unwrap();
        if folder.ends_with("claims") || folder.ends_with("manifest") {
            let row = "2,9,0,0,0.5,0.5,0.6,1,1\n";
            let header =
                "dimension,n,lowest,whisker_low,lower_quartile,median,upper_quartile,whisker_high,highest\n";
            fs::write(figures.join("fig09-ari-box.csv"), format!("{header}{row}")).unwrap();
        }
    }
    fs::write(at("short.csv"), "sensor,part\n0,0\n").unwrap();
    fs::write(at("file"), "").unwrap();

    for (arguments, expected) in [
        ("distance absent.npy --out d.npy", "absent.npy: no such file"),
        ("distance text.npy --out d.npy", "text.npy: cannot be read as a .npy file"),
        ("distance nan.npy --out d.npy", "row 1, column 0: NaN"),
        ("distance nan.npy --symbols --out d.npy", "row 1, column 0: NaN"),
        ("distance line.npy --levels 1 --out d.npy", "`quantise.levels` is 1, but must be 2 to 256"),
        ("map wide.npy --dims 2 --out m.npy", "square matrix, but the shape is 2 x 3"),
        ("map line.npy --of distances --dims 4 --out m.npy", "at most 1"),
        ("map line.npy --of distances --dims 4 --method smacof --out m.npy", "at most 1"),
        ("map same.npy --dims 1 --method nonmetric --out m.npy", "all at distance 0"),
        ("map far.npy --of distances --dims 1 --method smacof --out m.npy", "the largest distance is 1e200"),
        ("map line.npy --dims 1 --settings method.toml --out m.npy", "unknown variant `sammon`"),
        ("map line.npy --dims 0 --out m.npy", "--dims is 0"),
        ("map line.npy --dims 1 --out file/m.npy", "file/m.npy: cannot be written"),
        (
            "infer flat.npy --settings fraley.toml --out s",
            "flat.npy: the 3 points span fewer than 2 dimensions",
        ),
        ("infer nan.npy --out s", "row 1, column 0: NaN"),
        ("infer clusters.npy --components 0 --out s", "`schema.components` is 0, but must be 1 to 1000"),
        ("infer clusters.npy --settings zero.toml --out s", "`schema.components` is 0"),
        ("infer clusters.npy --settings start.toml --out s", "unknown variant `random`"),
        ("infer clusters.npy --chains 0 --out s", "`schema.chains` is 0"),
        (
            "infer clusters.npy --labels short.csv --tree tree.csv --out s",
            "short.csv: sensor 1 of 100 has no part",
        ),
        (
            "infer clusters.npy --labels labels.csv --tree labels.csv --out s",
            "labels.csv: line 2: missing field `child`",
        ),
        ("simulate --settings absent.toml --out s", "absent.toml: cannot read the settings"),
        ("simulate --settings unknown.toml --out s", "unknown.toml: unknown setting `motion.speed`"),
        ("simulate --settings broken.toml --out s", "broken.toml: line 1"),
        ("simulate --settings wild.toml --out s", "lower motion.stiffness"),
        ("simulate --settings heavy.toml --out s", "`agent.density` is 1e300"),
        ("simulate --settings long.toml --out s", "at most 20 million samples"),
        (
            "simulate --settings steps.toml --out s",
            "`physics.duration` is 10000.0, but must be at least sense.interval",
        ),
        ("reproduce exp1 --settings vast.toml --out s", "`skin.around * skin.along + skin.caps` is 20000"),
        ("simulate --settings endless.toml --out s", "`schema.chains * schema.sweeps`"),
        ("simulate --settings long-file.toml --out s", "it is longer than 1048576 bytes"),
        ("simulate --settings binary.toml --out s", "binary.toml: cannot read the settings"),
        ("simulate --settings /dev/zero --out s", "/dev/zero: cannot read the settings"),
        ("simulate --settings . --out s", ".: cannot read the settings"),
        ("distance . --out d.npy", ".: cannot be read as a .npy file"),
        ("map line.npy --of distances --dims 18446744073709551615 --out m.npy", "at most 1"),
        ("map far.npy --of distances --dims 1 --out m.npy", "the largest distance is 1e200"),
        ("infer broad.npy --out s", "the 2 points span fewer than 200000 dimensions"),
        ("infer deep.npy --components 1000 --out s", "schema.components = 1000 in 200 dimensions"),
        (
            "infer clusters.npy --keep all --sweeps 100001 --burn-in 1 --chains 11 --out s",
            "at most 1000000 samples",
        ),
        ("plot absent", "absent/figures: has no table of a figure"),
        ("plot no-figure", "has no table of a figure"),
        ("plot bad-figure", "fig07-parts.csv: line 2: "),
        ("plot binary-figure", "fig07-parts.csv: has no rows"),
        ("plot bad-claims", "claims.csv: line 2: missing field"),
        ("plot bad-manifest", "bad-manifest/manifest.json: is not a manifest"),
        ("plot deep-manifest", "deep-manifest/manifest.json: is not a manifest"),
        ("simulate --out file/s", "file/s: cannot be written to"),
        ("distance transposed.npy --out d.npy", "is it transposed?"),
        ("distance transposed.npy --symbols --out d.npy", "is it transposed?"),
        ("map same.npy --dims 1 --out m.npy", "all at distance 0"),
        ("map line.npy --dims 1 --out /dev/null", "/dev/null: cannot be written: it is not a regular file"),
        ("infer tiny.npy --out s", "tiny.npy: the points spread over 1.5"),
        ("infer clusters.npy --chains 1000000000000 --out s", "`schema.chains`"),
        ("reproduce exp1 --settings deep.toml --out s", "but 840 sensors span fewer"),
        ("reproduce exp1 --jobs 0 --out s", "--jobs is 0"),
        ("reproduce exp1 --simulations 0 --out s", "`experiment.simulations` is 0"),
    ] {
        let output = bodyschema(folder.path(), arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
        assert_eq!(errors.lines().count(), 1, "{arguments}: {errors}");
        assert!(errors.contains(expected), "{arguments}: {errors:?} lacks {expected:?}");
    }
    // Arguments that do not fit are clap's to explain, with the same status.
    assert_eq!(
        bodyschema(folder.path(), "infer clusters.npy --labels labels.csv --out s").status.code(),
        Some(2)
    );
}
