//! Other ways to find parts and tree from the same pressures.

use nalgebra::DMatrix;

use crate::settings::Settings;
use crate::stages::body_map::ClassicalScaling;
use crate::stages::distance::Distances;
use crate::stages::quantise::Symbols;
use crate::stages::schema::{Model, Sample, best, infer};
use crate::stages::tree::{Edge, prim};

/// Dimensions of the body map of the mixtures: those of the paper's headline.
const DIMENSIONS: usize = 14;

/// Two trees over given parts: of the nearest sensors, and of most information between parts (Chow and Liu 1968), which is
/// the mean of the mutual information of their sensors. `estimate` takes that of joint speeds and motions instead.
pub(super) fn trees(labels: &[usize], distances: &Distances, symbols: &Symbols) -> [Vec<Edge>; 2] {
    let parts = labels.iter().max().map_or(0, |last| last + 1);
    let entropies: Vec<f64> = symbols.series().map(|series| entropy(series, symbols.levels)).collect();
    let mut nearest = DMatrix::from_element(parts, parts, f64::INFINITY);
    let (mut sums, mut counts) = (DMatrix::<f64>::zeros(parts, parts), DMatrix::<f64>::zeros(parts, parts));
    for (i, &a) in labels.iter().enumerate() {
        for (j, &b) in labels.iter().enumerate() {
            let distance = distances.get(i, j);
            nearest[(a, b)] = f64::min(nearest[(a, b)], distance);
            // H(X|Y) + H(Y|X) = H(X) + H(Y) - 2 I(X; Y).
            sums[(a, b)] += (entropies[i] + entropies[j] - distance) / 2.0;
            counts[(a, b)] += 1.0;
        }
    }
    let nodes: Vec<usize> = (0..parts).collect();
    let information = |a: usize, b: usize| sums[(a, b)] / f64::max(counts[(a, b)], 1.0);
    [
        prim(&nodes, |child, parent| nearest[(child, parent)]),
        prim(&nodes, |child, parent| -information(child, parent)),
    ]
}

/// Entropy of a series of symbols, bits.
fn entropy(series: &[u8], levels: usize) -> f64 {
    let mut counts = vec![0_usize; levels];
    series.iter().for_each(|symbol| counts[usize::from(*symbol)] += 1);
    let share = |count: usize| count as f64 / series.len() as f64;
    counts.into_iter().filter(|count| *count > 0).map(|count| -share(count) * share(count).log2()).sum()
}

/// The posterior sample of highest log posterior of the DPGMM-LJ, and of the DPGMM with Prim's tree; `None` where there is no body map.
pub(super) fn mixtures(distances: &Distances, settings: &Settings, simulation: usize) -> Option<[Sample; 2]> {
    let scaling = ClassicalScaling::new(distances, DIMENSIONS).ok()?;
    let map = scaling.coordinates(scaling.positive().clamp(1, DIMENSIONS)).ok()?;
    let draw = |model| {
        let samples =
            infer(&map, model, &settings.schema, settings.experiment.seed, simulation, &|| ()).ok()?;
        Some(best(&samples).clone())
    };
    Some([draw(Model::DpgmmLj)?, draw(Model::Dpgmm)?])
}

#[cfg(test)]
mod tests;
