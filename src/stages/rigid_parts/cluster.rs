//! Give a cluster of sensors its motion subspace and its description length (Ma et al. 2007).
//!
//! The description length is what it takes to encode what the sensors feel up to a tolerance. The motion at a sample takes
//! ½ ln det(I + Σ c cᵀ / tolerance), for components of variance 1: as much as the roots tell of it that are felt then. Each of these
//! beyond takes ½ ln(1 + the residual variance over the tolerance). Both are the likelihood of probabilistic principal components
//! (Tipping and Bishop 1999). Each loading takes ½ ln n over n, for n samples (Schwarz 1978). Clusters of one part share components,
//! so that their union is shorter than both.

use faer::{Mat, MatRef};

use super::als::Als;
use super::factorisation::{MAX_RANK, principal_axes};
use super::loadings::{components, leverages, solved, whitened};
use super::log_determinant::log_determinant;
use super::memory::{Memory, key};
use super::roots::{Roots, columns, product};
use super::stratified::stratified;
use crate::stages::parameters::Parameters;

/// Sensors of a cluster that its motion is learned from, spread over all.
pub(super) const MAX_SENSORS: usize = 48;
/// Sensors of a group that are tried with a cluster, and of the cluster that they are tried with. They are as many, so that neither decides
/// alone what the motion is, and together so few that it is learned from all.
pub(super) const MAX_GROUP: usize = MAX_SENSORS / 2;
/// Iterations in which the motion of a cluster is learned; and more where it is in doubt whether one motion explains it, or with one component
/// more.
pub(super) const ITERATIONS: [usize; 2] = [8, 24];
/// Iterations in which c of other sensors is found from given w: where completed roots start it, and at most from nothing. A sensor that feels
/// something at few samples takes the most.
const LOADING_ITERATIONS: [usize; 2] = [2, 30];
/// Momentum of these iterations: the least and the largest.
const MOMENTUM: [f64; 2] = [0.5, 0.98];
/// Its factors while the residual falls, and when it grew.
const PACE: [f64; 2] = [1.1, 0.5];
/// Residual variance at which more iterations say nothing new.
pub(super) const ROUNDING: f64 = 1e-11;
/// Leverage above which a sensor spans a component alone: all others together tell less than a tenth of it.
const LEVERAGE: f64 = 0.9;

pub(super) mod evidence;
mod minimum;
mod shares;

/// What some sensors of a body felt, and what completes it.
pub(super) struct Felt {
    /// Scaled by sensor and by sample.
    pub roots: Roots,
    /// Samples × sensors: the roots where they are felt, and elsewhere what completes them.
    pub completed: Mat<f64>,
    /// The size that the roots at each sample were divided by.
    pub sizes: Vec<f64>,
    /// Residual variance that is encoded as noise is.
    pub tolerance: f64,
    /// Iterations in which the motion of a cluster is learned; and more where it is in doubt whether one motion explains it, or with one component
    /// more.
    pub iterations: [usize; 2],
    /// The parameters of the search.
    pub parameters: Parameters,
    /// Motions that were learned.
    pub memory: Memory<Learned>,
}

impl Felt {
    /// The largest residual variance that one motion explains.
    pub(super) fn explained(&self) -> f64 {
        self.parameters.max_residual * self.tolerance
    }

    /// Weight of a completed root in the first iterations, and in more.
    pub(super) fn weights(&self) -> [f64; 2] {
        [self.parameters.completed_weight, self.parameters.late_completed_weight]
    }

    /// What a root that is not felt tells of w, as a share of what one tells that is felt: all at the least tolerance of the search or
    /// below, since it is completed as exactly, and next to nothing with noise.
    fn told_by_censored(&self) -> f64 {
        f64::min(1.0, self.parameters.min_tolerance / self.tolerance).powi(2)
    }
}

/// What is learned of a cluster. What completes its roots follows from the loadings and the motion.
#[derive(Clone)]
pub(super) struct Learned {
    loadings: Mat<f64>,
    motion: Mat<f64>,
    components: Vec<f64>,
    residual: f64,
    freedom: f64,
    description_length: f64,
}

