//! Find what a rigid part feels of its motion, from the roots of the pressures on its sensors: a regression whose regressors
//! are unknown, too.
//!
//! A sensor at l with the outward normal n feels ρ (ṗ · n)² while it moves outward, and nothing otherwise, and ṗ · n is
//! linear in the velocity and the rate of its part, which are six numbers. So the root of a pressure is max(0, c · w): c
//! belongs to the sensor, and w, of at most six numbers, is the motion of the part. Neither is known. They are found in
//! turns by least squares over the sensors that feel something, and those that should but do not (censored regression; Tobin
//! 1958). A start comes from differences between sensors that never feel at the same time, which are opposite to each other:
//! principal components of these are linear in w. What no sensor can feel, such as the spin of a cylinder, is not in w. w is
//! known up to a linear map, which does not matter.
//!
//! Pressures that are also negative (of an incompressible medium behind a sensor, say) are roots with a sign; their principal
//! components are w.

use nalgebra::{DMatrix, DVectorView, SMatrix, SVector};

use crate::numerics::simd::vectorised;

/// Most numbers of a motion: velocity and rate of a rigid body.
pub const MAX_COMPONENTS: usize = 6;
/// Turns in which w is found at a time from given c, each with the sensors that the last one leaves wrong.
const TURNS: usize = 4;
/// Share of the strongest sensor's root at the same time from which on a sensor feels something; a weaker one only says
/// that c · w is no more than what it feels.
const FELT: f64 = 0.1;
/// Weight of no motion beside what is felt, where that leaves w undetermined.
const RIDGE: f64 = 1e-6;

/// Up to six numbers, the last ones 0.
pub type Column = SVector<f64, MAX_COMPONENTS>;

/// Runs an expression with a number of components that the compiler knows.
macro_rules! with_components {
    ($k:expr, $name:ident => $run:expr) => {
        match $k {
            1 => {
                const $name: usize = 1;
                $run
            }
            2 => {
                const $name: usize = 2;
                $run
            }
            3 => {
                const $name: usize = 3;
                $run
            }
            4 => {
                const $name: usize = 4;
                $run
            }
            5 => {
                const $name: usize = 5;
                $run
            }
            6 => {
                const $name: usize = MAX_COMPONENTS;
                $run
            }
            other => unreachable!("{other} components"),
        }
    };
}

/// Roots of the pressures on some sensors at some times.
pub struct Roots {
    /// Sensors × times.
    values: DMatrix<f64>,
    /// At each time, that from which on a sensor feels something.
    felt: Vec<f64>,
    /// Whether negative pressures are felt.
    signed: bool,
}

/// Where the turns begin: series that are linear in the motion, and their principal axes.
pub struct Start {
    unlike: DMatrix<f64>,
    axes: DMatrix<f64>,
}

/// c of some sensors and w at some times.
pub struct Fit {
    /// k.
    pub components: usize,
    /// c of each sensor; its columns are orthonormal.
    pub loadings: Vec<Column>,
    /// w at each time.
    pub motions: Vec<Column>,
    /// Share of the squares of all roots that is left.
    pub left: f64,
    /// Squares that are left of roots that tell something, for each time.
    pub residual: f64,
    /// Roots that tell something, for each time, beyond the k that w takes.
    pub spare: f64,
}

impl Roots {
    /// Of series of pressures, at these times.
    pub fn at(series: &[&[f32]], times: &[usize], signed: bool) -> Self {
        let root = |pressure: f32| match signed {
            true => f64::from(pressure.abs()).sqrt().copysign(f64::from(pressure)),
            false => f64::from(pressure.max(0.0)).sqrt(),
        };
        Self::new(
            DMatrix::from_fn(series.len(), times.len(), |sensor, t| root(series[sensor][times[t]])),
            signed,
        )
    }

    fn new(values: DMatrix<f64>, signed: bool) -> Self {
        let felt = |roots: DVectorView<f64>| {
            if signed { f64::NEG_INFINITY } else { (FELT * roots.max()).max(f64::MIN_POSITIVE) }
        };
        Self { felt: values.column_iter().map(felt).collect(), values, signed }
    }

    /// Of these sensors only.
    pub fn select(&self, sensors: &[usize]) -> Self {
        Self::new(self.values.select_rows(sensors), self.signed)
    }

    /// Divided by the root mean square of each sensor, where it feels anything.
    pub fn normalised(mut self) -> Self {
        for mut row in self.values.row_iter_mut() {
            let scale = (row.norm_squared() / row.len() as f64).sqrt();
            if scale > 0.0 {
                row /= scale;
            }
        }
        Self::new(self.values, self.signed)
    }

    /// Number of sensors.
    pub fn sensors(&self) -> usize {
        self.values.nrows()
    }

    /// Number of times.
    pub fn times(&self) -> usize {
        self.felt.len()
    }

