//! Find what a rigid part feels of its motion, from the roots of the pressures on its sensors: a regression whose regressors
//! are unknown, too.
//!
//! A sensor at l with the outward normal n feels ρ (ṗ · n)² while it moves outward, and nothing otherwise, and ṗ · n is
//! linear in the velocity and the rate of its part, which are six numbers. So the root of a pressure is max(0, c · w): c
//! belongs to the sensor, and w, of at most six numbers, is the motion of the part. Neither is known. They are found in
//! turns by least squares over the sensors that feel something, and those that should but do not (censored regression; Tobin
//! 1958). A start comes from differences between sensors that never feel at the same time, which are opposite to each other:
//! principal components of these are linear in w. What no sensor can simulate_and_sense, such as the spin of a cylinder, is not in w. w is
//! known up to a linear map, which does not matter.
//!
//! Pressures that are also negative (of an incompressible medium behind a sensor, say) are roots with a sign; their principal
//! components are w.

use faer::Mat;
use rayon::prelude::*;

use super::turns::Turns;
use crate::numerics::eigen::largest;

/// Most numbers of a motion: velocity and rate of a rigid body.
pub const MAX_COMPONENTS: usize = 6;
/// Turns in which c is found from given w, or w from given c, each with the roots that the last one leaves wrong.
const TURNS: usize = 4;
/// Share of the strongest sensor's root at the same time from which on a sensor feels something; a weaker one only says
/// that c · w is no more than what it feels.
const FELT: f64 = 0.1;
/// Share of the largest of what c spans along its axes, squared, from which on an axis is one.
const SPANNED: f64 = 1e-12;
/// Sensors whose share is found at once.
const SENSORS: usize = 64;

/// Roots of the pressures on some sensors at some times.
pub struct Roots {
    /// Times × sensors.
    values: Mat<f64>,
    /// At each time, that from which on a sensor feels something.
    felt: Vec<f64>,
    /// Whether negative pressures are felt.
    signed: bool,
}

/// c of some sensors and w at some times, up to six components, the most important first: where the turns begin.
pub struct Start {
    /// Sensors × components.
    loadings: Mat<f64>,
    /// Times × components.
    motions: Mat<f64>,
}

/// c of some sensors and w at some times.
pub struct Fit {
    /// Sensors × k; the columns are orthonormal.
    loadings: Mat<f64>,
    /// Times × k.
    motions: Mat<f64>,
    /// Squares that are left of roots that tell something, for each time.
    pub residual: f64,
    /// Roots that tell something, for each time, beyond the k that w takes.
    pub spare: f64,
}

impl Start {
    /// Most components.
    pub fn components(&self) -> usize {
        self.loadings.ncols()
    }
}

impl Fit {
    /// k.
    pub fn components(&self) -> usize {
        self.loadings.ncols()
    }

    /// Number of sensors.
    pub fn sensors(&self) -> usize {
        self.loadings.nrows()
    }

    /// Number of times.
    pub fn times(&self) -> usize {
        self.motions.nrows()
    }

    /// The sum of w wᵀ over times.
    pub fn scatter(&self) -> Mat<f64> {
        self.motions.transpose() * &self.motions
    }
}

impl Roots {
    /// Of series of pressures, at these times.
    pub fn at(series: &[&[f32]], times: &[usize], signed: bool) -> Self {
        let root = |pressure: f32| match signed {
            true => f64::from(pressure.abs()).sqrt().copysign(f64::from(pressure)),
            false => f64::from(pressure.max(0.0)).sqrt(),
        };
        let values = Mat::from_fn(times.len(), series.len(), |t, sensor| root(series[sensor][times[t]]));
        Self::new(values, signed)
    }

    fn new(values: Mat<f64>, signed: bool) -> Self {
        let felt = if signed {
            vec![f64::NEG_INFINITY; values.nrows()]
        } else {
            let mut most = vec![0.0; values.nrows()];
            for sensor in 0..values.ncols() {
                let roots = values.col_as_slice(sensor);
                most.iter_mut().zip(roots).for_each(|(most, root)| *most = f64::max(*most, *root));
            }
            most.into_iter().map(|most| f64::max(FELT * most, f64::MIN_POSITIVE)).collect()
        };
        Self { values, felt, signed }
    }

