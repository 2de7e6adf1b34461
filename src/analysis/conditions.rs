//! Estimate means and rates for each condition of an experiment, with intervals over simulations.

use super::bootstrap::Resamples;
use super::statistics::{Estimate, mean, rate, spread};
use crate::numerics::rng::stream;
use crate::pipeline::{BaselineRecord, Condition, Record};
use crate::stages::baselines::ClusteringMethod;

/// All evaluated posterior samples of an experiment.
///
/// Samples of one simulation share a body map, so that the simulation is the unit of every interval. With one
/// simulation it is the chain, and every statement holds for that simulation alone.
#[derive(Debug, Clone)]
pub(crate) struct Conditions {
    records: Vec<Record>,
    simulations: usize,
    resamples: Resamples,
}

impl Conditions {
    /// Takes the records of `simulations` simulations; the bootstrap's random numbers derive from `seed`.
    pub(crate) fn new(records: Vec<Record>, simulations: usize, seed: u64) -> Self {
        const RESAMPLES: usize = 10_000;
        let resamples = Resamples::new(simulations, RESAMPLES, &mut stream(seed, 0, "bootstrap", 0));
        Self { records, simulations, resamples }
    }

    /// Number of simulations.
    pub(crate) fn simulations(&self) -> usize {
        self.simulations
    }

    /// The samples of these simulations, counted from 1, each as often as it is named, as if all were of one simulation and
    /// there were no other.
    pub(crate) fn redrawn(&self, simulations: &[usize]) -> Self {
        let of = |simulation: &usize| {
            let simulation = *simulation;
            self.records.iter().filter(move |record| record.simulation == simulation)
        };
        let records = simulations.iter().flat_map(of).map(|record| Record { simulation: 1, ..*record });
        Self::new(records.collect(), 1, 0)
    }

    /// An extension of the paper's way of counting: of each condition and simulation only the most probable sample, that of
    /// highest log posterior, whose tree counts whether or not its parts are right.
    ///
    /// Samples with the same labels have the same log posterior but for rounding, and may have different trees: of those the
    /// first chain's counts, so that rounding decides nothing.
    pub(crate) fn best(&self) -> Self {
        let mut groups: Vec<Vec<&Record>> = Vec::new();
        for record in &self.records {
            let same = |group: &&mut Vec<&Record>| {
                (group[0].simulation, group[0].condition()) == (record.simulation, record.condition())
            };
            match groups.iter_mut().rev().find(same) {
                None => groups.push(vec![record]),
                Some(group) => group.push(record),
            }
        }
        let best = |group: &Vec<&Record>| Record { eligible: true, ..*most_probable(group) };
        Self {
            records: groups.iter().map(best).collect(),
            simulations: self.simulations,
            resamples: self.resamples.clone(),
        }
    }

    /// All conditions that were run, by mixture, then p, then d.
    pub(crate) fn all(&self) -> Vec<Condition> {
        let mut all: Vec<Condition> = Vec::new();
        for record in &self.records {
            if all.last() != Some(&record.condition()) {
                all.push(record.condition());
            }
        }
        all.sort_by(|a, b| {
            (a.model, a.dimension)
                .cmp(&(b.model, b.dimension))
                .then(a.coordination.total_cmp(&b.coordination))
        });
        all.dedup();
        all
    }

    /// The samples of one condition.
    pub(crate) fn records(&self, condition: Condition) -> impl Iterator<Item = &Record> + Clone {
        self.records.iter().filter(move |record| record.condition() == condition)
    }

    /// A value of each sample of one condition, by simulation; samples without the value are left out.
    pub(crate) fn by_simulation(
        &self,
        condition: Condition,
        value: impl Fn(&Record) -> Option<f64>,
    ) -> Vec<Vec<f64>> {
        let mut groups = vec![Vec::new(); self.simulations];
        for record in self.records(condition) {
            groups[record.simulation - 1].extend(value(record));
        }
        groups
    }

    /// Adjusted Rand indices of one condition.
    pub(crate) fn aris(&self, condition: Condition) -> Vec<f64> {
        self.records(condition).map(|record| record.ari).collect()
    }

    /// Mean number of parts.
    pub(crate) fn mean_parts(&self, condition: Condition) -> Estimate {
        self.mean(&self.by_simulation(condition, |record| Some(record.parts as f64)))
    }

    /// Mean adjusted Rand index, whose interval ends at 1, the highest that there is.
    pub(crate) fn mean_ari(&self, condition: Condition) -> Estimate {
        let mean = self.mean(&self.by_simulation(condition, |record| Some(record.ari)));
        Estimate { interval: mean.interval.map(|(low, high)| (low, high.min(1.0))), ..mean }
    }

