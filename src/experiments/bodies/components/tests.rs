//! Test the tree of principal components.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

#[test]
fn parts_that_share_more_of_their_motion_are_joined() {
    // Three parts of four sensors. The second feels half of what the first does, and the third half of what the second does.
    let mut rng = stream(7, 1, "components", 0);
    let samples = 3000;
    let mut series = vec![Vec::new(); 12];
    for _ in 0..samples {
        let mut uniform = || rng.random_range(0.0_f32..1.0);
        let first: [f32; 4] = std::array::from_fn(|_| uniform());
        let second = first.map(|own| own + uniform());
        let third = second.map(|own| own + 2.0 * uniform());
        for (at, root) in [third, first, second].concat().into_iter().enumerate() {
            series[at].push(root * root);
        }
    }
    let tactile = Tactile { samples, pressures: series.concat() };
    let labels: Vec<usize> = (0..12).map(|sensor| sensor / 4).collect();
    let tree = tree(&labels, &tactile);
    let mut pairs: Vec<_> =
        tree.iter().map(|edge| (edge.child.min(edge.parent), edge.child.max(edge.parent))).collect();
    pairs.sort_unstable();
    assert_eq!(pairs, [(0, 2), (1, 2)]);
    assert_eq!(mutual_information(&DMatrix::zeros(3, 2)), 0.0);
    let one = |r: f64| mutual_information(&DMatrix::from_element(1, 1, r));
    assert!(
        (one(0.6) + 0.5 * 0.64_f64.ln()).abs() < 1e-3 && one(1.0 + 1e-9) < 4.0,
        "{} {}",
        one(0.6),
        one(1.0)
    );
}
