//! Derive an independent stream of random numbers from the master seed, the simulation, the stage and the chain.
//!
//! A stream depends on nothing else, so neither the number of threads nor the order of work changes a
//! result, and a stage run by hand repeats what an experiment did in its first simulation.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use sha2::{Digest, Sha256};

/// The generator of every stage: xoshiro256++, whose output is fixed across versions of `rand`.
pub type Stream = Xoshiro256PlusPlus;

/// The stream of one chain of one stage of one simulation. Simulations and chains count from 1 and 0.
///
/// The 256-bit state is the SHA-256 of the four values, so that streams of neighbouring seeds share
/// nothing.
pub fn stream(master_seed: u64, simulation: usize, stage: &str, chain: usize) -> Stream {
    let mut hash = Sha256::new();
    hash.update(master_seed.to_le_bytes());
    hash.update((simulation as u64).to_le_bytes());
    hash.update((chain as u64).to_le_bytes());
    hash.update(stage);
    Stream::from_seed(hash.finalize().into())
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;

    #[test]
    fn each_of_the_four_values_changes_the_stream() {
        let first = |seed, simulation, stage, chain| stream(seed, simulation, stage, chain).next_u64();
        let reference = first(1, 1, "motion", 0);
        assert_eq!(reference, first(1, 1, "motion", 0));
        for other in [
            first(2, 1, "motion", 0),
            first(1, 2, "motion", 0),
            first(1, 1, "sense", 0),
            first(1, 1, "motion", 1),
        ] {
            assert_ne!(reference, other);
        }
    }
}
