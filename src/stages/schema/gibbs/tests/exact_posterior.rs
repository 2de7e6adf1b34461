//! Test how often a chain visits each partition of five points, against the exact posterior.

use super::*;
use crate::numerics::partition::named_by_appearance;

const POINTS: [f64; 5] = [-2.0, -1.6, 0.1, 1.9, 2.3];
const COMPONENTS: usize = 3;

fn prior(freedom: f64) -> NormalInverseWishart {
    NormalInverseWishart::new(DVector::from_element(1, 0.2), 0.4, DMatrix::from_element(1, 1, 0.8), freedom)
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

#[test]
fn the_log_posterior_of_every_labelling_agrees_with_the_chain_rule() {
    let points = Points::from_rows(1, POINTS.to_vec());
    let (prior, settings) = (prior(3.0), settings(COMPONENTS));
    let mut chain = start(&points, &prior, &settings, &mut stream(3, 1, "exact", 0));
    for labels in all_labellings() {
        chain.labels.clone_from(&labels);
        chain.update_statistics();
        let expected = log_joint(&labels, 3.0, settings.concentration);
        assert!((chain.log_posterior().unwrap() - expected).abs() < 1e-10, "{labels:?}");
    }
}

#[test]
fn the_chain_visits_every_partition_as_often_as_the_posterior_says() {
    let settings = settings(COMPONENTS);
    let mut exact: BTreeMap<Vec<usize>, f64> = BTreeMap::new();
    for labels in all_labellings() {
        *exact.entry(named_by_appearance(&labels)).or_default() +=
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
            chain.update_statistics();
            chain.draw_given_labels(&mut rng).unwrap();
            if sweep % 25 == 0 {
                *visits.get_mut(&named_by_appearance(&chain.labels)).unwrap() += 1.0;
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
