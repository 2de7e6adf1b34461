//! A tree over parts by the principal components of the roots of what each of them feels.
//!
//! The mutual information of two parts is that of their six leading principal components, taken as Gaussian. The tree is that of most
//! information (Chow and Liu 1968). It does not know that a joint is one point of both of its parts.

use nalgebra::{DMatrix, DVector};

use crate::stages::joints::of_correlation;
use crate::stages::rigid_parts::stratified;
use crate::stages::sense::Tactile;
use crate::stages::tree::{Edge, prim};

/// Leading components of each part: as many as a rigid motion has.
const COMPONENTS: usize = 6;
/// Samples that are used, spread over all.
const MAX_SAMPLES: usize = 20_000;
/// Share of the largest variance of a part beyond which a component tells something.
const LEAST: f64 = 1e-9;

/// Unexplained share of a component below which hardly more is told: two parts that feel the same would have infinitely much in common.
const NEGLIGIBLE: f64 = 1e-3;

/// The tree over the parts with these labels, 0, 1, …, of M sensors that felt M × T pressures, none of them missing.
pub(super) fn tree(labels: &[usize], tactile: &Tactile) -> Vec<Edge> {
    let parts = labels.iter().max().map_or(0, |last| last + 1);
    let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
    let own: Vec<DMatrix<f64>> = (0..parts)
        .map(|part| {
            let series = tactile.series().zip(labels).filter(|(_, label)| **label == part);
            let roots = series
                .flat_map(|(series, _)| samples.iter().map(move |&t| f64::from(series[t].max(0.0)).sqrt()));
            let roots: Vec<f64> = roots.collect();
            leading(DMatrix::from_vec(samples.len(), roots.len() / samples.len(), roots))
        })
        .collect();
    let mut information = DMatrix::zeros(parts, parts);
    for (a, b) in (0..parts).flat_map(|a| (a + 1..parts).map(move |b| (a, b))) {
        information[(a, b)] = mutual_information(&own[a].tr_mul(&own[b]));
        information[(b, a)] = information[(a, b)];
    }
    let nodes: Vec<usize> = (0..parts).collect();
    prim(&nodes, |child, parent| -information[(child, parent)])
}

/// The leading components of what a part feels over time, samples × sensors, each of length 1 over all samples.
fn leading(mut roots: DMatrix<f64>) -> DMatrix<f64> {
    for mut series in roots.column_iter_mut() {
        let mean = series.mean();
        series.add_scalar_mut(-mean);
    }
    let eigen = roots.tr_mul(&roots).symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let largest = order.first().map_or(0.0, |&first| eigen.eigenvalues[first]);
    let tells = |at: &usize| eigen.eigenvalues[*at] > LEAST * largest;
    let of =
        |at: usize| -> DVector<f64> { &roots * eigen.eigenvectors.column(at) / eigen.eigenvalues[at].sqrt() };
    let found: Vec<DVector<f64>> = order.into_iter().take(COMPONENTS).filter(tells).map(of).collect();
    if found.is_empty() { DMatrix::zeros(roots.nrows(), 0) } else { DMatrix::from_columns(&found) }
}

/// Of two Gaussian variables whose components have these correlations, nats: the sum of −½ ln(1 − ρ²) over their canonical correlations ρ.
fn mutual_information(correlations: &DMatrix<f64>) -> f64 {
    correlations.singular_values().iter().map(|r| of_correlation(*r, NEGLIGIBLE)).sum()
}

#[cfg(test)]
mod tests;
