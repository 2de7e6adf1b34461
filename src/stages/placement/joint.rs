//! Find the point at which two parts feel the same speed: their joint.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};

use super::motion::Motion;

/// Least samples at which both motions must be known.
const MIN_SAMPLES: usize = 50;
/// Added to the energy of each sample, as a share of the mean energy, so that one at which both parts hardly move has no endless
/// weight.
const REST: f64 = 1e-3;
/// Starts of which the place is improved: those of least mismatch.
const STARTS: usize = 3;
/// Iterations of the method of Levenberg and Marquardt.
const ITERATIONS: usize = 50;
/// Pull towards the start, as a share of the mean curvature: it decides only in directions that touch tells nothing about, such as
/// along the axis of a hinge.
const PULL: f64 = 1e-6;
/// Blocks of samples that are left out in turn for the standard error.
const BLOCKS: usize = 10;

/// A joint between two parts, and where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlace {
    /// The part that it carries.
    pub child: usize,
    /// The part that carries it.
    pub parent: usize,
    /// Its place in the frame of the parent, m.
    pub in_parent: Vector3<f64>,
    /// Its place in the frame of the child, m.
    pub in_child: Vector3<f64>,
    /// From the axes of the child's frame to those of the parent's: none at rest, otherwise what agrees best over all samples.
    pub rotation: Rotation3<f64>,
    /// Standard error of the place, m, by the jackknife over blocks of time: the root of the sum over the three directions, and in
    /// different frames the larger of both. It is of random errors only. `None` where touch does not tell the place, which is then the
    /// middle between the nearest sensors of both parts, or in different frames a guess.
    pub standard_error: Option<f64>,
    /// Mean square of the difference of the two speeds at the best place, as a share of the mean square of both, 0 to 1; `None` where
    /// both motions are known at too few samples.
    pub mismatch: Option<f64>,
}

/// The place at which two speeds agree best.
pub(super) struct Best {
    /// In the frame of the parent and of the child, m.
    pub place: [Vector3<f64>; 2],
    /// As in [`JointPlace`].
    pub standard_error: f64,
    /// As in [`JointPlace`].
    pub mismatch: f64,
}

/// Two parts that share a joint.
pub(super) struct Pair<'a> {
    /// Their motions, of the parent first.
    motions: [&'a Motion; 2],
    /// Whether both motions are in one frame.
    shares_frame: bool,
    /// The samples at which both motions are known, and the weight of each.
    samples: Vec<(usize, f64)>,
}

