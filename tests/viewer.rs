//! The page of `bodyschema view` as a reader sees it, in headless Chromium with WebGL in software. Skipped with a message where
//! there is no Chromium.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde::Deserialize;

#[path = "support/browser.rs"]
mod browser;

use browser::{inaccessible, quoted, seen};

/// The paper's body of 840 sensors for a minute, in which joints move eleven times out of twelve.
const MINUTE: &str = "
[physics]
duration = 60.0
[motion]
coordination = 0.5
";

/// Opens the page in a frame of each width, works with it as a reader does, and says what it sees as JSON in `seen`.
const HARNESS: &str = r#"<!doctype html><meta charset="utf-8"><body><pre id="seen"></pre><script>
const report = REPORT, wait = MOTION;
// Whatever the page complains of, or loads, is written down before it begins.
const watch = `<script>window.complaints = [];
  addEventListener("error", event => complaints.push(String(event.message)));
  addEventListener("securitypolicyviolation", event => complaints.push("loads " + event.blockedURI));
  for (const kind of ["error", "warn"]) console[kind] = (...words) => complaints.push(words.join(" "));
<\/script>`;
const tap = (canvas, x, y) => {
  const box = canvas.getBoundingClientRect(), view = canvas.ownerDocument.defaultView;
  for (const kind of ["pointermove", "pointerdown", "pointerup", "click"]) {
    const make = kind === "click" ? view.MouseEvent : view.PointerEvent;
    canvas.dispatchEvent(new make(kind, { clientX: box.left + x, clientY: box.top + y, pointerId: 1, bubbles: true }));
  }
};
const pixels = space => {
  const gl = space.gl, all = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, all);
  return all;
};
const differing = (a, b) => a.reduce((count, x, at) => count + (x !== b[at]), 0);
function work(page, window, width) {
  const section = page.querySelector("section.viewer"), viewer = section.viewer, found = { width };
  viewer.play(false);
  const slider = section.querySelector(".time input"), spaces = [viewer.body, viewer.map].filter(space => space);
  const shown = () => spaces.map(pixels);
  const at = frame => {
    slider.value = frame;
    slider.dispatchEvent(new window.Event("input", { bubbles: true }));
  };
  at(10);
  const before = shown();
  at(40.5);
  found.frame = viewer.frame;
  found.clock = section.querySelector(".clock").textContent;
  found.moved = before.map((old, space) => differing(old, pixels(spaces[space])));
  if (viewer.body) {
    // The sensor that the reader sees best.
    const { canvas, eye, places } = viewer.body, { normals } = viewer.moved;
    const facing = sensor => [0, 1, 2].reduce((sum, axis) => sum + eye[axis] * normals[3 * sensor + axis], 0);
    const best = Array.from({ length: viewer.scene.sensors }, (_, sensor) => sensor).sort((a, b) => facing(b) - facing(a))[0];
    const unmarked = shown();
    tap(canvas, ...viewer.body.project(...places.subarray(3 * best, 3 * best + 3)).slice(0, 2));
    found.tapped = viewer.marked;
    const [here, there] = [viewer.body.places, viewer.map.places].map(all => [...all.subarray(3 * found.tapped, 3 * found.tapped + 3)]);
    found.near = Math.hypot(...[0, 1, 2].map(axis => here[axis] - places[3 * best + axis]));
    found.linked = unmarked.map((old, space) => differing(old, pixels(spaces[space])));
    // A ring of black around the place of the sensor on the map.
    const map = viewer.map, ratio = map.canvas.width / map.canvas.clientWidth, [x, y] = map.project(...there).map(length => length * ratio);
    const all = pixels(map);
    found.ring = 0;
    for (let dx = -9; dx <= 9; dx++) for (let dy = -9; dy <= 9; dy++) {
      const place = 4 * (Math.round(map.canvas.height - y + dy) * map.canvas.width + Math.round(x + dx));
      found.ring += all[place] + all[place + 1] + all[place + 2] === 0;
    }
  } else {
    const canvas = section.querySelector(".raster canvas"), box = canvas.getBoundingClientRect();
    tap(canvas, box.width / 2, box.height / 2);
    found.tapped = viewer.marked;
  }
  found.status = section.querySelector(".status").textContent;
  section.querySelector(".trees [role=button]")?.dispatchEvent(new window.KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
  found.part = section.querySelector(".trees [aria-pressed=true]")?.getAttribute("aria-label") ?? "";
  found.trees = [...section.querySelectorAll(".trees h3")].map(heading => heading.textContent);
  found.colourings = [...section.querySelectorAll(".colouring option")].map(option => option.textContent);
  const named = element => (element.getAttribute("aria-label") ?? element.labels?.[0]?.textContent ?? element.textContent).trim();
  found.nameless = [...section.querySelectorAll("button, input, select, canvas, [role=button]")].filter(element => !named(element)).map(element => element.outerHTML);
  found.scroll = page.documentElement.scrollWidth;
  found.complaints = window.complaints;
  found.loaded = window.performance.getEntriesByType("resource").map(entry => entry.name);
  found.speed = wait ? 0 : viewer.measure(40);
  // A machine that draws slowly draws less, as long as the body moves.
  const widths = () => spaces.map(space => space.canvas.width / space.canvas.clientWidth);
  const whole = widths();
  found.detail = [60, 10, 10].map(speed => {
    viewer.pace(speed);
    viewer.draw();
    return widths().every((width, at) => width === whole[at]);
  });
  viewer.play(false);
  found.detail.push(widths().every((width, at) => width === whole[at]));
  return found;
}
const frames = [375, 1280].map(width => {
  const frame = document.createElement("iframe");
  frame.style.cssText = `border:0;width:${width}px;height:1600px`;
  frame.srcdoc = report.replace("<head>", "<head>" + watch);
  document.body.append(frame);
  return [frame, width];
});
// What happens before the end of this event is seen, even where time is not virtual.
addEventListener("load", () => {
  const begin = () => {
    const seen = frames.map(([{ contentDocument, contentWindow }, width]) => {
      const { playing } = contentDocument.querySelector("section.viewer").viewer;
      return { playing, ...work(contentDocument, contentWindow, width) };
    });
    document.getElementById("seen").textContent = JSON.stringify(seen);
  };
  if (wait) setTimeout(begin, wait); else begin();
});
</script></body>"#;

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

fn bodyschema(folder: &Path, arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bodyschema"))
        .current_dir(folder)
        .args(arguments.split_whitespace())
        .output()
        .expect("the program starts")
}

fn succeed(folder: &Path, arguments: &str) {
    let output = bodyschema(folder, arguments);
    assert!(output.status.success(), "{arguments}: {output:?}");
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

/// A folder with a simulation, and with an estimate of it that has the true parts and edges of other confidences.
fn simulated() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("minute.toml"), MINUTE).unwrap();
    succeed(folder.path(), "simulate --settings minute.toml --out body");
    fs::create_dir(at("found")).unwrap();
    fs::copy(at("body/labels.csv"), at("found/parts.csv")).unwrap();
    let tree = fs::read_to_string(at("body/tree.csv")).unwrap();
    let edges = tree.lines().skip(1).map(|edge| format!("{edge},0.75\n"));
    fs::write(at("found/tree.csv"), format!("child,parent,confidence\n{}", edges.collect::<String>()))
        .unwrap();
    folder
}

