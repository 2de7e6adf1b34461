//! Sum the products of quadratic monomials of parts and of unassigned clusters, for parts that have any of these clusters.

use std::ops::Range;

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::correlation::{QuadraticForms, common};
use super::moments::{monomials, scales};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::{MotionSubspace, stratified};

/// Samples that are used, spread over all.
const MAX_SAMPLES: usize = 4000;
/// About as many monomials are summed by one thread at a time.
const CHUNK: usize = 256;

/// A part with some unassigned clusters.
pub(super) struct Extended {
    /// The clusters.
    pub clusters: Vec<usize>,
    /// Where its monomials are.
    places: Vec<usize>,
    forms: Option<QuadraticForms>,
}

/// Sums over samples of the products of monomials: of each part's motion, of each cluster's, and of one of each.
///
/// Only the sums with monomials of parts are kept, since all are needed. There are far more of the others, of which few are.
pub(super) struct CrossMoments {
    /// The monomials at the samples used: samples × monomials, those of parts first.
    monomials: DMatrix<f64>,
    /// Sums of the products of all monomials and those of parts.
    with_parts: DMatrix<f64>,
    /// Where the monomials of a part, of two clusters, and of a part and a cluster are.
    of_part: Vec<Range<usize>>,
    of_clusters: Vec<Vec<Range<usize>>>,
    of_both: Vec<Vec<Range<usize>>>,
    /// Ranks of the motions of parts, and of clusters.
    parts: Vec<usize>,
    clusters: Vec<usize>,
    /// The parameters of the search.
    pub parameters: Parameters,
}

impl CrossMoments {
    /// Of the motions of parts and of unassigned clusters at the same T samples.
    pub(super) fn new(
        parts: &[MotionSubspace],
        unassigned: &[MotionSubspace],
        samples: usize,
        parameters: &Parameters,
    ) -> Self {
        let chosen: Vec<usize> = stratified(samples, MAX_SAMPLES).collect();
        let scales = scales(parts, samples);
        let mut values: Vec<f64> = Vec::new();
        let mut add = |a: &MotionSubspace, b: &MotionSubspace, same: bool| {
            let first = values.len() / chosen.len();
            for i in 0..a.rank {
                for j in if same { i } else { 0 }..b.rank {
                    let product = |&t: &usize| scales[t] * a.at(t)[i] * b.at(t)[j];
                    // What is not known says nothing.
                    let known = |product: f64| if product.is_nan() { 0.0 } else { product };
                    values.extend(chosen.iter().map(product).map(known));
                }
            }
            first..values.len() / chosen.len()
        };
        let of_part: Vec<Range<usize>> = parts.iter().map(|part| add(part, part, true)).collect();
        let of_clusters = (0..unassigned.len())
            .map(|a| (0..=a).map(|b| add(&unassigned[a], &unassigned[b], a == b)).collect())
            .collect();
        let of_both = parts
            .iter()
            .map(|part| unassigned.iter().map(|cluster| add(part, cluster, false)).collect())
            .collect();
        let monomials = DMatrix::from_vec(chosen.len(), values.len() / chosen.len(), values);
        let with_parts = products(&monomials, of_part.last().map_or(0, |last| last.end));
        let ranks = |motions: &[MotionSubspace]| motions.iter().map(|motion| motion.rank).collect();
        let (parts, clusters) = (ranks(parts), ranks(unassigned));
        Self {
            monomials,
            with_parts,
            of_part,
            of_clusters,
            of_both,
            parts,
            clusters,
            parameters: *parameters,
        }
    }

    /// Number of parts.
    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// A part with these clusters.
    pub(super) fn extended(&self, part: usize, clusters: Vec<usize>) -> Extended {
        let (places, pairs) = self.places(part, &clusters);
        let forms = QuadraticForms::new(pairs, self.select(&places, &places), self.parameters.monomial_ridge);
        Extended { clusters, places, forms }
    }

    /// The correlation of two parts.
    pub(super) fn correlation(&self, first: &Extended, second: &Extended) -> f64 {
        common(&first.forms, &second.forms, &self.select(&first.places, &second.places)).correlation
    }

    /// The places of the monomials of a part with these clusters, and which two components of their motion each is the product
    /// of.
    fn places(&self, part: usize, clusters: &[usize]) -> (Vec<usize>, Vec<(usize, usize)>) {
        let k = self.parts[part];
        let mut places: Vec<usize> = self.of_part[part].clone().collect();
        let mut pairs = monomials(k);
        let mut firsts: Vec<usize> = Vec::new();
        let mut next = k;
        for (at, &cluster) in clusters.iter().enumerate() {
            firsts.push(next);
            let own = next..next + self.clusters[cluster];
            next = own.end;
            places.extend(self.of_both[part][cluster].clone());
            pairs.extend((0..k).flat_map(|i| own.clone().map(move |j| (i, j))));
            for (&other, &first) in clusters[..=at].iter().zip(&firsts) {
                places.extend(self.of_clusters[cluster.max(other)][cluster.min(other)].clone());
                let theirs = first..first + self.clusters[other];
                // The cluster of the greater number gives the rows.
                let (rows, columns) = if cluster > other { (&own, &theirs) } else { (&theirs, &own) };
                if cluster == other {
                    pairs.extend(own.clone().flat_map(|i| (i..own.end).map(move |j| (i, j))));
                } else {
                    pairs.extend(
                        rows.clone().flat_map(|i| columns.clone().map(move |j| (i.min(j), i.max(j)))),
                    );
                }
            }
        }
        (places, pairs)
    }

    /// The sums of the products of some monomials and others.
    fn select(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        let of_parts = self.with_parts.ncols();
        let others = |places: &[usize]| places.iter().copied().filter(|place| *place >= of_parts).collect();
        let (own, theirs): (Vec<usize>, Vec<usize>) = (others(rows), others(columns));
        let sums_of_others =
            self.monomials.select_columns(&own).transpose() * self.monomials.select_columns(&theirs);
        let mut rest = sums_of_others.iter();
        // By column, as a matrix is kept.
        let mut sums = DMatrix::zeros(rows.len(), columns.len());
        for (at, &column) in columns.iter().enumerate() {
            for (sum, &row) in sums.column_mut(at).iter_mut().zip(rows) {
                *sum = match (row < of_parts, column < of_parts) {
                    (_, true) => self.with_parts[(row, column)],
                    (true, false) => self.with_parts[(column, row)],
                    (false, false) => *rest.next().expect("a sum for each pair"),
                };
            }
        }
        sums
    }
}

/// Sums over samples of the products of all monomials and the first ones, so many. In: samples × monomials.
fn products(monomials: &DMatrix<f64>, first: usize) -> DMatrix<f64> {
    let (all, firsts) = (monomials.ncols(), monomials.columns(0, first));
    let chunks = all.div_ceil(CHUNK);
    let of = |chunk: usize| {
        let own = chunk * all / chunks..(chunk + 1) * all / chunks;
        // By row of the result.
        firsts.transpose() * monomials.columns(own.start, own.len())
    };
    let found: Vec<DMatrix<f64>> = (0..chunks).into_par_iter().map(of).collect();
    let mut sums = DMatrix::zeros(all, first);
    for (chunk, found) in found.iter().enumerate() {
        sums.rows_mut(chunk * all / chunks, found.ncols()).tr_copy_from(found);
    }
    sums
}