    /// Of these sensors only.
    pub fn select(&self, sensors: &[usize]) -> Self {
        Self::new(columns(&self.values, sensors), self.signed)
    }

    /// Divided by the root mean square of each sensor, where it feels anything.
    pub fn normalised(mut self) -> Self {
        for sensor in 0..self.sensors() {
            let roots = self.values.col_as_slice_mut(sensor);
            let scale = (roots.iter().map(|root| root * root).sum::<f64>() / roots.len() as f64).sqrt();
            if scale > 0.0 {
                roots.iter_mut().for_each(|root| *root /= scale);
            }
        }
        Self::new(self.values, self.signed)
    }

    /// Means over times: of the products of two sensors' roots, sensors × sensors, and of each sensor's roots.
    pub fn moments(&self) -> (Mat<f64>, Vec<f64>) {
        let share = 1.0 / self.times().max(1) as f64;
        let mean = |sensor| self.values.col_as_slice(sensor).iter().sum::<f64>() * share;
        let means = (0..self.sensors()).map(mean).collect();
        (self.values.transpose() * &self.values * faer::Scale(share), means)
    }

    /// Number of sensors.
    pub fn sensors(&self) -> usize {
        self.values.ncols()
    }

    /// Number of times.
    pub fn times(&self) -> usize {
        self.values.nrows()
    }

    /// Whether nothing is felt.
    pub fn is_empty(&self) -> bool {
        self.values.norm_max() == 0.0
    }

    /// Where the turns begin: along the principal axes of series that are linear in the motion.
    pub fn start(&self) -> Start {
        let unlike = if self.signed { self.values.clone() } else { self.differences() };
        let loadings = principal_axes(&(unlike.transpose() * &unlike));
        Start { motions: &unlike * &loadings, loadings }
    }

    /// Each sensor's root minus that of the sensor that feels least at the times at which it does.
    fn differences(&self) -> Mat<f64> {
        let together = self.values.transpose() * &self.values;
        let opposite = |sensor: usize| {
            let alive = (0..self.sensors()).filter(|other| together[(*other, *other)] > 0.0);
            let likeness = |other: usize| together[(sensor, other)] / together[(other, other)].sqrt();
            alive.min_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(sensor)
        };
        let opposites: Vec<usize> = (0..self.sensors()).map(opposite).collect();
        &self.values - columns(&self.values, &opposites)
    }

    /// Finds c and w of k components in so many turns. k is at most that of the start.
    pub fn fit(&self, start: &Start, components: usize, rounds: usize) -> Fit {
        let rounds = if self.signed { 1 } else { rounds };
        let mut loadings = start.loadings.subcols(0, components).to_owned();
        let mut motions = start.motions.subcols(0, components).to_owned();
        let turns = Turns::new(self.values.as_ref(), &self.felt);
        for _ in 0..rounds {
            turns.move_all(loadings.as_ref(), &mut motions);
            turns.load_all(loadings.as_mut(), &motions);
            orthonormalise(&mut loadings, &mut motions);
        }
        turns.move_all(loadings.as_ref(), &mut motions);
        let [residual, spare] = turns.residual_and_spare(loadings.as_ref(), &motions);
        Fit { residual, spare, loadings, motions }
    }

    /// The share of the squares of all roots that a fit leaves.
    pub fn left_of_all(&self, fit: &Fit) -> f64 {
        self.left_at_times(fit).iter().sum::<f64>() / self.values.squared_norm_l2()
    }

    /// The squares that a fit leaves at each time.
    pub fn left_at_times(&self, fit: &Fit) -> Vec<f64> {
        let mut left = vec![0.0; self.times()];
        let reaches = &fit.motions * fit.loadings.transpose();
        for sensor in 0..self.sensors() {
            let own = reaches.col_as_slice(sensor).iter().zip(self.values.col_as_slice(sensor));
            for (left, (reach, root)) in left.iter_mut().zip(own) {
                *left += (root - self.felt_of(*reach)).powi(2);
            }
        }
        left
    }

