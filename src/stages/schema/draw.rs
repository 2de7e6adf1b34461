//! Hold a draw: the state of a chain that is kept after a sweep.

use serde::{Deserialize, Serialize};

use super::settings::Schema;
use crate::stages::tree::Edge;

/// One draw of a body schema.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// The chain it is from, from 0.
    pub chain: usize,
    /// The sweep after which it was drawn, from 1.
    pub sweep: usize,
    /// z: the component of each sensor, below K.
    pub labels: Vec<usize>,
    /// The tree over the active components.
    pub tree: Vec<Edge>,
    /// q of each edge of the tree, on the body map. Empty for a DPGMM, which has no joints.
    pub joints: Vec<Vec<f64>>,
    /// log p(x, z), see [`Chain::log_posterior`]; none without a body map.
    pub log_posterior: Option<f64>,
}

/// The draw of highest log posterior, of at least one.
pub fn best(draws: &[Draw]) -> &Draw {
    draws
        .iter()
        .reduce(|kept, next| if next.log_posterior > kept.log_posterior { next } else { kept })
        .expect("there is at least one chain, which keeps at least one draw")
}

/// What each chain says of sensors that do not differ: all of them are on one part.
pub fn one_part(sensors: usize, settings: &Schema) -> Vec<Draw> {
    let draw = |chain| Draw {
        chain,
        sweep: settings.sweeps,
        labels: vec![0; sensors],
        tree: Vec::new(),
        joints: Vec::new(),
        log_posterior: None,
    };
    (0..settings.chains).map(draw).collect()
}
