//! Test draws against moments, another construction, and the posterior on a grid.

use super::super::gaussian::standard_normal;
use super::*;
use crate::numerics::rng::stream;
use crate::numerics::testing::{ALPHA, ks_one_sample, ks_two_sample};

fn scale() -> DMatrix<f64> {
    DMatrix::from_row_slice(3, 3, &[2.0, 0.6, -0.3, 0.6, 1.5, 0.4, -0.3, 0.4, 1.0])
}

fn prior(freedom: f64) -> NormalInverseWishart {
    NormalInverseWishart::new(DVector::from_vec(vec![1.0, -2.0, 0.5]), 0.8, scale(), freedom).unwrap()
}

/// z scores of sample means against expectations.
fn z_scores(draws: &[Vec<f64>], expected: &[f64]) -> Vec<f64> {
    let n = draws.len() as f64;
    (0..expected.len())
        .map(|k| {
            let mean = draws.iter().map(|draw| draw[k]).sum::<f64>() / n;
            let variance = draws.iter().map(|draw| (draw[k] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            (mean - expected[k]) / (variance / n).sqrt()
        })
        .collect()
}

#[test]
fn draws_have_the_moments_of_the_normal_inverse_wishart() {
    // E Λ = ν Ψ⁻¹, E μ = m, E (μ − m)(μ − m)ᵀ = E Σ / k = Ψ / (k (ν − d − 1)), Var Λ_00 = 2 ν (Ψ⁻¹)_00².
    let moments = |drawn_freedom: f64| {
        let mut rng = stream(1, 1, "niw", 0);
        let prior = prior(drawn_freedom);
        let draws: Vec<Vec<f64>> = (0..20_000)
            .map(|_| {
                let gaussian = prior.draw(&mut rng);
                let (precision, offset) = (gaussian.precision(), gaussian.mean() - prior.mean());
                let inverse = scale().try_inverse().unwrap();
                let centred = precision[(0, 0)] - 12.0 * inverse[(0, 0)];
                let mut values: Vec<f64> = precision.iter().copied().collect();
                values.extend(offset.iter());
                values.extend((&offset * offset.transpose()).iter());
                values.push(centred * centred);
                values
            })
            .collect();
        let inverse = scale().try_inverse().unwrap();
        let mut expected: Vec<f64> = (12.0 * &inverse).iter().copied().collect();
        expected.extend([0.0; 3]);
        expected.extend((scale() / (0.8 * 8.0)).iter());
        expected.push(24.0 * inverse[(0, 0)].powi(2));
        z_scores(&draws, &expected).into_iter().fold(0.0, |largest: f64, z| largest.max(z.abs()))
    };
    // 22 values at a level of 0.001 together: |z| below 4.08.
    assert!(moments(12.0) < 4.08, "{}", moments(12.0));
    assert!(moments(13.0) > 4.08, "one degree of freedom too many is seen: {}", moments(13.0));
}

#[test]
fn bartlett_s_draws_are_those_of_sums_of_outer_products() {
    // Log determinant, trace, and one entry off the diagonal, of Λ ~ W(Ψ⁻¹, ν).
    let features =
        |precision: &DMatrix<f64>| [precision.determinant().ln(), precision.trace(), precision[(0, 1)]];
    let root = scale().try_inverse().unwrap().cholesky().unwrap().unpack();
    let mut rng = stream(1, 1, "wishart", 0);
    let mut sums = vec![];
    for _ in 0..4000 {
        let mut precision = DMatrix::zeros(3, 3);
        for _ in 0..7 {
            let x = &root * standard_normal(3, &mut rng);
            precision += &x * x.transpose();
        }
        sums.push(features(&precision));
    }
    let mut p_values = |freedom: f64| {
        let prior = prior(freedom);
        let drawn: Vec<_> = (0..4000).map(|_| features(&prior.draw(&mut rng).precision())).collect();
        let column = |rows: &[[f64; 3]], k: usize| rows.iter().map(|row| row[k]).collect::<Vec<_>>();
        [0, 1, 2].map(|k| ks_two_sample(&column(&drawn, k), &column(&sums, k)))
    };
    let right = p_values(7.0);
    assert!(right.iter().all(|p| *p > ALPHA / 3.0), "{right:?}");
    let wrong = p_values(8.0);
    assert!(wrong[0] < ALPHA / 3.0 && wrong[1] < ALPHA / 3.0, "{wrong:?}");
}

/// Data of one component in one dimension, with a joint.
fn data(with_joint: bool) -> SufficientStatistics {
    let mut data = SufficientStatistics::new(1);
    [0.3, 1.1, 0.7].iter().for_each(|x| data.add(&[*x]));
    if with_joint {
        data.add(&[2.4]);
    }
    data
}

#[test]
fn the_component_s_conditional_agrees_with_the_posterior_on_a_grid() {
    // Λ ~ W(1/Ψ, ν) is Gamma(ν/2, rate Ψ/2); equations 16 and 17 multiplied out on a grid of (μ, Λ).
    let (mean, weight, psi, freedom) = (0.5, 0.3, 1.7, 4.0);
    let points = [0.3, 1.1, 0.7, 2.4];
    const SIDE: usize = 600;
    let mu = |i: usize| -4.0 + 10.0 * (i as f64 + 0.5) / SIDE as f64;
    let lambda = |j: usize| 12.0 * (j as f64 + 0.5) / SIDE as f64;
    let mut over_mu = vec![0.0; SIDE];
    let mut over_lambda = vec![0.0; SIDE];
    for (i, mass_at_mu) in over_mu.iter_mut().enumerate() {
        for (j, mass_at_lambda) in over_lambda.iter_mut().enumerate() {
            let (m, l) = (mu(i), lambda(j));
            let wishart = (freedom / 2.0 - 1.0) * l.ln() - psi * l / 2.0;
            let normal = |x: f64, precision: f64| 0.5 * precision.ln() - 0.5 * precision * (x - m).powi(2);
            let log: f64 =
                wishart + normal(mean, weight * l) + points.iter().map(|x| normal(*x, l)).sum::<f64>();
            *mass_at_mu += log.exp();
            *mass_at_lambda += log.exp();
        }
    }
    let distribution = |masses: Vec<f64>, low: f64, width: f64| {
        let total: f64 = masses.iter().sum();
        move |x: f64| {
            let at = ((x - low) / width * SIDE as f64).clamp(0.0, SIDE as f64);
            let whole = at as usize;
            let part = masses.get(whole).map_or(0.0, |mass| mass * at.fract());
            (masses[..whole].iter().sum::<f64>() + part) / total
        }
    };
    let (mu_distribution, lambda_distribution) =
        (distribution(over_mu, -4.0, 10.0), distribution(over_lambda, 0.0, 12.0));

    let p_values = |freedom: f64, data: &SufficientStatistics| {
        let prior = NormalInverseWishart::new(
            DVector::from_element(1, mean),
            weight,
            DMatrix::from_element(1, 1, psi),
            freedom,
        );
        let posterior = prior.unwrap().posterior(data).unwrap();
        let mut rng = stream(1, 1, "component", 0);
        let draws: Vec<Gaussian> = (0..5000).map(|_| posterior.draw(&mut rng)).collect();
        let means: Vec<f64> = draws.iter().map(|draw| draw.mean()[0]).collect();
        let precisions: Vec<f64> = draws.iter().map(|draw| draw.precision()[0]).collect();
        (ks_one_sample(&means, &mu_distribution), ks_one_sample(&precisions, &lambda_distribution))
    };
    let right = p_values(freedom, &data(true));
    assert!(right.0 > ALPHA / 2.0 && right.1 > ALPHA / 2.0, "{right:?}");
    let missing_joint = p_values(freedom, &data(false));
    assert!(missing_joint.0 < ALPHA / 2.0, "{missing_joint:?}");
    let wrong_freedom = p_values(freedom + 1.0, &data(true));
    assert!(wrong_freedom.1 < ALPHA / 2.0, "{wrong_freedom:?}");
}

impl NormalInverseWishart {
    /// log NIW(μ, Σ), by which the tests check Bayes' rule: the density of a draw with respect to (μ, Λ), up to no constant.
    fn log_density(&self, gaussian: &Gaussian) -> f64 {
        let dims = self.scale.dims as f64;
        let log_det_precision = 2.0 * (gaussian.log_peak + 0.5 * dims * (2.0 * PI).ln());
        let precision = gaussian.precision();
        let lower = self.scale.upper().transpose();
        let trace = (lower.transpose() * &precision * &lower).trace();
        let offset = gaussian.mean() - self.mean();
        let wishart = self.log_mass() + 0.5 * (self.degrees_of_freedom - dims - 1.0) * log_det_precision
            - 0.5 * trace
            - 0.5 * self.degrees_of_freedom * dims * std::f64::consts::LN_2
            - 0.25 * dims * (dims - 1.0) * PI.ln();
        let normal = 0.5 * dims * (self.mean_weight() / (2.0 * PI)).ln() + 0.5 * log_det_precision
            - 0.5 * self.mean_weight() * offset.dot(&(&precision * &offset));
        wishart + normal
    }
}

#[test]
fn marginal_likelihood_prior_posterior_and_likelihood_agree() {
    // Bayes' rule at any (μ, Σ): log p(x) = log prior + log likelihood − log posterior.
    let mut rng = stream(1, 1, "bayes", 0);
    let prior = prior(5.5);
    let points: Vec<DVector<f64>> = (0..6).map(|_| standard_normal(3, &mut rng) * 2.0).collect();
    let mut data = SufficientStatistics::new(3);
    points.iter().for_each(|x| data.add(x.as_slice()));
    let posterior = prior.posterior(&data).unwrap();
    for _ in 0..20 {
        let at = prior.draw(&mut rng);
        let likelihood: f64 = points.iter().map(|x| at.log_density(x.as_slice())).sum();
        let by_bayes = prior.log_density(&at) + likelihood - posterior.log_density(&at);
        assert!((prior.log_marginal(&data).unwrap() - by_bayes).abs() < 1e-8, "{by_bayes}");
    }
}

#[test]
fn a_gaussian_draws_with_its_own_covariance() {
    let gaussian = prior(6.0).draw(&mut stream(1, 1, "gaussian", 0));
    let mut rng = stream(1, 1, "gaussian", 1);
    let draws: Vec<Vec<f64>> = (0..20_000)
        .map(|_| {
            let offset = gaussian.draw(&mut rng) - gaussian.mean();
            (&offset * offset.transpose()).iter().copied().collect()
        })
        .collect();
    let covariance = gaussian.covariance();
    let z = z_scores(&draws, covariance.as_slice());
    assert!(z.iter().all(|z| z.abs() < 3.9), "{z:?}");
    assert!((gaussian.precision() * covariance - DMatrix::identity(3, 3)).norm() < 1e-9);
    let mean = DVector::from_iterator(3, gaussian.moments().border());
    assert!((mean - gaussian.mean()).norm() < 1e-9);
}
