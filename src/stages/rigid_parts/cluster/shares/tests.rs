//! Test that shares are those of as many updates as there may be.

use rand::RngExt;

use super::super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::rigid_parts::roots::product;

#[test]
fn stopping_early_changes_no_bit() {
    let mut rng = stream(17, 1, "shares", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let mut felt = felt_of(&product(uniform(400, 4).as_ref(), uniform(4, 70).as_ref())).0;
    felt.roots.values[(5, 3)] = f64::NAN;
    // Sensors of another part, of which the last share of the sensors has some.
    for sensor in 60..70 {
        felt.roots.values.col_as_slice_mut(sensor).reverse();
    }
    let cluster = Cluster::of_rank(&felt, (0..40).collect(), 4);
    let als = Als::new(felt.roots.values.as_ref(), &felt.roots.thresholds);
    let mut loadings = Mat::zeros(70, cluster.rank());
    for _ in 0..LOADING_ITERATIONS[1] {
        als.update_loadings(loadings.as_mut(), &cluster.motion);
    }
    let residuals = als.residuals(loadings.as_ref(), &cluster.motion);
    let shares = cluster.shares(&felt.roots);
    assert_eq!(shares.len(), 70);
    for (sensor, (share, [residual, _])) in shares.iter().zip(residuals).enumerate() {
        let both = felt.roots.values.col_as_slice(sensor).iter().zip(&felt.roots.thresholds);
        let all: f64 = both.filter(|(root, least)| root >= least).map(|(root, _)| root * root).sum();
        assert_eq!(share.to_bits(), (residual / all).to_bits(), "sensor {sensor}");
        assert_eq!(*share < 0.01, sensor < 60, "sensor {sensor}: {share}");
    }
}
