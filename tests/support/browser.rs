//! Open pages in headless Chromium, and ask axe-core whether they are accessible.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::tools::{run, skipped};

/// Loads the page at the width of a phone and of a desk, and lists what axe-core finds against WCAG 2.1 A and AA.
const ACCESSIBILITY: &str = r#"<!doctype html><meta charset="utf-8"><body><pre id="seen"></pre><script>
const page = PAGE, axe = AXE;
const look = width => new Promise(done => {
  const frame = document.createElement("iframe");
  frame.style.cssText = `border:0;width:${width}px;height:1600px`;
  frame.onload = async () => {
    const { violations } = await frame.contentWindow.axe.run(frame.contentDocument, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] });
    done(violations.flatMap(({ id, nodes }) => nodes.map(({ html, failureSummary }) => `at ${width} px: ${id}: ${html.slice(0, 120)}: ${failureSummary}`)));
  };
  frame.srcdoc = page.replace("<head>", () => `<head><script>${axe}<\/script>`);
  document.body.append(frame);
});
(async () => {
  const found = [...await look(375), ...await look(1280)];
  document.getElementById("seen").textContent = JSON.stringify(found);
})();
</script></body>"#;

/// A text as JSON that may stand within a script, where "</" would end it.
pub fn quoted(text: &str) -> String {
    serde_json::to_string(text).unwrap().replace("</", "<\\/")
}

/// What a page writes into its element `seen`, once Chromium has opened it; none, with a message, without Chromium.
pub fn seen(harness: &str, folder: &Path, options: &[&str]) -> Option<String> {
    let page = folder.join("harness.html");
    fs::write(&page, harness).unwrap();
    let mut chromium = Command::new("chromium");
    chromium
        .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .arg(format!("--user-data-dir={}", folder.join("chromium").display()))
        .args(options)
        .arg("--dump-dom")
        .arg(format!("file://{}", page.display()));
    let said = run(&mut chromium)?;
    let (_, rest) = said.out.split_once("id=\"seen\">").unwrap_or_else(|| panic!("{said:?}"));
    let (seen, _) = rest.split_once("</pre>").unwrap();
    Some(seen.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))
}

/// What keeps some readers from a page, by axe-core; none, with a message, without Chromium or axe-core.
pub fn inaccessible(page: &str, folder: &Path, options: &[&str]) -> Option<Vec<String>> {
    let Some(axe) = axe() else {
        skipped("axe-core is missing");
        return None;
    };
    let axe = fs::read_to_string(axe).unwrap();
    let parts = ACCESSIBILITY.split("AXE").collect::<Vec<_>>();
    let harness = [parts[0], &quoted(&axe), parts[1]].concat();
    // Nothing moves while it looks.
    let options: Vec<&str> = options
        .iter()
        .copied()
        .chain(["--force-prefers-reduced-motion", "--virtual-time-budget=60000"])
        .collect();
    let seen = seen(&harness.replacen("PAGE", &quoted(page), 1), folder, &options)?;
    Some(serde_json::from_str(&seen).unwrap_or_else(|error| panic!("{error}: {seen}")))
}

/// axe-core as the package axe-core-python of a Python environment on the path has it.
fn axe() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).find_map(|folder| {
        let pythons = fs::read_dir(folder.parent()?.join("lib")).ok()?;
        pythons
            .filter_map(|python| Some(python.ok()?.path().join("site-packages/axe_core_python/axe.min.js")))
            .find(|path| path.is_file())
    })
}
