//! Find the pieces of some sensors, each of one motion, by K-subspaces (Bradley and Mangasarian 2000) for a rising K.

use faer::Mat;
use kodama::Method;

use super::cluster::{Cluster, Felt};
use super::completion::Completion;
use super::search::{MIN_CLUSTER, MIN_SENSORS, smallest};
use crate::numerics::linkage;

/// Most pieces that are looked for at once.
const MAX_PIECES: usize = 6;
/// Most rounds of looking for pieces among the sensors that are left.
const MAX_ROUNDS: usize = 4;
/// Most iterations of K-subspaces.
const MAX_ITERATIONS: usize = 12;

/// The clusters of these sensors that one motion each explains to the tolerance, and the sensors that are in none.
pub(super) fn pieces(felt: &Felt, sensors: &[usize]) -> (Vec<Cluster>, Vec<usize>) {
    let (mut found, mut rest) = (Vec::new(), sensors.to_vec());
    for _ in 0..MAX_ROUNDS {
        if rest.len() < MIN_SENSORS {
            break;
        }
        let (more, left) = pieces_once(felt, &rest);
        if more.is_empty() {
            break;
        }
        found.extend(more);
        rest = left;
    }
    (found.into_iter().map(|own| Cluster::learned_longer(felt, own)).collect(), rest)
}

/// The same without looking again among those that are left. The completion of a few sensors shows what that of all hides.
fn pieces_once(outer: &Felt, sensors: &[usize]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let roots = outer.roots.select_as_they_are(sensors);
    let completion = Completion::new(&roots, outer.parameters.completion_ridge);
    let felt = Felt {
        roots,
        completed: completion.velocities,
        sizes: outer.sizes.clone(),
        memory: outer.memory.clone(),
        ..*outer
    };
    let limit = felt.explained();
    let whole = Cluster::learned_longer(&felt, (0..sensors.len()).collect());
    if whole.variance() <= limit {
        return (vec![sensors.to_vec()], Vec::new());
    }
    let limit = f64::min(limit, whole.variance() / felt.parameters.min_piece_gain);
    let mut best = Vec::new();
    for k in 2..=MAX_PIECES.min(2 * sensors.len() / MIN_SENSORS) {
        let mut found = k_subspaces(&felt, &completion.affinities, k);
        found.retain(|own| {
            own.variance() <= limit
                && own.freedom >= felt.parameters.min_freedom
                && !is_two(&felt, &completion.affinities, own)
        });
        if count(&found) > count(&best) {
            best = found;
        }
        if count(&best) == sensors.len() {
            break;
        }
    }
    let members = nearest(&felt, &best, limit);
    let named = |own: Vec<usize>| own.into_iter().map(|at| sensors[at]).collect::<Vec<_>>();
    let found: Vec<Vec<usize>> =
        members.into_iter().filter(|own| own.len() >= MIN_CLUSTER).map(named).collect();
    let rest = sensors.iter().copied().filter(|sensor| !found.iter().any(|own| own.contains(sensor)));
    let rest = rest.collect();
    (found, rest)
}

/// Whether two halves of a cluster have nothing in common: faces of two parts, say, of rank three each. One motion of rank six explains
/// both exactly.
fn is_two(felt: &Felt, affinities: &Mat<f64>, cluster: &Cluster) -> bool {
    let sensors = &cluster.sensors;
    let halves =
        linkage::clusters(sensors.len(), |i, j| 1.0 - affinities[(sensors[i], sensors[j])], Method::Ward, 2);
    let half = |label| {
        let own = sensors.iter().zip(&halves).filter(|(_, half)| **half == label);
        Cluster::new(felt, own.map(|(sensor, _)| *sensor).collect())
    };
    let both = Cluster::new(felt, sensors.clone());
    half(0).description_length + half(1).description_length - both.description_length
        <= felt.parameters.min_saving
}

/// Sensors in these clusters.
fn count(clusters: &[Cluster]) -> usize {
    clusters.iter().map(|own| own.sensors.len()).sum()
}

/// All sensors in at most K clusters, each on that whose motion leaves it the smallest residual. The start is by Ward's method on the
/// affinities.
fn k_subspaces(felt: &Felt, affinities: &Mat<f64>, k: usize) -> Vec<Cluster> {
    let distance = |i: usize, j: usize| 1.0 - affinities[(i, j)];
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); k];
    for (sensor, label) in
        linkage::clusters(affinities.nrows(), distance, Method::Ward, k).into_iter().enumerate()
    {
        members[label].push(sensor);
    }
    for _ in 0..MAX_ITERATIONS {
        members.retain(|own| own.len() >= MIN_CLUSTER);
        let found: Vec<Cluster> = members.iter().map(|own| Cluster::widest(felt, own.clone())).collect();
        let now = nearest(felt, &found, f64::INFINITY);
        if now == members {
            break;
        }
        members = now;
    }
    members.retain(|own| own.len() >= MIN_CLUSTER);
    members.into_iter().map(|own| Cluster::learned_longer(felt, own)).collect()
}

/// For each cluster, the sensors that it leaves the smallest residual of all, no more than `most`.
fn nearest(felt: &Felt, clusters: &[Cluster], most: f64) -> Vec<Vec<usize>> {
    let residuals: Vec<Vec<f64>> = clusters.iter().map(|own| own.residuals(felt)).collect();
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); clusters.len()];
    for sensor in 0..felt.roots.sensors() {
        let best = smallest(residuals.iter().map(|own| own[sensor]));
        if let Some((best, _)) = best.filter(|(_, least)| *least <= most) {
            members[best].push(sensor);
        }
    }
    members
}

#[cfg(test)]
mod tests;