/// A cluster of sensors.
#[derive(Clone)]
pub(super) struct Cluster {
    /// In ascending order.
    pub sensors: Vec<usize>,
    /// Those that the motion is learned from.
    pub representatives: Vec<usize>,
    /// c of these, sensors × k.
    loadings: Mat<f64>,
    /// w, samples × k.
    motion: Mat<f64>,
    /// Their roots where they are felt, and elsewhere what completes them: samples × sensors.
    completed: Mat<f64>,
    /// Variances of the components, descending: the sum of the sensors' variances along each.
    components: Vec<f64>,
    /// Residual sum of squares of the informative roots, on average over samples.
    residual: f64,
    /// Degrees of freedom of that residual: informative roots beyond the k that w takes, on average over samples.
    pub freedom: f64,
    /// Description length per sample, in nats; see the head of this file.
    pub description_length: f64,
    /// Whether its motion was learned in more iterations.
    is_learned: bool,
}

impl Cluster {
    /// Learns the motion of sensors, with the rank of the shortest description.
    pub(super) fn new(felt: &Felt, sensors: Vec<usize>) -> Self {
        let mut best = Self::of_rank(felt, sensors, MAX_RANK);
        loop {
            let present = best.present(felt, felt.tolerance);
            if present == 0 || present >= best.rank() {
                return best;
            }
            let less = Self::of_rank(felt, best.sensors.clone(), present);
            if less.description_length >= best.description_length {
                return best;
            }
            best = less;
        }
    }

