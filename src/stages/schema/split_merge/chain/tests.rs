//! The split–merge sampler against brute force: the exact posterior of partitions and trees of tiny data, and Geweke's
//! (2004) joint-distribution test of whole sweeps. Every test rejects deliberately broken twins.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::*;
use crate::numerics::partition::named_by_appearance;
use crate::numerics::rng::{Stream, stream};
use crate::numerics::testing::{ALPHA, chi_squared};
use crate::stages::schema::joints::collapsed_cost;

const CONCENTRATION: f64 = 1.5;

fn target<'a>(points: &'a Points, prior: &'a NormalInverseWishart, model: Model) -> Target<'a> {
    Target { points, prior, concentration: CONCENTRATION, model, neighbours: Neighbours::of(points) }
}

/// A mistake that a test must find.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mutant {
    None,
    /// A further split or merge, without a mistake.
    Further,
    /// One that is accepted without the probabilities of the divisions.
    NoDivisions,
    /// One whose first end is taken for one drawn evenly from all points.
    NoEnds,
    /// A further move between two and three clusters, without a mistake.
    FurtherOfThree,
    /// One whose ends are taken for points drawn evenly from all.
    NoEndsOfThree,
    /// Gaussians are drawn from their points alone.
    NoJoints,
}

impl Mutant {
    fn sweep(self, chain: &mut SplitMerge, rng: &mut Stream) {
        chain.sweep(rng).unwrap();
        match self {
            Self::None => {}
            Self::Further | Self::NoDivisions | Self::NoEnds => {
                (0..4).for_each(|_| self.step(chain, Move::SplitOrMerge(SplitProposal::Tempered(0.3)), rng));
            }
            Self::FurtherOfThree | Self::NoEndsOfThree => {
                (0..4).for_each(|_| self.step(chain, Move::TwoOrThree(SplitProposal::Tempered(0.3)), rng));
            }
            Self::NoJoints => {
                for cluster in &mut chain.clusters {
                    let posterior = chain.target.prior.posterior(&cluster.statistics).unwrap();
                    cluster.take(posterior.draw(rng));
                }
            }
        }
    }

    /// A move in both directions, whose acceptance ratio may be wrong.
    fn step(self, chain: &mut SplitMerge, proposed: Move, rng: &mut Stream) {
        let Some(mut regrouping) = chain.draw_ends(proposed, rng) else { return };
        if matches!(self, Self::NoEnds | Self::NoEndsOfThree) {
            regrouping.by_cluster = 0;
        }
        let Some(proposal) = chain.propose(&regrouping, rng).unwrap() else { return };
        let divisions = if self == Self::NoDivisions { 0.0 } else { proposal.log_divisions };
        if accepted(proposal.log_ratio + divisions, rng) {
            chain.adopt(proposal);
        }
    }

    /// Whether it leaves the target as it is.
    fn is_right(self) -> bool {
        matches!(self, Self::None | Self::Further | Self::FurtherOfThree)
    }
}

/// All partitions of n points.
fn partitions(n: usize) -> Vec<Vec<usize>> {
    let mut all = vec![vec![0]];
    for _ in 1..n {
        all = all
            .into_iter()
            .flat_map(|labels| {
                let next = labels.iter().max().unwrap() + 1;
                (0..=next).map(move |label| labels.iter().copied().chain([label]).collect())
            })
            .collect();
    }
    all
}

fn clusters(
    points: &Points,
    prior: &NormalInverseWishart,
    labels: &[usize],
    rng: &mut Stream,
) -> Vec<Cluster> {
    let of = |k: usize| (0..labels.len()).filter(|&i| labels[i] == k).collect();
    (0..=*labels.iter().max().unwrap()).map(|k| Cluster::draw(points, prior, of(k), rng).unwrap()).collect()
}

/// log p(x, z) of the mixture without joints, up to a constant.
fn log_mixture(clusters: &[Cluster]) -> f64 {
    let own = |cluster: &Cluster| {
        CONCENTRATION.ln() + libm::lgamma(cluster.members.len() as f64) + cluster.log_marginal
    };
    clusters.iter().map(own).sum()
}

