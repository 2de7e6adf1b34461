//! Find what a part feels of its own motion: a few numbers for each time, from the pressures on its sensors.
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

use nalgebra::{DMatrix, DVectorView, RowDVector, SMatrix, SVector};
use rayon::prelude::*;

use crate::stages::sense::Tactile;

/// Most numbers of a motion: velocity and rate of a rigid body.
pub const MAX_COMPONENTS: usize = 6;
/// Sensors of a part that are read, spread over all: enough for six numbers.
const MAX_SENSORS: usize = 256;
/// Times that c is learned from, spread over all.
const TIMES: usize = 2000;
/// Turns in which c and w are found.
const ROUNDS: usize = 16;
/// Turns in which w is found at a time from given c, each with the sensors that the last one leaves wrong.
const TURNS: usize = 4;
/// Share of the strongest sensor's root at the same time from which on a sensor feels something; a weaker one only says
/// that c · w is no more than what it feels.
const FELT: f64 = 0.1;
/// Share of what six numbers explain that fewer may leave unexplained.
const NEGLIGIBLE: f64 = 0.01;
/// Weight of no motion beside what is felt, where that leaves w undetermined.
const RIDGE: f64 = 1e-6;

type Square = SMatrix<f64, MAX_COMPONENTS, MAX_COMPONENTS>;
/// Up to six numbers, the last ones 0.
pub type Column = SVector<f64, MAX_COMPONENTS>;

/// What a part feels of its own motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// k, at most [`MAX_COMPONENTS`]; 0 if the part feels nothing.
    pub components: usize,
    /// T × k, by time, in √Pa; along the principal axes of what the sensors feel.
    pub values: Vec<f64>,
}

impl Motion {
    /// w at a time.
    pub fn at(&self, t: usize) -> &[f64] {
        &self.values[t * self.components..][..self.components]
    }
}

/// What a part feels of its own motion, from the series of its sensors.
///
/// `components` is k; without it, the fewest that explain nearly what six do. `signed` says whether negative pressures are
/// felt. All series have T pressures, which must be finite.
pub fn motion(series: &[&[f32]], components: Option<usize>, signed: bool) -> Motion {
    /// Times whose roots are gathered at once.
    const BLOCK: usize = 256;
    let series: Vec<&[f32]> = spread(series.len(), MAX_SENSORS).map(|sensor| series[sensor]).collect();
    let samples = series.first().map_or(0, |series| series.len());
    let Some(loadings) = Roots::at(&series, spread(samples, TIMES), signed).learn(components) else {
        return Motion { components: 0, values: Vec::new() };
    };
    let k = loadings.ncols();
    let rows = rows(&loadings);
    let mut values = vec![0.0; samples * k];
    values.par_chunks_mut(BLOCK * k).enumerate().for_each(|(block, values)| {
        let roots = Roots::at(&series, block * BLOCK..block * BLOCK + values.len() / k, signed);
        for (t, motion) in values.chunks_exact_mut(k).enumerate() {
            motion.copy_from_slice(&roots.motion(t, &rows, k).as_slice()[..k]);
        }
    });
    Motion { components: k, values }
}

/// At most `most` of 0, …, n − 1, evenly spread.
fn spread(n: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = n.min(most);
    (0..count).map(move |at| at * n / count)
}

/// What all sensors of a body feel at some times, spread over all.
pub struct Felt {
    roots: Roots,
}

impl Felt {
    /// Of M × T pressures.
    pub fn new(tactile: &Tactile) -> Self {
        let series: Vec<&[f32]> = tactile.series().collect();
        Self { roots: Roots::at(&series, spread(tactile.samples, TIMES), is_signed(tactile)) }
    }

    /// The motion of a part with these sensors at these times, and the number of its components, which the data choose if it
    /// is not given.
    pub fn motions(&self, sensors: &[usize], components: Option<usize>) -> (Vec<Column>, usize) {
        let own: Vec<usize> = spread(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        let roots = Roots::new(self.roots.values.select_rows(&own), self.roots.signed);
        let Some(loadings) = roots.learn(components) else {
            return (vec![Column::zeros(); roots.felt.len()], 0);
        };
        let (rows, k) = (rows(&loadings), loadings.ncols());
        let motion = |t: usize| roots.motion(t, &rows, k);
        ((0..roots.felt.len()).into_par_iter().map(motion).collect(), k)
    }

    /// The share of a sensor's squares that c · w leaves with its best c, for w of some part.
    pub fn left(&self, sensor: usize, motions: &[Column]) -> f64 {
        let own = self.roots.values.row(sensor);
        let mut c = Column::zeros();
        for _ in 0..TURNS {
            let (mut squares, mut products) = (Square::zeros(), Column::zeros());
            for ((motion, &root), &felt) in motions.iter().zip(own.iter()).zip(&self.roots.felt) {
                if root >= felt || c.dot(motion) > root {
                    squares += motion * motion.transpose();
                    products += root * motion;
                }
            }
            c = solve(squares, &products, MAX_COMPONENTS);
        }
        let left = motions
            .iter()
            .zip(own.iter())
            .map(|(motion, root)| (root - self.roots.predicted(&c, motion)).powi(2));
        left.sum::<f64>() / own.norm_squared()
    }
}

/// Whether any pressure is negative.
pub fn is_signed(tactile: &Tactile) -> bool {
    tactile.pressures.par_iter().any(|pressure| *pressure < 0.0)
}

/// Roots of the pressures on some sensors at some times.
struct Roots {
    /// Sensors × times.
    values: DMatrix<f64>,
    /// At each time, that from which on a sensor feels something.
    felt: Vec<f64>,
    /// Whether negative pressures are felt.
    signed: bool,
}

impl Roots {
    fn at(series: &[&[f32]], times: impl Iterator<Item = usize>, signed: bool) -> Self {
        let times: Vec<usize> = times.collect();
        let root = |pressure: f32| f64::from(pressure.abs()).sqrt().copysign(f64::from(pressure));
        let values = DMatrix::from_fn(series.len(), times.len(), |sensor, t| root(series[sensor][times[t]]));
        Self::new(values, signed)
    }

