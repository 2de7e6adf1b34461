//! Symmetric matrix → its largest eigenvalues and their eigenvectors.
//!
//! A few of many eigenvalues come from block Lanczos with thick restarts (Wu & Simon, SIAM Journal on Matrix
//! Analysis and Applications 22, 2000), all sums of which are in a fixed order. faer's own partial
//! decomposition is of no use here: it takes eigenvalues of largest magnitude, the negative ones too, and its
//! blocks are single vectors, which do not see that an eigenvalue is multiple.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};
use rand::RngExt;
use rayon::prelude::*;

use crate::streams::stream;

/// Vectors of a block beyond the wanted ones: the last ones wanted converge by their distance from the first
/// ones that are not in the block.
const SPARE: usize = 9;

/// Blocks of the basis from which eigenvectors are combined; half of them survive a restart.
const BLOCKS: usize = 4;

/// Restarts after which the whole matrix is decomposed instead; ten are usual.
const MOST_RESTARTS: usize = 300;

/// Rows of a product that one thread sums, in an order that does not depend on the number of threads.
const ROWS: usize = 64;

/// Eigenvalues and eigenvectors of a symmetric matrix.
#[derive(Debug, Clone)]
pub struct Eigen {
    /// Descending.
    pub values: Vec<f64>,
    /// n × number of values, of unit length.
    pub vectors: Mat<f64>,
}

/// A decomposition that did not converge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoConvergence;

/// The `wanted` largest eigenvalues, or all if there are fewer; a multiple one counts as often as it is there.
///
/// # Errors
/// If the decomposition does not converge.
pub fn largest(matrix: MatRef<'_, f64>, wanted: usize) -> Result<Eigen, NoConvergence> {
    // faer's results depend on its number of threads.
    faer::set_global_parallelism(Par::Seq);
    let block = wanted + SPARE;
    let few = 2 * BLOCKS * block <= matrix.nrows();
    match few.then(|| lanczos(matrix, wanted, block)).flatten() {
        Some(eigen) => Ok(eigen),
        None => whole(matrix, wanted),
    }
}

/// The largest eigenvalues by a decomposition of the whole matrix.
fn whole(matrix: MatRef<'_, f64>, wanted: usize) -> Result<Eigen, NoConvergence> {
    let decomposition = matrix.self_adjoint_eigen(Side::Lower).map_err(|_| NoConvergence)?;
    let (ascending, vectors) = (decomposition.S().column_vector(), decomposition.U());
    let n = matrix.nrows();
    let wanted = wanted.min(n);
    let values = (0..wanted).map(|k| ascending[n - 1 - k]).collect();
    Ok(Eigen { values, vectors: vectors.reverse_cols().subcols(0, wanted).to_owned() })
}

/// The largest eigenvalues by block Lanczos; none if they do not converge.
///
/// The basis grows by the image of its last block until it is full, and restarts from the best combinations
/// of all its vectors. All is orthogonalised and projected in full: that costs little beside the products,
/// and where the images span nothing new, as for a matrix of low rank, rounding puts other vectors in place.
fn lanczos(matrix: MatRef<'_, f64>, wanted: usize, block: usize) -> Option<Eigen> {
    let (n, most) = (matrix.nrows(), BLOCKS * block);
    let kept = most / 2;
    let mut basis = Mat::<f64>::zeros(n, most);
    let mut images = Mat::<f64>::zeros(n, most);
    let mut rng = stream(0, 0, "eigenvectors", 0);
    let mut next = Mat::from_fn(n, block, |_, _| rng.random_range(-1.0..1.0));
    let mut held = 0;
    for _restart in 0..MOST_RESTARTS {
        while held < most {
            let vectors = orthonormal(next, basis.subcols(0, held));
            next = product(matrix, vectors.as_ref());
            basis.subcols_mut(held, block).copy_from(&vectors);
            images.subcols_mut(held, block).copy_from(&next);
            held += block;
        }
        let projected = basis.transpose() * &images;
        let ritz = projected.self_adjoint_eigen(Side::Lower).ok()?;
        let best = ritz.U().reverse_cols().subcols(0, kept);
        let magnitude = ritz.S().column_vector().iter().fold(0.0, |kept: f64, value| kept.max(value.abs()));
        let rounding = f64::EPSILON * (n as f64).sqrt() * magnitude;
        let values: Vec<f64> = (0..wanted).map(|k| ritz.S().column_vector()[most - 1 - k]).collect();
        next = orthonormal(next, basis.as_ref());
        let (vectors, applied) = (&basis * best, &images * best);
        let residual = |k: usize| (applied.col(k) - faer::Scale(values[k]) * vectors.col(k)).norm_l2();
        if std::env::var("EIGEN_TRACE").is_ok() {
            let r = (0..wanted).map(residual).fold(0.0, f64::max);
            eprintln!("restart {_restart}: {r:e} of {rounding:e}");
        }
        if (0..wanted).all(|k| residual(k) <= rounding) {
            return Some(Eigen { values, vectors: vectors.subcols(0, wanted).to_owned() });
        }
        basis.subcols_mut(0, kept).copy_from(&vectors);
        images.subcols_mut(0, kept).copy_from(&applied);
        held = kept;
    }
    None
}

/// An orthonormal basis of what `vectors` span beside the orthonormal `basis`, to which it is orthogonal.
///
/// The second pass removes the rounding of the first, which is of any size where little or nothing is left.
fn orthonormal(mut vectors: Mat<f64>, basis: MatRef<'_, f64>) -> Mat<f64> {
    for _pass in 0..2 {
        let along = basis.transpose() * &vectors;
        vectors -= basis * along;
        vectors = vectors.qr().compute_thin_Q();
    }
    vectors
}

/// A symmetric matrix times a few vectors.
fn product(matrix: MatRef<'_, f64>, vectors: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(matrix.nrows(), vectors.ncols());
    let mut parts: Vec<(usize, MatMut<'_, f64>)> = Vec::new();
    let mut rest = product.as_mut();
    for row in (0..matrix.nrows()).step_by(ROWS) {
        let (part, below) = rest.split_at_row_mut(ROWS.min(matrix.nrows() - row));
        parts.push((row, part));
        rest = below;
    }
    parts.into_par_iter().for_each(|(row, part)| {
        // Columns in place of rows, which are the same and lie together.
        let rows = matrix.subcols(row, part.nrows()).transpose();
        matmul(part, Accum::Replace, rows, vectors, 1.0, Par::Seq);
    });
    product
}
