//! Compare what parts feel of their joints: quadratic forms of their motions that are the same at all times.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::motion::Motion;

/// Weight of a time at which the whole body hardly moves, in units of its mean square.
const REST: f64 = 1e-3;
/// What is added to the variances of products, as a share of their mean: forms of hardly any variance are noise.
const RIDGE: f64 = 1e-5;
/// Turns in which forms are made positive, and explain each other.
const ROUNDS: usize = 6;

/// Sums over times of the products of all quadratic monomials of all motions, by blocks of times.
#[derive(Debug, Clone)]
pub struct Moments {
    /// Where the monomials of each part begin, and where the last end.
    starts: Vec<usize>,
    /// For each block, monomials × monomials.
    blocks: Vec<DMatrix<f64>>,
}

impl Moments {
    /// Of the motions of all parts at the same T times, in blocks of nearly equal length.
    ///
    /// A monomial is w_i w_j divided by the root of the whole body's Σ |w|² at the time, so that fast times count in
    /// proportion to speed, not to its square.
    pub fn new(motions: &[Motion], samples: usize, blocks: usize) -> Self {
        let mut starts = vec![0];
        for Motion { components: k, .. } in motions {
            starts.push(starts[starts.len() - 1] + k * (k + 1) / 2);
        }
        let all = starts[motions.len()];
        let scales = scales(motions, samples);
        let block = |at: usize| {
            let times = at * samples / blocks..(at + 1) * samples / blocks;
            let mut monomials = DMatrix::zeros(times.len(), all);
            for (row, t) in times.enumerate() {
                let mut column = 0;
                for motion in motions {
                    let w = motion.at(t);
                    for i in 0..w.len() {
                        for j in i..w.len() {
                            monomials[(row, column)] = scales[t] * w[i] * w[j];
                            column += 1;
                        }
                    }
                }
            }
            monomials.transpose() * &monomials
        };
        let moves = scales.iter().any(|scale| *scale > 0.0);
        let blocks = if moves { (0..blocks).into_par_iter().map(block).collect() } else { Vec::new() };
        Self { starts, blocks }
    }

    /// Number of blocks; none if nothing moves.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// The sum over blocks, each counted so many times.
    pub fn sum(&self, counts: &[usize]) -> DMatrix<f64> {
        let all = self.starts[self.starts.len() - 1];
        let mut sum = DMatrix::zeros(all, all);
        for (block, &count) in self.blocks.iter().zip(counts).filter(|(_, count)| **count > 0) {
            sum.zip_apply(block, |sum, moment| *sum += moment * count as f64);
        }
        sum
    }

    /// The [`correlations`] over all blocks.
    pub fn of_all(&self) -> DMatrix<f64> {
        self.correlations(&self.sum(&vec![1; self.blocks()]))
    }

    /// The [`correlations`] from a sum of these moments.
    pub fn correlations(&self, sum: &DMatrix<f64>) -> DMatrix<f64> {
        correlations(sum, &self.starts)
    }
}

/// What monomials are divided by, inverted: the root of the whole body's Σ |w|² at each time, times its mean; 0 if nothing moves.
pub fn scales(motions: &[Motion], samples: usize) -> Vec<f64> {
    let energy = |t: usize| -> f64 { motions.iter().flat_map(|motion| motion.at(t)).map(|w| w * w).sum() };
    let energies: Vec<f64> = (0..samples).into_par_iter().map(energy).collect();
    let mean = energies.iter().sum::<f64>() / samples.max(1) as f64;
    let scale = |energy: f64| if mean > 0.0 { 1.0 / (mean * (energy + REST * mean)).sqrt() } else { 0.0 };
    energies.into_iter().map(scale).collect()
}

/// The quadratic forms of one part's motion.
pub struct Forms {
    /// Which two numbers of the motion each monomial is the product of, the second not before the first.
    pairs: Vec<(usize, usize)>,
    /// The size of each number of the motion.
    scales: Vec<f64>,
    /// Sums over times of the products of two monomials, with a ridge.
    moments: DMatrix<f64>,
    /// The lower factor of the moments.
    factor: DMatrix<f64>,
}

impl Forms {
    /// From the moments of these monomials; `None` if the part feels nothing.
    pub fn new(pairs: Vec<(usize, usize)>, mut moments: DMatrix<f64>) -> Option<Self> {
        let n = moments.nrows();
        if n == 0 {
            return None;
        }
        let numbers = pairs.iter().map(|pair| pair.1 + 1).max().unwrap_or(0);
        let mut scales = vec![0.0; numbers];
        for (at, (i, _)) in pairs.iter().enumerate().filter(|(_, (i, j))| i == j) {
            scales[*i] = moments[(at, at)].max(0.0).sqrt().sqrt();
        }
        let ridge = RIDGE * moments.trace() / n as f64;
        (0..n).for_each(|at| moments[(at, at)] += ridge);
        let factor = moments.clone().cholesky()?.unpack();
        Some(Self { pairs, scales, moments, factor })
    }