fn page(folder: &Path, arguments: &str) -> String {
    succeed(folder, &format!("view {arguments} --out page.html"));
    let page = fs::read_to_string(folder.join("page.html")).unwrap();
    assert!(page.len() < 3_000_000, "{arguments}: {} bytes", page.len());
    page
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
    let page = page(folder.path(), "body --estimate found");
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
        let page = page(folder.path(), arguments);
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
    succeed(folder.path(), &format!("estimate body/tactile.npy {truth} --interval 0.1 --out own"));
    let page = fs::read_to_string(folder.path().join("own/report.html")).unwrap();
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
    let output = bodyschema(folder.path(), "estimate body/tactile.npy --interval 0 --out own");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

#[test]
fn what_does_not_fit_is_said_in_one_line() {
    let folder = simulated();
    let at = |name: &str| folder.path().join(name);
    for name in ["empty", "own", "torn"] {
        fs::create_dir(at(name)).unwrap();
    }
    fs::write(at("own/tactile.csv"), "1,2\n3,4\n").unwrap();
    fs::write(at("own/parts.csv"), "sensor,part\n0,0\n1,1\n").unwrap();
    fs::write(at("own/tree.csv"), "child,parent\n1,7\n").unwrap();
    fs::write(at("torn/tactile.csv"), "1,2\n3,4\n").unwrap();
    for name in ["solids.csv", "sensors.csv", "poses.npy"] {
        fs::copy(at("body").join(name), at("torn").join(name)).unwrap();
    }
    for (arguments, expected) in [
        ("absent", "absent: no such folder"),
        ("empty", "empty: has no tactile.npy or tactile.csv"),
        ("body --tactile absent.npy", "absent.npy: no such file"),
        ("body --estimate empty", "empty: has no parts.csv"),
        ("own", "own/tree.csv: part 7 has no sensor in own/parts.csv"),
        (
            "torn",
            "torn/poses.npy: is of 840 sensors and 600 samples, but the pressures are of 2 sensors and 2 samples",
        ),
    ] {
        let output = bodyschema(folder.path(), &format!("view {arguments}"));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
        assert_eq!(errors.lines().count(), 1, "{arguments}: {errors}");
        assert!(errors.contains(expected), "{arguments}: {errors:?} lacks {expected:?}");
    }
}
