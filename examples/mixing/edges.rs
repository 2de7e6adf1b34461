//! Bodies drawn from the model itself: whether an edge that has the probability 0.8 is there four times of five.

use std::error::Error;
use std::path::Path;

use bodyschema::files::tables::write_rows;
use bodyschema::internals::Posterior;
use bodyschema::internals::markdown::{row, rule};
use bodyschema::internals::sampler::{self, WeightedGraph, draw_between};
use bodyschema::internals::statistics::mean;
use bodyschema::numerics::rng::{Stream, stream};
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::evaluate::adjusted_rand_index;
use bodyschema::stages::mixture::{Gaussian, NormalInverseWishart, Rounding, SufficientStatistics};
use bodyschema::stages::schema::{Model, Prior, Schema, TreePosterior, infer, tree_over};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::{picture, split_merge};

const SEED: u64 = 8_000_000;
const BODIES: usize = 400;
const PARTS: usize = 5;
/// Sensors of a part.
const SENSORS: usize = 60;
const DIMENSIONS: [usize; 3] = [3, 6, 12];
/// Sweeps of the prior before a body is taken from it.
const SWEEPS: usize = 300;
/// Bins of the probability of an edge.
const BINS: usize = 10;
/// The least adjusted Rand index at which estimated parts stand for the true ones.
const SAME_PARTS: f64 = 0.9;

/// What is known of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
enum Parts {
    /// They are given.
    Given,
    /// They are the consensus of the sampler.
    Found,
}

/// A pair of parts of a body.
#[derive(serde::Serialize)]
struct Pair {
    dimension: usize,
    parts: Parts,
    body: usize,
    part: usize,
    other: usize,
    /// The probability of an edge between them.
    probability: f64,
    /// Whether the likeliest tree has it, and the probability of that tree.
    in_tree: bool,
    tree_probability: f64,
    /// Whether it is there.
    there: bool,
}

/// Runs the study, writes its table and its picture, and returns its section of the page.
pub(crate) fn study(folder: &Path) -> Result<String, Box<dyn Error>> {
    let mut lines = vec![
        "## Bodies drawn from the model\n".to_owned(),
        format!(
            "{BODIES} bodies for each d, of {PARTS} parts with {SENSORS} sensors each (seed {SEED}), whose Gaussians, tree and \
             joints are drawn from the model. The tree is inferred with the same prior, over the true parts and over the parts \
             that the sampler finds. The latter count where they are the true ones (as many, ARI from {SAME_PARTS}). Brier \
             score: the mean of (probability − what is there)² over all pairs of parts. That of a single tree takes its edges \
             for certain. Intervals are over bodies. [All pairs](edges.csv).\n"
        ),
        row([
            "d",
            "parts",
            "bodies",
            "Brier score",
            "of the likeliest tree alone",
            "difference",
            "tree right",
            "its mean probability",
        ]),
        rule(8),
    ];
    let mut pairs = Vec::new();
    for dimension in DIMENSIONS {
        let bodies: Result<Vec<Vec<Pair>>, String> = (0..BODIES)
            .into_par_iter()
            .map(|at| body(dimension, at).map_err(|error| error.to_string()))
            .collect();
        let bodies: Vec<Pair> = bodies?.into_iter().flatten().collect();
        for parts in [Parts::Given, Parts::Found] {
            let own: Vec<&Pair> = bodies.iter().filter(|pair| pair.parts == parts).collect();
            lines.push(summary(dimension, parts, &own));
        }
        pairs.extend(bodies);
        eprintln!("mixing: bodies drawn from the model, d = {dimension}, done");
    }
    write_rows(&folder.join("edges.csv"), &pairs)?;
    let panels: Vec<(String, Vec<picture::Bin>)> = [Parts::Given, Parts::Found]
        .into_iter()
        .map(|parts| {
            let name = if parts == Parts::Given { "true parts" } else { "parts found" };
            (name.to_owned(), bins(pairs.iter().filter(|pair| pair.parts == parts)))
        })
        .collect();
    picture::reliability(&folder.join("figures/edges.svg"), &panels)?;
    lines.push("\n![How often an edge is there, against its probability](figures/edges.svg)\n".to_owned());
    lines.push(
        "Each point: the pairs of all d whose probability lies in a tenth, with the interval over bodies; none of a single body.\n"
            .to_owned(),
    );
    Ok(lines.join("\n"))
}

