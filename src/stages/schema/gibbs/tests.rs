//! The sampler against brute force: each conditional, the exact posterior of tiny data, and Geweke's
//! (2004) joint-distribution test with the tree held fixed. Every test rejects deliberately broken twins.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::super::joints;
use super::super::latent_tree::Joint;
use super::super::settings::{EdgeWeight, Keep, Prior, Sampler};
use super::*;
use crate::numerics::rng::{Stream, stream};
use crate::numerics::testing::{ALPHA, chi_squared};

fn settings(components: usize) -> Schema {
    Schema {
        sampler: Sampler::Equations,
        components,
        concentration: 1.5,
        mean_weight: 0.01,
        extra_freedom: 2.0,
        prior: Prior::FraleyRaftery,
        scale: 1.0,
        edge_weight: EdgeWeight::Collapsed,
        start: Start::Uniform,
        sweeps: 1000,
        chains: 100,
        keep: Keep::Last,
        burn_in: 500,
        authors: Departures::NONE,
    }
}

fn start<'a>(
    points: &'a Points,
    prior: &'a NormalInverseWishart,
    settings: &'a Schema,
    rng: &mut Stream,
) -> Chain<'a> {
    Chain::start(points, prior, settings, Model::Dpgmm, rng).unwrap()
}

#[test]
fn a_chain_starts_from_labels_of_the_named_kind() {
    // Three far clusters of 20 points.
    let mut rng = stream(2, 1, "far clusters", 0);
    let coordinates = (0..60).map(|i| f64::from(i % 3 * 100) + rng.random_range(-1.0..1.0)).collect();
    let points = Points::from_rows(1, coordinates);
    let prior = NormalInverseWishart::new(DVector::zeros(1), 0.5, DMatrix::identity(1, 1), 3.0).unwrap();
    let first = |start_with, components, chain| {
        let settings = Schema { start: start_with, ..settings(components) };
        start(&points, &prior, &settings, &mut stream(2, 1, "start", chain)).labels
    };
    let mut uniform = stream(2, 1, "start", 0);
    let expected: Vec<usize> = (0..60).map(|_| uniform.random_range(0..5)).collect();
    assert_eq!(first(Start::Uniform, 5, 0), expected);
    assert_eq!(first(Start::Single, 5, 0), [0; 60]);
    for chain in 0..5 {
        let found = first(Start::KMeans, 3, chain);
        assert!((0..60).all(|i| (found[i] == found[0]) == (i % 3 == 0) && found[i] == found[i % 3]));
    }
    assert_ne!(first(Start::KMeans, 5, 0), first(Start::KMeans, 5, 1), "each chain draws a start of its own");
}

/// What a broken twin does after a correct step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mutant {
    None,
    WrongFreedom,
    MissingJoint,
    SwappedIndex,
    SwappedPoints,
    UnnormalisedWeight,
}

impl Mutant {
    /// The correct draw of labels, or one that lacks the Gaussians' normalising constants, or one that
    /// confuses two components, or two points that are far apart.
    fn draw_labels(self, chain: &mut Chain, rng: &mut Stream) {
        if self == Self::UnnormalisedWeight {
            let kept = chain.gaussians.clone();
            chain.gaussians.iter_mut().for_each(|gaussian| gaussian.log_peak = 0.0);
            chain.draw_labels(rng);
            chain.gaussians = kept;
        } else {
            chain.draw_labels(rng);
        }
        if self == Self::SwappedIndex {
            chain.labels.iter_mut().filter(|label| **label < 2).for_each(|label| *label = 1 - *label);
        }
        if self == Self::SwappedPoints {
            let last = chain.labels.len() - 1;
            chain.labels.swap(0, last);
        }
    }
}

mod conditionals;
mod exact_posterior;
mod joint_distribution;
