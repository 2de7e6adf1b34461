//! Put a box around the sensors of a part.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// Least side of a box, m.
const THIN: f64 = 1e-3;

/// A box along the principal axes of some points, which holds all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Centre, m.
    pub centre: Vector3<f64>,
    /// From the axes of the box to those of its frame.
    pub rotation: Rotation3<f64>,
    /// Lengths of the sides, m.
    pub sides: Vector3<f64>,
}

impl OrientedBox {
    /// Around at least one point.
    pub(super) fn around(points: &[Vector3<f64>]) -> Self {
        let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let spread: Matrix3<f64> =
            points.iter().map(|point| (point - mean) * (point - mean).transpose()).sum();
        let mut axes = spread.symmetric_eigen().eigenvectors;
        if axes.determinant() < 0.0 {
            axes.column_mut(0).neg_mut();
        }
        let rotation = Rotation3::from_matrix_unchecked(axes);
        let turned = |point: &Vector3<f64>| rotation.inverse() * point;
        let (mut low, mut high) = (turned(&points[0]), turned(&points[0]));
        for point in points.iter().map(turned) {
            (low, high) = (low.inf(&point), high.sup(&point));
        }
        let sides = (high - low).map(|side| side.max(THIN));
        Self { centre: rotation * ((low + high) / 2.0), rotation, sides }
    }

    /// How far a point is outside, m.
    pub(super) fn distance(&self, point: &Vector3<f64>) -> f64 {
        let from_centre = (self.rotation.inverse() * (point - self.centre)).abs();
        (from_centre - self.sides / 2.0).sup(&Vector3::zeros()).norm()
    }

    /// Points where a joint may be: the centre, the middle of each face, and the corners, in this order.
    pub(super) fn points(&self) -> impl Iterator<Item = Vector3<f64>> {
        let steps = [-0.5, 0.0, 0.5];
        let all = steps.into_iter().flat_map(move |x| {
            steps.into_iter().flat_map(move |y| steps.into_iter().map(move |z| Vector3::new(x, y, z)))
        });
        let zeros = |at: &Vector3<f64>| at.iter().filter(|step| **step == 0.0).count();
        // Not the middle of an edge.
        let mut chosen: Vec<Vector3<f64>> = all.filter(|at| zeros(at) != 1).collect();
        chosen.sort_by_key(|at| std::cmp::Reverse(zeros(at)));
        let Self { centre, rotation, sides } = *self;
        chosen.into_iter().map(move |at| centre + rotation * at.component_mul(&sides))
    }
}

#[cfg(test)]
mod tests;
