//! Agreement with NumPy, SciPy, scikit-learn and statsmodels; `tests/reference/make.py` made the values.

use bodyschema::internals::statistics;
use bodyschema::numerics::rng::stream;
use bodyschema::stages::baselines::{gmm, ridge, ward};
use bodyschema::stages::body_map::{BodyMap, ClassicalScaling};
use bodyschema::stages::body_map::{Fit, Majorisation};
use bodyschema::stages::distance::{Distances, information_metric};
use bodyschema::stages::evaluate::adjusted_rand_index;
use bodyschema::stages::mixture::NormalInverseWishart;
use bodyschema::stages::mixture::SufficientStatistics;
use bodyschema::stages::mixture::k_means;
use bodyschema::stages::quantise::Symbols;
use bodyschema::stages::tree::prim;
use nalgebra::{DMatrix, DVector};
use serde::Deserialize;

#[derive(Deserialize)]
struct Reference {
    information_metric: InformationMetric,
    classical_scaling: Scaling,
    majorisation: Majorised,
    adjusted_rand: Vec<AdjustedRand>,
    spanning_trees: Vec<SpanningTree>,
    marginal_likelihoods: Vec<MarginalLikelihood>,
    statistics: Intervals,
    baselines: Baselines,
}

#[derive(Deserialize)]
struct InformationMetric {
    levels: usize,
    symbols: Vec<Vec<u8>>,
    metric: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Scaling {
    distances: Vec<Vec<f64>>,
    eigenvalues: Vec<f64>,
    agreement: f64,
    within: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct Majorised {
    steps: usize,
    metric: Vec<Vec<f64>>,
    metric_stress: f64,
    start: Vec<Vec<f64>>,
    nonmetric: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct AdjustedRand {
    first: Vec<usize>,
    second: Vec<usize>,
    ari: f64,
}

#[derive(Deserialize)]
struct SpanningTree {
    weights: Vec<Vec<f64>>,
    edges: Vec<(usize, usize)>,
}

#[derive(Deserialize)]
struct MarginalLikelihood {
    prior: Prior,
    points: Vec<Vec<f64>>,
    log_marginal: f64,
}

#[derive(Deserialize)]
struct Prior {
    mean: Vec<f64>,
    mean_weight: f64,
    scale: Vec<Vec<f64>>,
    freedom: f64,
}

#[derive(Deserialize)]
struct Intervals {
    wilson: Vec<Wilson>,
    newcombe: Vec<Newcombe>,
    mann_whitney: Vec<MannWhitney>,
    kruskal: Vec<Kruskal>,
    student: Vec<Student>,
}

#[derive(Deserialize)]
struct Kruskal {
    groups: Vec<Vec<f64>>,
    p: f64,
}

#[derive(Deserialize)]
struct Student {
    values: Vec<f64>,
    interval: (f64, f64),
    quartiles: [f64; 3],
}

#[derive(Deserialize)]
struct Wilson {
    k: usize,
    n: usize,
    interval: (f64, f64),
}

#[derive(Deserialize)]
struct Newcombe {
    counts: (usize, usize, usize, usize),
    interval: (f64, f64),
}

#[derive(Deserialize)]
struct MannWhitney {
    first: Vec<f64>,
    second: Vec<f64>,
    p: f64,
}

#[derive(Deserialize)]
struct Baselines {
    points: Vec<Vec<f64>>,
    ridge: f64,
    cases: Vec<Clusters>,
}

#[derive(Deserialize)]
struct Clusters {
    clusters: usize,
    ward: Vec<usize>,
    k_means: Vec<usize>,
    inertia: f64,
    gmm: Vec<usize>,
    log_likelihood: f64,
}

fn reference() -> Reference {
    serde_json::from_str(include_str!("reference/reference.json")).expect("reference.json has this form")
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

#[test]
fn information_metric_agrees_with_scikit_learn() {
    let InformationMetric { levels, symbols, metric } = reference().information_metric;
    let distances =
        information_metric(&Symbols { samples: symbols[0].len(), levels, values: symbols.concat() });
    for (i, row) in metric.iter().enumerate() {
        for (j, expected) in row.iter().enumerate() {
            close(distances.get(i, j), *expected, 1e-9);
        }
    }
    let pairs = (0..symbols.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let nats = pairs.filter(|&(i, j)| (distances.get(i, j) * 2_f64.ln() - metric[i][j]).abs() > 1e-3);
    assert!(nats.count() > 40, "nats for bits would be seen");
    assert_eq!(distances.get(6, 7), 0.0, "another name for the same symbols is no distance");
}

#[test]
fn body_maps_agree_with_numpy_eigh() {
    let Scaling { distances, eigenvalues, agreement, within } = reference().classical_scaling;
    let sensors = distances.len();
    let scaling = ClassicalScaling::new(&Distances { sensors, values: distances.concat() }, sensors).unwrap();
    scaling.eigenvalues.iter().zip(&eigenvalues).for_each(|(found, expected)| close(*found, *expected, 1e-8));
    close(scaling.agreement(3), agreement, 1e-10);
    let squared = distances.concat().iter().map(|d| d * d).collect();
    let twin = ClassicalScaling::new(&Distances { sensors, values: squared }, 1).unwrap();
    assert!((twin.eigenvalues[0] - eigenvalues[0]).abs() > 1.0, "squaring once too often would be seen");
    let map = scaling.coordinates(3).unwrap();
    assert!(farthest_from(&map, &within) < 1e-8);
}

/// The largest difference of a distance within a map.
fn farthest_from(map: &BodyMap, within: &[Vec<f64>]) -> f64 {
    let row = |i: usize| &map.coordinates[map.dims * i..][..map.dims];
    let distance =
        |i, j| row(i).iter().zip(row(j)).map(|(a, b): (&f64, &f64)| (a - b).powi(2)).sum::<f64>().sqrt();
    let pairs = (0..within.len()).flat_map(|i| (0..within.len()).map(move |j| (i, j)));
    pairs.map(|(i, j)| (distance(i, j) - within[i][j]).abs()).fold(0.0, f64::max)
}

#[test]
fn majorisation_agrees_with_scikit_learn_step_by_step() {
    let Reference { classical_scaling, majorisation, .. } = reference();
    let Majorised { steps, metric, metric_stress, start, nonmetric } = majorisation;
    let sensors = start.len();
    let distances = Distances { sensors, values: classical_scaling.distances.concat() };
    let after = |map: &BodyMap, fit, steps| {
        let mut state = Majorisation::new(&distances, map.clone(), fit);
        (0..steps).for_each(|_| state.step());
        (state.map().clone(), state.raw_stress())
    };
    let classical = ClassicalScaling::new(&distances, 2).unwrap().coordinates(2).unwrap();
    let start = BodyMap { dims: 2, coordinates: start.concat() };
    let (map, stress) = after(&classical, Fit::Metric, steps);
    close(stress / metric_stress, 1.0, 1e-9);
    assert!(farthest_from(&map, &metric) < 1e-9);
    let off = farthest_from(&after(&start, Fit::Nonmetric, steps).0, &nonmetric);
    assert!(off < 1e-9, "{off:e}");
    assert!(
        farthest_from(&after(&classical, Fit::Metric, steps - 1).0, &metric) > 1e-4,
        "a lost step is seen"
    );
    assert!(
        farthest_from(&after(&start, Fit::Nonmetric, steps - 1).0, &nonmetric) > 1e-4,
        "a lost step is seen"
    );
    assert!(farthest_from(&after(&start, Fit::Metric, steps).0, &nonmetric) > 0.1, "the wrong fit is seen");
}

#[test]
fn adjusted_rand_index_agrees_with_scikit_learn() {
    let mut changed = 0;
    for AdjustedRand { first, second, ari } in reference().adjusted_rand {
        close(adjusted_rand_index(&first, &second), ari, 1e-12);
        let mut moved = first.clone();
        moved[0] = 1 + first.iter().max().unwrap();
        changed += usize::from((adjusted_rand_index(&moved, &second) - ari).abs() > 1e-6);
    }
    assert!(changed >= 16, "one sensor in another cluster is seen in nearly all cases: {changed} of 24");
}

#[test]
fn the_baseline_s_tree_agrees_with_scipy() {
    for SpanningTree { weights, edges } in reference().spanning_trees {
        let nodes: Vec<usize> = (0..weights.len()).collect();
        let mut found: Vec<(usize, usize)> = prim(&nodes, |a, b| weights[a][b])
            .iter()
            .map(|edge| (edge.child.min(edge.parent), edge.child.max(edge.parent)))
            .collect();
        found.sort_unstable();
        assert_eq!(found, edges);
        let longest = prim(&nodes, |a, b| -weights[a][b]);
        let shared = longest
            .iter()
            .filter(|edge| edges.contains(&(edge.child.min(edge.parent), edge.child.max(edge.parent))));
        assert!(nodes.len() < 4 || shared.count() < edges.len(), "the longest tree is another");
    }
}

#[test]
fn marginal_likelihoods_agree_with_scipy_s_multivariate_t() {
    for MarginalLikelihood { prior, points, log_marginal } in reference().marginal_likelihoods {
        let dims = prior.mean.len();
        let model = |freedom: f64| {
            let scale = DMatrix::from_row_slice(dims, dims, &prior.scale.concat());
            NormalInverseWishart::new(
                DVector::from_vec(prior.mean.clone()),
                prior.mean_weight,
                scale,
                freedom,
            )
            .unwrap()
        };
        let mut data = SufficientStatistics::new(dims);
        points.iter().for_each(|point| data.add(point));
        close(model(prior.freedom).log_marginal(&data).unwrap(), log_marginal, 1e-9);
        let wrong = model(prior.freedom + 1.0).log_marginal(&data).unwrap();
        assert!((wrong - log_marginal).abs() > 1e-2, "one degree of freedom too many is seen");
    }
}

#[test]
fn intervals_and_tests_agree_with_statsmodels_and_scipy() {
    let Intervals { wilson, newcombe, mann_whitney, kruskal, student } = reference().statistics;
    for Wilson { k, n, interval } in wilson {
        let found = statistics::rate(k, n).interval.unwrap();
        close(found.0, interval.0, 1e-9);
        close(found.1, interval.1, 1e-9);
    }
    for Newcombe { counts: (k_1, n_1, k_2, n_2), interval } in newcombe {
        let reproduced = statistics::rate(k_1, n_1);
        let (value, interval_1) = reproduced.value.zip(reproduced.interval).unwrap();
        let found = statistics::rate_difference(value, interval_1, (k_2, n_2));
        close(found.0, interval.0, 1e-9);
        close(found.1, interval.1, 1e-9);
    }
    for MannWhitney { first, second, p } in mann_whitney {
        close(statistics::mann_whitney(&first, &second), p, 1e-9);
    }
    for Kruskal { groups, p } in kruskal {
        close(statistics::kruskal_wallis(&groups).unwrap(), p, 1e-9);
        let mut moved = groups.clone();
        let value = moved[0].pop().unwrap();
        moved[1].push(value);
        let twin = statistics::kruskal_wallis(&moved).unwrap();
        assert!((twin - p).abs() > 1e-3, "a value in another group is seen");
    }
    for Student { values, interval, quartiles } in student {
        let found = statistics::mean(&values).interval.unwrap();
        close(found.0, interval.0, 1e-9);
        close(found.1, interval.1, 1e-9);
        let mut sorted = values;
        sorted.sort_by(f64::total_cmp);
        for (share, expected) in [0.25, 0.5, 0.75].into_iter().zip(quartiles) {
            close(statistics::quantile(&sorted, share), expected, 1e-12);
        }
    }
}

/// Whether two clusterings are one up to the names of the clusters.
fn same(first: &[usize], second: &[usize]) -> bool {
    (adjusted_rand_index(first, second) - 1.0).abs() < 1e-12
}

#[test]
fn ward_agrees_with_scipy() {
    let Baselines { points, cases, .. } = reference().baselines;
    let map = BodyMap { dims: 3, coordinates: points.concat() };
    let flat = BodyMap { dims: 2, coordinates: points.iter().flat_map(|x| x[..2].to_vec()).collect() };
    for expected in cases {
        assert!(same(&ward(&map, expected.clusters), &expected.ward));
        assert!(!same(&ward(&flat, expected.clusters), &expected.ward), "a lost dimension is seen");
        assert!(!same(&ward(&map, expected.clusters + 1), &expected.ward), "a cut too low is seen");
        assert!(!same(&expected.k_means, &expected.ward), "another method is seen");
    }
}

#[test]
fn k_means_agrees_with_scikit_learn() {
    let Baselines { points, cases, .. } = reference().baselines;
    let map = BodyMap { dims: 3, coordinates: points.concat() };
    for Clusters { clusters, k_means: labels, inertia, gmm, .. } in cases {
        let rng = |seed| stream(seed, 1, "k-means", 0);
        let found = k_means(&map, clusters, 200, &mut rng(1));
        close(found.inertia / inertia, 1.0, 1e-9);
        assert!(same(&found.labels, &labels));
        assert!(!same(&gmm, &labels), "another method is seen");
        let worse =
            (0..20).filter(|&seed| k_means(&map, clusters, 1, &mut rng(seed)).inertia > 1.001 * inertia);
        assert!(worse.count() > 2, "a start that is not the best is seen");
    }
}

#[test]
fn the_gaussian_mixture_agrees_with_scikit_learn() {
    let Baselines { points, ridge: expected_ridge, cases } = reference().baselines;
    let map = BodyMap { dims: 3, coordinates: points.concat() };
    close(ridge(&map) / expected_ridge, 1.0, 1e-12);
    for Clusters { clusters, k_means: start, gmm: labels, log_likelihood, .. } in cases {
        let rng = |seed| stream(seed, 1, "gmm", 0);
        let found = gmm(&map, clusters, 200, &mut rng(1));
        close(found.log_likelihood / log_likelihood, 1.0, 1e-6);
        assert!(same(&found.labels, &labels));
        assert!(!same(&start, &labels), "a climb that stays where k-means starts it is seen");
        let single = |seed| gmm(&map, clusters, 1, &mut rng(seed)).log_likelihood;
        let worse = (0..20).filter(|&seed| single(seed) < log_likelihood - 0.1);
        assert!(worse.count() > 2, "a start that is not the best is seen");
    }
}
