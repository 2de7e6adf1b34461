//! Measure what a claim is about: its values, each with the condition that it belongs to.

use std::collections::BTreeMap;

use super::conditions::{BaselineEstimate, Conditions};
use super::published::{At, Measure};
use super::statistics::{Estimate, kruskal_wallis, mann_whitney, mean, quantile, smallest_adjusted};
use crate::pipeline::{Condition, Record};
use crate::stages::baselines::ClusteringMethod;
use crate::stages::schema::{Model, Sampler};

/// What a run offers to judge claims by.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// All posterior samples.
    pub conditions: Conditions,
    /// The clusterings that are told the number of clusters.
    pub baselines: Vec<BaselineEstimate>,
    /// The reading of the paper that the posterior samples follow.
    pub reading: Sampler,
}

impl Evidence {
    /// The posterior samples of these simulations, each as often as it is named, as those of one.
    pub(crate) fn redrawn(&self, simulations: &[usize]) -> Self {
        let (baselines, reading) = (self.baselines.clone(), self.reading);
        Self { conditions: self.conditions.redrawn(simulations), baselines, reading }
    }
}

/// A value, and what tells its place from those of the claim's other values.
type Placed = (String, Estimate);

/// All values that a claim is about, each with its place.
pub(crate) fn measure(measure: &Measure, evidence: &Evidence) -> Vec<Placed> {
    let Evidence { conditions, baselines, .. } = evidence;
    let each = |at: &At, estimate: &dyn Fn(Condition) -> Estimate| -> Vec<Placed> {
        let places = places(at, conditions).into_iter();
        places.map(|(place, condition)| (place, estimate(condition))).collect()
    };
    match measure {
        Measure::TreeRate { at } => each(at, &|condition| conditions.tree_rate(&[condition])),
        Measure::PooledTreeRate { at } => vec![pooled_tree_rate(at, conditions)],
        Measure::TreeShare { at } => each(at, &|condition| tree_share(conditions, condition)),
        Measure::MeanParts { at } => each(at, &|condition| conditions.mean_parts(condition)),
        Measure::ModalParts { at } => each(at, &|condition| modal_parts(conditions, condition)),
        Measure::MeanAri { at } => each(at, &|condition| conditions.mean_ari(condition)),
        Measure::MedianAri { at } => each(at, &|condition| median_ari(conditions, condition)),
        Measure::AriDifference { dimensions } => vec![ari_difference(conditions, dimensions)],
        Measure::AriWorse { dimensions } => vec![ari_worse(conditions, dimensions)],
        Measure::BestDimension { dimension } => {
            let rates = tree_rates(conditions);
            vec![best(rates.iter().map(|(at, rate)| (at.dimension as f64, *rate)), *dimension as f64, "d")]
        }
        Measure::BestCoordination { coordination } => {
            let rates = tree_rates(conditions);
            vec![best(rates.iter().map(|(at, rate)| (at.coordination, *rate)), *coordination, "p")]
        }
        Measure::FirstDimension {} => vec![first_dimension(conditions)],
        Measure::TreeDependence {} => vec![tree_dependence(conditions)],
        Measure::BaselineShare { clusters, threshold } => {
            vec![baseline_share(baselines, *clusters, *threshold)]
        }
        Measure::BaselineLoss { right, other } => baseline_loss(baselines, *right, *other),
        Measure::Nothing { .. } => Vec::new(),
    }
}

/// Rate of right trees among the eligible posterior samples of several conditions together.
fn pooled_tree_rate(at: &At, conditions: &Conditions) -> Placed {
    let all: Vec<Condition> = places(at, conditions).into_iter().map(|(_, condition)| condition).collect();
    ("all together".to_owned(), conditions.tree_rate(&all))
}

/// Share of posterior samples that are eligible and have the right tree.
fn tree_share(conditions: &Conditions, condition: Condition) -> Estimate {
    let right = |record: &Record| Some(f64::from(u8::from(record.eligible && record.tree_correct)));
    conditions.rate(&conditions.by_simulation(condition, right))
}

