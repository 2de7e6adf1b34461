use nalgebra::{DMatrix, DVector};

use super::*;
use crate::numerics::rng::{Stream, stream};

fn gaussian(dims: usize, rng: &mut Stream) -> Gaussian {
    let mean = DVector::from_fn(dims, |_, _| rng.random_range(-1.0..1.0));
    let root = DMatrix::from_fn(dims, dims, |i, j| match i.cmp(&j) {
        std::cmp::Ordering::Less => 0.0,
        std::cmp::Ordering::Equal => rng.random_range(0.5..2.0),
        std::cmp::Ordering::Greater => rng.random_range(-0.5..0.5),
    });
    Gaussian::new(mean, root)
}

fn scene(dims: usize, rng: &mut Stream) -> Points {
    Points::from_rows(dims, (0..37 * dims).map(|_| rng.random_range(-2.0..2.0)).collect())
}

#[test]
fn squares_agree_with_the_textbook_and_are_left_only_above_their_limits() {
    let mut rng = stream(1, 1, "squares", 0);
    for dims in (1..=15).chain([40]) {
        let points = scene(dims, &mut rng);
        let gaussian = gaussian(dims, &mut rng);
        let (mean, inverse) = (gaussian.mean(), gaussian.precision());
        let log_norm = 0.5 * (inverse.determinant().ln() - dims as f64 * std::f64::consts::TAU.ln());
        for (block, first) in points.blocks().zip((0..points.count).step_by(BLOCK)) {
            let found = squares(block, &gaussian, &[f64::INFINITY; BLOCK]).unwrap();
            for (i, found) in (first..points.count).zip(&found) {
                let offset = DVector::from_row_slice(points.row(i)) - &mean;
                let square = offset.dot(&(&inverse * &offset));
                assert!((found - square).abs() < 1e-9 * square.max(1.0), "d = {dims}: {found} {square}");
                let log_density = gaussian.log_density(points.row(i));
                assert!((log_density - (log_norm - 0.5 * square)).abs() < 1e-9 * square.max(1.0));
            }
            assert_eq!(squares(block, &gaussian, &found), Some(found), "not above the limits");
            let mut limits = found.map(|square| 0.99 * square);
            assert_eq!(squares(block, &gaussian, &limits), None);
            limits[7] = found[7];
            assert_eq!(squares(block, &gaussian, &limits), Some(found), "one is not above");
        }
    }
}

#[test]
fn labels_do_not_depend_on_the_processor() {
    let mut rng = stream(1, 1, "labels", 0);
    for dims in 1..=15 {
        let points = scene(dims, &mut rng);
        let gaussians: Vec<Gaussian> = (0..5).map(|_| gaussian(dims, &mut rng)).collect();
        let weights = [-1.0, -2.0, -0.5, -4.0, -200.0];
        let (mut found, mut portable) = (vec![0; points.count], vec![0; points.count]);
        draw_labels(&points, &gaussians, &weights, false, &mut found, &mut stream(1, 1, "labels", 1));
        draw_labels_in_lanes(
            &points,
            &gaussians,
            &weights,
            false,
            &mut portable,
            &mut Vec::new(),
            &mut stream(1, 1, "labels", 1),
        );
        assert_eq!(found, portable, "d = {dims}");
    }
}
