//! Against nalgebra, and without vector instructions.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

#[test]
fn sums_factors_and_systems_agree_with_nalgebra_and_do_not_depend_on_the_processor() {
    let mut rng = stream(1, 1, "bordered", 0);
    for dims in (1..=17).chain([40]) {
        let points = DMatrix::from_fn(dims + 3, dims, |_, _| rng.random_range(-2.0..2.0));
        let rows: Vec<Vec<Chunk>> = points
            .row_iter()
            .map(|x| {
                let mut row = vec![[0.0; LANES]; chunks(dims)];
                x.iter().chain([&1.0]).zip(row.as_flattened_mut()).for_each(|(x, entry)| *entry = *x);
                row
            })
            .collect();
        let rows = || rows.iter().map(Vec::as_slice);
        let close = |found: &[f64], expected: &[f64]| {
            let largest = expected.iter().fold(0.0, |kept: f64, x| kept.max(x.abs()));
            let error = found.iter().zip(expected).fold(0.0, |kept: f64, (x, y)| kept.max((x - y).abs()));
            assert!(error < 1e-9 * largest, "d = {dims}: {error}");
        };

        let (mut sum, mut portable) = (Augmented::zeros(dims), Augmented::zeros(dims));
        sum.add_outer(rows());
        portable.add_outer_in_lanes(rows());
        assert_eq!(sum, portable, "the same bits without vector instructions");
        let outer = points.tr_mul(&points);
        close(sum.upper().as_slice(), outer.upper_triangle().as_slice());
        let border = DVector::from_iterator(dims, sum.border());
        close(border.as_slice(), points.row_sum_tr().as_slice());
        assert_eq!(sum.corner(), (dims + 3) as f64);

        let factor = sum.clone().factor().unwrap();
        assert!(portable.factor_in_lanes());
        assert_eq!(factor, portable, "the same bits without vector instructions");
        let lower = outer.clone().cholesky().unwrap().unpack();
        close(factor.upper().as_slice(), lower.transpose().as_slice());
        let mut vector: Vec<f64> = factor.border().collect();
        close(&vector, lower.solve_lower_triangular(&border).unwrap().as_slice());
        factor.solve_vector(&mut vector);
        close(&vector, outer.clone().lu().solve(&border).unwrap().as_slice());

        let mut columns = Augmented::zeros(dims);
        for i in 0..dims {
            columns.row_mut(i)[i..dims].fill_with(|| rng.random_range(0.5..1.5));
        }
        let solved = lower.tr_solve_lower_triangular(&columns.upper()).unwrap();
        let mut portable = columns.clone();
        factor.solve(&mut columns);
        factor.solve_in_lanes(&mut portable);
        assert_eq!(columns, portable, "the same bits without vector instructions");
        close(columns.upper().as_slice(), solved.as_slice());

        let mut portable = sum.clone();
        sum.eliminate_border();
        portable.eliminate_border_in_lanes();
        assert_eq!(sum, portable, "the same bits without vector instructions");
        let centred = outer - &border * border.transpose() / (dims + 3) as f64;
        close(sum.upper().as_slice(), centred.upper_triangle().as_slice());
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_has_no_factor() {
    let mut matrix = Augmented::zeros(2);
    matrix.row_mut(0)[..2].copy_from_slice(&[1.0, 2.0]);
    matrix.row_mut(1)[1] = 4.0;
    assert!(matrix.factor().is_none());
}