/// A body from the prior of the model with five parts: NIW(0, k₀, I, ν₀) for each, a tree, and a joint for each edge.
struct Drawn {
    map: BodyMap,
    labels: Vec<usize>,
    tree: Vec<(usize, usize)>,
}

fn settings() -> Schema {
    Schema { prior: Prior::Identity, scale: 1.0, chains: 3, sweeps: 120, burn_in: 60, ..split_merge() }
}

fn draw_body(dims: usize, rng: &mut Stream) -> Result<Drawn, Rounding> {
    let schema = settings();
    let freedom = dims as f64 + schema.extra_freedom;
    let prior = NormalInverseWishart::new(
        DVector::zeros(dims),
        schema.mean_weight,
        DMatrix::identity(dims, dims),
        freedom,
    )
    .ok_or(Rounding)?;
    let mut gaussians: Vec<Gaussian> = (0..PARTS).map(|_| prior.draw(rng)).collect();
    // Gibbs sweeps over the tree, the joints and the Gaussians, which no data ties down.
    for _ in 0..SWEEPS {
        let mut data = vec![SufficientStatistics::new(dims); PARTS];
        for (i, j) in graph(&gaussians)?.draw_tree(rng) {
            let joint = draw_between(&gaussians[i].information(), &gaussians[j].information(), rng)?;
            data[i].add(joint.as_slice());
            data[j].add(joint.as_slice());
        }
        gaussians =
            data.iter().map(|data| Ok(prior.posterior(data)?.draw(rng))).collect::<Result<_, Rounding>>()?;
    }
    let tree = graph(&gaussians)?.draw_tree(rng);
    let labels: Vec<usize> = (0..PARTS * SENSORS).map(|i| i / SENSORS).collect();
    let coordinates = labels.iter().flat_map(|&part| gaussians[part].draw(rng).as_slice().to_vec()).collect();
    Ok(Drawn { map: BodyMap { dims, coordinates }, labels, tree })
}

/// The weights of all trees over some Gaussians.
pub(crate) fn graph(gaussians: &[Gaussian]) -> Result<WeightedGraph, Rounding> {
    let moments: Vec<_> = gaussians.iter().map(Gaussian::moments).collect();
    sampler::graph(&moments.iter().collect::<Vec<_>>())
}

/// The pairs of parts of a body, with the true parts and, if they are found, with those that are found.
fn body(dimension: usize, at: usize) -> Result<Vec<Pair>, Box<dyn Error>> {
    let drawn = draw_body(dimension, &mut stream(SEED, at, &format!("body {dimension}"), 0))?;
    let schema = settings();
    let given = tree_over(&drawn.map, &drawn.labels, &schema, SEED, at)?;
    let mut pairs = pairs(&drawn, dimension, at, Parts::Given, &given, &[0, 1, 2, 3, 4]);
    let draws = infer(&drawn.map, Model::DpgmmLj, &schema, SEED, at, &|| ())?;
    let posterior = Posterior::of(&drawn.map, Model::DpgmmLj, &draws, &schema, SEED, at)?;
    let labels = &posterior.consensus.labels;
    if let (Some(names), Some(tree)) = (names(labels, &drawn.labels), &posterior.tree) {
        pairs.extend(self::pairs(&drawn, dimension, at, Parts::Found, tree, &names));
    }
    Ok(pairs)
}

