//! Sample specifications evenly from all combinations of reasonable values.
//!
//! Options come from an Owen-scrambled Sobol sequence (Burley 2020, "Practical hash-based Owen scrambling"), whose first 2^k
//! points cover the values of each factor, and the pairs of any two, more evenly than independent draws would.

use std::collections::HashSet;

use sobol_burley::sample;

use super::super::draws::{Draws, Level};
use super::design::{Design, Factor};

/// A reading of the paper: an option of each factor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawn {
    /// Its number, from 1.
    pub number: usize,
    /// The movement that it shares with others, from 1.
    pub movement: usize,
    /// The matrix of distances that it shares with others, from 1.
    pub distances: usize,
    /// The body maps that it shares with others, from 1.
    pub maps: usize,
    /// The option of each factor of the design.
    pub options: Vec<usize>,
}

/// All specifications of a design, those that share a movement next to each other, no two alike.
pub fn specifications(design: &Design) -> Vec<Drawn> {
    let Draws { movements, distances, maps, inferences } = design.draws;
    let mut all: Vec<Drawn> = Vec::new();
    let mut known = HashSet::new();
    for movement in 0..movements {
        for distance in 0..distances {
            let felt = movement * distances + distance;
            for mapped in felt * maps..(felt + 1) * maps {
                for inferred in mapped * inferences..(mapped + 1) * inferences {
                    let options = options(design, [movement, felt, mapped, inferred]);
                    if known.insert((movement, options.clone())) {
                        all.push(Drawn {
                            number: all.len() + 1,
                            movement: movement + 1,
                            distances: felt + 1,
                            maps: mapped + 1,
                            options,
                        });
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
        let place = match factor.decides {
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
