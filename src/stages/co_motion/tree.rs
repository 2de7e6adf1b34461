//! Find the tree over given parts that the speeds of joints agree with best, and how sure each edge is.

use nalgebra::DMatrix;
use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::joint_speed::Moments;
use super::motion::{Motion, is_signed, motion, whole_motion};
use crate::numerics::partition::sizes;
use crate::stages::sense::Tactile;
use crate::stages::tree::{Edge, prim};

/// Blocks of times that are drawn with replacement, and the fewest times of a block: longer than a movement lasts.
const BLOCKS: usize = 50;
const BLOCK_SAMPLES: usize = 100;
/// Resampled trees.
const RESAMPLES: usize = 400;

/// A pair of parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Label of one part.
    pub part: usize,
    /// Label of the other, which is larger.
    pub other: usize,
    /// How well both know the same speed: see [`correlations`](super::correlations).
    pub agreement: f64,
    /// Share of resampled trees that join them.
    pub confidence: f64,
    /// Whether the tree joins them.
    pub in_tree: bool,
}

/// A tree over parts from what they feel of their joints.
#[derive(Debug, Clone, PartialEq)]
pub struct CoMotion {
    /// Labels of the parts, rising, and the components of the motion that each feels.
    pub parts: Vec<(usize, usize)>,
    /// The tree between labels.
    pub tree: Vec<Edge>,
    /// All pairs of parts.
    pub pairs: Vec<Pair>,
}

impl CoMotion {
    /// The confidence of an edge of the tree.
    pub fn confidence(&self, edge: &Edge) -> f64 {
        let (a, b) = (edge.child.min(edge.parent), edge.child.max(edge.parent));
        let pair = self.pairs.iter().find(|pair| (pair.part, pair.other) == (a, b));
        pair.map_or(0.0, |pair| pair.confidence)
    }
}

/// The tree over the parts of a body, from the pressures on its sensors.
///
/// In: M × T pressures, of any sign, and the part of each sensor that has one, any numbers. `components` is k of every part; without
/// it, the data choose it. Out: the tree, and for each pair of parts the share of trees over blocks of times drawn with
/// replacement that join it.
pub fn co_motion(
    tactile: &Tactile,
    labels: &[Option<usize>],
    components: Option<usize>,
    rng: &mut impl Rng,
) -> CoMotion {
    let (parts, motions) = parts_and_motions(tactile, labels, components);
    joined(&parts, &motions, tactile.samples, rng)
}

/// The tree of [`co_motion`] without its confidences, which take longest of a short recording.
pub fn co_motion_tree(tactile: &Tactile, labels: &[Option<usize>]) -> Vec<Edge> {
    let (parts, motions) = parts_and_motions(tactile, labels, None);
    let moments = Moments::new(&motions, tactile.samples, blocks(tactile.samples));
    named(&spanning(&moments.of_all()), &parts)
}

/// The labels of the parts, rising, and what each feels of its motion.
fn parts_and_motions(
    tactile: &Tactile,
    labels: &[Option<usize>],
    components: Option<usize>,
) -> (Vec<usize>, Vec<Motion>) {
    assert_eq!(labels.len(), tactile.sensors(), "a part for each sensor");
    let signed = is_signed(tactile);
    let known: Vec<usize> = labels.iter().copied().flatten().collect();
    let parts: Vec<usize> = sizes(&known).into_keys().collect();
    let series = |part: usize| -> Vec<&[f32]> {
        let own = tactile.series().zip(labels).filter(|(_, label)| **label == Some(part));
        own.map(|(series, _)| series).collect()
    };
    let own = |part: usize| match components {
        None => whole_motion(&series(part), signed),
        given => motion(&series(part), given, signed),
    };
    let motions = parts.iter().map(|&part| own(part)).collect();
    (parts, motions)
}

/// Blocks of so many times.
fn blocks(samples: usize) -> usize {
    (samples / BLOCK_SAMPLES).clamp(2, BLOCKS)
}

/// A tree over places in a list, over what is there.
fn named(tree: &[Edge], parts: &[usize]) -> Vec<Edge> {
    tree.iter().map(|edge| Edge { child: parts[edge.child], parent: parts[edge.parent] }).collect()
}

/// The tree over parts with these labels, rising, from their motions at the same times.
pub fn joined(parts: &[usize], motions: &[Motion], samples: usize, rng: &mut impl Rng) -> CoMotion {
    let moments = Moments::new(motions, samples, blocks(samples));
    let agreement = moments.of_all();
    let tree = spanning(&agreement);
    let mut joined = DMatrix::<usize>::zeros(parts.len(), parts.len());
    for edge in resampled(&moments, rng).iter().flatten() {
        joined[(edge.child.min(edge.parent), edge.child.max(edge.parent))] += 1;
    }
    let pairs = (0..parts.len()).flat_map(|a| (a + 1..parts.len()).map(move |b| (a, b)));
    let is_edge =
        |a: usize, b: usize| tree.iter().any(|edge| [(a, b), (b, a)].contains(&(edge.child, edge.parent)));
    // An edge of two parts that know nothing of each other is in a tree by its place in the list alone.
    let confidence = |a: usize, b: usize| {
        if agreement[(a, b)] > 0.0 { joined[(a, b)] as f64 / RESAMPLES as f64 } else { 0.0 }
    };
    let pair = |(a, b): (usize, usize)| Pair {
        part: parts[a],
        other: parts[b],
        agreement: agreement[(a, b)],
        confidence: confidence(a, b),
        in_tree: is_edge(a, b),
    };
    CoMotion {
        pairs: pairs.map(pair).collect(),
        tree: named(&tree, parts),
        parts: parts.iter().zip(motions).map(|(&part, motion)| (part, motion.components)).collect(),
    }
}

