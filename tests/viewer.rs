//! The page of `bodyschema view` as a reader sees it, in headless Chromium with WebGL in software. Skipped without Chromium.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use crate::support::browser::{inaccessible, quoted, seen};
use crate::support::folder::Folder;

/// The paper's body of 840 sensors for a minute, in which joints move eleven times out of twelve.
const MINUTE: &str = "physics.duration = 60.0\nmotion.coordination = 0.5";

/// Opens the page in a frame of each width, works with it as a reader does, and says what it sees as JSON in `seen`.
const HARNESS: &str = include_str!("support/viewer.html");

#[derive(Debug, Deserialize)]
struct Seen {
    width: f64,
    /// Whether it plays by itself.
    playing: bool,
    frame: f64,
    clock: String,
    /// Bytes of each canvas that change between two times.
    moved: Vec<usize>,
    tapped: Option<usize>,
    /// From the sensor that was tapped to the one that is marked, m.
    near: Option<f64>,
    /// Bytes of each canvas that change with the mark.
    #[serde(default)]
    linked: Vec<usize>,
    /// Black pixels around the marked sensor on the map.
    ring: Option<usize>,
    status: String,
    part: String,
    trees: Vec<String>,
    colourings: Vec<String>,
    nameless: Vec<String>,
    scroll: f64,
    complaints: Vec<String>,
    loaded: Vec<String>,
    speed: f64,
    /// Whether the canvases have all their pixels: at 60 frames a second, at 10, at 10 again, and once the body stands still.
    detail: [bool; 4],
}

/// What Chromium shows of a page at the width of a phone and of a desk, after it was open for `motion` ms of virtual time; none
/// without Chromium.
fn look(page: &str, folder: &Path, motion: u32, options: &[&str]) -> Option<Vec<Seen>> {
    let harness = HARNESS.replace("REPORT", &quoted(page)).replace("MOTION", &motion.to_string());
    let virtual_time: &[&str] = if motion > 0 { &["--virtual-time-budget=20000"] } else { &[] };
    let seen = seen(&harness, folder, &[options, virtual_time].concat())?;
    Some(serde_json::from_str(&seen).unwrap_or_else(|error| panic!("{error}: {seen}")))
}

const WEBGL: [&str; 3] = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/// A folder with a simulation, and with an estimate of it that has the true parts and edges of a support of 75 %.
fn simulated() -> Folder {
    let folder = Folder::new();
    folder.write("minute.toml", MINUTE);
    folder.succeed("simulate --settings minute.toml --out body");
    folder.write("found/parts.csv", folder.bytes("body/labels.csv"));
    let edges: String =
        folder.text("body/tree.csv").lines().skip(1).map(|edge| format!("{edge},0.75\n")).collect();
    folder.write("found/tree.csv", format!("child,parent,support\n{edges}"));
    folder
}

fn page(folder: &Folder, arguments: &str) -> String {
    folder.succeed(&format!("view {arguments} --out page.html"));
    let page = folder.text("page.html");
    assert!(page.len() < 3_000_000, "{arguments}: {} bytes", page.len());
    page
}

