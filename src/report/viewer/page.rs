//! Write the viewer as a section of a page, and as a page of its own that needs no other file and no network.

use maud::{Markup, PreEscaped, html};
use serde_json::Value;

use super::super::document::document;

/// Its programs, in the order in which they use each other.
const PROGRAMS: [&str; 5] = [
    include_str!("colours.js"),
    include_str!("space.js"),
    include_str!("tree.js"),
    include_str!("scene.js"),
    include_str!("viewer.js"),
];

/// Its style.
pub(crate) const STYLE: &str = include_str!("viewer.css");

/// A page with nothing but the viewer.
pub(crate) fn page(title: &str, scenes: &[Value]) -> String {
    let body = html! {
        body.viewer-page {
            main {
                h1 { (title) }
                (section(scenes))
            }
        }
    };
    document(title, &[STYLE], &body)
}

/// The viewer of one or more movements, between which its reader can switch; each as [`super::scene::Scene::data`] gives it.
pub(crate) fn section(scenes: &[Value]) -> Markup {
    // Within a script, "</" would end it.
    let data =
        serde_json::to_string(scenes).expect("plain data can be written as JSON").replace("</", "<\\/");
    html! {
        section.viewer id="viewer" aria-label="Body, touch, map and tree" {
            noscript { p { "The viewer needs JavaScript." } }
            div.controls {
                button.play type="button" { "Play" }
                label.time { "Time " input type="range" min="0" value="0" step="any"; }
                output.clock aria-hidden="true" {}
                label.scenes hidden[scenes.len() < 2] {
                    "Simulation "
                    select { @for (at, scene) in scenes.iter().enumerate() { option value=(at) { (scene["name"].as_str().unwrap_or_default()) } } }
                }
                label.colouring { "Colour " select {} }
                label.sensor { "Sensor " input type="number" min="0" step="1" placeholder="none"; }
            }
            p.status role="status" { "Point at a sensor, or at a part of a tree." }
            p.webgl hidden { "This browser does not support WebGL. Instead of body and map, the viewer shows what each sensor feels over time." }
            div.panels {
                div.panel.body {
                    h3 { "Body" }
                    canvas tabindex="0" role="img" aria-label="The body in three dimensions. Arrow keys rotate it, plus and minus zoom." {}
                }
                div.panel.raster {
                    h3 { "Touch over time" }
                    canvas tabindex="0" role="img" aria-label="Each row is a sensor, ordered by part, and each column a point in time. Arrow keys choose a sensor and a time." {}
                }
                div.panel.map {
                    h3 { "Body map" }
                    canvas tabindex="0" role="img" aria-label="The body map in three dimensions. Arrow keys rotate it, plus and minus zoom." {}
                }
                div.panel.trees {}
            }
            p.scale {}
            script.data type="application/json" { (PreEscaped(data)) }
            script { (PreEscaped("(() => {\n\"use strict\";\n")) @for program in PROGRAMS { (PreEscaped(program)) } (PreEscaped("})();\n")) }
        }
    }
}