/// The tree of greatest agreement.
pub fn spanning(agreement: &DMatrix<f64>) -> Vec<Edge> {
    let nodes: Vec<usize> = (0..agreement.nrows()).collect();
    prim(&nodes, |child, parent| -agreement[(child, parent)])
}

/// Trees over blocks drawn with replacement.
fn resampled(moments: &Moments, rng: &mut impl Rng) -> Vec<Vec<Edge>> {
    let blocks = moments.blocks();
    let mut draw = || {
        let mut counts = vec![0; blocks];
        (0..blocks).for_each(|_| counts[rng.random_range(0..blocks)] += 1);
        counts
    };
    let counts: Vec<Vec<usize>> = (0..RESAMPLES).map(|_| draw()).collect();
    counts.par_iter().map(|counts| spanning(&moments.correlations(&moments.sum(counts)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rng::stream;
    use crate::stages::agent::{Agent, Morphology, Skin};
    use crate::stages::sense::{Sense, sense};
    use crate::stages::simulate::fixtures::{INTERVAL, Scene};
    use crate::stages::simulate::simulate;

    fn felt(morphology: Morphology, coordination: f64) -> (Agent, Tactile) {
        let mut scene = Scene::new();
        scene.geometry.morphology = morphology;
        (scene.geometry.part_length, scene.geometry.part_radius, scene.geometry.gap) = (0.5, 0.03, 0.1);
        (scene.motion.stiffness, scene.motion.damping) = (0.47, 0.05);
        (scene.motion.coordination, scene.physics.duration) = (coordination, 1000.0);
        let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 3, caps: 0 });
        let rng = &mut stream(3, 1, "motion", 0);
        let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
        let tactile =
            sense(&agent, &trajectory, &Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 });
        (agent, tactile)
    }

    fn known(agent: &Agent) -> Vec<Option<usize>> {
        agent.labels().into_iter().map(Some).collect()
    }

    fn undirected(mut edges: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
        edges.iter_mut().for_each(|edge| *edge = (edge.0.min(edge.1), edge.0.max(edge.1)));
        edges.sort_unstable();
        edges
    }

    fn edges(found: &CoMotion) -> Vec<(usize, usize)> {
        undirected(found.tree.iter().map(|edge| (edge.child, edge.parent)).collect())
    }

    #[test]
    fn the_tree_is_found_with_joints_that_are_locked_and_that_never_are() {
        for (morphology, coordination) in
            [(Morphology::Chain, 0.0), (Morphology::Chain, 0.9), (Morphology::Tee, 0.5)]
        {
            let (agent, tactile) = felt(morphology, coordination);
            let found = co_motion(&tactile, &known(&agent), None, &mut stream(1, 1, "co-motion", 0));
            assert_eq!(
                edges(&found),
                undirected(agent.tree()),
                "{morphology:?}, p = {coordination}: {found:?}"
            );
            let sum: f64 = found.pairs.iter().map(|pair| pair.confidence).sum();
            assert!((sum - 4.0).abs() < 1e-9, "every resampled tree has four edges");
            assert!(found.tree.iter().all(|edge| found.confidence(edge) > 0.5));
            assert_eq!(co_motion_tree(&tactile, &known(&agent)), found.tree);
            assert!(found.parts.iter().all(|(_, components)| (3..=5).contains(components)));
        }
    }

    #[test]
    fn only_what_happens_at_the_same_time_tells_the_tree() {
        let (agent, mut tactile) = felt(Morphology::Chain, 0.5);
        let agreement = |tactile: &Tactile| {
            let found = co_motion(tactile, &known(&agent), None, &mut stream(1, 1, "co-motion", 0));
            found.pairs.iter().find(|pair| (pair.part, pair.other) == (0, 1)).unwrap().agreement
        };
        let before = agreement(&tactile);
        let own = tactile.samples * agent.labels().iter().filter(|part| **part == 0).count();
        // The first part feels everything by half of the time later.
        tactile.pressures[..own].chunks_mut(tactile.samples).for_each(|series| series.rotate_right(5000));
        assert!(agreement(&tactile) < before - 0.1, "{} {before}", agreement(&tactile));
    }

    #[test]
    fn the_number_of_threads_changes_no_bit() {
        let (agent, tactile) = felt(Morphology::Chain, 0.5);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| co_motion(&tactile, &known(&agent), None, &mut stream(1, 1, "co-motion", 0)))
        };
        assert_eq!(on(1), on(3));
    }
}
