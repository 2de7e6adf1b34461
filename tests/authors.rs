//! Test the reading of the authors' code against an independent one in NumPy and SciPy: `tests/reference/authors.py`, which
//! was written from the same description, made the values.

use std::collections::{BTreeMap, BTreeSet};

use bodyschema::internals::sampler::{
    Components, Joint, LatentTree, Update, cost, draw_between, draw_labels, tree,
};
use bodyschema::numerics::rng::stream;
use bodyschema::numerics::testing::{ALPHA, chi_squared, ks_two_sample};
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::evaluate::{adjusted_rand_index, parts};
use bodyschema::stages::mixture::{Gaussian, NormalInverseWishart, Points, SufficientStatistics};
use bodyschema::stages::schema::{
    Densities, Departures, EdgeWeight, Keep, MeanCovariance, Model, Prior, Sample, Sampler, Schema, Start,
    infer,
};
use bodyschema::stages::tree::Edge;
use nalgebra::{DMatrix, DVector};
use serde::Deserialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

#[derive(Deserialize)]
struct Reference {
    conditionals: Vec<Case>,
    chains: Vec<Chains>,
    power: BTreeMap<String, Power>,
}

/// A state, and what the reference computes from it.
#[derive(Deserialize)]
struct Case {
    name: String,
    options: Departures,
    prior: GivenPrior,
    points: Vec<Vec<f64>>,
    gaussians: Vec<Normal>,
    weights: Vec<f64>,
    labels_before: Vec<usize>,
    active: Vec<usize>,
    pair_conditionals: Vec<Pair>,
    pair_joints: Vec<Vec<Vec<f64>>>,
    costs: Vec<Vec<f64>>,
    root: usize,
    tree: Vec<(usize, usize)>,
    all_parents: Vec<i64>,
    label_probabilities: Vec<Option<Vec<f64>>>,
    labels: Vec<usize>,
    parents: Vec<i64>,
    joints: Vec<Vec<f64>>,
    posterior: Vec<Posterior>,
}

