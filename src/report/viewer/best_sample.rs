//! Read the posterior sample of highest log posterior from the folder of the published samplers.

use std::path::Path;

use serde::Deserialize;

use super::scene::{Parts, TreeEdge};
use crate::files::tables::read_rows;
use crate::files::{FileError, npy};

/// A row of samples.csv, which is known by its chain and sweep.
#[derive(Deserialize)]
struct SampleRow {
    chain: usize,
    sweep: Option<usize>,
    log_posterior: f64,
}

/// A row of trees.csv.
#[derive(Deserialize)]
struct Joined {
    chain: usize,
    sweep: Option<usize>,
    child: usize,
    parent: usize,
}

/// The files that a folder must have.
const FILES: [&str; 3] = ["samples.csv", "assignments.npy", "trees.csv"];

/// Whether a folder is one that `infer` wrote.
pub(super) fn is_in(folder: &Path) -> bool {
    FILES.iter().all(|name| folder.join(name).is_file())
}

/// Parts and tree of the first sample of highest log posterior, of so many sensors.
///
/// # Errors
/// If a file cannot be read, or the files do not fit each other.
pub(super) fn read(folder: &Path, sensors: usize) -> Result<Parts, FileError> {
    let [samples, assignments, trees] = FILES.map(|name| folder.join(name));
    let samples: Vec<SampleRow> = read_rows(&samples)?;
    let (rows, columns, labels) = npy::read_assignments(&assignments)?;
    if (rows, columns) != (samples.len(), sensors) {
        let message = format!(
            "has {rows} samples of {columns} sensors, but samples.csv has {} samples, and there are {sensors} sensors",
            samples.len()
        );
        return Err(FileError::new(&assignments, message));
    }
    let better = |best: usize, at: usize| {
        if samples[at].log_posterior > samples[best].log_posterior { at } else { best }
    };
    let best = (0..samples.len()).fold(0, better);
    let SampleRow { chain, sweep, .. } = samples[best];
    let own: Vec<Joined> = read_rows(&trees)?;
    let own = own.into_iter().filter(|row| (row.chain, row.sweep) == (chain, sweep));
    let of: Vec<Option<usize>> = labels[best * sensors..][..sensors].iter().copied().map(Some).collect();
    let tree = own.map(|Joined { child, parent, .. }| TreeEdge { child, parent, support: None });
    Ok(Parts { of, tree: tree.collect(), names: Vec::new() })
}