    /// The nearest form that is nowhere negative, as a square of a speed is: nearest by its coefficients, with each number of the motion
    /// in the unit of its size.
    fn positive(&self, form: &DVector<f64>) -> DVector<f64> {
        let n = self.scales.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (&(i, j), coefficient) in self.pairs.iter().zip(form.iter()) {
            let share = if i == j { *coefficient } else { 0.5 * coefficient };
            matrix[(i, j)] = share * self.scales[i] * self.scales[j];
            matrix[(j, i)] = matrix[(i, j)];
        }
        let mut eigen = matrix.symmetric_eigen();
        eigen.eigenvalues.apply(|value| *value = value.max(0.0));
        let matrix = eigen.recompose();
        let coefficient = |(i, j): (usize, usize)| {
            let scale = self.scales[i] * self.scales[j];
            let twice = if i == j { 1.0 } else { 2.0 };
            if scale > 0.0 { twice * matrix[(i, j)] / scale } else { 0.0 }
        };
        DVector::from_iterator(form.len(), self.pairs.iter().copied().map(coefficient))
    }

    /// The root of the sum of squares of a form over times.
    fn length(&self, form: &DVector<f64>) -> f64 {
        (form.transpose() * &self.moments * form)[(0, 0)].max(0.0).sqrt()
    }

    /// The form that explains most of what these products say.
    fn explain(&self, products: &DVector<f64>) -> DVector<f64> {
        let half = self.factor.solve_lower_triangular(products).expect("a factor is regular");
        self.factor.tr_solve_lower_triangular(&half).expect("a factor is regular")
    }

    /// Whether a form is rather negative than positive.
    fn is_negative(&self, form: &DVector<f64>) -> bool {
        let own = self.pairs.iter().zip(form.iter()).filter(|((i, j), _)| i == j);
        own.map(|((i, _), coefficient)| coefficient * self.scales[*i].powi(2)).sum::<f64>() < 0.0
    }
}

/// The largest cosine between a quadratic form of one part's motion and one of another's, both nowhere negative, as the square of a
/// speed is; 0 where a part feels nothing.
///
/// The start is their first canonical correlation (Hotelling 1936) without a constant, for a form is 0 at rest. Then each form is
/// made positive, and explains the other, in turns, of which the best counts: a lower bound of the largest.
pub fn agreement(first: &Option<Forms>, second: &Option<Forms>, both: &DMatrix<f64>) -> f64 {
    let (Some(first), Some(second)) = (first, second) else { return 0.0 };
    let half = first.factor.solve_lower_triangular(both).expect("a factor is regular");
    let whole = second.factor.solve_lower_triangular(&half.transpose()).expect("a factor is regular");
    let svd = whole.svd(true, true);
    let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else { return 0.0 };
    let at = svd.singular_values.imax();
    let mut b =
        second.factor.tr_solve_lower_triangular(&u.column(at).into_owned()).expect("a factor is regular");
    let mut a = first.factor.tr_solve_lower_triangular(&v.row(at).transpose()).expect("a factor is regular");
    if first.is_negative(&a) {
        (a, b) = (-a, -b);
    }
    let mut best = 0.0;
    for _ in 0..ROUNDS {
        let (own, other) = (first.positive(&a), second.positive(&b));
        let lengths = first.length(&own) * second.length(&other);
        if lengths <= 0.0 {
            break;
        }
        let products = both * &other;
        best = f64::max(best, own.dot(&products) / lengths);
        (a, b) = (first.explain(&products), second.explain(&both.tr_mul(&own)));
    }
    best.clamp(0.0, 1.0)
}

/// The monomials of k numbers.
pub fn monomials(k: usize) -> Vec<(usize, usize)> {
    (0..k).flat_map(|i| (i..k).map(move |j| (i, j))).collect()
}

