//! Tell seeds that were used to choose settings from those that are held out.

use serde::Deserialize;

use super::design::{PARTS_IN_FLUID, SEARCH, SENSITIVITY};

/// The seed of a design; what else it has does not matter here.
#[derive(Deserialize)]
struct Seeded {
    seed: u64,
}

/// Seeds by which settings were chosen before: that of the first search, and that of the movements which the second one
/// tries.
const FORMER: [u64; 2] = [1, 4];

/// Whether neither a search for the default nor the study of its settings has used a master seed.
pub fn is_held_out(seed: u64) -> bool {
    !used().contains(&seed) && !FORMER.contains(&seed)
}

/// The seeds of the search, of its last parts and of the study.
fn used() -> Vec<u64> {
    let seed = |design: &str| {
        let Seeded { seed } = toml::from_str(design).expect("the repository's designs have a seed");
        seed
    };
    [SEARCH, SENSITIVITY].into_iter().chain(PARTS_IN_FLUID).map(seed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    #[test]
    fn the_experiments_use_a_seed_that_search_and_study_do_not() {
        assert!(is_held_out(Settings::paper().experiment.seed));
        assert!(used().iter().all(|seed| !is_held_out(*seed)));
        assert!(FORMER.iter().all(|seed| !is_held_out(*seed) && !used().contains(seed)));
    }
}
