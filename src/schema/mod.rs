//! Stage 6. Body map → samples of the body schema, by the DPGMM-LJ or the DPGMM (section 3).

pub mod bordered;
pub mod gaussian;
pub mod joints;
pub mod labels;
pub mod points;
pub mod sweep;
pub mod tree;

use clap::ValueEnum;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use self::gaussian::{MixtureError, NormalInverseWishart};
use self::points::Points;
use self::sweep::Chain;
use self::tree::Edge;
use crate::body_map::BodyMap;
use crate::settings::{Keep, Schema};
use crate::streams::stream;

/// Most numbers in the matrices of all components together, of which a chain holds a few: 80 MB each.
const MOST_NUMBERS: usize = 10_000_000;

/// Most labels in all draws that are kept, 8 GB.
pub const MOST_LABELS: usize = 1_000_000_000;

/// Whether the matrices of so many components in so many dimensions fit the memory.
pub fn fits(components: usize, dims: usize) -> bool {
    dims.saturating_mul(dims).saturating_mul(components) <= MOST_NUMBERS
}

/// The mixture to sample from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// Dirichlet-process Gaussian mixture model; its tree is found afterwards by Prim's algorithm.
    Dpgmm,
    /// The same with latent joints.
    DpgmmLj,
}

impl Model {
    /// Both, the baseline first.
    pub const ALL: [Self; 2] = [Self::Dpgmm, Self::DpgmmLj];

    /// Name on the command line and in every file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dpgmm => "dpgmm",
            Self::DpgmmLj => "dpgmm-lj",
        }
    }
}

/// One draw of a body schema.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sample {
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
pub fn best(samples: &[Sample]) -> &Sample {
    samples
        .iter()
        .reduce(|kept, next| if next.log_posterior > kept.log_posterior { next } else { kept })
        .expect("there is at least one chain, which keeps at least one draw")
}

/// What each chain says of sensors that do not differ: all of them are on one part.
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

/// Runs `settings.chains` independent chains and returns the draws that are kept, by chain and sweep.
///
/// Chain c of a map in d dimensions has the stream (seed, simulation, "model d", c). `progress` advances
/// by one for each chain.
///
/// # Errors
/// [`MixtureError`] if the map spans fewer dimensions than it has columns, or is more than can be computed with.
pub fn infer(
    map: &BodyMap,
    model: Model,
    settings: &Schema,
    seed: u64,
    simulation: usize,
    progress: &ProgressBar,
) -> Result<Vec<Sample>, MixtureError> {
    let (components, dims, draws, count) = (settings.components, map.dims, settings.draws(), map.points());
    // Before anything of that size is made; n points span n − 1 dimensions.
    if count <= dims {
        return Err(MixtureError::Flat { points: count, dims });
    }
    if !fits(components, dims) {
        return Err(MixtureError::TooManyNumbers { components, dims });
    }
    if draws.saturating_mul(count) > MOST_LABELS {
        return Err(MixtureError::TooManyLabels { draws, points: count });
    }
    let points = Points::new(map);
    let prior = NormalInverseWishart::fraley_raftery(&points, settings)?;
    let stage = format!("{} {}", model.name(), map.dims);
    let chains: Result<Vec<Vec<Sample>>, MixtureError> = (0..settings.chains)
        .into_par_iter()
        .map(|chain| {
            let mut rng = stream(seed, simulation, &stage, chain);
            let mut state = Chain::start(&points, &prior, settings, model, &mut rng)?;
            let mut samples = Vec::new();
            for sweep in 1..=settings.sweeps {
                state.sweep(&mut rng)?;
                let keep = match settings.keep {
                    Keep::Last => sweep == settings.sweeps,
                    Keep::All => sweep > settings.burn_in,
                };
                if keep {
                    samples.push(Sample {
                        chain,
                        sweep,
                        labels: state.labels.clone(),
                        tree: state.tree(),
                        joints: state.joints.iter().map(|joint| points.uncentred(&joint.position)).collect(),
                        log_posterior: Some(state.log_posterior()?),
                    });
                }
            }
            progress.inc(1);
            Ok(samples)
        })
        .collect();
    Ok(chains?.into_iter().flatten().collect())
}
