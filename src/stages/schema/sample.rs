//! A posterior sample: the state of a chain that is kept after a sweep.

use serde::{Deserialize, Serialize};

use super::settings::Schema;
use crate::stages::tree::Edge;

/// A posterior sample of a body schema: the state of a chain after a sweep (section 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Number of the chain, from 0.
    pub chain: usize,
    /// Number of the sweep after which the state was kept, from 1.
    pub sweep: usize,
    /// z: the component of each of the M sensors, from 0. It is below K, but for the split–merge sampler, which is not truncated.
    pub labels: Vec<usize>,
    /// C: the tree over the active components ([`super::Chain::active`]); with the split–merge sampler, over all clusters.
    pub tree: Vec<Edge>,
    /// q of each edge of the tree: d coordinates on the body map. Empty for a DPGMM, which has no joints, and for the split–merge
    /// sampler, which integrates them out.
    pub joints: Vec<Vec<f64>>,
    /// log p(x, z), see [`super::Chain::log_posterior`]; `None` without a body map.
    pub log_posterior: Option<f64>,
}

/// The posterior sample of highest log p(x, z), in which joints do not count; the first of equal ones.
///
/// # Panics
/// If `samples` is empty.
pub fn best(samples: &[Sample]) -> &Sample {
    samples
        .iter()
        .reduce(|kept, next| if next.log_posterior > kept.log_posterior { next } else { kept })
        .expect("samples must not be empty")
}

/// One sample for each chain, with all sensors in one component: the answer where no sensor differs from another, so that
/// there is no body map to infer from.
pub fn one_part(sensors: usize, settings: &Schema) -> Vec<Sample> {
    let sample = |chain| Sample {
        chain,
        sweep: settings.sweeps,
        labels: vec![0; sensors],
        tree: Vec::new(),
        joints: Vec::new(),
        log_posterior: None,
    };
    (0..settings.chains).map(sample).collect()
}
