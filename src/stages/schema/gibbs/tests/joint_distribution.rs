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
    let moments: Vec<_> = gaussians.iter().map(Gaussian::moments).collect();
    let cost = |edge: &Edge| joints::collapsed_cost(&moments[edge.child], &moments[edge.parent]).unwrap();
    let log_mass = TREE.iter().map(|edge| -cost(edge)).sum();
    let joints =
        TREE.iter().map(|edge| Joint { edge: *edge, position: draw_joint(&gaussians, *edge, rng) }).collect();
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
    let mut tree = LatentTree::new(DVector::zeros(2));
    tree.joints = state.joints;
    let mut chain = Chain {
        points,
        prior,
        settings,
        departures: &Departures::NONE,
        components: Components::new(prior, &Departures::NONE).unwrap(),
        model: Model::DpgmmLj,
        labels: state.labels,
        gaussians: state.gaussians,
        log_weights: state.log_weights,
        tree,
        statistics: Vec::new(),
    };
    mutant.draw_labels(&mut chain, rng);
    chain.update_statistics();
    let missing = (mutant == Mutant::MissingJoint).then(|| chain.tree.joints.pop()).flatten();
    chain.draw_gaussians(rng).unwrap();
    chain.tree.joints.extend(missing);
    chain.draw_weights(rng);
    let positions = TREE.map(|edge| draw_joint(&chain.gaussians, edge, rng));
    chain.tree.joints.iter_mut().zip(positions).for_each(|(joint, position)| joint.position = position);
    State {
        labels: chain.labels,
        gaussians: chain.gaussians,
        log_weights: chain.log_weights,
        joints: chain.tree.joints,
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
