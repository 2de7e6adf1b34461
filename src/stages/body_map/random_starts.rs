//! Make a body map by metric majorisation (SMACOF) from random starts, step by step as scikit-learn 0.17 to 0.19 does it.
//!
//! Those versions of 2016 to 2017 are what a program of the paper's time ran; later ones stop by another rule. Each start
//! is uniform in [0, 1)ᵈ; a step is the Guttman transform (Borg & Groenen 2005, chapter 8); the last step is that whose
//! raw stress over Σ ‖x_i‖ is hardly less than that of the step before. Nothing is rescaled. Of all starts, the map of
//! least raw stress is kept.
//!
//! A step keeps no matrix but the distances: distances within the map are made and used a few at a time.

use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::coordinates::BodyMap;
use crate::numerics::simd::vectorised;
use crate::stages::distance::Distances;

/// Points that are computed side by side.
const LANES: usize = 8;
/// What stands for a distance of 0 between two points of the map, in the unit of the distances.
const COINCIDENT: f64 = 1e-5;
/// Rows of the matrix that a thread takes at a time.
const ROWS: usize = 32;

/// A number for each of a few points.
type Lanes = [f64; LANES];

/// A map on its way from a random start to less stress.
#[derive(Debug)]
pub struct Descent<'a> {
    distances: &'a Distances,
    dims: usize,
    /// ⌈n / LANES⌉ × d: coordinate k of a few points; the last ones are padded by 0.
    blocks: Vec<Lanes>,
}

/// Where a descent ended.
#[derive(Debug)]
pub struct Descended {
    /// The map after the last step.
    pub map: BodyMap,
    /// Raw stress before the last step, which decides between starts.
    pub stress: f64,
    /// Steps taken.
    pub steps: usize,
}

impl<'a> Descent<'a> {
    /// Begins at coordinates that are uniform in [0, 1). The distances must be finite and symmetric.
    pub fn random(distances: &'a Distances, dims: usize, rng: &mut impl Rng) -> Self {
        let coordinates = (0..distances.sensors * dims).map(|_| rng.random()).collect();
        Self::new(distances, &BodyMap { dims, coordinates })
    }

    /// Begins at a map of as many points as the distances have.
    pub fn new(distances: &'a Distances, map: &BodyMap) -> Self {
        let dims = map.dims;
        let mut blocks = vec![[0.0; LANES]; distances.sensors.div_ceil(LANES) * dims];
        for (i, row) in map.coordinates.chunks_exact(dims).enumerate() {
            for (k, x) in row.iter().enumerate() {
                blocks[i / LANES * dims + k][i % LANES] = *x;
            }
        }
        Self { distances, dims, blocks }
    }

    /// Steps down until a step of at most `steps` lowers raw stress over Σ ‖x_i‖ by less than `tolerance`.
    pub fn run(mut self, steps: usize, tolerance: f64) -> Descended {
        let (mut taken, mut stress) = (0, 0.0);
        let mut before = f64::INFINITY;
        while taken < steps {
            stress = self.step();
            taken += 1;
            let relative = stress / self.norms();
            if before - relative < tolerance {
                break;
            }
            before = relative;
        }
        Descended { map: self.map(), stress, steps: taken }
    }

    /// Moves every point by the Guttman transform; returns raw stress, the sum over pairs of (distance − distance within
    /// the map)², as it was before.
    pub fn step(&mut self) -> f64 {
        let (n, dims) = (self.distances.sensors, self.dims);
        let mut moved = vec![0.0; n * dims];
        let rows = moved.par_chunks_mut(ROWS * dims).enumerate().map(|(at, moved)| {
            let mut stress = 0.0;
            let mut row = Row::new(dims);
            for (offset, moved) in moved.chunks_exact_mut(dims).enumerate() {
                let i = at * ROWS + offset;
                let own: Vec<f64> = (0..dims).map(|k| self.coordinate(i, k)).collect();
                let distances = &self.distances.values[i * n..][..n];
                vectorised(
                    #[inline(always)]
                    || row.sum(&own, distances, &self.blocks),
                );
                stress += row.finish(&own, n, moved);
            }
            stress
        });
        // Summed in the order of the rows, so that the number of threads does not change a bit.
        let stress: Vec<f64> = rows.collect();
        self.blocks = Self::new(self.distances, &BodyMap { dims, coordinates: moved }).blocks;
        0.5 * stress.iter().sum::<f64>()
    }

    fn coordinate(&self, i: usize, k: usize) -> f64 {
        self.blocks[i / LANES * self.dims + k][i % LANES]
    }

    /// Σ ‖x_i‖.
    fn norms(&self) -> f64 {
        let square = |i: usize| (0..self.dims).map(|k| self.coordinate(i, k).powi(2)).sum::<f64>();
        (0..self.distances.sensors).map(|i| square(i).sqrt()).sum()
    }

    /// The map, in the unit of the distances.
    pub fn map(&self) -> BodyMap {
        let points = 0..self.distances.sensors;
        let coordinates = points.flat_map(|i| (0..self.dims).map(move |k| self.coordinate(i, k))).collect();
        BodyMap { dims: self.dims, coordinates }
    }
}

/// Sums over all points j of one row i of the transform, a few points side by side.
struct Row {
    /// Σ_j (D_ij / d_ij) x_jk for each k.
    pulls: Vec<Lanes>,
    /// Σ_j D_ij / d_ij.
    ratios: Lanes,
    /// Σ_j (D_ij − d_ij)².
    squares: Lanes,
}

impl Row {
    fn new(dims: usize) -> Self {
        Self { pulls: vec![[0.0; LANES]; dims], ratios: [0.0; LANES], squares: [0.0; LANES] }
    }

