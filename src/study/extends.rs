//! Find the text of a design: a file or one of the bundled designs, laid over the design that it extends.

use std::path::Path;

use toml::{Table, Value};

use super::choices::merge;
use crate::settings::{read_toml, toml_message};
use crate::tasks::error::ExperimentError;

/// The designs that the program brings: those of `reproduce/`, by name.
pub(super) const BUNDLED: [(&str, &str); 8] = [
    ("ablation", include_str!("../../reproduce/ablation.toml")),
    ("momentum", include_str!("../../reproduce/momentum.toml")),
    ("multiverse", include_str!("../../reproduce/multiverse.toml")),
    ("multiverse-held-out", include_str!("../../reproduce/multiverse-held-out.toml")),
    ("multiverse-near", include_str!("../../reproduce/multiverse-near.toml")),
    ("scored", include_str!("../../reproduce/scored.toml")),
    ("sensitivity", include_str!("../../reproduce/sensitivity.toml")),
    ("step", include_str!("../../reproduce/step.toml")),
];

/// Designs that may extend each other, at most.
const MOST_EXTENDED: usize = 8;

/// A design as a text that depends on no other file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DesignText {
    /// TOML. Where the design extends no other and its seed is its own, this is the file itself, with its comments.
    pub text: String,
    /// Where it is from, for messages.
    pub origin: String,
}

impl DesignText {
    /// Reads a design: a file, or a bundled design by its name, such as `multiverse`. What it does not say stands in the design
    /// that it `extends`; `seed` takes the place of its seed.
    ///
    /// # Errors
    /// If there is no such file or name, or the text is not TOML.
    pub(crate) fn read(design: &Path, seed: Option<u64>) -> Result<Self, ExperimentError> {
        let (text, origin) = find(design)?;
        let mut table = parse(&text, &origin)?;
        let extends = table.contains_key("extends");
        if !extends && seed.is_none() {
            return Ok(Self { text, origin });
        }
        table = extended(table, design, &origin, 0)?;
        if let Some(seed) = seed {
            let seed = i64::try_from(seed).map_err(|_| {
                ExperimentError::design("--seed", format!("{seed} is too large; use one below 2^63"))
            })?;
            table.insert("seed".to_owned(), Value::Integer(seed));
        }
        let text = toml::to_string(&table).expect("a table can be written");
        Ok(Self { text, origin })
    }
}

/// A design with all that it extends below it.
fn extended(mut own: Table, path: &Path, origin: &str, depth: usize) -> Result<Table, ExperimentError> {
    let Some(base) = own.remove("extends") else { return Ok(own) };
    let Value::String(base) = base else {
        return Err(ExperimentError::design(
            origin,
            "`extends` must be a file or the name of a bundled design",
        ));
    };
    if depth == MOST_EXTENDED {
        let message =
            format!("extends more than {MOST_EXTENDED} designs, one after the other; is it a circle?");
        return Err(ExperimentError::design(origin, message));
    }
    // A bundled design extends another bundled one.
    let beside = path.parent().unwrap_or(Path::new("")).join(&base);
    let path = match path.is_file() {
        true if beside.is_file() => beside,
        true => base.into(),
        false => beside.with_extension(""),
    };
    let (text, base_origin) = find(&path)
        .map_err(|error| ExperimentError::design(origin, format!("`extends` another design: {error}")))?;
    let mut below = extended(parse(&text, &base_origin)?, &path, &base_origin, depth + 1)?;
    merge(&mut below, &own);
    Ok(below)
}

/// The text of a file or of a bundled design, and where it is from.
fn find(design: &Path) -> Result<(String, String), ExperimentError> {
    let bundled = BUNDLED.iter().find(|(name, _)| Path::new(name) == design && !design.is_file());
    match bundled {
        Some((name, text)) => Ok(((*text).to_owned(), format!("reproduce/{name}.toml"))),
        None if design.is_file() => Ok((read_toml(design)?, design.display().to_string())),
        None => {
            let names: Vec<&str> =
                BUNDLED.iter().map(|(name, _)| *name).filter(|name| *name != "scored").collect();
            let message = format!("no such file; give a design, or one of {}", names.join(", "));
            Err(ExperimentError::design(&design.display().to_string(), message))
        }
    }
}

fn parse(text: &str, origin: &str) -> Result<Table, ExperimentError> {
    text.parse().map_err(|error: toml::de::Error| ExperimentError::design(origin, toml_message(text, &error)))
}

#[cfg(test)]
mod tests;