#[derive(Deserialize)]
struct GivenPrior {
    mean: Vec<f64>,
    mean_weight: f64,
    freedom: f64,
    scale: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Normal {
    mean: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Pair {
    pair: (usize, usize),
    mean: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Posterior {
    freedom: f64,
    scale: Vec<Vec<f64>>,
    mean: Vec<f64>,
    mean_weight: f64,
    mean_covariance: Option<Vec<Vec<f64>>>,
}

/// What chains on a map end in.
#[derive(Deserialize)]
struct Chains {
    options: Departures,
    components: usize,
    alpha: f64,
    prior: GivenPrior,
    iterations: usize,
    points: Vec<Vec<f64>>,
    truth: Vec<usize>,
    outcomes: Vec<Outcome>,
}

#[derive(Debug, Clone, Deserialize)]
struct Outcome {
    parts: usize,
    ari: f64,
    tree: String,
}

/// Where a departure shows most.
#[derive(Deserialize)]
struct Power {
    map: usize,
    test: String,
}

fn reference() -> Reference {
    serde_json::from_str(include_str!("reference/authors.json")).unwrap()
}

fn matrix(rows: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
}

/// Agrees to 1e-9 of the largest entry.
fn close(found: &DMatrix<f64>, expected: &DMatrix<f64>, what: &str) {
    let off = (found - expected).abs().max();
    assert!(off <= 1e-9 * expected.abs().max().max(1e-3), "{what}: {found} for {expected}");
}

impl Case {
    fn map(&self) -> Points {
        Points::new(&BodyMap { dims: self.points[0].len(), coordinates: self.points.concat() })
    }

    /// A position on the map among the centred points.
    fn centred(points: &Points, position: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(position) + points.origin()
    }

    fn gaussians(&self, points: &Points) -> Vec<Gaussian> {
        let gaussian = |normal: &Normal| {
            // Σ = R Rᵀ with R lower triangular, so that P = R⁻¹ is a lower triangular root of Λ.
            let root = matrix(&normal.covariance).cholesky().unwrap().l();
            Gaussian::new(Self::centred(points, &normal.mean), root.try_inverse().unwrap())
        };
        self.gaussians.iter().map(gaussian).collect()
    }

    fn update<'a>(&'a self, components: &'a [Gaussian]) -> Update<'a> {
        let (active, departures) = (&self.active, &self.options);
        Update { components, active, edge_weight: EdgeWeight::Pairwise, departures }
    }
}

#[test]
fn components_given_labels_and_joints_have_the_reference_s_parameters() {
    for case in reference().conditionals {
        let points = case.map();
        let GivenPrior { mean, mean_weight, freedom, scale } = &case.prior;
        let centre = Case::centred(&points, mean);
        let prior = NormalInverseWishart::new(centre, *mean_weight, matrix(scale), *freedom).unwrap();
        let components = Components::new(&prior, &case.options).unwrap();
        let of = |k: usize| {
            let members: Vec<usize> = (0..points.count).filter(|&i| case.labels[i] == k).collect();
            SufficientStatistics::of(&points, &members)
        };
        let statistics: Vec<SufficientStatistics> = (0..case.posterior.len()).map(of).collect();
        let joint = |(child, parent): (usize, &i64)| {
            let edge = Edge { child, parent: usize::try_from(*parent).ok()? };
            Some(Joint { edge, position: Case::centred(&points, &case.joints[child]) })
        };
        let mut tree = LatentTree::new(points.origin());
        tree.joints = case.parents.iter().enumerate().filter_map(joint).collect();
        let smallest = case.options.smallest_part as f64;
        tree.drop_inactive(&case.options, |k| statistics[k].count() >= smallest);
        for (found, expected) in components.posteriors(&statistics, &tree).zip(&case.posterior) {
            let found = found.unwrap();
            assert!((found.degrees_of_freedom - expected.freedom).abs() < 1e-12, "{}", case.name);
            assert!((found.mean_weight() - expected.mean_weight).abs() < 1e-12, "{}", case.name);
            close(&found.scale(), &matrix(&expected.scale), &case.name);
            let mean = Case::centred(&points, &expected.mean);
            assert!((found.mean() - mean).abs().max() < 1e-9, "{}", case.name);
            let inverse = || found.scale().try_inverse().unwrap() / found.mean_weight();
            let of_mean = (case.options.mean_covariance == MeanCovariance::InverseScale).then(inverse);
            assert_eq!(of_mean.is_some(), expected.mean_covariance.is_some(), "{}", case.name);
            if let (Some(found), Some(expected)) = (of_mean, &expected.mean_covariance) {
                close(&found, &matrix(expected), &case.name);
            }
        }
    }
}

#[test]
fn edges_and_trees_are_the_reference_s() {
    for case in reference().conditionals {
        let points = case.map();
        let gaussians = case.gaussians(&points);
        let update = case.update(&gaussians);
        let weight = |s: usize, c: usize| {
            let q = Case::centred(&points, &case.pair_joints[s][c]);
            cost(&q, &gaussians[s], &gaussians[c], case.options.density_floor)
        };
        for &s in &case.active {
            for &c in case.active.iter().filter(|&&c| c != s) {
                let expected = case.costs[s][c];
                assert!((weight(s, c) / expected - 1.0).abs() < 1e-9, "{}: {s} {c}", case.name);
            }
        }
        let edges: Vec<_> = tree(update, weight).iter().map(|edge| (edge.child, edge.parent)).collect();
        assert_eq!(edges, case.tree, "{}", case.name);
        // What has no edge hangs on the root, if stale joints stay.
        let mut latent = LatentTree::new(points.origin());
        latent.update(update, &mut stream(1, 1, "tree", 0)).unwrap();
        let children: BTreeSet<usize> =
            latent.joints.iter().chain(&latent.stale).map(|joint| joint.edge.child).collect();
        if case.options.stale_joints {
            let all = (0..gaussians.len()).filter(|&k| k != case.root).collect();
            assert_eq!(children, all, "{}", case.name);
            assert!(latent.stale.iter().all(|joint| joint.edge.parent == case.root), "{}", case.name);
            let hang = |&(child, _): &(usize, i64)| edges.iter().all(|edge| edge.0 != child);
            let parents = case.all_parents.iter().enumerate().map(|(child, parent)| (child, *parent));
            let others = parents.filter(|(child, _)| *child != case.root).filter(hang);
            assert!(others.into_iter().all(|(_, parent)| parent == case.root as i64), "{}", case.name);
        } else {
            assert!(latent.stale.is_empty(), "{}", case.name);
        }
    }
}

#[test]
fn joints_of_pairs_have_the_reference_s_distribution() {
    const DRAWS: usize = 4000;
    let mut rng = stream(1, 1, "pairs", 0);
    for case in reference().conditionals {
        let points = case.map();
        let gaussians = case.gaussians(&points);
        for Pair { pair: (s, c), mean, covariance } in &case.pair_conditionals {
            let informations = [gaussians[*s].information(), gaussians[*c].information()];
            // Whitened by the reference's moments, the draws are standard normal.
            let root = matrix(covariance).cholesky().unwrap().l();
            let expected = Case::centred(&points, mean);
            let draw = |_| {
                let q = draw_between(&informations[0], &informations[1], &mut rng).unwrap();
                root.solve_lower_triangular(&(q - &expected)).unwrap()
            };
            let draws: Vec<DVector<f64>> = (0..DRAWS).map(draw).collect();
            let n = DRAWS as f64;
            for i in 0..mean.len() {
                let moment = |power: i32| draws.iter().map(|x| x[i].powi(power)).sum::<f64>() / n;
                let across = draws.iter().map(|x| x[0] * x[mean.len() - 1]).sum::<f64>() / n;
                assert!(moment(1).abs() * n.sqrt() < 5.0, "{}: {s} {c}", case.name);
                assert!((moment(2) - 1.0).abs() * (n / 2.0).sqrt() < 5.0, "{}: {s} {c}", case.name);
                assert!(across.abs() * n.sqrt() < 5.0, "{}: {s} {c}", case.name);
            }
        }
    }
}

#[test]
fn labels_have_the_reference_s_probabilities_and_stay_where_densities_underflow() {
    const DRAWS: usize = 2000;
    let mut rng = stream(1, 1, "labels", 0);
    let mut kept = 0;
    for case in reference().conditionals {
        let points = case.map();
        let gaussians = case.gaussians(&points);
        let weights: Vec<f64> = case.weights.iter().map(|weight| weight.ln()).collect();
        let underflow = case.options.densities == Densities::Plain;
        let mut counts = vec![vec![0.0; gaussians.len()]; points.count];
        for _ in 0..DRAWS {
            let mut labels = case.labels_before.clone();
            draw_labels(&points, &gaussians, &weights, underflow, &mut labels, &mut rng);
            labels.iter().enumerate().for_each(|(i, &label)| counts[i][label] += 1.0);
        }
        for (i, expected) in case.label_probabilities.iter().enumerate() {
            let Some(expected) = expected else {
                assert_eq!(counts[i][case.labels_before[i]], DRAWS as f64, "{}: {i}", case.name);
                kept += 1;
                continue;
            };
            let several = expected.iter().filter(|p| **p * DRAWS as f64 >= 5.0).count() > 1;
            if several {
                let p = chi_squared(&counts[i], expected);
                assert!(p > ALPHA / 100.0, "{}: {i}: {p} {:?}", case.name, counts[i]);
            } else {
                let likeliest = (0..expected.len()).max_by(|a, b| expected[*a].total_cmp(&expected[*b]));
                assert!(counts[i][likeliest.unwrap()] > 0.98 * DRAWS as f64, "{}: {i}", case.name);
            }
        }
    }
    assert!(kept > 0);
}

/// p value of Pearson's test that two samples of equal size have one distribution over categories. Those with fewer than
/// ten in both together are one.
fn same_categories<T: Ord>(first: impl Iterator<Item = T>, second: impl Iterator<Item = T>) -> f64 {
    let mut counts: BTreeMap<T, [f64; 2]> = BTreeMap::new();
    first.for_each(|category| counts.entry(category).or_default()[0] += 1.0);
    second.for_each(|category| counts.entry(category).or_default()[1] += 1.0);
    let (often, rare): (Vec<_>, Vec<_>) = counts.into_values().partition(|[a, b]| a + b >= 10.0);
    let rare = rare.into_iter().fold([0.0; 2], |sum, [a, b]| [sum[0] + a, sum[1] + b]);
    let cells: Vec<[f64; 2]> = often.into_iter().chain([rare]).filter(|[a, b]| a + b > 0.0).collect();
    if cells.len() < 2 {
        return 1.0;
    }
    let statistic: f64 = cells.iter().map(|[a, b]| (a - b).powi(2) / (a + b)).sum();
    ChiSquared::new((cells.len() - 1) as f64).unwrap().sf(statistic)
}

/// Smallest of the p values by which the parts, the adjusted Rand indices and the trees of two samples differ.
fn p_values(found: &[Outcome], expected: &[Outcome]) -> BTreeMap<&'static str, f64> {
    let aris = |outcomes: &[Outcome]| outcomes.iter().map(|outcome| outcome.ari).collect::<Vec<_>>();
    BTreeMap::from([
        ("parts", same_categories(found.iter().map(|o| o.parts), expected.iter().map(|o| o.parts))),
        ("ari", ks_two_sample(&aris(found), &aris(expected))),
        ("tree", same_categories(found.iter().map(|o| &o.tree), expected.iter().map(|o| &o.tree))),
    ])
}

impl Chains {
    fn run(&self, authors: Departures, seed: u64) -> Vec<Outcome> {
        let settings = Schema {
            sampler: Sampler::AuthorsCode,
            components: self.components,
            concentration: self.alpha * self.components as f64,
            mean_weight: self.prior.mean_weight,
            extra_freedom: self.prior.freedom - self.points[0].len() as f64,
            prior: Prior::Identity,
            scale: self.prior.scale[0][0],
            edge_weight: EdgeWeight::Pairwise,
            start: Start::StickBreaking,
            sweeps: self.iterations,
            chains: self.outcomes.len(),
            keep: Keep::Last,
            burn_in: 0,
            authors: authors.clone(),
        };
        let map = BodyMap { dims: self.points[0].len(), coordinates: self.points.concat() };
        let draws = infer(&map, Model::DpgmmLj, &settings, seed, 1, &|| ()).unwrap();
        let outcome = |draw: &Sample| {
            // The part that most of a component's points are on, the first of equally frequent ones.
            let name = |k: usize| {
                let mut on = BTreeMap::new();
                let members = draw.labels.iter().zip(&self.truth).filter(|(label, _)| **label == k);
                members.for_each(|(_, part)| *on.entry(*part).or_insert(0) += 1);
                on.into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap().0
            };
            let edge = |edge: &Edge| {
                let (a, b) = (name(edge.child), name(edge.parent));
                format!("{}-{}", a.min(b), a.max(b))
            };
            let mut edges: Vec<String> = draw.tree.iter().map(edge).collect();
            edges.sort();
            let ari = adjusted_rand_index(&draw.labels, &self.truth);
            Outcome { parts: parts(&draw.labels), ari: (ari * 1e12).round() / 1e12, tree: edges.join(" ") }
        };
        draws.iter().map(outcome).collect()
    }
}

/// A departure, and the value of the equations in its place.
type Switch = (&'static str, fn(&mut Departures));

const SWITCHES: [Switch; 8] = [
    ("density_floor", |departures| departures.density_floor = Departures::NONE.density_floor),
    ("smallest_part", |departures| departures.smallest_part = Departures::NONE.smallest_part),
    ("root", |departures| departures.root = Departures::NONE.root),
    ("stale_joints", |departures| departures.stale_joints = Departures::NONE.stale_joints),
    ("densities", |departures| departures.densities = Departures::NONE.densities),
    ("joints_in_scatter", |departures| departures.joints_in_scatter = Departures::NONE.joints_in_scatter),
    ("mean_covariance", |departures| departures.mean_covariance = Departures::NONE.mean_covariance),
    ("empty_components", |departures| departures.empty_components = Departures::NONE.empty_components),
];

#[test]
fn chains_end_as_the_reference_s_do_and_otherwise_without_any_one_departure() {
    let Reference { chains, power, .. } = reference();
    for (at, map) in chains.iter().enumerate() {
        for (test, p) in p_values(&map.run(map.options.clone(), 1), &map.outcomes) {
            assert!(p > ALPHA / 9.0, "map {at}: {test}, p = {p}");
        }
    }
    for (name, switch) in SWITCHES {
        let Power { map, test } = &power[name];
        let mut twin = chains[*map].options.clone();
        switch(&mut twin);
        let p = p_values(&chains[*map].run(twin, 1), &chains[*map].outcomes)[test.as_str()];
        assert!(p < 1e-4, "without {name}, map {map}: {test}, p = {p}");
    }
}
