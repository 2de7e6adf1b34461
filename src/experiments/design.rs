//! Hold the designs of the repository's studies, and what all designs need: lay tables of settings over each other, and
//! write them in a line.

use toml::{Table, Value};

/// `reproduce/search.toml`, the design of the search for the default, with its score.
pub const SEARCH: &str = include_str!("../../reproduce/search.toml");

/// `reproduce/fluid.toml` and `reproduce/fluid-wide.toml`, the designs of its last parts.
pub const PARTS_IN_FLUID: [&str; 2] =
    [include_str!("../../reproduce/fluid.toml"), include_str!("../../reproduce/fluid-wide.toml")];

/// `reproduce/sensitivity.toml`, the design of the study of what the paper leaves open.
pub const SENSITIVITY: &str = include_str!("../../reproduce/sensitivity.toml");

/// `reproduce/ablation.toml`, the design of the comparison of the authors' code with and without its departures.
pub const ABLATION: &str = include_str!("../../reproduce/ablation.toml");

/// `reproduce/multiverse.toml`, the design of the multiverse of replications.
pub const MULTIVERSE: &str = include_str!("../../reproduce/multiverse.toml");

/// Lays `over` on `base`, section by section.
pub fn merge(base: &mut Table, over: &Table) {
    for (name, value) in over {
        match (base.get_mut(name), value) {
            (Some(Value::Table(base)), Value::Table(over)) => merge(base, over),
            _ => {
                base.insert(name.clone(), value.clone());
            }
        }
    }
}

/// `section.key = value` for every setting of a table.
pub fn flat(table: &Table) -> Vec<String> {
    let mut all = Vec::new();
    for (name, value) in table {
        match value {
            Value::Table(inner) => all.extend(flat(inner).into_iter().map(|line| format!("{name}.{line}"))),
            value => all.push(format!("{name} = {}", value.to_string().replace('"', ""))),
        }
    }
    all
}
