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
    pub shared_stages: SharedStages,
    /// The option of each factor of the design; `None` where options of later factors override all that it says.
    pub options: Vec<Option<usize>>,
}

/// All drawn configurations, those that share a movement next to each other, no two alike.
pub(super) fn drawn(design: &Design, draws: DrawCounts) -> Vec<Drawn> {
    let DrawCounts { movements, distances, maps, inferences, .. } = draws;
    let mut all: Vec<Drawn> = Vec::new();
    let mut known = HashSet::new();
    let kept: Vec<Option<usize>> = design.factors.iter().map(|factor| factor.of_base(design)).collect();
    let evaluations = evaluations(design);
    for movement in 0..movements {
        for distance in movement * distances..(movement + 1) * distances {
            for map in distance * maps..(distance + 1) * maps {
                for inference in map * inferences..(map + 1) * inferences {
                    let inferred = options(design, &kept, [movement, distance, map, inference]);
                    for judged in &evaluations {
                        let all_options =
                            inferred.iter().zip(judged).map(|(drawn, judged)| judged.unwrap_or(*drawn));
                        let options = effective(design, &all_options.collect::<Vec<_>>());
                        if known.insert((movement, options.clone())) {
                            let [movement, distances, maps] = [movement, distance, map].map(|at| at + 1);
                            let shared_stages = SharedStages { movement, distances, maps };
                            all.push(Drawn { shared_stages, options });
                        }
                    }
                }
            }
        }
    }
    all
}

/// All combinations of options of the factors that decide the evaluation; `None` for the others.
fn evaluations(design: &Design) -> Vec<Vec<Option<usize>>> {
    let mut all = vec![vec![None; design.factors.len()]];
    for (at, factor) in design.factors.iter().enumerate() {
        if factor.level == Some(Level::Evaluation) {
            let each = |one: &Vec<Option<usize>>| {
                let with = |option| [&one[..at], &[Some(option)], &one[at + 1..]].concat();
                (0..factor.options.len()).map(with).collect::<Vec<_>>()
            };
            all = all.iter().flat_map(each).collect();
        }
    }
    all
}

/// The option of each factor, given the numbers in the sequences of movements, distances, maps and inferences.
fn options(design: &Design, kept: &[Option<usize>], numbers: [usize; 4]) -> Vec<usize> {
    let keep = design.draws.and_then(|draws| draws.keep).unwrap_or(0.0);
    let option = |(dimension, factor): (usize, &Factor)| {
        let place = match factor.level.unwrap_or(Level::Inference) {
            Level::Movement => numbers[0],
            Level::Distances => numbers[1],
            Level::Map => numbers[2],
            Level::Inference | Level::Evaluation => numbers[3],
        };
        // The design was checked: sequences have 2^16 points and 2^8 dimensions.
        let uniform = f64::from(sample(place as u32, dimension as u32, design.seed as u32));
        match kept[dimension] {
            Some(kept) if uniform < keep => kept,
            Some(_) => factor.at((uniform - keep) / (1.0 - keep)),
            None => factor.at(uniform),
        }
    };
    design.factors.iter().enumerate().map(option).collect()
}

/// The options that say something: without those all of whose settings options of later factors set, too.
fn effective(design: &Design, options: &[usize]) -> Vec<Option<usize>> {
    let mut set: HashSet<String> = HashSet::new();
    let mut all = vec![None; options.len()];
    for (at, (factor, &option)) in design.factors.iter().zip(options).enumerate().rev() {
        let own = factor.options[option].keys();
        let is_overridden = !own.is_empty() && own.iter().all(|key| set.contains(key));
        all[at] = (!is_overridden).then_some(option);
        set.extend(own);
    }
    all
}
