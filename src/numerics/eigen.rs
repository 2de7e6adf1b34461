//! Find the largest eigenvalues of a symmetric matrix and their eigenvectors.
//!
//! A few of many eigenvalues come from block Lanczos with thick restarts (Wu & Simon, SIAM Journal on Matrix
//! Analysis and Applications 22, 2000), all sums of which are in a fixed order. faer's own partial
//! decomposition is of no use here: it takes eigenvalues of largest magnitude, the negative ones too, and its
//! blocks are single vectors, which do not see that an eigenvalue is multiple.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::householder;
use faer::linalg::matmul::matmul;
use faer::linalg::qr::no_pivoting::factor;
use faer::{Accum, Conj, Mat, MatMut, MatRef, Par};
use rand::RngExt;
use rayon::prelude::*;

use crate::numerics::rng::stream;

/// Vectors of a block beyond the wanted ones: how fast the last wanted eigenvector converges depends on how far
/// its eigenvalue is from the first that a block has no room for.
const SPARE: usize = 5;

/// Blocks of the basis from which eigenvectors are combined, and those of them that survive a restart.
const BLOCKS: usize = 6;
const KEPT_BLOCKS: usize = 2;

/// Maximum number of restarts, after which the whole matrix is decomposed instead; fewer than ten are usual.
const MAX_RESTARTS: usize = 300;

/// Restarts for which the images of the basis are combined before they are found anew: a product with the matrix
/// is what takes the time.
const TRUSTED_RESTARTS: usize = 8;

/// Length of B v − λ v at which an eigenvector counts as found, in units of ε √n |λ|max. The rounding of a
/// product leaves about four.
const RESIDUAL: f64 = 20.0;

/// Rows of a product that one thread sums, in an order that does not depend on the number of threads.
const ROWS: usize = 64;

/// faer's results depend on its number of threads.
const ONE_THREAD: Par = Par::Seq;

/// Eigenvalues and eigenvectors of a symmetric matrix.
#[derive(Debug, Clone)]
pub(crate) struct Eigen {
    /// Descending.
    pub values: Vec<f64>,
    /// n × number of values, of unit length.
    pub vectors: Mat<f64>,
}

/// A decomposition that did not converge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NoConvergence;

/// The `wanted` largest eigenvalues of a symmetric n × n matrix, or all n if `wanted` is more; a multiple eigenvalue is
/// repeated.
///
/// # Errors
/// If the decomposition does not converge.
pub(crate) fn largest(matrix: MatRef<'_, f64>, wanted: usize) -> Result<Eigen, NoConvergence> {
    let wanted = wanted.min(matrix.nrows());
    let block = wanted + SPARE;
    let few = 2 * BLOCKS * block <= matrix.nrows();
    match few.then(|| lanczos(matrix, wanted, block)).flatten() {
        Some(eigen) => Ok(eigen),
        None => whole(matrix, wanted),
    }
}

/// The largest eigenvalues by a decomposition of the whole matrix.
fn whole(matrix: MatRef<'_, f64>, wanted: usize) -> Result<Eigen, NoConvergence> {
    let (ascending, vectors) = decompose(matrix)?;
    let n = matrix.nrows();
    let values = (0..wanted).map(|k| ascending[n - 1 - k]).collect();
    Ok(Eigen { values, vectors: vectors.reverse_cols().subcols(0, wanted).to_owned() })
}

/// All eigenvalues of a symmetric matrix, ascending, and their eigenvectors, by faer.
fn decompose(matrix: MatRef<'_, f64>) -> Result<(Diag<f64>, Mat<f64>), NoConvergence> {
    let n = matrix.nrows();
    let (mut values, mut vectors) = (Diag::zeros(n), Mat::zeros(n, n));
    let scratch =
        self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, ONE_THREAD, Default::default());
    let mut memory = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut memory);
    self_adjoint_evd(matrix, values.as_mut(), Some(vectors.as_mut()), ONE_THREAD, stack, Default::default())
        .map_err(|_| NoConvergence)?;
    Ok((values, vectors))
}

/// The orthonormal factor of a matrix that has no more columns than rows (Householder's QR decomposition, by faer).
fn orthonormal_factor(mut matrix: Mat<f64>) -> Mat<f64> {
    let (rows, columns) = matrix.shape();
    let block = factor::recommended_block_size::<f64>(rows, columns);
    let mut coefficients = Mat::zeros(block, columns);
    let scratch = factor::qr_in_place_scratch::<f64>(rows, columns, block, ONE_THREAD, Default::default());
    let mut memory = MemBuffer::new(scratch);
    let stack = MemStack::new(&mut memory);
    factor::qr_in_place(matrix.as_mut(), coefficients.as_mut(), ONE_THREAD, stack, Default::default());
    let mut orthonormal = Mat::identity(rows, columns);
    let scratch = householder::apply_block_householder_sequence_on_the_left_in_place_scratch::<f64>(
        rows, block, columns,
    );
    let mut memory = MemBuffer::new(scratch);
    householder::apply_block_householder_sequence_on_the_left_in_place_with_conj(
        matrix.as_ref(),
        coefficients.as_ref(),
        Conj::No,
        orthonormal.as_mut(),
        ONE_THREAD,
        MemStack::new(&mut memory),
    );
    orthonormal
}

