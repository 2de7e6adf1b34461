//! Say of each setting where its default is from, and what it means: `reproduce/sources.toml`.

use serde::Deserialize;
use serde_json::Value;

use super::sections::Settings;

/// `reproduce/sources.toml`: a table for each setting, in the sections of `reproduce/paper.toml`.
const SOURCES: &str = include_str!("../../reproduce/sources.toml");

/// A setting as the table of a report has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// Its section and name, such as `motion.epoch`.
    pub key: String,
    /// Its value in `reproduce/paper.toml`.
    pub default: Value,
    /// `stated (SECTION)` if the paper gives that value, `ours` if it leaves it open, `extension` if it has nothing of the kind.
    pub source: String,
    /// What it means, with its unit and its other values.
    pub meaning: String,
}

/// An entry of `reproduce/sources.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    source: String,
    meaning: String,
}

/// All settings, in the order of `reproduce/paper.toml`.
pub fn described() -> Vec<Described> {
    let sources = toml::from_str(SOURCES).expect("reproduce/sources.toml is TOML; a test checks it");
    // Settings of a random movement do not write the rhythm, which has defaults, too.
    let rhythmic = "[motion]\nmovement = \"rhythmic\"".parse().expect("it is TOML");
    let rhythmic =
        Settings::overlaid([&rhythmic], "defaults").expect("the defaults of a rhythm are in range");
    let mut defaults = serde_json::to_value(rhythmic).expect("settings are plain data");
    defaults["motion"]["movement"] = "random".into();
    let mut all = Vec::new();
    gather("", &defaults, &sources, &mut all);
    all
}

/// Adds the settings of a section, whose name ends with a point, and of the sections within it.
fn gather(section: &str, defaults: &Value, sources: &Value, all: &mut Vec<Described>) {
    for (name, default) in defaults.as_object().into_iter().flatten() {
        let (key, source) = (format!("{section}{name}"), &sources[name]);
        if default.is_object() {
            gather(&format!("{key}."), default, source, all);
        } else {
            let Entry { source, meaning } =
                Entry::deserialize(source).expect("every setting has a source; a test checks it");
            all.push(Described { key, default: default.clone(), source, meaning });
        }
    }
}

#[cfg(test)]
mod tests;