/// The most frequent number of parts; of equally frequent numbers the smallest.
fn modal_parts(conditions: &Conditions, condition: Condition) -> Estimate {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    conditions.records(condition).for_each(|record| *counts.entry(record.parts).or_default() += 1);
    let n = counts.values().sum();
    let mode = counts.into_iter().rev().max_by_key(|(_, count)| *count).map(|(parts, _)| parts as f64);
    Estimate::bare(mode, n)
}

fn median_ari(conditions: &Conditions, condition: Condition) -> Estimate {
    let mut aris = conditions.aris(condition);
    aris.sort_by(f64::total_cmp);
    Estimate::bare((!aris.is_empty()).then(|| quantile(&aris, 0.5)), aris.len())
}

/// Smallest p value, after Holm's correction, of tests between both mixtures' ARI at each d.
fn ari_difference(conditions: &Conditions, dimensions: &[usize]) -> Placed {
    let pairs = both_aris(conditions, dimensions);
    let p_values: Vec<f64> = pairs.iter().map(|[first, second]| mann_whitney(first, second)).collect();
    let n = pairs.iter().flatten().map(Vec::len).sum();
    ("all d".to_owned(), Estimate::bare(smallest_adjusted(&p_values), n))
}

/// Share of the dimensions at which the mean ARI of DPGMM-LJ is lower than that of DPGMM.
fn ari_worse(conditions: &Conditions, dimensions: &[usize]) -> Placed {
    let pairs = both_aris(conditions, dimensions);
    let average = |aris: &[f64]| aris.iter().sum::<f64>() / aris.len() as f64;
    let worse = pairs.iter().filter(|[dpgmm, joints]| average(joints) < average(dpgmm)).count();
    (format!("{worse} of {} dimensions", pairs.len()), share(worse, pairs.len()))
}

/// The smallest dimension from which on every tree rate is at least one half.
fn first_dimension(conditions: &Conditions) -> Placed {
    let rates = tree_rates(conditions);
    let high = |(_, rate): &&(Condition, Estimate)| rate.value.is_some_and(|rate| rate >= 0.5);
    let first = rates.iter().rev().take_while(high).last();
    let n = rates.iter().map(|(_, rate)| rate.n).sum();
    let estimate = Estimate::bare(first.map(|(at, _)| at.dimension as f64), n);
    ("from there on the rate is at least one half".to_owned(), estimate)
}

/// p value that the simulations' tree rates have one distribution at all p.
fn tree_dependence(conditions: &Conditions) -> Placed {
    let rates = |condition: Condition| -> Vec<f64> {
        let trees = conditions.trees(condition).into_iter().filter(|trees| !trees.is_empty());
        trees.map(|trees| trees.iter().sum::<f64>() / trees.len() as f64).collect()
    };
    let groups: Vec<Vec<f64>> =
        conditions.all().into_iter().map(rates).filter(|rates| !rates.is_empty()).collect();
    let n = groups.iter().map(Vec::len).sum();
    let several = groups.iter().any(|rates| rates.len() > 1);
    let p_value = kruskal_wallis(&groups).filter(|_| several);
    (format!("rates of {n} simulations at {} p", groups.len()), Estimate::bare(p_value, n))
}

/// Share of the conditions in which the mean ARI of the clusterings exceeds a threshold.
fn baseline_share(baselines: &[BaselineEstimate], clusters: usize, threshold: f64) -> Placed {
    let values: Vec<f64> = baselines
        .iter()
        .filter(|baseline| baseline.clusters == clusters)
        .filter_map(|baseline| baseline.ari.value)
        .collect();
    let above = values.iter().filter(|ari| **ari > threshold).count();
    let place = format!("{above} of {} conditions (methods by dimensions)", values.len());
    (place, share(above, values.len()))
}