    #[inline(always)]
    fn sum(&mut self, own: &[f64], distances: &[f64], blocks: &[Lanes]) {
        self.pulls.fill([0.0; LANES]);
        (self.ratios, self.squares) = ([0.0; LANES], [0.0; LANES]);
        let mut whole = distances.chunks_exact(LANES);
        let mut blocks = blocks.chunks_exact(own.len());
        for (distances, block) in whole.by_ref().zip(blocks.by_ref()) {
            self.add(own, distances.try_into().expect("a whole chunk"), &[1.0; LANES], block);
        }
        if let Some(block) = blocks.next() {
            let rest = whole.remainder();
            let (mut distances, mut real) = ([0.0; LANES], [0.0; LANES]);
            distances[..rest.len()].copy_from_slice(rest);
            real[..rest.len()].fill(1.0);
            self.add(own, &distances, &real, block);
        }
    }

    /// Adds a few points; `real` is 0 for padding.
    #[inline(always)]
    fn add(&mut self, own: &[f64], distances: &Lanes, real: &Lanes, block: &[Lanes]) {
        let mut squared = [0.0; LANES];
        for (own, x) in own.iter().zip(block) {
            for (squared, x) in squared.iter_mut().zip(x) {
                *squared = (own - x).mul_add(own - x, *squared);
            }
        }
        let within = squared.map(f64::sqrt);
        let mut off = [0.0; LANES];
        for (((off, real), distance), within) in off.iter_mut().zip(real).zip(distances).zip(&within) {
            *off = real * (distance - within);
        }
        let mut ratios = [0.0; LANES];
        for ((ratio, distance), within) in ratios.iter_mut().zip(distances).zip(&within) {
            *ratio = distance / if *within > 0.0 { *within } else { COINCIDENT };
        }
        multiply_add(&mut self.squares, &off, &off);
        multiply_add(&mut self.ratios, &ratios, &[1.0; LANES]);
        for (pull, x) in self.pulls.iter_mut().zip(block) {
            // By way of copies, which the compiler knows not to overlap.
            let (mut sums, x) = (*pull, *x);
            multiply_add(&mut sums, &ratios, &x);
            *pull = sums;
        }
    }

    /// Where point i moves; returns its part of the sum of squares.
    fn finish(&self, own: &[f64], n: usize, moved: &mut [f64]) -> f64 {
        let ratio: f64 = self.ratios.iter().sum();
        for ((moved, own), pull) in moved.iter_mut().zip(own).zip(&self.pulls) {
            *moved = (ratio * own - pull.iter().sum::<f64>()) / n as f64;
        }
        self.squares.iter().sum()
    }
}

/// sums += factors × numbers, lane by lane.
#[inline(always)]
fn multiply_add(sums: &mut Lanes, factors: &Lanes, numbers: &Lanes) {
    for ((sum, factor), number) in sums.iter_mut().zip(factors).zip(numbers) {
        *sum = factor.mul_add(*number, *sum);
    }
}

#[cfg(test)]
mod tests {
    use super::super::smacof::{Fit, Majorisation};
    use super::*;
    use crate::numerics::rng::stream;

    /// City-block distances between random points, which are not Euclidean.
    fn distances(n: usize) -> Distances {
        let mut rng = stream(1, 1, "city block", n);
        let points: Vec<[f64; 4]> = (0..n).map(|_| [0; 4].map(|_| rng.random_range(-1.0..1.0))).collect();
        let between = |i: usize, j: usize| (0..4).map(|k| f64::abs(points[i][k] - points[j][k])).sum();
        Distances { sensors: n, values: (0..n * n).map(|at| between(at / n, at % n)).collect() }
    }

    /// With numbers of points that fill the lanes and that do not.
    #[test]
    fn steps_are_those_of_majorisation() {
        for (n, dims) in [(5, 2), (8, 3), (40, 3), (67, 9)] {
            let distances = distances(n);
            let mut found = Descent::random(&distances, dims, &mut stream(1, 1, "start", 0));
            let mut expected = Majorisation::new(&distances, found.map(), Fit::Metric);
            for _ in 0..20 {
                let stress = expected.raw_stress();
                assert!((found.step() / stress - 1.0).abs() < 1e-12, "{n} points");
                expected.step();
                let off = found.map().coordinates.into_iter().zip(&expected.map().coordinates);
                assert!(off.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-12, "{n} points");
            }
        }
    }

    #[test]
    fn a_descent_ends_with_the_first_step_that_gains_too_little() {
        let distances = distances(30);
        let begin = || Descent::random(&distances, 3, &mut stream(1, 1, "start", 0));
        let mut stepped = begin();
        let relative: Vec<f64> = (0..60).map(|_| stepped.step() / stepped.norms()).collect();
        for tolerance in [1e-2, 1e-3] {
            let last = 1 + relative.windows(2).position(|pair| pair[0] - pair[1] < tolerance).unwrap();
            assert_eq!(begin().run(300, tolerance).steps, last + 1);
            assert!(last > 2);
        }
        assert_eq!(begin().run(2, 1e-3).steps, 2);
    }

    #[test]
    fn points_that_coincide_on_the_map_do_not_move_each_other_to_infinity() {
        let distances = distances(9);
        let mut descent = Descent::new(&distances, &BodyMap { dims: 2, coordinates: vec![0.5; 18] });
        for _ in 0..3 {
            descent.step();
        }
        assert!(descent.map().coordinates.iter().all(|x| x.is_finite()));
    }

    #[test]
    fn one_thread_and_three_give_the_same_bits() {
        let distances = distances(150);
        let map = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Descent::random(&distances, 5, &mut stream(1, 1, "start", 0)).run(30, 0.0).map)
        };
        assert_eq!(map(1), map(3));
    }
}