    /// Whether nothing is felt.
    pub fn is_empty(&self) -> bool {
        self.values.iter().all(|root| *root == 0.0)
    }

    /// Where the turns begin.
    pub fn start(&self) -> Start {
        let unlike = if self.signed { self.values.clone() } else { self.differences() };
        Start { axes: principal_axes(&unlike), unlike }
    }

    /// Each sensor's root minus that of the sensor that feels least at the times at which it does.
    fn differences(&self) -> DMatrix<f64> {
        let roots = &self.values;
        let together = roots * roots.transpose();
        let opposite = |sensor: usize| {
            let alive = (0..roots.nrows()).filter(|other| together[(*other, *other)] > 0.0);
            let likeness = |other: usize| together[(sensor, other)] / together[(other, other)].sqrt();
            alive.min_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(sensor)
        };
        let opposites: Vec<usize> = (0..roots.nrows()).map(opposite).collect();
        roots - roots.select_rows(&opposites)
    }

    /// Finds c and w of k components in so many turns. k is at most [`MAX_COMPONENTS`] and the number of sensors.
    pub fn fit(&self, start: &Start, components: usize, rounds: usize) -> Fit {
        let rounds = if self.signed { 1 } else { rounds };
        with_components!(components, K => vectorised(
            #[inline(always)]
            || self.fit_of::<K>(start, rounds)
        ))
    }

    #[inline(always)]
    fn fit_of<const K: usize>(&self, start: &Start, rounds: usize) -> Fit {
        let axes = start.axes.columns(0, K);
        let mut rows: Vec<SVector<f64, K>> =
            axes.row_iter().map(|row| SVector::from_fn(|at, _| row[at])).collect();
        let first = axes.transpose() * &start.unlike;
        let mut motions: Vec<SVector<f64, K>> =
            first.column_iter().map(|column| SVector::from_fn(|at, _| column[at])).collect();
        for _ in 0..rounds {
            self.move_all(&rows, &mut motions);
            rows = self.loadings_of(&rows, &motions);
            orthonormalise(&mut rows, &mut motions);
        }
        self.move_all(&rows, &mut motions);
        let (mut left, mut residual, mut spare) = (0.0, 0.0, 0.0);
        for (t, motion) in motions.iter().enumerate() {
            let mut telling = 0;
            for (c, &root) in rows.iter().zip(self.values.column(t).iter()) {
                let reach = c.dot(motion);
                left += (root - self.felt_of(reach)).powi(2);
                if self.tells(t, root, reach) {
                    residual += (root - reach).powi(2);
                    telling += 1;
                }
            }
            spare += f64::max(0.0, f64::from(telling) - K as f64);
        }
        let times = self.times() as f64;
        Fit {
            components: K,
            loadings: rows.iter().map(padded).collect(),
            motions: motions.iter().map(padded).collect(),
            left: left / self.values.norm_squared(),
            residual: residual / times,
            spare: spare / times,
        }
    }

    /// The squares that a fit leaves at each time.
    pub fn left_at_times(&self, fit: &Fit) -> Vec<f64> {
        let left = |(t, motion): (usize, &Column)| {
            let own = |(c, root): (&Column, &f64)| (root - self.felt_of(c.dot(motion))).powi(2);
            fit.loadings.iter().zip(self.values.column(t).iter()).map(own).sum()
        };
        fit.motions.iter().enumerate().map(left).collect()
    }

    /// Whether a root says something of a motion: it is felt, or should be.
    #[inline(always)]
    fn tells(&self, t: usize, root: f64, reach: f64) -> bool {
        root >= self.felt[t] || reach > root
    }

    /// What a sensor feels of c · w.
    #[inline(always)]
    fn felt_of(&self, reach: f64) -> f64 {
        if self.signed { reach } else { reach.max(0.0) }
    }

    #[inline(always)]
    fn move_all<const K: usize>(&self, rows: &[SVector<f64, K>], motions: &mut [SVector<f64, K>]) {
        for (t, motion) in motions.iter_mut().enumerate() {
            *motion = self.motion_at(t, rows, motion);
        }
    }

    /// w at a time by least squares over the sensors that feel something, and those that should by w as it was `before`.
    #[inline(always)]
    fn motion_at<const K: usize>(
        &self,
        t: usize,
        rows: &[SVector<f64, K>],
        before: &SVector<f64, K>,
    ) -> SVector<f64, K> {
        let mut sums = Sums::default();
        for (c, &root) in rows.iter().zip(self.values.column(t).iter()) {
            if self.tells(t, root, c.dot(before)) {
                sums.add(c, root);
            }
        }
        sums.solve()
    }