/// For each clustering, by how much its ARI is higher with the right number of clusters than with another.
fn baseline_loss(baselines: &[BaselineEstimate], right: usize, other: usize) -> Vec<Placed> {
    let loss = |method: ClusteringMethod| {
        let average = |clusters: usize| {
            let of =
                |baseline: &&BaselineEstimate| baseline.method == method && baseline.clusters == clusters;
            mean(&baselines.iter().filter(of).filter_map(|b| b.ari.value).collect::<Vec<_>>())
        };
        let (right, other) = (average(right), average(other));
        let loss = right.value.zip(other.value).map(|(right, other)| right - other);
        (method.name().to_owned(), Estimate::bare(loss, right.n))
    };
    ClusteringMethod::ALL.into_iter().map(loss).collect()
}

fn share(count: usize, n: usize) -> Estimate {
    Estimate::bare((n > 0).then(|| count as f64 / n as f64), n)
}

/// All conditions that `at` names, each with what tells it from the others.
fn places(at: &At, conditions: &Conditions) -> Vec<(String, Condition)> {
    let run = conditions.all();
    let or_run = |given: &[f64], of: &dyn Fn(&Condition) -> f64| -> Vec<f64> {
        let mut values = if given.is_empty() { run.iter().map(of).collect() } else { given.to_vec() };
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let given: Vec<f64> = at.dimensions.iter().map(|&d| d as f64).collect();
    let dimensions = or_run(&given, &|condition| condition.dimension as f64);
    let coordinations = or_run(&at.coordinations, &|condition| condition.coordination);
    let mut places = Vec::new();
    for &model in &at.models {
        for &coordination in &coordinations {
            for &dimension in &dimensions {
                let mut place = Vec::new();
                if at.models.len() > 1 {
                    place.push(model.name().to_owned());
                }
                if coordinations.len() > 1 {
                    place.push(format!("p = {coordination}"));
                }
                if dimensions.len() > 1 || place.is_empty() {
                    place.push(format!("d = {dimension}"));
                }
                places.push((
                    place.join(" at "),
                    Condition { model, coordination, dimension: dimension as usize },
                ));
            }
        }
    }
    places
}

/// ARI of both mixtures at each dimension at which both were run.
fn both_aris(conditions: &Conditions, dimensions: &[usize]) -> Vec<[Vec<f64>; 2]> {
    let at = At { models: vec![Model::Dpgmm], dimensions: dimensions.to_vec(), coordinations: Vec::new() };
    places(&at, conditions)
        .into_iter()
        .map(|(_, condition)| Model::ALL.map(|model| conditions.aris(Condition { model, ..condition })))
        .filter(|[first, second]| !first.is_empty() && !second.is_empty())
        .collect()
}

/// Tree rates of DPGMM-LJ at all conditions that were run, by d and p.
fn tree_rates(conditions: &Conditions) -> Vec<(Condition, Estimate)> {
    let all = conditions.all().into_iter().filter(|condition| condition.model == Model::DpgmmLj);
    all.map(|condition| (condition, conditions.tree_rate(&[condition]))).collect()
}

/// Where the rate is highest; `published` if it is among those places.
fn best(rates: impl Iterator<Item = (f64, Estimate)>, published: f64, symbol: &str) -> (String, Estimate) {
    let rates: Vec<(f64, f64, usize)> =
        rates.filter_map(|(place, rate)| Some((place, rate.value?, rate.n))).collect();
    let n = rates.iter().map(|(_, _, n)| n).sum();
    let Some(highest) = rates.iter().map(|(_, rate, _)| *rate).reduce(f64::max) else {
        return ("all, since no sample is eligible".to_owned(), Estimate::default());
    };
    let best: Vec<f64> =
        rates.iter().filter(|(_, rate, _)| *rate == highest).map(|(place, ..)| *place).collect();
    // Without a rate at the published place there is nothing to compare with.
    let tested = rates.iter().any(|(place, ..)| *place == published);
    let value = if best.contains(&published) { Some(published) } else { best.first().copied() };
    let list = best.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let place = format!("{:.1} % at {symbol} = {list}", 100.0 * highest);
    (place, Estimate::bare(value.filter(|_| tested), n))
}