    /// Share of right trees among the eligible samples of some conditions together.
    pub(crate) fn tree_rate(&self, conditions: &[Condition]) -> Estimate {
        let mut groups = vec![Vec::new(); self.simulations];
        for &condition in conditions {
            for (group, outcomes) in groups.iter_mut().zip(self.trees(condition)) {
                group.extend(outcomes);
            }
        }
        self.rate(&groups)
    }

    /// 1 for a right tree and 0 for a wrong one, of each eligible sample of one condition, by simulation.
    pub(crate) fn trees(&self, condition: Condition) -> Vec<Vec<f64>> {
        self.by_simulation(condition, |record| {
            record.eligible.then(|| f64::from(u8::from(record.tree_correct)))
        })
    }

    /// Mean of values, by simulation.
    pub(crate) fn mean(&self, groups: &[Vec<f64>]) -> Estimate {
        self.clustered(mean(&groups.concat()), groups)
    }

    /// Rate of ones among ones and zeros, by simulation.
    pub(crate) fn rate(&self, groups: &[Vec<f64>]) -> Estimate {
        self.clustered(pooled_rate(groups), groups)
    }

    /// The difference of the means, or of the rates if `rates`, of `groups` of these conditions and `others` of
    /// conditions of the same simulations: others minus groups.
    pub(crate) fn difference(&self, groups: &[Vec<f64>], others: &[Vec<f64>], rates: bool) -> Estimate {
        let pooled = |groups: &[Vec<f64>]| if rates { pooled_rate(groups) } else { mean(&groups.concat()) };
        let (first, second) = (totals(groups), totals(others));
        self.resamples.difference((pooled(groups), &first), (pooled(others), &second))
    }

    fn clustered(&self, pooled: Estimate, groups: &[Vec<f64>]) -> Estimate {
        self.resamples.clustered(pooled, &totals(groups))
    }
}

/// The first of the samples whose log posterior is the highest but for rounding; of samples without one, the first.
fn most_probable<'a>(samples: &[&'a Record]) -> &'a Record {
    /// Far above the rounding of a sum over some thousand sensors, and far below what one sensor in another part changes.
    const ROUNDING: f64 = 1e-9;
    let highest = samples.iter().filter_map(|sample| sample.log_posterior).fold(f64::NEG_INFINITY, f64::max);
    let near = |sample: &&&Record| {
        sample.log_posterior.is_some_and(|value| value >= highest - ROUNDING * highest.abs().max(1.0))
    };
    samples.iter().find(near).unwrap_or(&samples[0])
}

/// Rate of ones among all observations, with Wilson's interval.
///
/// Where all are 0 or all are 1, the samples of one simulation are no evidence beyond the simulation itself, and a bootstrap over
/// simulations cannot tell how much they might differ: the interval counts the simulations that have an observation.
fn pooled_rate(groups: &[Vec<f64>]) -> Estimate {
    let all = groups.concat();
    let pooled = rate(ones(&all), all.len());
    let simulations = groups.iter().filter(|group| !group.is_empty()).count();
    let unanimous = ones(&all) == 0 || ones(&all) == all.len();
    if simulations < 2 || !unanimous {
        return pooled;
    }
    let agreeing = if ones(&all) == 0 { 0 } else { simulations };
    Estimate { interval: rate(agreeing, simulations).interval, ..pooled }
}

/// Number of ones.
fn ones(outcomes: &[f64]) -> usize {
    outcomes.iter().filter(|&&outcome| outcome == 1.0).count()
}

/// Sum and number of the values of each simulation.
fn totals(groups: &[Vec<f64>]) -> Vec<(f64, usize)> {
    groups.iter().map(|values| (values.iter().sum(), values.len())).collect()
}

/// Mean ARI over simulations of a clustering that is told the number of clusters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BaselineEstimate {
    /// The clustering.
    pub method: ClusteringMethod,
    /// K.
    pub clusters: usize,
    /// p.
    pub coordination: f64,
    /// d.
    pub dimension: usize,
    /// Mean ARI; a simulation gives one.
    pub ari: Estimate,
}

/// Means over simulations of records that are all of one p, by method, K and d.
pub(crate) fn baseline_estimates(records: &[BaselineRecord]) -> Vec<BaselineEstimate> {
    let place = |record: &BaselineRecord| (record.method, record.clusters, record.dimension);
    let mut sorted = records.to_vec();
    sorted.sort_by_key(place);
    sorted
        .chunk_by(|a, b| place(a) == place(b))
        .map(|group| {
            let aris: Vec<f64> = group.iter().map(|record| record.ari).collect();
            let BaselineRecord { coordination, dimension, method, clusters, .. } = group[0];
            let ari = Estimate { simulations: aris.len(), spread: spread(&aris), ..mean(&aris) };
            BaselineEstimate { method, clusters, coordination, dimension, ari }
        })
        .collect()
}

#[cfg(test)]
mod tests;