/// p value of a χ² test of visits to states against their probabilities, not normalised.
fn fit<K: Ord + Clone>(exact: &BTreeMap<K, f64>, visits: impl Iterator<Item = K>) -> f64 {
    let mut counts: BTreeMap<K, f64> = exact.keys().map(|key| (key.clone(), 0.0)).collect();
    visits.for_each(|key| *counts.get_mut(&key).expect("a state that can be") += 1.0);
    let total: f64 = exact.values().sum();
    let probabilities: Vec<f64> = exact.values().map(|mass| mass / total).collect();
    chi_squared(&counts.into_values().collect::<Vec<_>>(), &probabilities)
}

fn line(points: &[f64]) -> (Points, NormalInverseWishart) {
    let prior =
        NormalInverseWishart::new(DVector::from_element(1, 0.2), 0.4, DMatrix::from_element(1, 1, 4.0), 8.0);
    (Points::from_rows(1, points.to_vec()), prior.unwrap())
}

/// Every 10th of many sweeps of a chain, by when it has forgotten where it was.
fn visits(chain: &mut SplitMerge, mutant: Mutant, rng: &mut Stream) -> Vec<Vec<usize>> {
    let visit = |_| {
        (0..10).for_each(|_| mutant.sweep(chain, rng));
        named_by_appearance(&chain.labels)
    };
    (0..6_000).map(visit).collect()
}

#[test]
fn the_chain_visits_every_partition_of_six_points_as_often_as_the_posterior_says() {
    let (points, prior) = line(&[-2.0, -1.6, 0.1, 0.3, 1.9, 2.3]);
    let mut rng = stream(5, 1, "partitions", 0);
    let mass = |labels: &Vec<usize>| log_mixture(&clusters(&points, &prior, labels, &mut rng)).exp();
    let exact: BTreeMap<Vec<usize>, f64> = {
        let mut mass = mass;
        partitions(6).into_iter().map(|labels| (labels.clone(), mass(&labels))).collect()
    };
    let target = target(&points, &prior, Model::Dpgmm);
    let moves =
        [Mutant::Further, Mutant::NoDivisions, Mutant::NoEnds, Mutant::FurtherOfThree, Mutant::NoEndsOfThree];
    moves.into_par_iter().chain([Mutant::None]).for_each(|mutant| {
        let mut rng = stream(5, 1, "partitions", 1);
        let mut chain = SplitMerge::start(&target, &[0; 6], &mut rng).unwrap();
        let p_value = fit(&exact, visits(&mut chain, mutant, &mut rng).into_iter());
        assert_eq!(p_value > ALPHA, mutant.is_right(), "{mutant:?}: {p_value}");
    });
}

/// All trees of up to six nodes, edges as (larger, smaller), sorted.
fn trees(nodes: usize) -> Vec<Vec<(usize, usize)>> {
    let pairs: Vec<(usize, usize)> = (0..nodes).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let subsets = (0..1usize << pairs.len()).filter(|set| set.count_ones() as usize + 1 == nodes);
    let edges = |set: usize| -> Vec<(usize, usize)> {
        (0..pairs.len()).filter(|at| set >> at & 1 == 1).map(|at| pairs[at]).collect()
    };
    let connected = |edges: &Vec<(usize, usize)>| {
        let mut part: Vec<usize> = (0..nodes).collect();
        for &(i, j) in edges {
            let (kept, lost) = (part[j], part[i]);
            part.iter_mut().filter(|of| **of == lost).for_each(|of| *of = kept);
        }
        part.iter().all(|of| *of == part[0])
    };
    subsets.map(edges).filter(connected).collect()
}

/// The number of trees over so many nodes (Cayley).
fn cayley(nodes: usize) -> f64 {
    (nodes as f64).powf(nodes as f64 - 2.0)
}

/// A partition with a tree over its clusters, in order of their first points.
type Schema = (Vec<usize>, Vec<(usize, usize)>);

