use super::*;

/// A symmetric matrix with these eigenvalues and random eigenvectors.
fn with_spectrum(values: &[f64]) -> Mat<f64> {
    let n = values.len();
    let mut rng = stream(1, 1, "spectrum", 0);
    let vectors = Mat::from_fn(n, n, |_, _| rng.random_range(-1.0..1.0)).qr().compute_thin_Q();
    let scaled = Mat::from_fn(n, n, |i, j| vectors[(i, j)] * values[j]);
    let matrix = scaled * vectors.transpose();
    Mat::from_fn(n, n, |i, j| matrix[(i.max(j), i.min(j))])
}

fn few(matrix: &Mat<f64>, wanted: usize) -> Eigen {
    lanczos(matrix.as_ref(), wanted, wanted + SPARE).expect("it converges")
}

/// Checks eigenvalues and what eigenvectors must be, multiple eigenvalues or not.
fn check(matrix: &Mat<f64>, wanted: usize) {
    let (found, oracle) = (few(matrix, wanted), whole(matrix.as_ref(), wanted).unwrap());
    let scale = matrix.norm_l2().max(1e-300);
    let off = (found.vectors.transpose() * &found.vectors - Mat::<f64>::identity(wanted, wanted)).norm_max();
    assert!(off < 1e-13, "not orthonormal by {off}");
    for k in 0..wanted {
        assert!((found.values[k] - oracle.values[k]).abs() < 1e-12 * scale, "eigenvalue {k}");
        let image = matrix * found.vectors.col(k);
        let residual = (image - faer::Scale(found.values[k]) * found.vectors.col(k)).norm_l2();
        assert!(residual < 1e-11 * scale, "eigenvector {k} is off by {residual}");
    }
}

#[test]
fn agrees_with_the_whole_decomposition_where_eigenvalues_are_close() {
    // Pairs that differ by a thousandth, above a slow decay; and others as far below 0.
    let pair = |k: usize| (20 - k / 2) as f64 * [1.0, 0.999][k % 2];
    let values: Vec<f64> = (0..300)
        .map(|k| match k {
            0..20 => pair(k),
            20..200 => 10.0 * 0.97_f64.powi(k as i32 - 20),
            _ => -25.0 / (k - 199) as f64,
        })
        .collect();
    let matrix = with_spectrum(&values);
    check(&matrix, 15);
    let (found, oracle) = (few(&matrix, 15), whole(matrix.as_ref(), 15).unwrap());
    for (k, value) in values.iter().enumerate().take(15) {
        let along = found.vectors.col(k).transpose() * oracle.vectors.col(k);
        let off = (found.vectors.col(k) - faer::Scale(along.signum()) * oracle.vectors.col(k)).norm_max();
        assert!(off < 1e-9, "eigenvector {k} is off by {off}");
        assert!((found.values[k] - value).abs() < 1e-11);
    }
}

#[test]
fn multiple_eigenvalues_and_low_ranks_are_whole() {
    let n = 250;
    let spectrum = |value: fn(usize) -> f64| with_spectrum(&(0..n).map(value).collect::<Vec<f64>>());
    // More copies than a block has vectors, copies below others, and fewer values than are wanted.
    check(&spectrum(|k| if k < 60 { 2.0 } else { -1.0 }), 15);
    check(&spectrum(|k| [3.0, 3.0, 3.0, 2.0, 2.0, 1.0, 1.0, 1.0].get(k).copied().unwrap_or(0.0)), 7);
    check(&spectrum(|k| if k < 3 { 3.0 - k as f64 } else { 0.0 }), 15);
    check(&spectrum(|k| if k == 0 { -1.0 } else { 0.0 }), 5);
    check(&Mat::identity(n, n), 15);
    check(&Mat::zeros(n, n), 15);
    check(&Mat::from_fn(n, n, |_, _| 1.0), 2);
}

/// The high-level calls run on as many threads as a global setting says: one, as the tests are built.
#[test]
fn on_one_thread_both_decompositions_are_those_of_the_high_level_calls() {
    let mut rng = stream(2, 1, "spectrum", 0);
    for (rows, columns) in [(6, 1), (20, 20), (300, 15), (840, 20)] {
        let matrix = Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0..1.0));
        assert_eq!(orthonormal_factor(matrix.clone()), matrix.qr().compute_thin_Q());
    }
    let matrix = with_spectrum(&(0..200).map(|k| 1.0 / (1.0 + f64::from(k))).collect::<Vec<f64>>());
    let expected = matrix.self_adjoint_eigen(faer::Side::Lower).unwrap();
    let (values, vectors) = decompose(matrix.as_ref()).unwrap();
    assert_eq!((values.as_ref(), vectors.as_ref()), (expected.S(), expected.U()));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let matrix = with_spectrum(&(0..300).map(|k| 1.0 / (1.0 + k as f64)).collect::<Vec<f64>>());
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| few(&matrix, 10))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!((one.values, one.vectors), (three.values, three.vectors));
}