    /// c of all sensors by least squares over the times at which each feels something, or should by c as it was.
    #[inline(always)]
    fn loadings_of<const K: usize>(
        &self,
        rows: &[SVector<f64, K>],
        motions: &[SVector<f64, K>],
    ) -> Vec<SVector<f64, K>> {
        let mut sums = vec![Sums::default(); rows.len()];
        for (t, motion) in motions.iter().enumerate() {
            for ((sums, c), &root) in sums.iter_mut().zip(rows).zip(self.values.column(t).iter()) {
                if self.tells(t, root, c.dot(motion)) {
                    sums.add(motion, root);
                }
            }
        }
        sums.iter().map(Sums::solve).collect()
    }

    /// w at all times from given c of k components: T × k, by time.
    pub fn motions(&self, loadings: &[Column], components: usize) -> Vec<f64> {
        with_components!(components, K => {
            let rows: Vec<SVector<f64, K>> = loadings.iter().map(cut).collect();
            let motion = |t: usize| {
                (0..TURNS).fold(SVector::<f64, K>::zeros(), |found, _| self.motion_at(t, &rows, &found))
            };
            (0..self.times()).flat_map(|t| motion(t).iter().copied().collect::<Vec<_>>()).collect()
        })
    }

    /// The share of a sensor's squares that c · w leaves with its best c, for w of k components of some part at these times; 1 if it
    /// feels nothing.
    pub fn left(&self, sensor: usize, motions: &[Column], components: usize) -> f64 {
        with_components!(components, K => vectorised(
            #[inline(always)]
            || self.left_of::<K>(sensor, motions)
        ))
    }

    #[inline(always)]
    fn left_of<const K: usize>(&self, sensor: usize, motions: &[Column]) -> f64 {
        let own: Vec<f64> = self.values.row(sensor).iter().copied().collect();
        let motions = || motions.iter().map(cut::<K>).zip(own.iter()).enumerate();
        let mut c = SVector::<f64, K>::zeros();
        for _ in 0..TURNS {
            let mut sums = Sums::default();
            for (t, (motion, &root)) in motions() {
                if self.tells(t, root, c.dot(&motion)) {
                    sums.add(&motion, root);
                }
            }
            c = sums.solve();
        }
        let left = motions().map(|(_, (motion, root))| (root - self.felt_of(c.dot(&motion))).powi(2));
        let all: f64 = own.iter().map(|root| root * root).sum();
        if all > 0.0 { left.sum::<f64>() / all } else { 1.0 }
    }
}

/// Normal equations of a regression.
#[derive(Clone)]
struct Sums<const K: usize> {
    squares: SMatrix<f64, K, K>,
    products: SVector<f64, K>,
}

impl<const K: usize> Default for Sums<K> {
    fn default() -> Self {
        Self { squares: SMatrix::zeros(), products: SVector::zeros() }
    }
}

impl<const K: usize> Sums<K> {
    #[inline(always)]
    fn add(&mut self, x: &SVector<f64, K>, y: f64) {
        self.squares += x * x.transpose();
        self.products += y * x;
    }

    /// Nearly 0 where the equations leave it open.
    #[inline(always)]
    fn solve(&self) -> SVector<f64, K> {
        let mut squares = self.squares;
        let mean = squares.trace() / K as f64;
        let ridge = if mean > 0.0 { RIDGE * mean } else { 1.0 };
        for at in 0..K {
            squares[(at, at)] += ridge;
        }
        squares.cholesky().map_or_else(SVector::zeros, |factor| factor.solve(&self.products))
    }
}

fn padded<const K: usize>(column: &SVector<f64, K>) -> Column {
    Column::from_fn(|at, _| column.get(at).copied().unwrap_or_default())
}

fn cut<const K: usize>(column: &Column) -> SVector<f64, K> {
    SVector::from_fn(|at, _| column[at])
}

/// Eigenvectors of X Xᵀ, by descending eigenvalue.
fn principal_axes(x: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = (x * x.transpose()).symmetric_eigen();
    let mut order: Vec<usize> = (0..x.nrows()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    eigen.eigenvectors.select_columns(&order)
}

/// Makes the columns of c orthonormal along its principal axes, and turns w with it.
fn orthonormalise<const K: usize>(rows: &mut [SVector<f64, K>], motions: &mut [SVector<f64, K>]) {
    let loadings = DMatrix::from_fn(rows.len(), K, |row, at| rows[row][at]);
    let svd = loadings.svd(true, true);
    let (left, right) = (svd.u.expect("it was asked for"), svd.v_t.expect("it was asked for"));
    for (at, row) in rows.iter_mut().enumerate() {
        *row = SVector::from_fn(|column, _| left[(at, column)]);
    }
    let turn = SMatrix::<f64, K, K>::from_fn(|row, column| svd.singular_values[row] * right[(row, column)]);
    motions.iter_mut().for_each(|motion| *motion = turn * *motion);
}