/// What a page shows.
fn scenes(page: &str) -> Value {
    let (_, rest) = page.split_once("<script class=\"data\" type=\"application/json\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// What holds for every page.
fn check(context: &str, seen: &Seen) {
    assert_eq!(seen.complaints, [""; 0], "{context}");
    assert_eq!(seen.loaded, [""; 0], "{context}: it asks the network");
    assert_eq!(seen.nameless, [""; 0], "{context}: elements without a name");
    assert!(seen.scroll <= seen.width, "{context}: {} px wide", seen.scroll);
    assert_eq!(seen.frame, 40.5, "{context}: the slider seeks");
    assert!(
        seen.tapped.is_some_and(|sensor| seen.status.starts_with(&format!("Sensor {sensor},"))),
        "{context}: {seen:?}"
    );
    assert!(seen.part.starts_with("part "), "{context}: {}", seen.part);
}

/// Whether everybody can read a page, by axe-core.
fn check_access(page: &str, folder: &Path) {
    let found = inaccessible(page, folder, &WEBGL).unwrap_or_default();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_reader_sees_the_body_move_and_finds_a_sensor_again_on_the_map() {
    let folder = simulated();
    let page = page(&folder, "body --estimate found");
    let Some(seen) = look(&page, folder.path(), 500, &WEBGL) else { return };
    for seen in &seen {
        let context = format!("at {} px", seen.width);
        check(&context, seen);
        assert!(seen.clock.ends_with(" s"), "{context}: {}", seen.clock);
        assert!(
            seen.moved.len() == 2 && seen.moved.iter().all(|bytes| *bytes > 100),
            "{context}: {:?}",
            seen.moved
        );
        // A sensor beside the one that was meant may be a little nearer.
        assert!(seen.near.unwrap() < 0.05, "{context}: {seen:?}");
        assert!(
            seen.linked.len() == 2 && seen.linked.iter().all(|bytes| *bytes > 100),
            "{context}: {:?}",
            seen.linked
        );
        assert!(seen.ring.unwrap() >= 10, "{context}: {seen:?}");
        assert_eq!(seen.trees, ["Estimated tree", "True tree"], "{context}");
        assert_eq!(seen.colourings, ["pressure", "true part", "estimated part"], "{context}");
        assert_eq!(seen.detail, [true, false, false, true], "{context}");
    }
    // The second frame is below what a reader sees, and waits.
    assert!(seen[0].playing && !seen[1].playing, "{seen:?}");
    check_access(&page, folder.path());
    // The twin: words that are too pale, and a control without a name.
    let pale = page.replace("<main>", "<main><p style=\"color:#bbb\">pale</p><input>");
    if let Some(found) = inaccessible(&pale, folder.path(), &WEBGL) {
        for wrong in ["color-contrast", "label"] {
            assert!(found.iter().any(|line| line.contains(wrong)), "{wrong}: {found:?}");
        }
    }
    // Nothing moves by itself for those who ask for that.
    let options: Vec<&str> = WEBGL.into_iter().chain(["--force-prefers-reduced-motion"]).collect();
    let seen = look(&page, folder.path(), 500, &options).unwrap();
    assert!(seen.iter().all(|seen| !seen.playing), "{seen:?}");
    // In time as it passes, which is not virtual. How fast a shared machine draws is said, not demanded.
    for seen in look(&page, folder.path(), 0, &WEBGL).unwrap() {
        assert!(seen.speed > 0.0, "{seen:?}");
        eprintln!("{:.0} frames a second at {} px, drawn by software", seen.speed, seen.width);
    }
}

#[test]
fn without_webgl_or_without_a_body_touch_over_time_is_shown() {
    let folder = simulated();
    for (arguments, options) in [
        ("body --estimate found", &["--disable-gpu", "--disable-3d-apis"][..]),
        ("found --tactile body/tactile.npy", &WEBGL[..]),
    ] {
        let page = page(&folder, arguments);
        let Some(seen) = look(&page, folder.path(), 500, options) else { return };
        for seen in &seen {
            check(&format!("{arguments} at {} px", seen.width), seen);
            assert!(seen.near.is_none(), "{arguments}: no body is drawn");
        }
    }
}

#[test]
fn an_estimate_has_a_page_of_its_own() {
    let folder = simulated();
    let truth = "--labels body/labels.csv --tree body/tree.csv";
    let tree = folder.text("body/tree.csv");
    folder.succeed(&format!("estimate body/tactile.npy {truth} --interval 0.1 --out own"));
    let page = folder.text("own/report.html");
    assert!(
        page.len() < 3_000_000 && page.contains("Against the truth: adjusted Rand index"),
        "{}",
        page.len()
    );
    check_access(&page, folder.path());
    let Some(seen) = look(&page, folder.path(), 500, &WEBGL) else { return };
    for seen in &seen {
        check(&format!("estimate at {} px", seen.width), seen);
        assert!(seen.clock.ends_with(" s"), "{}", seen.clock);
        assert_eq!(seen.trees, ["Estimated tree", "True tree"]);
    }
    // Not over the true tree.
    for wrong in ["--interval 0 --out own", "--out body"] {
        let said = folder.run(&format!("estimate body/tactile.npy {wrong}"));
        assert_eq!(said.status, Some(2), "{said:?}");
    }
    assert_eq!(folder.text("body/tree.csv"), tree);
}

#[test]
fn times_of_an_estimate_count_the_samples_that_were_lost() {
    let folder = Folder::new();
    let felt = |t: usize, sensor: usize| (0.1 * t as f64 + sensor as f64).sin().max(0.0);
    let row = |t: usize| {
        let cells = (0..12)
            .map(|sensor| if (10..60).contains(&t) { "nan".to_owned() } else { felt(t, sensor).to_string() });
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    folder.write("touch.csv", (0..200).map(row).collect::<String>());
    // The movement repeats itself, so that no page would be written.
    let said = folder.run("estimate touch.csv --interval 0.5 --out own --force");
    assert_eq!(said.status, Some(0), "{said:?}");
    let scene = &scenes(&folder.text("own/report.html"))[0];
    let times = scene["times"].as_array().unwrap();
    assert_eq!(times.len(), 150);
    assert_eq!([9, 10, 149].map(|frame| times[frame].as_f64().unwrap()), [4.5, 30.0, 99.5]);
}

#[test]
fn of_many_draws_that_of_highest_log_posterior_is_shown() {
    let folder = simulated();
    folder.succeed("distance body/tactile.npy --out distance.npy");
    folder.succeed("map distance.npy --dims 5 --out body-map.npy");
    folder.succeed("infer body-map.npy --chains 20 --sweeps 20 --start uniform --out draws");
    let samples = folder.rows("draws/samples.csv");
    let height = |row: &BTreeMap<String, String>| row["log_posterior"].parse::<f64>().unwrap();
    let best = samples.iter().max_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
    assert_ne!(best["chain"], "0", "the first draw is no test: {samples:?}");

    let page = page(&folder, "body --estimate draws");
    let estimate = &scenes(&page)[0]["estimate"];
    let mut sensors = BTreeMap::<u64, usize>::new();
    for part in estimate["of"].as_array().unwrap() {
        *sensors.entry(part.as_u64().unwrap()).or_default() += 1;
    }
    let parts = sensors.values().filter(|sensors| **sensors > 1).count();
    assert_eq!(parts.to_string(), best["parts"], "{sensors:?}");
    let trees = folder.rows("draws/trees.csv");
    let own: Vec<[u64; 2]> = trees
        .iter()
        .filter(|row| row["chain"] == best["chain"])
        .map(|row| ["child", "parent"].map(|end| row[end].parse().unwrap()))
        .collect();
    let edge = |edge: &Value| ["child", "parent"].map(|end| edge[end].as_u64().unwrap());
    assert_eq!(estimate["tree"].as_array().unwrap().iter().map(edge).collect::<Vec<_>>(), own);

    // Draws of another body.
    folder.write("two.csv", "1,2\n3,4\n");
    let said = folder.run("view body --tactile two.csv --estimate draws");
    assert_eq!(said.status, Some(2), "{said:?}");
}

/// What the page of a body at rest shows.
#[derive(Debug, Deserialize)]
struct SeenAtRest {
    /// Whether play, time and clock are hidden.
    hidden: [bool; 3],
    colourings: Vec<String>,
    trees: Vec<String>,
    /// What is said of a part of the tree that one points at.
    parts: Vec<String>,
    /// Pixels of the body that are not white.
    drawn: usize,
    complaints: Vec<String>,
}

const AT_REST: &str = include_str!("support/at_rest.html");

#[test]
fn a_body_is_shown_before_it_moves_with_its_meshes() {
    let folder = Folder::new();
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/import/robot/urdf/robot.urdf");
    let said = folder.succeed(&format!("view {robot} --out robot.html"));
    assert!(said.contains("sensors on ") && said.contains("note: link "), "{said}");
    folder.succeed(&format!("body import {robot} --out robot.toml --view imported.html"));
    assert_eq!(folder.text("imported.html"), folder.text("robot.html"));
    folder.refuse(
        &format!("body import {robot} --out b.toml --view {robot}"),
        "robot.urdf: is the description or the body",
    );
    folder.refuse(
        &format!("body import {robot} --out b.toml --view b.toml"),
        "b.toml: is the description or the body",
    );
    assert!(!folder.at("b.toml").exists());
    folder.succeed("view robot.toml --out page.html");
    for (page, meshes) in [("robot.html", 2), ("page.html", 0)] {
        let page = folder.text(page);
        assert_eq!(page.matches("\"kind\":\"mesh\"").count(), meshes);
        let Some(seen) = seen(&AT_REST.replace("REPORT", &quoted(&page)), folder.path(), &WEBGL) else {
            return;
        };
        let seen: SeenAtRest = serde_json::from_str(&seen).unwrap();
        assert_eq!((seen.hidden, &seen.colourings[..]), ([true; 3], &["true part".to_owned()][..]));
        assert_eq!((&seen.trees[..], &seen.complaints[..]), (&["True tree".to_owned()][..], &[][..]));
        assert!(seen.parts[0].starts_with("part 0 (base"), "{:?}", seen.parts);
        assert!(seen.drawn > 1000, "{seen:?}");
    }
}

#[test]
fn parts_have_the_names_of_the_folder() {
    let folder = Folder::new();
    folder.write("own/tactile.csv", "1,2\n3,4\n");
    folder.write("own/labels.csv", "sensor,part\n0,0\n1,1\n");
    folder.write("own/names.csv", "part,name\n1,right\n0,left\n");
    folder.succeed("view own");
    assert!(folder.text("own/view.html").contains("\"names\":[\"left\",\"right\"]"));
    folder.write("own/names.csv", "part,name\n0,left\n3,right\n");
    folder.refuse("view own", "own/names.csv: names part 3 where part 1 is expected");
}

#[test]
fn what_does_not_fit_is_said_in_one_line() {
    let folder = simulated();
    fs::create_dir(folder.at("empty")).unwrap();
    folder.write("own/tactile.csv", "1,2\n3,4\n");
    folder.write("fewer/parts.csv", "sensor,part\n0,0\n1,1\n");
    folder.write("fewer/summary.json", "{\"sensors\": 2}");
    folder.write("own/parts.csv", "sensor,part\n0,0\n1,1\n");
    folder.write("own/tree.csv", "child,parent\n1,7\n");
    folder.write("torn/tactile.csv", "1,2\n3,4\n");
    for name in ["solids.csv", "sensors.csv", "poses.npy"] {
        fs::copy(folder.at("body").join(name), folder.at("torn").join(name)).unwrap();
    }
    folder.write("short.toml", "");
    for (arguments, expected) in [
        ("absent", "absent: no such folder"),
        ("empty", "empty: has no tactile.npy or tactile.csv"),
        ("own/tree.csv", "own/tree.csv: is a table or a recording, and not a body"),
        ("short.toml --estimate found", "short.toml: --tactile, --estimate and --settings are for a folder"),
        ("short.toml --out short.toml", "short.toml: is the input file; give another --out"),
        ("absent --tactile body/tactile.npy", "absent: no such folder"),
        ("body --tactile absent.npy", "absent.npy: no such file"),
        ("body --estimate fewer", "fewer/summary.json: is of 2 sensors, but the pressures are of 840"),
        ("body --estimate empty", "empty: has no parts.csv"),
        ("own", "own/tree.csv: part 7 has no sensor in own/parts.csv"),
        (
            "torn",
            "torn/poses.npy: is of 840 sensors and 600 samples, but the pressures are of 2 sensors and 2 samples",
        ),
    ] {
        folder.refuse(&format!("view {arguments}"), expected);
    }
}
