//! The report as a reader sees it, on a phone and on a desk: opened in headless Chromium, every figure is
//! there and nothing overflows. Skipped without Chromium.

use std::path::Path;

use serde::Deserialize;

use crate::support::browser::{inaccessible, quoted, seen};
use crate::support::folder::Folder;
use crate::support::small::small;

/// Opens the report in a frame of each width and says what it sees, as JSON in the element `seen`.
const HARNESS: &str = r#"<!doctype html><meta charset="utf-8"><body><pre id="seen"></pre><script>
const report = REPORT;
function look(width) {
  return new Promise(done => {
    const frame = document.createElement("iframe");
    frame.style.cssText = `border:0;width:${width}px;height:900px`;
    frame.onload = () => {
      const page = frame.contentDocument, right = element => element.getBoundingClientRect().right;
      const beyond = [...page.body.querySelectorAll("*")]
        .filter(element => !element.closest("svg svg, svg *") && right(element) > width + 0.5);
      const figures = [...page.querySelectorAll("figure")].map(figure => {
        const box = figure.querySelector("svg")?.getBoundingClientRect();
        const sizes = [...figure.querySelectorAll("svg text")].map(text => {
          const matrix = text.getScreenCTM(), scale = Math.hypot(matrix.a, matrix.b); // some are turned
          return parseFloat(getComputedStyle(text).fontSize) * scale;
        });
        const cut = [...figure.querySelectorAll("svg text")].filter(text => {
          const inner = text.getBoundingClientRect();
          return inner.left < box.left - 1 || inner.right > box.right + 1 || inner.top < box.top - 1 ||
            inner.bottom > box.bottom + 1;
        }).map(text => text.textContent.trim()).filter(words => words);
        return { name: figure.id, width: box?.width ?? 0, height: box?.height ?? 0,
          smallest_text: Math.min(...sizes), cut };
      });
      const ranges = [...page.querySelectorAll(".claims tbody svg.range")].map(svg => {
        const box = svg.getBoundingClientRect(), marks = [...svg.querySelectorAll("rect, line, circle, text, polygon")];
        return { words: svg.getAttribute("aria-label"), title: svg.querySelector("title").textContent,
          width: box.width, bands: svg.querySelectorAll(".band").length,
          cut: marks.filter(mark => {
            const inner = mark.getBoundingClientRect();
            return inner.left < box.left - 1 || inner.right > box.right + 1 || inner.bottom > box.bottom + 1;
          }).map(mark => mark.tagName) };
      });
      done({ width, ranges, scroll: page.documentElement.scrollWidth, rows: page.querySelectorAll(".claims tbody tr").length,
        settings: page.querySelectorAll(".settings tbody tr").length,
        beyond: beyond.map(element => `${element.tagName} ${element.textContent.slice(0, 40)}`), figures });
    };
    frame.srcdoc = report;
    document.body.append(frame);
  });
}
(async () => {
  const seen = [await look(375), await look(1280)];
  document.getElementById("seen").textContent = JSON.stringify(seen);
})();
</script></body>"#;

#[derive(Debug, Deserialize)]
struct Seen {
    width: f64,
    scroll: f64,
    rows: usize,
    settings: usize,
    beyond: Vec<String>,
    ranges: Vec<Range>,
    figures: Vec<Figure>,
}