/// Probabilities, not normalised, of all partitions of the points with all trees; Gaussians are integrated out by many
/// draws from their posterior.
fn exact_trees(
    points: &Points,
    prior: &NormalInverseWishart,
    weight: impl Fn(&Gaussian, &Gaussian) -> f64,
) -> BTreeMap<Schema, f64> {
    const DRAWS: usize = 6_000;
    let mut rng = stream(5, 1, "trees", 0);
    let mut exact = BTreeMap::new();
    for labels in partitions(points.count) {
        let clusters = clusters(points, prior, &labels, &mut rng);
        let posteriors: Vec<NormalInverseWishart> =
            clusters.iter().map(|cluster| prior.posterior(&cluster.statistics).unwrap()).collect();
        let trees = trees(clusters.len());
        let mut sums = vec![0.0; trees.len()];
        for _ in 0..DRAWS {
            let gaussians: Vec<Gaussian> =
                posteriors.iter().map(|posterior| posterior.draw(&mut rng)).collect();
            let weights: Vec<Vec<f64>> = (0..gaussians.len())
                .map(|i| (0..i).map(|j| weight(&gaussians[i], &gaussians[j])).collect())
                .collect();
            for (sum, tree) in sums.iter_mut().zip(&trees) {
                *sum += tree.iter().map(|&(i, j)| weights[i][j]).product::<f64>();
            }
        }
        let mixture = log_mixture(&clusters).exp() / cayley(clusters.len());
        for (tree, sum) in trees.into_iter().zip(sums) {
            exact.insert((labels.clone(), tree), mixture * sum / DRAWS as f64);
        }
    }
    exact
}

#[test]
fn the_chain_visits_every_partition_of_six_points_with_every_tree_as_often_as_the_posterior_says() {
    let (points, prior) = line(&[-3.0, -2.5, -1.2, 1.0, 1.6, 3.1]);
    let joint = |s: &Gaussian, c: &Gaussian| (-collapsed_cost(&s.moments(), &c.moments()).unwrap()).exp();
    let one_sided = |s: &Gaussian, c: &Gaussian| s.log_density(c.mean().as_slice()).exp();
    let target = target(&points, &prior, Model::DpgmmLj);
    let visits = |mutant: Mutant| -> Vec<Schema> {
        let mut rng = stream(5, 1, "trees", 1);
        let mut chain = SplitMerge::start(&target, &[0; 6], &mut rng).unwrap();
        let visit = |_| {
            (0..10).for_each(|_| mutant.sweep(&mut chain, &mut rng));
            let labels = named_by_appearance(&chain.labels);
            let name = |k: usize| labels[chain.clusters[k].members[0]];
            let edges = chain.edges(&mut rng).unwrap();
            let pair = |edge: &Edge| {
                let (i, j) = (name(edge.child), name(edge.parent));
                (i.max(j), i.min(j))
            };
            let mut tree: Vec<(usize, usize)> = edges.iter().map(pair).collect();
            // In the order of `trees`.
            tree.sort_unstable();
            (labels, tree)
        };
        (0..6_000).map(visit).collect()
    };
    let (exact, (forgotten, (right, wrong))) = rayon::join(
        || exact_trees(&points, &prior, joint),
        || {
            rayon::join(
                || exact_trees(&points, &prior, one_sided),
                || rayon::join(|| visits(Mutant::None), || visits(Mutant::NoJoints)),
            )
        },
    );
    let p_value = |target: &BTreeMap<Schema, f64>, visits: &[Schema]| fit(target, visits.iter().cloned());
    let right_p = p_value(&exact, &right);
    assert!(right_p > ALPHA, "{right_p}");
    // Each in turn has a mistake: the chain; the target, without the prior of trees; and the target, with the weight of a parent whose
    // covariance is forgotten.
    let without_prior =
        exact.iter().map(|(schema, mass)| (schema.clone(), mass * cayley(schema.1.len() + 1)));
    let wrong_p =
        [p_value(&exact, &wrong), p_value(&without_prior.collect(), &right), p_value(&forgotten, &right)];
    assert!(wrong_p.iter().all(|p_value| *p_value < ALPHA), "{wrong_p:?}");
}

mod joint_distribution;

/// Four clusters in a row, so that the tree over their means is the row itself.
#[test]
fn without_joints_the_tree_is_that_of_the_means() {
    let place = |i: usize| (5 * (i / 6)) as f64 + 0.01 * (i % 6) as f64;
    let (points, prior) = line(&(0..24).map(place).collect::<Vec<f64>>());
    let labels: Vec<usize> = (0..24).map(|i| i / 6).collect();
    let rng = &mut stream(1, 1, "tree of means", 0);
    let target = target(&points, &prior, Model::Dpgmm);
    let chain = SplitMerge::start(&target, &labels, rng).unwrap();
    let mut edges: Vec<(usize, usize)> = chain
        .edges(rng)
        .unwrap()
        .iter()
        .map(|edge| (edge.child.min(edge.parent), edge.child.max(edge.parent)))
        .collect();
    edges.sort_unstable();
    assert_eq!(edges, [(0, 1), (1, 2), (2, 3)]);
}
