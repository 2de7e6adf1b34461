//! Find what a part feels of its own motion at all times: a few numbers for each, from the pressures on its sensors.

use rayon::prelude::*;

use super::censored::{Fit, MAX_COMPONENTS, Roots};
use super::faces::faces;
use crate::stages::sense::Tactile;

/// Sensors of a part that are read, spread over all: enough for six numbers.
const MAX_SENSORS: usize = 256;
/// Times that c is learned from, spread over all at which anything is felt.
const TIMES: usize = 2000;
/// Turns in which c and w are found.
const ROUNDS: usize = 16;
/// Share of what six numbers explain that fewer may leave unexplained.
const NEGLIGIBLE: f64 = 0.01;
/// Components from which on the sensors of a face say something of how a part turns. The end of a thin cylinder says one.
pub const LEAST_COMPONENTS: usize = 3;
/// Components of a face from which on it may be told from others by what it feels: more than the end of a thin cylinder has.
pub const LEAST_OF_FACE: usize = 2;

/// What a part feels of its own motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// k, at most [`MAX_COMPONENTS`](super::MAX_COMPONENTS) of one set of sensors; 0 if it feels nothing.
    pub components: usize,
    /// T × k, by time, in √Pa; along the principal axes of what the sensors feel.
    pub values: Vec<f64>,
}

impl Motion {
    /// w at a time.
    pub fn at(&self, t: usize) -> &[f64] {
        &self.values[t * self.components..][..self.components]
    }

    /// Of this motion and another at the same times.
    pub fn with(&self, other: &Self) -> Self {
        if self.components == 0 || other.components == 0 {
            return if self.components == 0 { other.clone() } else { self.clone() };
        }
        let samples = self.values.len() / self.components;
        let values = (0..samples).flat_map(|t| [self.at(t), other.at(t)].concat()).collect();
        Self { components: self.components + other.components, values }
    }
}

/// What a part feels of its own motion, from the series of its sensors.
///
/// `components` is k; without it, the fewest that explain nearly what six do. `signed` says whether negative pressures are
/// felt. All series have T pressures, which must be finite.
pub fn motion(series: &[&[f32]], components: Option<usize>, signed: bool) -> Motion {
    /// Times whose roots are gathered at once.
    const BLOCK: usize = 240;
    let series: Vec<&[f32]> = spread(series.len(), MAX_SENSORS).map(|sensor| series[sensor]).collect();
    let samples = series.first().map_or(0, |series| series.len());
    let Some(fit) = learn(&Roots::at(&series, &felt_times(&series, samples), signed), components) else {
        return Motion { components: 0, values: Vec::new() };
    };
    let k = fit.components();
    let mut values = vec![0.0; samples * k];
    values.par_chunks_mut(BLOCK * k).enumerate().for_each(|(block, values)| {
        let times: Vec<usize> = (block * BLOCK..block * BLOCK + values.len() / k).collect();
        let roots = Roots::at(&series, &times, signed);
        values.copy_from_slice(&roots.motions(&fit));
    });
    Motion { components: k, values }
}

/// What a part feels of its own motion, from the series of all of its sensors: of its large faces together, and of each face that
/// alone feels one or two numbers by itself, since few such sensors would hardly count among the rest. Where that gives more than six
/// numbers, faces share some, and all are taken together.
pub fn whole_motion(series: &[&[f32]], signed: bool) -> Motion {
    let samples = series.first().map_or(0, |series| series.len());
    let times: Vec<usize> = spread(samples, TIMES).collect();
    let every: Vec<usize> = (0..series.len()).collect();
    let faces = faces(&Roots::at(series, &times, signed), &every);
    let largest = faces.iter().map(Vec::len).max().unwrap_or(0);
    let of =
        |face: &[usize]| motion(&face.iter().map(|&sensor| series[sensor]).collect::<Vec<_>>(), None, signed);
    let by_itself = |face: &Vec<usize>| {
        (face.len() < largest).then(|| of(face)).filter(|own| own.components < LEAST_COMPONENTS)
    };
    let alone: Vec<Option<Motion>> = faces.par_iter().map(by_itself).collect();
    let rest = faces.iter().zip(&alone).filter(|(_, own)| own.is_none()).flat_map(|(face, _)| face);
    let mut rest: Vec<usize> = rest.copied().collect();
    rest.sort_unstable();
    let whole = alone.iter().flatten().fold(of(&rest), |whole, own| whole.with(own));
    if whole.components > MAX_COMPONENTS { of(&every) } else { whole }
}

/// Times that c is learned from, of those at which a sensor feels anything.
fn felt_times(series: &[&[f32]], samples: usize) -> Vec<usize> {
    let felt: Vec<usize> =
        (0..samples).into_par_iter().filter(|t| series.iter().any(|series| series[*t] != 0.0)).collect();
    spread(felt.len(), TIMES).map(|at| felt[at]).collect()
}

/// At most `most` of 0, …, n − 1, evenly spread: one of each stretch of equal length, not always at the same place of it, so that
/// nothing that repeats itself, such as the sensors of a ring, is always met at the same place.
pub fn spread(n: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = n.min(most);
    (0..count).map(move |at| {
        let (from, to) = (at * n / count, (at + 1) * n / count);
        // Multiples of the golden ratio's fraction of 2⁶⁴ are spread evenly.
        let place = (at as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        from + ((place * (to - from) as u64) >> 32) as usize
    })
}

/// Share of all that is felt from which on negative pressures are felt, too; fewer are taken for noise about 0.
const SIGNED: f64 = 0.01;

/// Whether negative pressures say something.
pub fn is_signed(tactile: &Tactile) -> bool {
    let sums = |series: &[f32]| {
        series.iter().fold((0.0, 0.0), |(below, all), pressure| {
            let size = f64::from(pressure.abs());
            (if *pressure < 0.0 { below + size } else { below }, all + size)
        })
    };
    let sums: Vec<(f64, f64)> = tactile.pressures.par_chunks_exact(tactile.samples).map(sums).collect();
    let (below, all) = sums.into_iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    below > SIGNED * all
}

/// c and w; `None` if nothing is felt.
fn learn(roots: &Roots, components: Option<usize>) -> Option<Fit> {
    if roots.is_empty() {
        return None;
    }
    let start = roots.start();
    let most = start.components();
    if let Some(k) = components {
        return Some(roots.fit(&start, k.min(most), ROUNDS));
    }
    let with = |k: usize| {
        let fit = roots.fit(&start, k, ROUNDS);
        (roots.left_of_all(&fit), fit)
    };
    let fits: Vec<(f64, Fit)> = (1..=most).into_par_iter().map(with).collect();
    let least = fits.iter().map(|(left, _)| *left).fold(f64::INFINITY, f64::min);
    fits.into_iter().find(|(left, _)| left - least <= NEGLIGIBLE * (1.0 - least)).map(|(_, fit)| fit)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// Motions of k numbers that simulate_movement, and the pressures of sensors with random c: T × k, and M series.
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
