//! Write a page of HTML that needs no other file and no network.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// The style of a page of results.
pub(crate) const STYLE: &str = include_str!("style.css");

/// A page may load nothing, from nowhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The page with this title, these styles and this element `body`.
pub(crate) fn document(title: &str, styles: &[&str], body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { "bodyschema: " (title) }
                style { @for style in styles { (PreEscaped(style)) } }
            }
            (body)
        }
    }
    .into_string()
}
