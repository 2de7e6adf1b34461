//! Draw configurations evenly from all combinations of options, nested: many share a movement, of these some the distances,
//! and of these some the body maps.
//!
//! Options come from an Owen-scrambled Sobol sequence (Burley 2020, "Practical hash-based Owen scrambling"), whose first 2^k
//! points cover the options of each factor, and the pairs of any two, more evenly than independent draws would.

use std::collections::HashSet;

use sobol_burley::sample;

use super::design::{Design, Factor};
use super::levels::{DrawCounts, Level, SharedStages};

/// A drawn configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Drawn {
    /// What it shares.
    pub places: SharedStages,
    /// The option of each factor of the design.
    pub options: Vec<usize>,
}

/// All drawn configurations, those that share a movement next to each other, no two alike.
pub(super) fn drawn(design: &Design, draws: DrawCounts) -> Vec<Drawn> {
    let DrawCounts { movements, distances, maps, inferences } = draws;
    let mut all: Vec<Drawn> = Vec::new();
    let mut known = HashSet::new();
    for movement in 0..movements {
        for distance in movement * distances..(movement + 1) * distances {
            for map in distance * maps..(distance + 1) * maps {
                for inference in map * inferences..(map + 1) * inferences {
                    let options = options(design, [movement, distance, map, inference]);
                    if known.insert((movement, options.clone())) {
                        let places =
                            SharedStages { movement: movement + 1, distances: distance + 1, maps: map + 1 };
                        all.push(Drawn { places, options });
                    }
                }
            }
        }
    }
    all
}

/// The option of each factor, given the places in the sequences of movements, distances, maps and inferences.
fn options(design: &Design, places: [usize; 4]) -> Vec<usize> {
    let option = |(dimension, factor): (usize, &Factor)| {
        let place = match factor.level.unwrap_or(Level::Inference) {
            Level::Movement => places[0],
            Level::Distances => places[1],
            Level::Map => places[2],
            Level::Inference => places[3],
        };
        // The design was checked: sequences have 2^16 points and 2^8 dimensions.
        let uniform = sample(place as u32, dimension as u32, design.seed as u32);
        ((f64::from(uniform) * factor.options.len() as f64) as usize).min(factor.options.len() - 1)
    };
    design.factors.iter().enumerate().map(option).collect()
}