impl<'a> Pair<'a> {
    /// `None` if there are too few samples at which both motions are known.
    pub(super) fn new(motions: [&'a Motion; 2], shares_frame: bool) -> Option<Self> {
        let energies: Vec<(usize, f64)> = (0..motions[0].at.len())
            .filter_map(|t| Some((t, motions[0].energy(t)? + motions[1].energy(t)?)))
            .collect();
        let mean = energies.iter().map(|(_, energy)| energy).sum::<f64>() / energies.len().max(1) as f64;
        let weigh = |(t, energy)| (t, 1.0 / (energy + REST * mean));
        let samples: Vec<(usize, f64)> = energies.into_iter().map(weigh).collect();
        (samples.len() >= MIN_SAMPLES && mean > 0.0).then_some(Self { motions, shares_frame, samples })
    }

    /// The place where both speeds agree best. In: places to start from, in the frame of the parent and of the child.
    pub(super) fn place(&self, starts: &[[Vector3<f64>; 2]]) -> Best {
        let every = |_: usize| true;
        let mut ranked: Vec<(f64, DVector<f64>)> = starts
            .iter()
            .map(|start| self.coordinates(start))
            .map(|start| (self.mismatch(&start), start))
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let improved = ranked.into_iter().take(STARTS).map(|(_, start)| self.improved(&start, &every));
        let best = improved
            .map(|place| (self.mismatch(&place), place))
            .reduce(|best, other| if other.0 < best.0 { other } else { best });
        let (mismatch, place) = best.expect("there is a start");
        let standard_error = self.standard_error(&place);
        Best { place: self.both(&place), standard_error, mismatch }
    }

    /// The rotation from the child's axes to the parent's that agrees best with the velocity of the joint in both frames (Kabsch 1976).
    pub(super) fn rotation(&self, place: &[Vector3<f64>; 2]) -> Rotation3<f64> {
        let mut products = Matrix3::zeros();
        for &(t, weight) in &self.samples {
            let [(parent, _), (child, _)] = self.velocities(t, place);
            products += weight * parent * child.transpose();
        }
        let svd = products.svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Rotation3::identity() };
        let turn = (u * v).determinant().signum();
        Rotation3::from_matrix_unchecked(u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, turn)) * v)
    }

    fn coordinates(&self, [parent, child]: &[Vector3<f64>; 2]) -> DVector<f64> {
        let both = parent.iter().chain(child.iter()).copied();
        if self.shares_frame {
            DVector::from_column_slice(parent.as_slice())
        } else {
            DVector::from_iterator(6, both)
        }
    }

    fn both(&self, place: &DVector<f64>) -> [Vector3<f64>; 2] {
        let at = |from: usize| Vector3::new(place[from], place[from + 1], place[from + 2]);
        [at(0), at(if self.shares_frame { 0 } else { 3 })]
    }

    /// Velocity of the joint and angular velocity of the part, for both parts, at a sample at which both are known.
    fn velocities(&self, t: usize, place: &[Vector3<f64>; 2]) -> [(Vector3<f64>, Vector3<f64>); 2] {
        [0, 1].map(|at| {
            let [velocity, turn] =
                self.motions[at].of_point(t, &place[at]).expect("known at the samples of a pair");
            (velocity, turn)
        })
    }

    fn mismatch(&self, place: &DVector<f64>) -> f64 {
        let place = self.both(place);
        let (mut difference, mut all) = (0.0, 0.0);
        for &(t, weight) in &self.samples {
            let [(parent, _), (child, _)] = self.velocities(t, &place);
            difference += weight * (parent.norm() - child.norm()).powi(2);
            all += weight * (parent.norm_squared() + child.norm_squared());
        }
        if all > 0.0 { difference / all } else { 1.0 }
    }

    /// Half of the weighted squares of the differences of both speeds: its gradient, its Gauss–Newton matrix, and twice its value.
    fn normal_equations(
        &self,
        place: &DVector<f64>,
        is_used: &dyn Fn(usize) -> bool,
    ) -> (DVector<f64>, DMatrix<f64>, f64) {
        let size = place.len();
        let (mut gradient, mut matrix, mut value) = (DVector::zeros(size), DMatrix::zeros(size, size), 0.0);
        let both = self.both(place);
        for (_, &(t, weight)) in self.samples.iter().enumerate().filter(|(at, _)| is_used(*at)) {
            let [parent, child] = self.velocities(t, &both).map(|(velocity, turn)| {
                let speed = velocity.norm();
                // d|u| = û · (ω × dq) = (û × ω) · dq.
                (speed, velocity.cross(&turn) / speed.max(f64::MIN_POSITIVE))
            });
            let slope = if self.shares_frame {
                DVector::from_column_slice((parent.1 - child.1).as_slice())
            } else {
                DVector::from_iterator(6, parent.1.iter().copied().chain(child.1.iter().map(|own| -own)))
            };
            let difference = parent.0 - child.0;
            gradient += weight * difference * &slope;
            matrix += weight * &slope * slope.transpose();
            value += weight * difference * difference;
        }
        (gradient, matrix, value)
    }

    /// Levenberg and Marquardt's method from a start, over the samples that are used.
    fn improved(&self, start: &DVector<f64>, is_used: &dyn Fn(usize) -> bool) -> DVector<f64> {
        let mut place = start.clone();
        let (mut gradient, mut matrix, mut value) = self.normal_equations(&place, is_used);
        let pull = PULL * matrix.trace() / place.len() as f64;
        let penalty = |place: &DVector<f64>| pull * (place - start).norm_squared();
        let mut damping = 1e-3;
        for _ in 0..ITERATIONS {
            let mut damped = matrix.clone();
            (0..place.len()).for_each(|at| damped[(at, at)] += pull + damping * matrix[(at, at)].max(pull));
            let Some(factor) = damped.cholesky() else { break };
            let step = factor.solve(&(-&gradient - pull * (&place - start)));
            let next = &place + &step;
            let found = self.normal_equations(&next, is_used);
            if found.2 + penalty(&next) < value + penalty(&place) {
                damping = f64::max(damping / 10.0, 1e-9);
                place = next;
                (gradient, matrix, value) = found;
                if step.norm() < 1e-9 * (1.0 + place.norm()) {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e9 {
                    break;
                }
            }
        }
        place
    }

    /// By the jackknife (Tukey 1958) over blocks of time: samples next to each other are alike.
    fn standard_error(&self, place: &DVector<f64>) -> f64 {
        let block = |at: usize| at * BLOCKS / self.samples.len();
        let places: Vec<DVector<f64>> =
            (0..BLOCKS).map(|left_out| self.improved(place, &|at| block(at) != left_out)).collect();
        let mean = places.iter().sum::<DVector<f64>>() / BLOCKS as f64;
        let spread = |from: usize| -> f64 {
            places.iter().map(|place| (place - &mean).rows(from, 3).norm_squared()).sum()
        };
        let larger = (0..place.len()).step_by(3).map(spread).fold(0.0, f64::max);
        (larger * (BLOCKS - 1) as f64 / BLOCKS as f64).sqrt()
    }
}
