//! Tell seeds that were used to choose settings from those that are held out.

use serde::Deserialize;

/// The seed of a design; what else it has does not matter here.
#[derive(Deserialize)]
struct Seeded {
    seed: u64,
}

/// Whether neither the search for the default nor the study of its settings has used a master seed.
pub fn is_held_out(seed: u64) -> bool {
    const DESIGNS: [&str; 2] =
        [include_str!("../../reproduce/search.toml"), include_str!("../../reproduce/sensitivity.toml")];
    DESIGNS.into_iter().all(|design| {
        let used: Seeded = toml::from_str(design).expect("the repository's designs have a seed");
        used.seed != seed
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    #[test]
    fn the_experiments_use_a_seed_that_search_and_study_do_not() {
        assert!(is_held_out(Settings::paper().experiment.seed));
        // The seeds of the repository's designs.
        assert!(!is_held_out(1) && !is_held_out(3));
    }
}
