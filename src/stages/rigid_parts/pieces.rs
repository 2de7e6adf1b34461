//! Find the pieces of some sensors, each of one motion, by K-subspaces (Bradley and Mangasarian 2000) for a rising K.

use faer::Mat;
use kodama::Method;

use super::cluster::{Cluster, Felt, MIN_FREEDOM};
use super::completion::Completion;
use super::search::{EXPLAINED, MIN_CLUSTER, MIN_SAVING, MIN_SENSORS, smallest};
use crate::numerics::linkage;

/// How many times less variance a piece must leave than one motion of all sensors does. Pieces of a rigid part with noise, or with a
/// small error of the model, leave almost as much as the part.
const SHARPER: f64 = 30.0;
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
    (found.into_iter().map(|own| Cluster::converged(felt, own)).collect(), rest)
}

/// The same without looking again among those that are left. The completion of a few sensors shows what that of all hides.
fn pieces_once(outer: &Felt, sensors: &[usize]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let roots = outer.roots.select_as_they_are(sensors);
    let completion = Completion::new(&roots);
    let felt = Felt { roots, completed: completion.velocities, sizes: outer.sizes.clone(), ..*outer };
    let limit = EXPLAINED * felt.tolerance;
    let whole = Cluster::converged(&felt, (0..sensors.len()).collect());
    if whole.variance() <= limit {
        return (vec![sensors.to_vec()], Vec::new());
    }
    let limit = f64::min(limit, whole.variance() / SHARPER);
    let mut best = Vec::new();
    for k in 2..=MAX_PIECES.min(2 * sensors.len() / MIN_SENSORS) {
        let mut found = k_subspaces(&felt, &completion.affinities, k);
        found.retain(|own| {
            own.variance() <= limit
                && own.freedom >= MIN_FREEDOM
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
    half(0).description_length + half(1).description_length - both.description_length <= MIN_SAVING
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
    members.into_iter().map(|own| Cluster::converged(felt, own)).collect()
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
mod tests {
    use rand::RngExt;

    use super::super::roots::Roots;
    use super::*;
    use crate::numerics::rng::stream;

    /// What 24 sensors on each of two parts feel, whose motions of rank four differ by a share of their size; and noise of such a size,
    /// as a share of the largest root.
    fn felt(difference: f64, noise: f64) -> Felt {
        let mut rng = stream(1, 1, "pieces", 0);
        let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
        let motion = uniform(500, 4);
        let other = &motion + uniform(500, 4) * faer::Scale(difference);
        let velocities = [motion * uniform(4, 24), other * uniform(4, 24)];
        let errors = uniform(500, 48);
        let values = Mat::from_fn(500, 48, |t, sensor| {
            (velocities[sensor / 24][(t, sensor % 24)] + noise * errors[(t, sensor)]).max(0.0)
        });
        let sizes = vec![1.0; 500];
        let roots = Roots { values, thresholds: sizes.clone(), signed: false }.equalised(&sizes, 0.0);
        let completed = Completion::new(&roots).velocities;
        Felt { roots, completed, sizes, tolerance: 2e-5, iterations: [24, 100] }
    }

    fn found(felt: &Felt) -> (Vec<Vec<usize>>, Vec<usize>) {
        let (found, rest) = pieces(felt, &(0..48).collect::<Vec<_>>());
        (found.into_iter().map(|own| own.sensors).collect(), rest)
    }

    #[test]
    fn parts_that_hardly_move_against_each_other_are_told_apart() {
        let felt = felt(0.1, 0.0);
        let whole = Cluster::converged(&felt, (0..48).collect());
        assert!(
            (1e-4..1e-2).contains(&whole.variance()),
            "one motion nearly explains both: {}",
            whole.variance()
        );
        // A sensor whose velocity hardly differs may be on either.
        let (mut found, rest) = found(&felt);
        found.sort();
        let wrong = |own: &Vec<usize>, part: usize| own.iter().filter(|sensor| *sensor / 24 != part).count();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(wrong(&found[0], 0) + wrong(&found[1], 1) + rest.len() <= 2, "{found:?} {rest:?}");
    }

    #[test]
    fn one_part_is_one_piece_and_noise_makes_none() {
        assert_eq!(found(&felt(0.0, 0.0)), (vec![(0..48).collect()], vec![]));
        for difference in [0.0, 0.1] {
            assert_eq!(found(&felt(difference, 0.1)), (vec![], (0..48).collect()), "{difference}");
        }
    }
}