/// The largest eigenvalues by block Lanczos; `None` if they do not converge.
///
/// The basis grows by the image of its last block until it is full, and restarts from the best combinations
/// of all its vectors. All is orthogonalised and projected in full: that costs little beside the products,
/// and where the images span nothing new, as for a matrix of low rank, rounding puts other vectors in place.
fn lanczos(matrix: MatRef<'_, f64>, wanted: usize, block: usize) -> Option<Eigen> {
    let (n, most, kept) = (matrix.nrows(), BLOCKS * block, KEPT_BLOCKS * block);
    let mut basis = Mat::<f64>::zeros(n, most);
    let mut images = Mat::<f64>::zeros(n, most);
    let mut rng = stream(0, 0, "eigenvectors", 0);
    let mut next = Mat::from_fn(n, block, |_, _| rng.random_range(-1.0..1.0));
    let mut held = 0;
    for restart in 1..=MAX_RESTARTS {
        while held < most {
            let vectors = orthonormal(next, basis.subcols(0, held));
            next = product(matrix, vectors.as_ref());
            basis.subcols_mut(held, block).copy_from(&vectors);
            images.subcols_mut(held, block).copy_from(&next);
            held += block;
        }
        let (ascending, ritz) = decompose(product(basis.transpose(), images.as_ref()).as_ref()).ok()?;
        let values: Vec<f64> = ascending.column_vector().iter().rev().copied().collect();
        let magnitude = values[0].abs().max(values[most - 1].abs());
        let small = RESIDUAL * f64::EPSILON * (n as f64).sqrt() * magnitude;
        let found = |vectors: &Mat<f64>, applied: &Mat<f64>| {
            let residual = |k: usize| (applied.col(k) - faer::Scale(values[k]) * vectors.col(k)).norm_l2();
            (0..wanted).all(|k| residual(k) <= small)
        };
        let combined = ritz.reverse_cols().subcols(0, kept);
        let vectors = product(basis.as_ref(), combined);
        let mut applied = product(images.as_ref(), combined);
        if found(&vectors, &applied) || restart.is_multiple_of(TRUSTED_RESTARTS) {
            // Combined from images that are held, they gather rounding with each restart.
            applied = product(matrix, vectors.as_ref());
            if found(&vectors, &applied) {
                let vectors = vectors.subcols(0, wanted).to_owned();
                return Some(Eigen { values: values[..wanted].to_vec(), vectors });
            }
        }
        next = orthonormal(next, basis.as_ref());
        basis.subcols_mut(0, kept).copy_from(&vectors);
        images.subcols_mut(0, kept).copy_from(&applied);
        held = kept;
    }
    None
}

/// An orthonormal basis of what `vectors` span beside the orthonormal `basis`, to which it is orthogonal.
///
/// Where little or nothing is left beside it, what is left is rounding, which points along the basis too: a pass
/// counts only if it found unit vectors that were nearly orthogonal before it.
fn orthonormal(mut vectors: Mat<f64>, basis: MatRef<'_, f64>) -> Mat<f64> {
    const MAX_PASSES: usize = 6;
    for pass in 0..MAX_PASSES {
        let along = product(basis.transpose(), vectors.as_ref());
        let along_length = along.norm_l2();
        vectors -= product(basis, along.as_ref());
        // Taking this off unit vectors changes their lengths and angles by its square, which is nothing.
        if pass > 0 && along_length.powi(2) < f64::EPSILON {
            break;
        }
        vectors = orthonormal_factor(vectors);
        if pass > 0 && along_length < 0.1 {
            break;
        }
    }
    vectors
}

/// A matrix times another, by all threads.
fn product(left: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(left.nrows(), right.ncols());
    let mut parts: Vec<(usize, MatMut<'_, f64>)> = Vec::new();
    let mut rest = product.as_mut();
    for row in (0..left.nrows()).step_by(ROWS) {
        let (part, below) = rest.split_at_row_mut(ROWS.min(left.nrows() - row));
        parts.push((row, part));
        rest = below;
    }
    parts.into_par_iter().for_each(|(row, part)| {
        let rows = left.subrows(row, part.nrows());
        matmul(part, Accum::Replace, rows, right, 1.0, ONE_THREAD);
    });
    product
}

#[cfg(test)]
mod tests;