/// For each pair of parts, how well both know the same speed: the largest cosine between quadratic forms of their motions.
///
/// `moments` are sums of products of monomials, which begin for each part at `starts`. Out: parts × parts, 0 to 1,
/// symmetric, 1 on the diagonal.
pub fn correlations(moments: &DMatrix<f64>, starts: &[usize]) -> DMatrix<f64> {
    let parts = starts.len() - 1;
    let length = |part: usize| starts[part + 1] - starts[part];
    let block =
        |a: usize, b: usize| moments.view((starts[a], starts[b]), (length(a), length(b))).into_owned();
    let numbers = |part: usize| (0..).find(|k| k * (k + 1) / 2 == length(part)).expect("whole");
    let forms: Vec<_> =
        (0..parts).map(|part| Forms::new(monomials(numbers(part)), block(part, part))).collect();
    let mut cosines = DMatrix::identity(parts, parts);
    for (a, b) in (0..parts).flat_map(|a| (a + 1..parts).map(move |b| (a, b))) {
        cosines[(a, b)] = agreement(&forms[a], &forms[b], &block(a, b));
        cosines[(b, a)] = cosines[(a, b)];
    }
    cosines
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// Two planar parts whose frames turn against each other at random, and which share the velocity of a joint; and a third
    /// that shares nothing. Each feels two numbers of velocity and one of its rate.
    fn motions(samples: usize) -> Vec<Motion> {
        let mut rng = stream(1, 1, "joint speed", 0);
        let mut values = vec![Vec::new(); 3];
        for _ in 0..samples {
            let mut uniform = || rng.random_range(-1.0..1.0);
            let (joint, angle, rates) = ([uniform(), uniform()], 3.0 * uniform(), [uniform(), uniform()]);
            let (sine, cosine) = f64::sin_cos(angle);
            let turned = [cosine * joint[0] - sine * joint[1], sine * joint[0] + cosine * joint[1]];
            // v = the joint's velocity − ω × l, with l along x.
            values[0].extend([joint[0], joint[1] - 0.7 * rates[0], rates[0]]);
            values[1].extend([turned[0], turned[1] + 0.4 * rates[1], rates[1]]);
            values[2].extend([uniform(), uniform(), uniform()]);
        }
        values.into_iter().map(|values| Motion { components: 3, values }).collect()
    }

    #[test]
    fn parts_that_share_a_joint_know_its_speed() {
        let motions = motions(5000);
        let moments = Moments::new(&motions, 5000, 7);
        let found = moments.correlations(&moments.sum(&[1; 7]));
        // The ridge takes some thousandths.
        assert!(found[(0, 1)] > 0.995, "{found}");
        assert!(found[(0, 2)] < 0.95 && found[(1, 2)] < 0.95, "{found}");
        assert!(found == found.transpose());
        // No linear form of the one is one of the other: the joint bends.
        let column = |part: usize, at: usize| motions[part].values.iter().skip(at).step_by(3).copied();
        let product = |a: usize, b: usize| column(0, a).zip(column(1, b)).map(|(x, y)| x * y).sum::<f64>();
        assert!((0..3).all(|a| (0..3).all(|b| product(a, b).abs() < 0.15 * 5000.0 / 3.0)));
    }

    #[test]
    fn a_speed_is_not_the_difference_of_two_squares() {
        // The first part lacks a number of its motion, and the second one has it instead: only with a minus do both agree.
        let motions = motions(5000);
        let numbers = |part: usize, at: &[usize]| -> Vec<Vec<f64>> {
            at.iter().map(|at| motions[part].values.iter().skip(*at).step_by(3).copied().collect()).collect()
        };
        let together = |columns: Vec<Vec<f64>>| Motion {
            components: columns.len(),
            values: (0..5000)
                .flat_map(|t| columns.iter().map(move |column| column[t]).collect::<Vec<_>>())
                .collect(),
        };
        let lacks = together(numbers(0, &[1, 2]));
        let has = together([numbers(1, &[0, 1, 2]), numbers(0, &[0])].concat());
        let agreement = |a: Motion, b: Motion| {
            let moments = Moments::new(&[a, b], 5000, 1);
            moments.correlations(&moments.sum(&[1]))[(0, 1)]
        };
        let right = agreement(motions[0].clone(), motions[1].clone());
        let wrong = agreement(lacks, has);
        assert!(wrong < right - 0.02, "{wrong} {right}");
    }

    #[test]
    fn a_part_that_feels_nothing_agrees_with_none() {
        let mut motions = motions(100);
        motions.push(Motion { components: 0, values: Vec::new() });
        motions[1].values.fill(0.0);
        let moments = Moments::new(&motions, 100, 2);
        let found = moments.correlations(&moments.sum(&[1, 1]));
        assert_eq!((found[(0, 3)], found[(0, 1)]), (0.0, 0.0));
        assert!(found.iter().all(|cosine| (0.0..=1.0).contains(cosine)));
    }
}