    fn new(values: DMatrix<f64>, signed: bool) -> Self {
        let felt = |roots: DVectorView<f64>| {
            if signed { f64::NEG_INFINITY } else { (FELT * roots.max()).max(f64::MIN_POSITIVE) }
        };
        Self { felt: values.column_iter().map(felt).collect(), values, signed }
    }

    /// What a sensor with this c feels of a motion.
    fn predicted(&self, c: &Column, motion: &Column) -> f64 {
        if self.signed { c.dot(motion) } else { c.dot(motion).max(0.0) }
    }

    /// c of each sensor, by rows, with orthonormal columns along the principal axes; `None` if nothing is felt.
    fn learn(&self, components: Option<usize>) -> Option<DMatrix<f64>> {
        if self.values.iter().all(|root| *root == 0.0) {
            return None;
        }
        let unlike = if self.signed { self.values.clone() } else { self.differences() };
        let axes = principal_axes(&unlike);
        let most = MAX_COMPONENTS.min(axes.ncols());
        let fit = |k: usize| self.fit(&unlike, axes.columns(0, k).into_owned());
        if let Some(k) = components {
            return Some(fit(k.min(most)).0);
        }
        let fits: Vec<(DMatrix<f64>, f64)> = (1..=most).into_par_iter().map(fit).collect();
        let least = fits.iter().map(|(_, left)| *left).fold(f64::INFINITY, f64::min);
        fits.into_iter().find(|(_, left)| left - least <= NEGLIGIBLE * (1.0 - least)).map(|(c, _)| c)
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

    /// Finds c and w in turns; returns c with orthonormal columns, and the share of squares that they leave.
    fn fit(&self, unlike: &DMatrix<f64>, start: DMatrix<f64>) -> (DMatrix<f64>, f64) {
        let k = start.ncols();
        let mut motions: Vec<Column> = (start.transpose() * unlike).column_iter().map(filled).collect();
        let mut loadings = start;
        let all_motions = |loadings: &DMatrix<f64>, motions: &[Column]| -> Vec<Column> {
            let rows = rows(loadings);
            motions.iter().enumerate().map(|(t, motion)| self.motion_at(t, &rows, k, motion)).collect()
        };
        for _ in 0..if self.signed { 1 } else { ROUNDS } {
            motions = all_motions(&loadings, &motions);
            let (axes, turned) = orthonormal(&self.loadings_of(&motions, &rows(&loadings), k));
            loadings = axes;
            motions.iter_mut().for_each(|motion| *motion = filled((&turned * motion.rows(0, k)).column(0)));
        }
        let rows = rows(&loadings);
        let motions = all_motions(&loadings, &motions);
        let left = |(t, motion): (usize, &Column)| -> f64 {
            let off = |(c, root): (&Column, &f64)| (root - self.predicted(c, motion)).powi(2);
            rows.iter().zip(self.values.column(t).iter()).map(off).sum()
        };
        (loadings, motions.iter().enumerate().map(left).sum::<f64>() / self.values.norm_squared())
    }

    /// w at a time from given c.
    fn motion(&self, t: usize, rows: &[Column], k: usize) -> Column {
        (0..TURNS).fold(Column::zeros(), |found, _| self.motion_at(t, rows, k, &found))
    }

    /// w at a time by least squares over the sensors that feel something, and those that should by w as it was `before`.
    fn motion_at(&self, t: usize, rows: &[Column], k: usize, before: &Column) -> Column {
        let (mut squares, mut products) = (Square::zeros(), Column::zeros());
        for (c, &root) in rows.iter().zip(self.values.column(t).iter()) {
            if root >= self.felt[t] || c.dot(before) > root {
                squares += c * c.transpose();
                products += root * c;
            }
        }
        solve(squares, &products, k)
    }

    /// c of all sensors by least squares over the times at which each feels something, or should by c as it was.
    fn loadings_of(&self, motions: &[Column], rows: &[Column], k: usize) -> DMatrix<f64> {
        let mut sums = vec![(Square::zeros(), Column::zeros()); rows.len()];
        for (t, motion) in motions.iter().enumerate() {
            let outer = motion * motion.transpose();
            for ((sums, c), &root) in sums.iter_mut().zip(rows).zip(self.values.column(t).iter()) {
                if root >= self.felt[t] || c.dot(motion) > root {
                    sums.0 += outer;
                    sums.1 += root * motion;
                }
            }
        }
        let solved: Vec<Column> =
            sums.iter().map(|(squares, products)| solve(*squares, products, k)).collect();
        DMatrix::from_fn(rows.len(), k, |sensor, at| solved[sensor][at])
    }
}

/// A column, filled up with 0.
fn filled(column: DVectorView<f64>) -> Column {
    Column::from_fn(|at, _| column.get(at).copied().unwrap_or_default())
}

/// c of each sensor, filled up with 0.
fn rows(loadings: &DMatrix<f64>) -> Vec<Column> {
    let row = |row: RowDVector<f64>| filled(row.transpose().column(0));
    loadings.row_iter().map(|own| row(own.into_owned())).collect()
}

/// Eigenvectors of X Xᵀ, by descending eigenvalue.
fn principal_axes(x: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = (x * x.transpose()).symmetric_eigen();
    let mut order: Vec<usize> = (0..x.nrows()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    eigen.eigenvectors.select_columns(&order)
}

/// The solution of the normal equations in the first k components, nearly 0 where they leave it open.
fn solve(mut squares: Square, products: &Column, k: usize) -> Column {
    let mean = squares.trace() / k as f64;
    for at in 0..MAX_COMPONENTS {
        squares[(at, at)] += if at < k && mean > 0.0 { RIDGE * mean } else { 1.0 };
    }
    squares.cholesky().map_or_else(Column::zeros, |factor| factor.solve(products))
}

/// The same span with orthonormal columns, and what turns w with it.
fn orthonormal(loadings: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let svd = loadings.clone().svd(true, true);
    let (left, right) = (svd.u.expect("it was asked for"), svd.v_t.expect("it was asked for"));
    (left, DMatrix::from_diagonal(&svd.singular_values) * right)
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// Motions of k numbers that wander, and the pressures of sensors with random c: T × k, and M series.
    fn felt(k: usize, sensors: usize, signed: bool) -> (DMatrix<f64>, Vec<Vec<f32>>) {
        let samples = 3000;
        let mut rng = stream(1, 1, "felt", k);
        let mut normal = || (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
        let mut w = DMatrix::zeros(samples, k);
        for t in 1..samples {
            for at in 0..k {
                w[(t, at)] = 0.9 * w[(t - 1, at)] + normal() / (1.0 + at as f64);
            }
        }
        let c: DMatrix<f64> = DMatrix::from_fn(k, sensors, |_, _| normal());
        let roots = &w * &c;
        let pressure =
            |root: &f64| if signed { (root * root.abs()) as f32 } else { root.max(0.0).powi(2) as f32 };
        let series = roots.column_iter().map(|root| root.iter().map(pressure).collect()).collect();
        (w, series)
    }

    /// The share of squares of the true motion that no linear map of what was found explains.
    fn unexplained(w: &DMatrix<f64>, found: &Motion) -> f64 {
        let x = DMatrix::from_row_slice(w.nrows(), found.components, &found.values);
        let fitted = &x * x.clone().svd(true, true).solve(w, 1e-12).unwrap();
        (w - fitted).norm_squared() / w.norm_squared()
    }

    #[test]
    fn a_motion_is_found_up_to_a_linear_map() {
        for (k, signed) in [(2, false), (4, false), (6, false), (4, true)] {
            let (w, series) = felt(k, 40, signed);
            let series: Vec<&[f32]> = series.iter().map(Vec::as_slice).collect();
            let found = motion(&series, Some(k), signed);
            let off = unexplained(&w, &found);
            assert!(off < 0.05, "k = {k}, signed {signed}: {off}");
            // A motion of fewer numbers is not the whole.
            let fewer = unexplained(&w, &motion(&series, Some(k - 1), signed));
            assert!(fewer > off + 0.02, "k = {k}, signed {signed}: {fewer}");
        }
    }

    #[test]
    fn the_data_choose_the_number_of_components() {
        for (k, signed) in [(2, false), (3, false), (4, true)] {
            let (_, series) = felt(k, 40, signed);
            let series: Vec<&[f32]> = series.iter().map(Vec::as_slice).collect();
            assert_eq!(motion(&series, None, signed).components, k);
        }
    }

    #[test]
    fn no_touch_is_no_motion() {
        let still = [0.0_f32; 50];
        assert_eq!(motion(&[&still, &still], None, false).components, 0);
        assert_eq!(motion(&[], None, false).components, 0);
        // A single sensor that feels one time of all.
        let mut once = still;
        once[49] = 1.0;
        let found = motion(&[&once], None, false);
        assert!(found.values.iter().all(|value| value.is_finite()));
    }
}
