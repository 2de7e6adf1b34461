//! Records of an experiment → the data of the paper's figures, as tidy tables.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::pipeline::Record;
use crate::record::FileError;
use crate::record::tables::write_rows;
use crate::schema::Model;
use crate::statistics::{Estimate, mean, rate};

/// The records of each condition, a model at a dimension.
#[derive(Debug)]
pub struct Conditions(BTreeMap<(Model, usize), Vec<Record>>);

impl Conditions {
    /// Sorts records by condition.
    pub fn new(records: &[Record]) -> Self {
        let mut conditions: BTreeMap<_, Vec<Record>> = BTreeMap::new();
        for record in records {
            conditions.entry((record.model, record.dimension)).or_default().push(*record);
        }
        Self(conditions)
    }

    /// The dimensions that were run.
    pub fn dimensions(&self) -> Vec<usize> {
        let mut dimensions: Vec<usize> = self.0.keys().map(|(_, dimension)| *dimension).collect();
        dimensions.sort_unstable();
        dimensions.dedup();
        dimensions
    }

    /// The records of one condition; none if it was not run.
    pub fn get(&self, model: Model, dimension: usize) -> &[Record] {
        self.0.get(&(model, dimension)).map_or(&[], Vec::as_slice)
    }

    /// Adjusted Rand indices of one condition.
    pub fn aris(&self, model: Model, dimension: usize) -> Vec<f64> {
        self.get(model, dimension).iter().map(|record| record.ari).collect()
    }

    /// Mean number of parts of one condition.
    pub fn mean_parts(&self, model: Model, dimension: usize) -> Estimate {
        let parts: Vec<f64> = self.get(model, dimension).iter().map(|record| record.parts as f64).collect();
        mean(&parts)
    }

    /// Number of eligible samples with the right tree, and number of eligible samples.
    pub fn trees(&self, model: Model, dimension: usize) -> (usize, usize) {
        let eligible = self.get(model, dimension).iter().filter(|record| record.eligible);
        (eligible.clone().filter(|record| record.tree_correct).count(), eligible.count())
    }
}

#[derive(Serialize)]
struct PartsRow {
    dimension: usize,
    parts: usize,
    count: usize,
    n: usize,
    mean: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

#[derive(Serialize)]
struct AriRow {
    dimension: usize,
    method: Model,
    mean_ari: Option<f64>,
    n: usize,
    low: Option<f64>,
    high: Option<f64>,
}

#[derive(Serialize)]
struct TreeRow {
    dimension: usize,
    method: Model,
    correct: usize,
    n: usize,
    rate: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

/// Writes the data of figures 7, 8b and 10 into `folder` and returns the names of the files.
///
/// # Errors
/// If a file cannot be written.
pub fn write_figures(folder: &Path, conditions: &Conditions) -> Result<Vec<String>, FileError> {
    let dimensions = conditions.dimensions();
    let by_method = || Model::ALL.into_iter().flat_map(|model| dimensions.iter().map(move |&d| (model, d)));

    let parts = dimensions.iter().flat_map(|&dimension| {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for record in conditions.get(Model::DpgmmLj, dimension) {
            *counts.entry(record.parts).or_default() += 1;
        }
        let Estimate { value: mean, n, interval } = conditions.mean_parts(Model::DpgmmLj, dimension);
        let (low, high) = interval.unzip();
        counts.into_iter().map(move |(parts, count)| PartsRow { dimension, parts, count, n, mean, low, high })
    });
    write_rows(&folder.join("fig07-parts.csv"), parts)?;

    let ari = by_method().map(|(method, dimension)| {
        let Estimate { value, n, interval } = mean(&conditions.aris(method, dimension));
        let (low, high) = interval.unzip();
        AriRow { dimension, method, mean_ari: value, n, low, high }
    });
    write_rows(&folder.join("fig08b-ari.csv"), ari)?;

    let tree = by_method().map(|(method, dimension)| {
        let (correct, eligible) = conditions.trees(method, dimension);
        let Estimate { value, n, interval } = rate(correct, eligible);
        let (low, high) = interval.unzip();
        TreeRow { dimension, method, correct, n, rate: value, low, high }
    });
    write_rows(&folder.join("fig10-tree.csv"), tree)?;

    Ok(["fig07-parts.csv", "fig08b-ari.csv", "fig10-tree.csv"].map(str::to_owned).into())
}