    /// What a sensor feels of c · w.
    fn felt_of(&self, reach: f64) -> f64 {
        if self.signed { reach } else { reach.max(0.0) }
    }

    /// w at all times from given c, of a fit to the same sensors at other times: T × k, by time.
    pub fn motions(&self, fit: &Fit) -> Vec<f64> {
        let k = fit.components();
        let mut motions = Mat::zeros(self.times(), k);
        let turns = Turns::new(self.values.as_ref(), &self.felt);
        (0..TURNS).for_each(|_| turns.move_all(fit.loadings.as_ref(), &mut motions));
        (0..self.times()).flat_map(|t| (0..k).map(move |at| (t, at))).map(|at| motions[at]).collect()
    }

    /// The best c of each sensor for w of a fit to any sensors at these times: sensors × k.
    pub fn loadings(&self, fit: &Fit) -> Mat<f64> {
        self.some_loadings(fit, 0, self.sensors())
    }

    /// The same of so many sensors from one on.
    fn some_loadings(&self, fit: &Fit, first: usize, count: usize) -> Mat<f64> {
        let mut loadings = Mat::zeros(count, fit.components());
        let turns = Turns::new(self.values.subcols(first, count), &self.felt);
        (0..TURNS).for_each(|_| turns.load_all(loadings.as_mut(), &fit.motions));
        loadings
    }

    /// The share of each sensor's squares that c · w leaves with its best c, for w of a fit to any sensors at these times; 1 if it
    /// feels nothing.
    pub fn left(&self, fit: &Fit) -> Vec<f64> {
        let firsts: Vec<usize> = (0..self.sensors()).step_by(SENSORS).collect();
        let left = |sensor: usize| {
            let count = SENSORS.min(self.sensors() - sensor);
            let loadings = self.some_loadings(fit, sensor, count);
            let reaches = &fit.motions * loadings.transpose();
            let share = |at: usize| {
                let roots = self.values.col_as_slice(sensor + at);
                let all: f64 = roots.iter().map(|root| root * root).sum();
                let left = roots.iter().zip(reaches.col_as_slice(at));
                let left: f64 = left.map(|(root, reach)| (root - self.felt_of(*reach)).powi(2)).sum();
                if all > 0.0 { left / all } else { 1.0 }
            };
            (0..count).map(share).collect::<Vec<f64>>()
        };
        firsts.into_par_iter().flat_map(left).collect()
    }
}

/// Some columns.
fn columns(matrix: &Mat<f64>, which: &[usize]) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), which.len(), |row, at| matrix[(row, which[at])])
}

/// The first eigenvectors, by descending eigenvalue.
fn principal_axes(squares: &Mat<f64>) -> Mat<f64> {
    largest(squares.as_ref(), MAX_COMPONENTS).map_or_else(
        |_| Mat::identity(squares.nrows(), MAX_COMPONENTS.min(squares.nrows())),
        |eigen| eigen.vectors,
    )
}

/// Makes the columns of c orthonormal along its principal axes, and turns w with it.
fn orthonormalise(loadings: &mut Mat<f64>, motions: &mut Mat<f64>) {
    let Ok(eigen) = largest((loadings.transpose() * &*loadings).as_ref(), loadings.ncols()) else { return };
    let least = SPANNED * eigen.values[0];
    let turn = |scale: &dyn Fn(f64) -> f64| {
        Mat::from_fn(eigen.vectors.nrows(), eigen.vectors.ncols(), |row, at| {
            let value = eigen.values[at];
            if value > least { eigen.vectors[(row, at)] * scale(value.sqrt()) } else { 0.0 }
        })
    };
    *loadings = &*loadings * turn(&f64::recip);
    *motions = &*motions * turn(&|span| span);
}
