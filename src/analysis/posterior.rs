//! Sum up the samples of the split–merge sampler: how many parts there are, which sensor is on which, how the parts are joined,
//! how sure each is, and whether the chains have mixed.

use std::collections::BTreeMap;

use super::consensus::{Consensus, consensus};
use super::diagnostics::{LARGEST_R_HAT, LEAST_ESS, Mixing, mixing};
use crate::numerics::partition::{adjusted_rand_index, sizes};
use crate::stages::body_map::BodyMap;
use crate::stages::evaluate::parts;
use crate::stages::schema::{InferenceError, Model, Sample, Schema, TreePosterior, tree_over};
use crate::stages::tree::Edge;

/// What the posterior samples say.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// Each number of parts that was drawn, with its probability.
    pub parts: Vec<(usize, f64)>,
    /// The partition that is nearest to all posterior samples.
    pub consensus: Consensus,
    /// The tree over its parts; `None` without joints.
    pub tree: Option<TreePosterior>,
    /// Whether the chains have mixed, by three numbers of each sample.
    pub mixing: Vec<(&'static str, Mixing)>,
}

impl Posterior {
    /// Of samples from a body map; the settings, the seed and the simulation are those of the samples.
    ///
    /// # Errors
    /// [`InferenceError::Rounding`].
    ///
    /// # Panics
    /// If there are no posterior samples.
    pub fn of(
        map: &BodyMap,
        model: Model,
        samples: &[Sample],
        settings: &Schema,
        seed: u64,
        simulation: usize,
    ) -> Result<Self, InferenceError> {
        let counts: Vec<usize> = samples.iter().map(|sample| parts(&sample.labels)).collect();
        let share = |count: usize| count as f64 / samples.len() as f64;
        let shares = sizes(&counts).into_iter().map(|(count, of)| (count, share(of)));
        let labels: Vec<&[usize]> = samples.iter().map(|sample| sample.labels.as_slice()).collect();
        let consensus = consensus(&labels);
        let tree = match model {
            Model::Dpgmm => None,
            Model::DpgmmLj => Some(tree_over(map, &consensus.labels, settings, seed, simulation)?),
        };
        let of_each = |number: &dyn Fn(&Sample) -> f64| {
            let mut chains: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            samples.iter().for_each(|sample| chains.entry(sample.chain).or_default().push(number(sample)));
            mixing(&chains.into_values().collect::<Vec<_>>())
        };
        let agreement = |sample: &Sample| adjusted_rand_index(&sample.labels, &consensus.labels);
        let mixing = vec![
            ("number of parts", of_each(&|sample| parts(&sample.labels) as f64)),
            ("log posterior", of_each(&|sample| sample.log_posterior.unwrap_or(f64::NAN))),
            ("agreement with the consensus", of_each(&agreement)),
        ];
        Ok(Self { parts: shares.collect(), consensus, tree, mixing })
    }

    /// The consensus and the likeliest tree over it, as a sample.
    pub fn summary(&self) -> Sample {
        let edges = self.tree.iter().flat_map(|tree| &tree.tree);
        Sample {
            chain: 0,
            sweep: 0,
            labels: self.consensus.labels.clone(),
            tree: edges.map(|&(child, parent)| Edge { child, parent }).collect(),
            joints: Vec::new(),
            log_posterior: None,
        }
    }

    /// What shows that the chains have not mixed, in words: the worst R̂ above its limit, else the smallest effective sample
    /// size below its limit.
    pub fn unmixed(&self) -> Option<String> {
        let r_hats = self.mixing.iter().filter_map(|(name, mixing)| Some((mixing.r_hat?, *name)));
        let sizes = self.mixing.iter().filter_map(|(name, mixing)| Some((mixing.ess?, *name)));
        let worst = r_hats.reduce(|worst, next| if next.0 > worst.0 { next } else { worst });
        let least = sizes.reduce(|least, next| if next.0 < least.0 { next } else { least });
        match (worst, least) {
            // Each chain hardly moves from a value of its own.
            (Some((r_hat, name)), _) if r_hat > 100.0 => {
                Some(format!("chains stay at different values of the {name}"))
            }
            (Some((r_hat, name)), _) if r_hat > LARGEST_R_HAT => {
                Some(format!("R-hat of the {name} is {r_hat:.2}, above {LARGEST_R_HAT}"))
            }
            (_, Some((ess, name))) if ess < LEAST_ESS => {
                Some(format!("effective sample size of the {name} is {ess:.0}, below {LEAST_ESS:.0}"))
            }
            _ => None,
        }
    }
}
