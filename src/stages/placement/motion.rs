//! Compute the motion of a part from what its sensors feel, where their positions and normals are known.

use faer::Mat;
use nalgebra::{Matrix6, SVector, Vector3, Vector6};

use crate::stages::agent::Site;
use crate::stages::rigid_parts::{Als, Roots};

/// Eigenvalue, as a share of the largest, from which on sensors feel a direction of motion. A cylinder with sensors on its ends
/// feels five directions, all but the rotation about its axis; without them it feels four.
const FEELS: f64 = 1e-4;
/// Least eigenvalue of what is felt at a sample, as a share of what all sensors could feel, so that the motion is known there.
const KNOWN: f64 = 0.02;
/// Iterations of least squares, by which it is settled which sensors should feel something.
const ITERATIONS: usize = 20;

/// The motion of a part at some samples, in the frame of its sensors.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// Mean position of the sensors, m.
    pub centre: Vector3<f64>,
    /// Root mean square distance of the sensors from their mean position, m.
    pub radius: f64,
    /// At each sample, the velocity of the centre and the angular velocity, in units of root pressure and of root pressure per metre;
    /// `None` where what is felt does not tell.
    pub at: Vec<Option<[Vector3<f64>; 2]>>,
    /// How many of the six directions of motion the sensors feel.
    pub rank: usize,
    /// The share of the squares of all roots that the motion explains, at most 1.
    pub explained: f64,
}

impl Motion {
    /// Of the sensors of a part: their sites, and the roots of their pressures at the same samples.
    pub(super) fn new(sites: &[&Site], roots: &Roots) -> Self {
        let positions: Vec<Vector3<f64>> = sites.iter().map(|site| Vector3::from(site.position)).collect();
        let centre = positions.iter().sum::<Vector3<f64>>() / sites.len() as f64;
        let squares: f64 = positions.iter().map(|position| (position - centre).norm_squared()).sum();
        let radius = (squares / sites.len() as f64).sqrt();
        let loadings = |(site, position): (&&Site, &Vector3<f64>)| {
            let normal = Vector3::from(site.normal);
            let moment = (position - centre).cross(&normal) / radius.max(f64::MIN_POSITIVE);
            Vector6::from_iterator(normal.iter().chain(moment.iter()).copied())
        };
        let loadings: Vec<Vector6<f64>> = sites.iter().zip(&positions).map(loadings).collect();
        let gram: Matrix6<f64> = loadings.iter().map(|row| row * row.transpose()).sum();
        let eigen = gram.symmetric_eigen();
        let least = FEELS * eigen.eigenvalues.max();
        // From coordinates in which all sensors together feel each direction alike.
        let directions: Vec<Vector6<f64>> = (0..6)
            .filter(|&at| eigen.eigenvalues[at] > least)
            .map(|at| eigen.eigenvectors.column(at) / eigen.eigenvalues[at].sqrt())
            .collect();
        let rank = directions.len();
        let whitened = Mat::from_fn(sites.len(), rank, |sensor, at| loadings[sensor].dot(&directions[at]));
        // Any root above 0 is exact, for noise was taken off before.
        let felt = if roots.signed { f64::NEG_INFINITY } else { f64::MIN_POSITIVE };
        let als = Als::new(roots.values.as_ref(), &vec![felt; roots.samples()]);
        let mut motion = Mat::zeros(roots.samples(), rank);
        (0..ITERATIONS).for_each(|_| als.update_motion(whitened.as_ref(), &mut motion));
        let residual: f64 =
            als.residuals(whitened.as_ref(), &motion).iter().map(|[squares, _]| squares).sum();
        let [_, all] = roots.sums();
        let known = |t: usize| {
            let mut felt = Matrix6::identity();
            felt.view_mut((0, 0), (rank, rank)).fill(0.0);
            for sensor in 0..sites.len() {
                let row =
                    SVector::<f64, 6>::from_fn(|at, _| if at < rank { whitened[(sensor, at)] } else { 0.0 });
                let predicted: f64 = (0..rank).map(|at| row[at] * motion[(t, at)]).sum();
                let root = roots.values[(t, sensor)];
                if root >= f64::MIN_POSITIVE || predicted > root || (roots.signed && !root.is_nan()) {
                    felt += row * row.transpose();
                }
            }
            (felt.symmetric_eigenvalues().min() >= KNOWN).then(|| {
                let w: Vector6<f64> =
                    directions.iter().enumerate().map(|(at, own)| own * motion[(t, at)]).sum();
                let turn = w.fixed_rows::<3>(3) / radius.max(f64::MIN_POSITIVE);
                [w.fixed_rows::<3>(0).into_owned(), turn]
            })
        };
        Self {
            centre,
            radius,
            at: (0..roots.samples()).map(known).collect(),
            rank,
            explained: if all > 0.0 { 1.0 - residual / all } else { 0.0 },
        }
    }

    /// The velocity of a point at a sample, and the angular velocity, where the motion is known.
    pub(super) fn of_point(&self, t: usize, point: &Vector3<f64>) -> Option<[Vector3<f64>; 2]> {
        self.at[t].map(|[velocity, turn]| [velocity + turn.cross(&(point - self.centre)), turn])
    }

    /// The squared size of the motion at a sample: that of the mean square of the speeds of its sensors, in the main.
    pub(super) fn energy(&self, t: usize) -> Option<f64> {
        self.at[t].map(|[velocity, turn]| velocity.norm_squared() + self.radius.powi(2) * turn.norm_squared())
    }
}
