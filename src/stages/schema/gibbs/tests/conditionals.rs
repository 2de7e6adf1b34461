//! Test each conditional distribution against brute force.

use super::*;

fn scene() -> (Points, NormalInverseWishart) {
    let points = Points::from_rows(2, vec![0.0, 0.1, 1.0, -0.5, -0.7, 0.4, 0.6, 0.9, -1.2, -0.3]);
    let prior = NormalInverseWishart::new(DVector::zeros(2), 0.5, DMatrix::identity(2, 2), 6.0).unwrap();
    (points, prior)
}

#[test]
fn labels_follow_equation_15() {
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
    chain.update_statistics();
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
    let largest = |share: f64| (0..3).flat_map(|k| z(k, share)).fold(0.0, |kept: f64, z| kept.max(z.abs()));
    assert!(largest(0.5) < 3.8, "{}", largest(0.5));
    assert!(largest(1.5) > 3.8, "γ in place of γ / K is seen");
}