/// The true part that each estimated one stands for; `None` if they are not the same.
fn names(found: &[usize], truth: &[usize]) -> Option<Vec<usize>> {
    let parts = found.iter().max()? + 1;
    let name = |part: usize| {
        let shared = |other: usize| found.iter().zip(truth).filter(|pair| *pair == (&part, &other)).count();
        (0..PARTS).max_by_key(|&other| shared(other))
    };
    (parts == PARTS && adjusted_rand_index(found, truth) >= SAME_PARTS)
        .then(|| (0..parts).map(name).collect())?
}

fn pairs(
    drawn: &Drawn,
    dimension: usize,
    body: usize,
    parts: Parts,
    tree: &TreePosterior,
    names: &[usize],
) -> Vec<Pair> {
    let edge = |a: usize, b: usize| drawn.tree.contains(&(a, b)) || drawn.tree.contains(&(b, a));
    let pair = |&(part, other, probability): &(usize, usize, f64)| Pair {
        dimension,
        parts,
        body,
        part,
        other,
        probability,
        in_tree: tree.tree.contains(&(part, other)),
        tree_probability: tree.probability,
        there: edge(names[part], names[other]),
    };
    tree.edges.iter().map(pair).collect()
}

/// The sum of a number of each pair, for each body.
fn of_bodies(pairs: &[&Pair], number: impl Fn(&Pair) -> f64) -> Vec<f64> {
    let sum = |own: &[&Pair]| own.iter().map(|pair| number(pair)).sum();
    pairs.chunk_by(|a, b| a.body == b.body && a.dimension == b.dimension).map(sum).collect()
}

fn summary(dimension: usize, parts: Parts, pairs: &[&Pair]) -> String {
    let all = (PARTS * (PARTS - 1) / 2) as f64;
    let square = |expected: f64, pair: &Pair| (expected - f64::from(u8::from(pair.there))).powi(2) / all;
    let brier = of_bodies(pairs, |pair| square(pair.probability, pair));
    let single = of_bodies(pairs, |pair| square(f64::from(u8::from(pair.in_tree)), pair));
    let difference: Vec<f64> = brier.iter().zip(&single).map(|(a, b)| a - b).collect();
    let right: Vec<f64> = single.iter().map(|score| f64::from(u8::from(*score == 0.0))).collect();
    let expected = of_bodies(pairs, |pair| pair.tree_probability / all);
    let cell = |values: &[f64], digits: usize| {
        let estimate = mean(values);
        let value = estimate.value.map(|value| format!("{value:.digits$}"));
        let ends = estimate.interval.map(|(low, high)| format!(" ({low:.digits$} to {high:.digits$})"));
        value.map_or("–".to_owned(), |value| value + &ends.unwrap_or_default())
    };
    row([
        dimension.to_string(),
        if parts == Parts::Given { "true".to_owned() } else { "found".to_owned() },
        brier.len().to_string(),
        cell(&brier, 3),
        cell(&single, 3),
        cell(&difference, 3),
        cell(&right, 2),
        cell(&expected, 2),
    ])
}

/// How often an edge is there, by tenths of its probability.
fn bins<'a>(pairs: impl Iterator<Item = &'a Pair>) -> Vec<picture::Bin> {
    let mut own: Vec<Vec<&Pair>> = vec![Vec::new(); BINS];
    pairs.for_each(|pair| own[((pair.probability * BINS as f64) as usize).min(BINS - 1)].push(pair));
    let bin = |pairs: &Vec<&Pair>| {
        let count = pairs.len() as f64;
        let predicted = pairs.iter().map(|pair| pair.probability).sum::<f64>() / count;
        let observed = pairs.iter().filter(|pair| pair.there).count() as f64 / count;
        // Pairs of a body are not independent: the surplus of each body is.
        let surplus = of_bodies(pairs, |pair| f64::from(u8::from(pair.there)) - pair.probability);
        let estimate = mean(&surplus);
        let scale = surplus.len() as f64 / count;
        // One body has no interval.
        let half = estimate.interval.map_or(0.0, |(low, high)| (high - low) / 2.0 * scale);
        picture::Bin { predicted, observed, half, pairs: pairs.len() }
    };
    own.iter().filter(|pairs| !pairs.is_empty()).map(bin).collect()
}