    /// Learns the motion of sensors with this rank, or as much as so many sensors have.
    pub(super) fn of_rank(felt: &Felt, mut sensors: Vec<usize>, rank: usize) -> Self {
        sensors.sort_unstable();
        let representatives: Vec<usize> =
            stratified(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        let rank = rank.min(representatives.len().saturating_sub(1)).max(1);
        let completed = columns(&felt.completed, &representatives);
        let (loadings, motion) = principal_motion(&completed, rank);
        let mut cluster = Self {
            sensors,
            representatives,
            loadings,
            motion,
            completed,
            components: Vec::new(),
            residual: 0.0,
            freedom: 0.0,
            description_length: 0.0,
            is_learned: false,
        };
        cluster.learn(felt, felt.iterations[0], felt.weights()[0]);
        cluster
    }

    /// The union of two clusters.
    pub(super) fn union(felt: &Felt, a: &Self, b: &Self) -> Self {
        Self::new(felt, [a.sensors.as_slice(), &b.sensors].concat())
    }

    /// Learns the motion in more iterations, and with lower ranks, as long as the description gets shorter.
    pub(super) fn learn_with_least_rank(&mut self, felt: &Felt) {
        self.learn_longer(felt);
        while self.rank() > 1 {
            let mut less = Self::of_rank(felt, self.sensors.clone(), self.rank() - 1);
            less.learn_longer(felt);
            if less.description_length >= self.description_length {
                break;
            }
            *self = less;
        }
    }

    /// Learns the motion of sensors with the largest rank.
    pub(super) fn widest(felt: &Felt, sensors: Vec<usize>) -> Self {
        Self::of_rank(felt, sensors, MAX_RANK)
    }

    /// The same in more iterations.
    pub(super) fn learned_longer(felt: &Felt, sensors: Vec<usize>) -> Self {
        let mut cluster = Self::widest(felt, sensors);
        cluster.learn_longer(felt);
        cluster
    }

    /// Learns the motion in more iterations.
    pub(super) fn learn_longer(&mut self, felt: &Felt) {
        if !self.is_learned || self.variance() > felt.tolerance {
            self.learn(felt, felt.iterations[1], felt.weights()[1]);
            // Beyond, it is of several parts.
            let most = felt.parameters.max_open_residual * felt.tolerance.max(felt.parameters.min_tolerance);
            if self.variance() > felt.tolerance && self.variance() <= most {
                self.leave_minimum(felt);
            }
            self.is_learned = true;
        }
    }

    /// c of the representatives, sensors × k, for which each component of w has a variance of 1.
    pub(super) fn whitened_loadings(&self) -> Mat<f64> {
        whitened(&self.loadings, &self.motion)
    }

    /// Representatives that span a component of the motion alone, if there are enough of them to tell. Such a component explains its
    /// sensor whatever that feels.
    pub(super) fn alone(&self) -> Vec<usize> {
        let leverages = leverages(&self.loadings);
        let is_alone = |at: &usize| leverages[*at] > LEVERAGE && leverages.len() > 2 * self.rank();
        (0..leverages.len()).filter(is_alone).map(|at| self.representatives[at]).collect()
    }

    /// k, the rank of the motion subspace.
    pub(super) fn rank(&self) -> usize {
        self.loadings.ncols()
    }

    /// How many components are more than residual.
    pub(super) fn present(&self, felt: &Felt, tolerance: f64) -> usize {
        let least = felt.parameters.min_component * tolerance;
        self.components.iter().filter(|variance| **variance > least).count()
    }

    /// Whether two clusters have components in common: their union has fewer than both. What is below `min_tolerance` may be an error
    /// of the model, and is no component.
    pub(super) fn have_common(a: &Self, b: &Self, union: &Self, felt: &Felt) -> bool {
        let tolerance = felt.tolerance.max(felt.parameters.min_tolerance);
        let present = |own: &Self| own.present(felt, tolerance);
        present(union) < present(a) + present(b)
    }

    /// Residual variance of an informative root.
    pub(super) fn variance(&self) -> f64 {
        variance(self.residual, self.freedom)
    }

    /// Replaces what completes the roots of these sensors by what this motion gives.
    pub(super) fn complete_roots(&self, felt: &mut Felt) {
        for (at, &sensor) in self.representatives.iter().enumerate() {
            felt.completed.col_mut(sensor).copy_from(self.completed.col(at));
        }
    }

    /// c · w of the representatives, samples × sensors.
    pub(super) fn predicted(&self) -> Mat<f64> {
        product(self.motion.as_ref(), self.loadings.transpose())
    }

    /// Residual variance of the informative roots of one of the representatives, 0 for another sensor.
    pub(super) fn residual_of(&self, felt: &Felt, sensor: usize) -> f64 {
        let Ok(at) = self.representatives.binary_search(&sensor) else { return 0.0 };
        let own = felt.roots.select_as_they_are(&[sensor]);
        let loadings = self.loadings.as_ref().subrows(at, 1);
        let residuals = Als::new(own.values.as_ref(), &own.thresholds).residuals(loadings, &self.motion);
        residuals.into_iter().map(per_root).sum()
    }

    /// Residual variance of the informative roots of each sensor by this motion.
    pub(super) fn residuals(&self, felt: &Felt) -> Vec<f64> {
        self.residuals_among(felt, &felt.roots, felt.completed.as_ref())
    }

    /// The same of some sensors, in their order.
    pub(super) fn residuals_of(&self, felt: &Felt, sensors: &[usize]) -> Vec<f64> {
        let completed = columns(&felt.completed, sensors);
        self.residuals_among(felt, &felt.roots.select_as_they_are(sensors), completed.as_ref())
    }

    /// The same of sensors with these roots, and what completes them.
    fn residuals_among(&self, felt: &Felt, roots: &Roots, completed: MatRef<'_, f64>) -> Vec<f64> {
        let squares = product(self.motion.transpose(), self.motion.as_ref());
        let products = product(completed.transpose(), self.motion.as_ref());
        let mut loadings = solved(&squares, &products);
        let als = Als::new(roots.values.as_ref(), &roots.thresholds);
        let with_completed =
            Als::new(roots.values.as_ref(), &roots.thresholds).with_completed(completed, felt.weights()[0]);
        for _ in 0..LOADING_ITERATIONS[0] {
            with_completed.update_loadings(loadings.as_mut(), &self.motion);
        }
        als.residuals(loadings.as_ref(), &self.motion).into_iter().map(per_root).collect()
    }

    /// Learns the motion in so many iterations from what it is, or remembers what that gave.
    fn learn(&mut self, felt: &Felt, iterations: usize, weight: f64) {
        let own = felt.roots.select_as_they_are(&self.representatives);
        let numbers = [felt.tolerance, weight, iterations as f64, self.sensors.len() as f64];
        let key = key(
            &[&numbers, own.thresholds.as_slice()].concat(),
            &[&own.values, &self.completed, &self.loadings, &self.motion],
        );
        match felt.memory.get(key) {
            Some(known) => self.adopt(&known, &own),
            None => self.alternate(felt, &own, iterations, weight, key),
        }
    }

    /// Takes what was learned from roots that were completed as these are.
    fn adopt(&mut self, known: &Learned, own: &Roots) {
        let Learned { loadings, motion, components, residual, freedom, description_length } = known.clone();
        Als::new(own.values.as_ref(), &own.thresholds).complete(
            loadings.as_ref(),
            &motion,
            &mut self.completed,
        );
        (self.loadings, self.motion, self.components) = (loadings, motion, components);
        (self.residual, self.freedom) = (residual, freedom);
        self.description_length = description_length;
    }

    /// Alternates least squares, and finds what the motion leaves. Remembers it by a key if all iterations were made, since only then the last
    /// motion completes the roots.
    fn alternate(&mut self, felt: &Felt, own: &Roots, iterations: usize, weight: f64, key: u64) {
        let is_whole = self.iterate(felt, own, iterations, weight);
        let plain = Als::new(own.values.as_ref(), &own.thresholds);
        let [residual, freedom] = plain.residual(self.loadings.as_ref(), &self.motion);
        let whitened = self.whitened_loadings();
        (self.residual, self.freedom, self.components) = (residual, freedom, components(&whitened));
        self.description_length = self.description_length(felt, own, &whitened);
        if is_whole {
            let (loadings, motion) = (self.loadings.clone(), self.motion.clone());
            let components = self.components.clone();
            let Self { residual, freedom, description_length, .. } = *self;
            felt.memory
                .add(key, Learned { loadings, motion, components, residual, freedom, description_length });
        }
    }

    /// Alternates least squares with momentum, which is lost when the residual grows. Returns whether all iterations were made.
    fn iterate(&mut self, felt: &Felt, own: &Roots, iterations: usize, weight: f64) -> bool {
        let (values, thresholds) = (own.values.as_ref(), &own.thresholds);
        let plain = Als::new(values, thresholds);
        let Self { loadings, motion, completed, .. } = self;
        Als::new(values, thresholds)
            .with_completed(completed.as_ref(), weight)
            .update_motion(loadings.as_ref(), motion);
        let mut last = loadings.clone();
        let (mut momentum, mut before) = (MOMENTUM[0], f64::INFINITY);
        for iteration in 0..iterations {
            let als = Als::new(values, thresholds).with_completed(completed.as_ref(), weight);
            let mut next = loadings.clone();
            als.update_loadings(next.as_mut(), motion);
            let [residual, freedom] = plain.residual(next.as_ref(), motion);
            if felt.tolerance < felt.parameters.min_tolerance && residual <= ROUNDING * freedom {
                *loadings = next;
                return false;
            }
            let mut step = 0.0;
            if residual > before {
                momentum = f64::max(MOMENTUM[0], momentum * PACE[1]);
            } else {
                momentum = f64::min(MOMENTUM[1], momentum * PACE[0]);
                step = if iteration == 0 { 0.0 } else { momentum };
            }
            before = residual;
            *loadings = Mat::from_fn(next.nrows(), next.ncols(), |i, j| {
                next[(i, j)] + step * (next[(i, j)] - last[(i, j)])
            });
            last = next;
            als.update_motion(loadings.as_ref(), motion);
            plain.complete(loadings.as_ref(), motion, completed);
        }
        true
    }

    /// In: the roots of the representatives, and their c for which each component of w has a variance of 1.
    fn description_length(&self, felt: &Felt, roots: &Roots, whitened: &Mat<f64>) -> f64 {
        let tolerance = felt.tolerance;
        let (sensors, samples) = (self.sensors.len() as f64, self.motion.nrows() as f64);
        // The motion may be learned from a share of the sensors only.
        let ratio = sensors / self.representatives.len() as f64;
        let motion = log_determinant(roots, whitened, ratio / tolerance, felt.told_by_censored());
        let residual =
            if self.freedom > 0.0 { (self.residual / self.freedom / tolerance).ln_1p() } else { 0.0 };
        let loadings = sensors * self.rank() as f64 * samples.ln() / samples;
        0.5 * (motion + ratio * self.freedom * residual + loadings)
    }
}

/// c and w where the iterations start: so many principal components of completed roots, samples × sensors.
fn principal_motion(completed: &Mat<f64>, rank: usize) -> (Mat<f64>, Mat<f64>) {
    let loadings = principal_axes(completed, rank);
    let motion = product(completed.as_ref(), loadings.as_ref());
    (loadings, motion)
}

/// The residual variance of a sum of squares with so many degrees of freedom.
fn variance(residual: f64, freedom: f64) -> f64 {
    residual / freedom.max(0.1)
}

/// The residual variance of a sum of squares of so many roots; of one more, so that there is a variance of none.
fn per_root([sum, count]: [f64; 2]) -> f64 {
    sum / (count + 1.0)
}
