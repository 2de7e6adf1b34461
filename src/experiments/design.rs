//! Lay tables of settings over each other, and write them out in a line, as designs of studies need it.

use toml::{Table, Value};

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
