//! Choose the other reading of the paper, whose headline stands beside that of the run.

use crate::settings::{Settings, SettingsError};
use crate::stages::schema::Sampler;

/// `reproduce/authors.toml`.
const AUTHORS: &str = include_str!("../../../reproduce/authors.toml");

/// `reproduce/equations.toml`.
const EQUATIONS: &str = include_str!("../../../reproduce/equations.toml");

/// The same body and movement, mapped and inferred from as the authors' code computes if `settings` follow the equations,
/// and as the equations say if they do not.
///
/// # Errors
/// If the other reading cannot be combined with these settings.
pub fn other_reading(settings: &Settings) -> Result<Settings, SettingsError> {
    match settings.schema.sampler {
        Sampler::Equations => settings.with(AUTHORS, "reproduce/authors.toml"),
        Sampler::AuthorsCode => settings.with(EQUATIONS, "reproduce/equations.toml"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reading_has_the_other() {
        let equations = Settings::paper().with(EQUATIONS, "equations").unwrap();
        let authors = other_reading(&equations).unwrap();
        assert_eq!(authors.schema.sampler, Sampler::AuthorsCode);
        assert_eq!(other_reading(&authors).unwrap(), equations);
        assert_eq!((&authors.agent, &authors.motion), (&equations.agent, &equations.motion));
    }
}
