//! The sampler against brute force: each conditional, the exact posterior of tiny data, and Geweke's
//! (2004) joint-distribution test with the tree held fixed. Every test rejects deliberately broken twins.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::*;
use crate::settings::Settings;
use crate::streams::{Stream, stream};
use crate::testing::{ALPHA, chi_squared};

fn settings(components: usize) -> Schema {
    Schema { components, concentration: 1.5, ..Settings::paper().schema }
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

mod conditionals {
    use super::*;

    fn scene() -> (Points, NormalInverseWishart) {
        let points = Points::from_rows(2, vec![0.0, 0.1, 1.0, -0.5, -0.7, 0.4, 0.6, 0.9, -1.2, -0.3]);
        let prior = NormalInverseWishart::new(DVector::zeros(2), 0.5, DMatrix::identity(2, 2), 6.0).unwrap();
        (points, prior)
    }

    #[test]
    fn labels_follow_equation_14() {
        let (points, prior) = scene();
        let settings = settings(3);
        let p_value = |mutant: Mutant| {
            let mut rng = stream(2, 1, "labels", 0);
            let mut chain = start(&points, &prior, &settings, &mut rng);
            let mut counts = vec![[0.0; 3]; points.count];
            for _ in 0..20_000 {
                mutant.draw_labels(&mut chain, &mut rng);
                chain.labels.iter().enumerate().for_each(|(i, &label)| counts[i][label] += 1.0);
            }
            let p = |i: usize| {
                let x = DVector::from_row_slice(points.row(i));
                let weigh =
                    |k: usize| (chain.log_weights[k] + chain.gaussians[k].log_density(x.as_slice())).exp();
                let weights = [0, 1, 2].map(weigh);
                let total: f64 = weights.iter().sum();
                chi_squared(&counts[i], &weights.map(|weight| weight / total))
            };
            (0..points.count).map(p).fold(1.0, f64::min)
        };
        let level = ALPHA / points.count as f64;
        assert!(p_value(Mutant::None) > level, "{}", p_value(Mutant::None));
        assert!(p_value(Mutant::SwappedIndex) < level);
        assert!(p_value(Mutant::UnnormalisedWeight) < level);
    }

    #[test]
    fn weights_follow_the_dirichlet_of_equation_19() {
        // Mean and second moment of π_k ~ Dir(γ/K + n_k), from Gamma draws divided by their sum.
        let (points, prior) = scene();
        let settings = settings(3);
        let mut rng = stream(2, 1, "weights", 0);
        let mut chain = start(&points, &prior, &settings, &mut rng);
        chain.labels = vec![0, 0, 0, 2, 2];
        chain.count();
        let draws: Vec<[f64; 3]> = (0..20_000)
            .map(|_| {
                chain.draw_weights(&mut rng);
                let weights = [0, 1, 2].map(|k| chain.log_weights[k].exp());
                weights.map(|weight| weight / weights.iter().sum::<f64>())
            })
            .collect();
        let z = |k: usize, share: f64| {
            let shape = share + [3.0, 0.0, 2.0][k];
            let total = 3.0 * share + 5.0;
            let expected = [shape / total, shape * (shape + 1.0) / (total * (total + 1.0))];
            [0, 1].map(|power| {
                let values: Vec<f64> = draws.iter().map(|draw| draw[k].powi(power as i32 + 1)).collect();
                let mean = values.iter().sum::<f64>() / 2e4;
                let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2e4;
                (mean - expected[power]) / (variance / 2e4).sqrt()
            })
        };
        let largest =
            |share: f64| (0..3).flat_map(|k| z(k, share)).fold(0.0, |kept: f64, z| kept.max(z.abs()));
        assert!(largest(0.5) < 3.8, "{}", largest(0.5));
        assert!(largest(1.5) > 3.8, "γ in place of γ / K is seen");
    }
}

mod exact_posterior {
    use super::*;

    const POINTS: [f64; 5] = [-2.0, -1.6, 0.1, 1.9, 2.3];
    const COMPONENTS: usize = 3;

    fn prior(freedom: f64) -> NormalInverseWishart {
        NormalInverseWishart::new(
            DVector::from_element(1, 0.2),
            0.4,
            DMatrix::from_element(1, 1, 0.8),
            freedom,
        )
        .unwrap()
    }

    /// log p(x, z) by the chain rule: each point's Student-t predictive and each label's Pólya urn, given
    /// those before. Shares no formula with the closed form under test.
    fn log_joint(labels: &[usize], freedom: f64, concentration: f64) -> f64 {
        let (m_0, k_0, psi_0) = (0.2, 0.4, 0.8);
        let mut sum = 0.0;
        for i in 0..labels.len() {
            let before: Vec<f64> = (0..i).filter(|&j| labels[j] == labels[i]).map(|j| POINTS[j]).collect();
            let n = before.len() as f64;
            let share = concentration / COMPONENTS as f64;
            sum += ((share + n) / (concentration + i as f64)).ln();

            let mean = before.iter().sum::<f64>() / n.max(1.0);
            let scatter: f64 = before.iter().map(|x| (x - mean).powi(2)).sum();
            let (k, nu) = (k_0 + n, freedom + n);
            let m = (k_0 * m_0 + n * mean) / k;
            let psi = psi_0 + scatter + k_0 * n / k * (mean - m_0).powi(2);
            let spread = psi * (k + 1.0) / (k * nu);
            let t = (POINTS[i] - m) / spread.sqrt();
            sum += libm::lgamma((nu + 1.0) / 2.0)
                - libm::lgamma(nu / 2.0)
                - 0.5 * (nu * std::f64::consts::PI * spread).ln()
                - (nu + 1.0) / 2.0 * (t * t / nu).ln_1p();
        }
        sum
    }

    fn all_labellings() -> Vec<Vec<usize>> {
        (0..COMPONENTS.pow(5))
            .map(|code| (0..5).map(|i| code / COMPONENTS.pow(i) % COMPONENTS).collect())
            .collect()
    }

    /// The partition behind a labelling: labels renamed in order of appearance.
    fn partition(labels: &[usize]) -> Vec<usize> {
        let mut names = Vec::new();
        labels
            .iter()
            .map(|label| {
                names.iter().position(|name| name == label).unwrap_or_else(|| {
                    names.push(*label);
                    names.len() - 1
                })
            })
            .collect()
    }

    #[test]
    fn the_log_posterior_of_every_labelling_agrees_with_the_chain_rule() {
        let points = Points::from_rows(1, POINTS.to_vec());
        let (prior, settings) = (prior(3.0), settings(COMPONENTS));
        let mut chain = start(&points, &prior, &settings, &mut stream(3, 1, "exact", 0));
        for labels in all_labellings() {
            chain.labels.clone_from(&labels);
            chain.count();
            let expected = log_joint(&labels, 3.0, settings.concentration);
            assert!((chain.log_posterior().unwrap() - expected).abs() < 1e-10, "{labels:?}");
        }
    }

    #[test]
    fn the_chain_visits_every_partition_as_often_as_the_posterior_says() {
        let settings = settings(COMPONENTS);
        let mut exact: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
        for labels in all_labellings() {
            *exact.entry(partition(&labels)).or_default() +=
                log_joint(&labels, 3.0, settings.concentration).exp();
        }
        let total: f64 = exact.values().sum();
        let points = Points::from_rows(1, POINTS.to_vec());
        let p_value = |mutant: Mutant| {
            let prior = prior(if mutant == Mutant::WrongFreedom { 4.0 } else { 3.0 });
            let mut rng = stream(3, 1, "exact", 1);
            let mut chain = start(&points, &prior, &settings, &mut rng);
            let mut visits: BTreeMap<Vec<usize>, f64> = exact.keys().map(|key| (key.clone(), 0.0)).collect();
            // Every 25th sweep, by when the chain has forgotten where it was.
            for sweep in 0..200_000 {
                mutant.draw_labels(&mut chain, &mut rng);
                chain.count();
                chain.draw_given_labels(&mut rng).unwrap();
                if sweep % 25 == 0 {
                    *visits.get_mut(&partition(&chain.labels)).unwrap() += 1.0;
                }
            }
            let counts: Vec<f64> = visits.into_values().collect();
            let probabilities: Vec<f64> = exact.values().map(|mass| mass / total).collect();
            chi_squared(&counts, &probabilities)
        };
        assert!(p_value(Mutant::None) > ALPHA, "{}", p_value(Mutant::None));
        // Confused components would pass: a partition does not know their names.
        for mutant in [Mutant::WrongFreedom, Mutant::SwappedPoints, Mutant::UnnormalisedWeight] {
            assert!(p_value(mutant) < ALPHA, "{mutant:?}");
        }
    }
}

mod joint_distribution {
    //! Geweke's test. The model's joint density with a fixed tree is p(π) p(z|π) Π NIW(μ_k, Σ_k) Π N(q_s; s)
    //! N(q_s; c_s) Π N(x_i; z_i). It is drawn from in two ways: directly, with importance weights for the
    //! joints' mass Π N(μ_s; μ_c, Σ_s + Σ_c); and by alternating the sweep with a draw of the data. Only a
    //! sweep that leaves the posterior invariant gives both the same moments.

    use super::*;

    const COMPONENTS: usize = 3;
    const POINTS: usize = 4;
    const TREE: [Edge; 2] = [Edge { child: 1, parent: 0 }, Edge { child: 2, parent: 1 }];

    fn prior(freedom: f64) -> NormalInverseWishart {
        let scale = DMatrix::from_row_slice(2, 2, &[8.0, 2.0, 2.0, 6.0]);
        NormalInverseWishart::new(DVector::from_vec(vec![0.5, -0.3]), 0.7, scale, freedom).unwrap()
    }

    /// The state of the sampler between two draws of the data.
    struct State {
        labels: Vec<usize>,
        gaussians: Vec<Gaussian>,
        log_weights: Vec<f64>,
        joints: Vec<Joint>,
    }

    impl State {
        fn draw_points(&self, rng: &mut Stream) -> Points {
            let draw = |&label: &usize| self.gaussians[label].draw(rng).as_slice().to_vec();
            Points::from_rows(2, self.labels.iter().flat_map(draw).collect())
        }

        /// Functions whose expectations are compared.
        fn features(&self, points: &Points) -> Vec<f64> {
            let (mean, precision) =
                (|k: usize| self.gaussians[k].mean(), |k: usize| self.gaussians[k].precision());
            let q = |s: usize| &self.joints[s].position;
            let count = |k: usize| self.labels.iter().filter(|&&label| label == k).count() as f64;
            vec![
                mean(0)[0],
                mean(1)[1],
                mean(0)[0] * mean(1)[0],
                mean(0)[0] * mean(2)[0],
                precision(0)[(0, 0)],
                precision(1)[(0, 1)],
                precision(1).determinant().ln(),
                precision(2).determinant().ln(),
                q(0)[0],
                q(0)[0] * q(1)[0],
                q(1)[1] * mean(2)[1],
                count(0),
                count(1) * count(2),
                points.row(0)[0],
                points.row(0)[1] * mean(self.labels[0])[1],
                f64::from(self.labels[0] == self.labels[1]),
            ]
        }
    }

    fn draw_joint(gaussians: &[Gaussian], edge: Edge, rng: &mut Stream) -> DVector<f64> {
        let information = |k: usize| gaussians[k].information();
        joints::draw_between(&information(edge.child), &information(edge.parent), rng).unwrap()
    }

    /// A draw from the joint density without the joints' mass, and the log of that mass.
    fn direct(prior: &NormalInverseWishart, settings: &Schema, rng: &mut Stream) -> (State, f64) {
        let gaussians: Vec<Gaussian> = (0..COMPONENTS).map(|_| prior.draw(rng)).collect();
        let gamma = Gamma::new(settings.concentration / COMPONENTS as f64, 1.0).unwrap();
        let weights: Vec<f64> = (0..COMPONENTS).map(|_| rng.sample(gamma)).collect();
        let total: f64 = weights.iter().sum();
        let label = |rng: &mut Stream| {
            let mut left = rng.random::<f64>() * total;
            weights.iter().position(|weight| (left -= weight, left < 0.0).1).unwrap_or(COMPONENTS - 1)
        };
        let labels = (0..POINTS).map(|_| label(rng)).collect();
        let between = |edge: &Edge| (&gaussians[edge.child], &gaussians[edge.parent]);
        let log_mass =
            TREE.iter().map(|edge| -joints::collapsed_cost(between(edge).0, between(edge).1).unwrap()).sum();
        let joints = TREE
            .iter()
            .map(|edge| Joint { edge: *edge, position: draw_joint(&gaussians, *edge, rng) })
            .collect();
        let log_weights = weights.iter().map(|weight| weight.ln()).collect();
        (State { labels, gaussians, log_weights, joints }, log_mass)
    }

    /// One sweep with the tree held fixed, and the mutants' mistakes.
    fn sweep(
        state: State,
        points: &Points,
        prior: &NormalInverseWishart,
        settings: &Schema,
        mutant: Mutant,
        rng: &mut Stream,
    ) -> State {
        let mut chain = Chain {
            points,
            prior,
            settings,
            model: Model::DpgmmLj,
            labels: state.labels,
            gaussians: state.gaussians,
            log_weights: state.log_weights,
            joints: state.joints,
            statistics: Vec::new(),
        };
        mutant.draw_labels(&mut chain, rng);
        chain.count();
        let missing = (mutant == Mutant::MissingJoint).then(|| chain.joints.pop()).flatten();
        chain.draw_gaussians(rng).unwrap();
        chain.joints.extend(missing);
        chain.draw_weights(rng);
        let positions = TREE.map(|edge| draw_joint(&chain.gaussians, edge, rng));
        chain.joints.iter_mut().zip(positions).for_each(|(joint, position)| joint.position = position);
        State {
            labels: chain.labels,
            gaussians: chain.gaussians,
            log_weights: chain.log_weights,
            joints: chain.joints,
        }
    }

    /// Largest |z| between both ways, over all features.
    fn largest_z(mutant: Mutant) -> f64 {
        const DIRECT: usize = 60_000;
        const BATCHES: usize = 50;
        const BATCH: usize = 2_000;
        let settings = settings(COMPONENTS);
        let prior_of_data = prior(9.0);
        let prior_of_sweep = prior(if mutant == Mutant::WrongFreedom { 10.0 } else { 9.0 });

        let mut rng = stream(4, 1, "direct", 0);
        let mut weighted: Vec<(f64, Vec<f64>)> = Vec::new();
        for _ in 0..DIRECT {
            let (state, log_mass) = direct(&prior_of_data, &settings, &mut rng);
            let points = state.draw_points(&mut rng);
            weighted.push((log_mass.exp(), state.features(&points)));
        }
        let total: f64 = weighted.iter().map(|(weight, _)| weight).sum();

        let mut rng = stream(4, 1, "successive", 0);
        let (mut state, _) = direct(&prior_of_data, &settings, &mut rng);
        let mut batches = Vec::new();
        for batch in 0..=BATCHES {
            let mut sum: Vec<f64> = Vec::new();
            for _ in 0..BATCH {
                let points = state.draw_points(&mut rng);
                state = sweep(state, &points, &prior_of_sweep, &settings, mutant, &mut rng);
                let features = state.features(&points);
                sum.resize(features.len(), 0.0);
                sum.iter_mut().zip(features).for_each(|(sum, feature)| *sum += feature);
            }
            // The first batch only forgets the start.
            if batch > 0 {
                batches.push(sum.into_iter().map(|sum| sum / BATCH as f64).collect::<Vec<_>>());
            }
        }

        let z = |k: usize| {
            let direct = weighted.iter().map(|(weight, g)| weight * g[k]).sum::<f64>() / total;
            let direct_variance =
                weighted.iter().map(|(weight, g)| (weight / total * (g[k] - direct)).powi(2)).sum::<f64>();
            let successive = batches.iter().map(|batch| batch[k]).sum::<f64>() / BATCHES as f64;
            let spread = batches.iter().map(|batch| (batch[k] - successive).powi(2)).sum::<f64>();
            let successive_variance = spread / (BATCHES * (BATCHES - 1)) as f64;
            (direct - successive) / (direct_variance + successive_variance).sqrt()
        };
        let features = batches[0].len();
        (0..features).map(z).fold(0.0, |largest: f64, z| largest.max(z.abs()))
    }

    /// 16 features at a level of 0.001 together.
    const CRITICAL: f64 = 4.0;

    #[test]
    fn the_sweep_with_a_fixed_tree_leaves_the_joint_distribution_invariant() {
        let z = largest_z(Mutant::None);
        assert!(z < CRITICAL, "{z}");
    }

    #[test]
    fn a_wrong_number_of_degrees_of_freedom_is_rejected() {
        assert!(largest_z(Mutant::WrongFreedom) > CRITICAL);
    }

    #[test]
    fn a_missing_joint_is_rejected() {
        assert!(largest_z(Mutant::MissingJoint) > CRITICAL);
    }

    #[test]
    fn a_swapped_index_is_rejected() {
        assert!(largest_z(Mutant::SwappedIndex) > CRITICAL);
    }

    #[test]
    fn an_unnormalised_weight_is_rejected() {
        assert!(largest_z(Mutant::UnnormalisedWeight) > CRITICAL);
    }
}
