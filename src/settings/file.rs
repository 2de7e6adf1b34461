//! Read settings from TOML and lay them over `reproduce/paper.toml`.
//!
//! `reproduce/paper.toml` is compiled in as the default, so that it is the only place where a default is
//! written. A user's file is laid over it; a key that `paper.toml` does not have is an error.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use toml::{Table, Value};

use super::error::SettingsError;
use super::sections::Settings;
use crate::files::one_line;

/// `reproduce/paper.toml` itself, whose comments say where each value is from.
pub const PAPER: &str = include_str!("../../reproduce/paper.toml");

/// A file of the project that is laid over `reproduce/paper.toml`.
#[derive(Debug, Clone, Copy)]
pub struct Base {
    text: &'static str,
    origin: &'static str,
}

impl Base {
    /// A run of less than a minute.
    pub const QUICK: Self =
        Self { text: include_str!("../../reproduce/quick.toml"), origin: "reproduce/quick.toml" };
    /// What goes with the split–merge sampler.
    pub const SPLIT_MERGE: Self =
        Self { text: include_str!("../../reproduce/split-merge.toml"), origin: "reproduce/split-merge.toml" };
    /// What goes with an estimate from any sensors.
    pub const ESTIMATE: Self =
        Self { text: include_str!("../../reproduce/estimate.toml"), origin: "reproduce/estimate.toml" };
}

/// Maximum length of a settings file, in bytes: far above any, and far below what a device or a wrong file may have.
const MAX_FILE_BYTES: u64 = 1 << 20;

impl Settings {
    /// The settings of the replication: `reproduce/paper.toml`.
    pub fn paper() -> Self {
        Self::checked(paper_table(), "reproduce/paper.toml")
            .expect("reproduce/paper.toml matches Settings; a test checks it")
    }

    /// `reproduce/paper.toml`, with `reproduce/quick.toml` over it if `quick`, and `file` over both.
    ///
    /// # Errors
    /// If the file cannot be read, is malformed, has an unknown key, or a value is out of range.
    pub fn load(quick: bool, file: Option<&Path>) -> Result<Self, SettingsError> {
        Self::load_over(quick.then_some(Base::QUICK), file)
    }

    /// `reproduce/paper.toml`, with another file of the project over it, and `file` over both.
    ///
    /// # Errors
    /// As for [`Self::load`].
    pub fn load_over(base: Option<Base>, file: Option<&Path>) -> Result<Self, SettingsError> {
        let mut table = paper_table();
        let mut origin = "reproduce/paper.toml".to_owned();
        if let Some(Base { text, origin }) = base {
            overlay(&mut table, parse(text, origin)?, "", origin)?;
        }
        if let Some(path) = file {
            let text = read_toml(path)?;
            origin = path.display().to_string();
            overlay(&mut table, parse(&text, &origin)?, "", &origin)?;
        }
        Self::checked(table, &origin)
    }

    /// `reproduce/paper.toml` with tables laid over it, one after the other; `origin` says where they are from.
    ///
    /// # Errors
    /// If a key is unknown, or a value is out of range.
    pub fn overlaid<'a>(
        tables: impl IntoIterator<Item = &'a Table>,
        origin: &str,
    ) -> Result<Self, SettingsError> {
        let mut table = paper_table();
        for over in tables {
            overlay(&mut table, over.clone(), "", origin)?;
        }
        Self::checked(table, origin)
    }

    /// These settings with a file's text, which must not have a seed, laid over them; `origin` says which.
    ///
    /// # Errors
    /// If a key is unknown, or a value is out of range.
    pub fn with(&self, text: &str, origin: &str) -> Result<Self, SettingsError> {
        // TOML has no numbers above 2⁶³, which a seed may be.
        let mut plain = self.clone();
        plain.experiment.seed = 0;
        let plain = Table::try_from(&plain).expect("settings can be written as a table");
        // Those of a random movement lack the rhythm, which the text may name.
        let mut table = paper_table();
        overlay(&mut table, plain, "", origin)?;
        overlay(&mut table, parse(text, origin)?, "", origin)?;
        let mut settings = Self::checked(table, origin)?;
        settings.experiment.seed = self.experiment.seed;
        Ok(settings)
    }

    fn checked(table: Table, origin: &str) -> Result<Self, SettingsError> {
        let mut settings: Self = table.try_into().map_err(|error: toml::de::Error| {
            SettingsError::Malformed { message: one_line(&error.to_string()), origin: origin.to_owned() }
        })?;
        settings.validate()?;
        // What does not count is not written: files of a random movement are what they were before there was a rhythm.
        settings.motion.rhythm = settings.motion.rhythm.filter(|_| !settings.motion.movement.is_random());
        Ok(settings)
    }
}

/// The text of a file of settings or of a design.
///
/// # Errors
/// If it cannot be read, or is too long to be one.
pub fn read_toml(path: &Path) -> Result<String, SettingsError> {
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_string(&mut text));
    match read {
        Ok(length) if length as u64 > MAX_FILE_BYTES => Err(io::Error::other(format!(
            "it is longer than {MAX_FILE_BYTES} bytes, the maximum for a settings file"
        ))),
        Ok(_) => Ok(text),
        Err(error) => Err(error),
    }
    .map_err(|reason| SettingsError::Unreadable { path: path.to_owned(), reason })
}

fn paper_table() -> Table {
    parse(PAPER, "reproduce/paper.toml").expect("reproduce/paper.toml is TOML; a test checks it")
}

fn parse(text: &str, origin: &str) -> Result<Table, SettingsError> {
    text.parse().map_err(|error: toml::de::Error| SettingsError::Malformed {
        origin: origin.to_owned(),
        message: one_line(&toml_message(text, &error)),
    })
}

/// What is wrong with a text in TOML, with the number of the line.
pub(crate) fn toml_message(text: &str, error: &toml::de::Error) -> String {
    let line = error.span().map(|span| 1 + text[..span.start].matches('\n').count());
    let line = line.map_or(String::new(), |line| format!("line {line}: "));
    format!("{line}{}", error.message())
}

/// Lays `over` on `base`, key by key; `section` and `origin` are for the message.
fn overlay(base: &mut Table, over: Table, section: &str, origin: &str) -> Result<(), SettingsError> {
    for (name, value) in over {
        let key = format!("{section}{}", name.escape_debug());
        match (base.get_mut(&name), value) {
            (Some(Value::Table(base)), Value::Table(over)) => {
                overlay(base, over, &format!("{key}."), origin)?
            }
            // TOML writes 1 for 1.0; a person does too.
            (Some(slot @ Value::Float(_)), Value::Integer(whole)) => *slot = Value::Float(whole as f64),
            (Some(slot), value) if slot.same_type(&value) => *slot = value,
            (Some(slot), value) => {
                return Err(SettingsError::Malformed {
                    origin: origin.to_owned(),
                    message: format!(
                        "`{key}` has type {}, but must have type {}",
                        value.type_str(),
                        slot.type_str()
                    ),
                });
            }
            (None, _) => return Err(SettingsError::Unknown { origin: origin.to_owned(), key }),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