/// The drawing of a claim's interval against its accepted range.
#[derive(Debug, Deserialize)]
struct Range {
    words: String,
    title: String,
    width: f64,
    bands: usize,
    cut: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Figure {
    name: String,
    width: f64,
    height: f64,
    smallest_text: f64,
    cut: Vec<String>,
}

/// What Chromium shows of a report, at the width of a phone and of a desk; none without Chromium.
fn look(report: &str, folder: &Path) -> Option<Vec<Seen>> {
    let seen = seen(
        &HARNESS.replace("REPORT", &quoted(report)),
        folder,
        &["--disable-gpu", "--virtual-time-budget=20000"],
    )?;
    Some(serde_json::from_str(&seen).unwrap_or_else(|error| panic!("{error}: {seen}")))
}

fn check_ranges(context: &str, ranges: &[Range], testable: usize) {
    assert_eq!(ranges.len(), testable, "{context}: a drawing for each claim that can be tested");
    for Range { words, title, width, bands, cut } in ranges {
        assert!(words.starts_with("accepted ") && words.contains("reproduced "), "{context}: {words}");
        assert_eq!(title, words, "{context}");
        assert!(*width > 100.0 && *bands == 1, "{context}: {words}: {width} px, {bands} bands");
        assert!(cut.is_empty(), "{context}: {words}: cuts off {cut:?}");
    }
}

#[test]
fn the_report_shows_every_figure_and_nothing_overflows() {
    let folder = Folder::new();
    // At the dimensions whose maps are drawn.
    let drawn = "experiment.dimensions = [2, 3, 14]\nexperiment.coordinations = [0.4, 0.9, 1.0]";
    folder.write(
        "small.toml",
        small(&format!("{drawn}\nexperiment.simulations = 2\nphysics.duration = 1500.0")),
    );
    for (experiment, figures) in [
        (
            "exp1",
            &[
                "fig04-agent",
                "fig05-angles",
                "fig06a-map-2d",
                "fig06b-map-3d",
                "fig06c-clusters-2d",
                "fig06d-clusters-3d",
                "fig07-parts",
                "fig08a-ari-baselines",
                "fig08b-ari",
                "fig09-ari-box",
                "fig10a-tree-baseline",
                "fig10b-tree",
            ][..],
        ),
        ("exp2", &["fig11a-ari", "fig11b-tree"]),
    ] {
        folder.reproduce(&format!("{experiment} --settings small.toml --out {experiment}"));
        let report = folder.text(format!("{experiment}/report.html"));
        for forbidden in ["src=\"http", "href=\"http", "@import", "url("] {
            assert!(!report.contains(forbidden), "the report needs the network: {forbidden}");
        }
        assert!(report.contains("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'"));
        let claims = folder.rows(format!("{experiment}/claims.csv"));
        let testable = claims.iter().filter(|row| !row["accepted_low"].is_empty()).count();
        assert!(testable >= 7, "{experiment}: {testable} claims can be tested");
        let Some(seen) = look(&report, folder.path()) else { return };
        for Seen { width, scroll, rows, settings, beyond, ranges, figures: found } in seen {
            let context = format!("{experiment} at {width} px");
            assert!(scroll <= width, "{context}: {scroll} px wide; {beyond:?}");
            assert!(beyond.is_empty(), "{context}: {beyond:?}");
            assert!(rows >= 10 && settings >= 30, "{context}: {rows} claims, {settings} settings");
            check_ranges(&context, &ranges, testable);
            let names: Vec<&str> = found.iter().map(|figure| figure.name.as_str()).collect();
            assert_eq!(names, figures, "{context}");
            for Figure { name, width, height, smallest_text, cut } in &found {
                assert!(*width > 300.0 && *height > 100.0, "{context}: {name} is {width} x {height} px");
                assert!(*smallest_text >= 7.5, "{context}: {name} has text of {smallest_text} px");
                assert!(cut.is_empty(), "{context}: {name} cuts off {cut:?}");
            }
        }
        let found = inaccessible(&report, folder.path(), &["--disable-gpu"]).unwrap_or_default();
        assert!(found.is_empty(), "{experiment}: {found:#?}");
        assert!(report.len() < 3_000_000, "{experiment}: {} bytes", report.len());
    }
    // The twin: a report that is too wide is seen.
    let report = folder.text("exp2/report.html");
    let too_wide = report.replace("</main>", "<p style=\"width:1400px\">wide</p></main>");
    let seen = look(&too_wide, folder.path()).unwrap();
    assert!(seen.iter().all(|seen| seen.scroll > seen.width && !seen.beyond.is_empty()), "{seen:?}");
}
