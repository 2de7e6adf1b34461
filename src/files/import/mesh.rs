//! Read the mesh of a shape, find the box around it, and spread sensors evenly over it.

mod dae;
mod gltf;
mod read;
mod simplified;

use std::f64::consts::PI;
use std::path::Path;

use nalgebra::{
    Isometry3, Matrix3, Matrix4, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3 as Column,
};

use super::document::Wrong;
use crate::stages::agent::{Spot, Vector3};

/// Thickness of the thinnest solid, m. A plate that is drawn without thickness gets it.
pub(super) const THIN: f64 = 1e-3;
/// Places among which those of the sensors are chosen, for each sensor.
const CANDIDATES: usize = 8;
/// Most comparisons of places with each other; with more, places that share the area evenly are taken as they are.
const MOST_COMPARED: usize = 100_000_000;
/// Step of a sequence that fills an interval evenly, and a triangle by two of them (Roberts 2018: the plastic number).
const EVEN: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// Most triangles that are read.
const MOST_TRIANGLES: usize = 10_000_000;

fn too_many() -> Wrong {
    format!("has more than {MOST_TRIANGLES} triangles; simplify it")
}

/// A surface of triangles, in m. The corners of each go round it counterclockwise as seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mesh {
    triangles: Vec<[Column<f64>; 3]>,
    /// Half axes of the ellipsoid that the triangles stand for, if they do, m. Its sensors are on the ellipsoid itself.
    half_axes: Option<Column<f64>>,
}

/// Reads a mesh, in the unit of its file (COLLADA, glTF: in m).
///
/// # Errors
/// If the file cannot be read, or holds no mesh of a known format.
pub(super) fn read(path: &Path) -> Result<Mesh, Wrong> {
    read::read(path)
}

/// The principal axes of a symmetric matrix, as a rotation, and its values along them. One that is diagonal stays as it is.
pub(super) fn principal(matrix: Matrix3<f64>) -> (UnitQuaternion<f64>, Vector3) {
    let diagonal = Matrix3::from_diagonal(&matrix.diagonal());
    if (matrix - diagonal).norm() <= 1e-9 * matrix.norm() {
        return (UnitQuaternion::identity(), matrix.diagonal().into());
    }
    let SymmetricEigen { eigenvectors: mut axes, eigenvalues } = SymmetricEigen::new(matrix);
    if axes.determinant() < 0.0 {
        axes.column_mut(0).neg_mut();
    }
    (UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)), eigenvalues.into())
}

/// Twice the area of a triangle, times its normal.
fn normal([a, b, c]: &[Column<f64>; 3]) -> Column<f64> {
    (b - a).cross(&(c - a))
}

/// Turns triangles round, so that what looked inward looks outward.
fn turn_round(triangles: &mut [[Column<f64>; 3]]) {
    triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
}

/// Turns placed triangles round if the place makes a mirror image of them.
fn look_outward(triangles: &mut [[Column<f64>; 3]], place: &Matrix4<f64>) {
    if place.fixed_view::<3, 3>(0, 0).determinant() < 0.0 {
        turn_round(triangles);
    }
}

impl Mesh {
    /// A mesh of triangles.
    ///
    /// # Errors
    /// If a number is not finite, or no triangle has an area.
    fn new(mut triangles: Vec<[Column<f64>; 3]>) -> Result<Self, Wrong> {
        let numbers = || triangles.iter().flatten().flat_map(|corner| corner.iter());
        if numbers().any(|number| !number.is_finite() || number.abs() > 1e9) {
            return Err("has a corner that is no number up to 1e9".to_owned());
        }
        triangles.retain(|triangle| normal(triangle).norm() > 0.0);
        if triangles.is_empty() {
            return Err("has no triangle with an area".to_owned());
        }
        Ok(Self { triangles, half_axes: None })
    }

    /// The mesh of an ellipsoid with these half axes, m: a globe of 24 rings of 48 quadrilaterals, each two triangles.
    pub(super) fn ellipsoid(half_axes: Vector3) -> Result<Self, Wrong> {
        const RINGS: usize = 24;
        let half_axes = Column::from(half_axes);
        let place = |ring: usize, at: usize| {
            let [(out, up), (y, x)] =
                [ring as f64 / RINGS as f64, at as f64 / RINGS as f64].map(|part| (PI * part).sin_cos());
            Column::new(out * x, out * y, -up).component_mul(&half_axes)
        };
        let mut triangles = Vec::with_capacity(4 * RINGS * RINGS);
        for ring in 0..RINGS {
            for at in 0..2 * RINGS {
                let next = (at + 1) % (2 * RINGS);
                let corners =
                    [place(ring, at), place(ring, next), place(ring + 1, next), place(ring + 1, at)];
                triangles
                    .extend([[0, 1, 2], [0, 2, 3]].map(|triangle| triangle.map(|corner| corners[corner])));
            }
        }
        Ok(Self { half_axes: Some(half_axes), ..Self::new(triangles)? })
    }

    /// The mesh with all corners moved.
    pub(super) fn moved(mut self, way: impl Fn(Column<f64>) -> Column<f64>) -> Self {
        self.triangles.iter_mut().flatten().for_each(|corner| *corner = way(*corner));
        self.half_axes = None;
        self
    }

    /// The mesh with its axes stretched. A reflection turns all triangles round, so that they look outward again. A surface that
    /// looks inward throughout is turned round, too.
    ///
    /// # Errors
    /// If nothing is left of it.
    pub(super) fn scaled(self, scale: Vector3) -> Result<Self, Wrong> {
        let [x, y, z] = scale;
        let stretch = |corner: Column<f64>| corner.component_mul(&Column::new(x, y, z));
        let mut mesh = Self::new(self.triangles.into_iter().map(|corners| corners.map(stretch)).collect())?;
        if mesh.signed_volume() < 0.0 {
            turn_round(&mut mesh.triangles);
        }
        Ok(mesh)
    }

    /// Its triangles, or fewer that look alike.
    pub(super) fn simplified(&self) -> Vec<[Column<f64>; 3]> {
        simplified::simplified(&self.triangles)
    }

    /// Volume of what the mesh encloses, m³; negative if it looks inward.
    fn signed_volume(&self) -> f64 {
        let middle = self.middle();
        self.triangles.iter().map(|corners| tetrahedron(corners, middle)).sum()
    }

    /// Volume of the tetrahedra from the middle to each triangle, m³, each as positive: that of MuJoCo's `legacy` inertia, and of a
    /// closed convex mesh the one that it encloses. A plate has its thickness at least.
    pub(super) fn volume(&self) -> f64 {
        let middle = self.middle();
        let sum: f64 = self.triangles.iter().map(|corners| tetrahedron(corners, middle).abs()).sum();
        sum.max(self.area() / 2.0 * THIN)
    }

    /// Area, m².
    pub(super) fn area(&self) -> f64 {
        self.triangles.iter().map(|corners| normal(corners).norm() / 2.0).sum()
    }

    /// The mean place on the surface.
    fn middle(&self) -> Column<f64> {
        let weighted =
            |corners: &[Column<f64>; 3]| normal(corners).norm() * corners.iter().sum::<Column<f64>>() / 3.0;
        self.triangles.iter().map(weighted).sum::<Column<f64>>() / (2.0 * self.area())
    }

    /// The smaller one of two boxes around the mesh: along the axes of its frame, and along the principal axes of its surface. Sides,
    /// and the pose of the box in the mesh's frame.
    ///
    /// A box and not the convex hull is the solid, because the physics engine has its mass and inertia, and the fluid its surface, in
    /// closed form; sensors are on the mesh itself.
    pub(super) fn bounds(&self) -> (Vector3, Isometry3<f64>) {
        let middle = self.middle();
        let mut spread = Matrix3::zeros();
        for corners in &self.triangles {
            let area = normal(corners).norm();
            let centre = corners.iter().sum::<Column<f64>>() / 3.0;
            // The second moment of a triangle is that of its corners and nine times that of its centre, over twelve.
            for off in corners.iter().chain([&centre; 9]).map(|place| place - middle) {
                spread += area * off * off.transpose();
            }
        }
        let [plain, turned] =
            [UnitQuaternion::identity(), principal(spread).0].map(|turn| self.bounds_along(turn));
        // A plate has a thickness as a solid, too.
        let volume = |sides: &Vector3| sides.iter().map(|side| side.max(THIN)).product::<f64>();
        // A little less is rounding, and a box along the axes is easier to read.
        if volume(&turned.0) < 0.99 * volume(&plain.0) { turned } else { plain }
    }

    fn bounds_along(&self, turn: UnitQuaternion<f64>) -> (Vector3, Isometry3<f64>) {
        let (mut low, mut high) = (Column::repeat(f64::INFINITY), Column::repeat(f64::NEG_INFINITY));
        for corner in self.triangles.iter().flatten().map(|corner| turn.inverse() * corner) {
            (low, high) = (low.inf(&corner), high.sup(&corner));
        }
        let centre = turn * ((low + high) / 2.0);
        ((high - low).into(), Isometry3::from_parts(Translation3::from(centre), turn))
    }

    /// So many places on the mesh, as far from each other as they can be: of eight times as many that share its area evenly, one
    /// after the other is taken that is farthest from all before it (Gonzalez 1985).
    pub(super) fn spread(&self, count: usize) -> Vec<Spot> {
        let many = CANDIDATES * count;
        if many.saturating_mul(count) > MOST_COMPARED {
            return self.even(count);
        }
        let candidates = self.even(many);
        let places: Vec<Column<f64>> = candidates.iter().map(|spot| Column::from(spot.position)).collect();
        let mut nearest = vec![f64::INFINITY; places.len()];
        let (mut chosen, mut next) = (Vec::with_capacity(count), 0);
        while chosen.len() < count.min(places.len()) {
            chosen.push(candidates[next]);
            nearest[next] = f64::NEG_INFINITY;
            for (near, place) in nearest.iter_mut().zip(&places) {
                *near = near.min((place - places[next]).norm_squared());
            }
            next = (1..nearest.len()).fold(0, |far, at| if nearest[at] > nearest[far] { at } else { far });
        }
        chosen
    }

    /// So many places that share the area evenly.
    fn even(&self, count: usize) -> Vec<Spot> {
        let pitch = 2.0 * self.area() / count as f64;
        let mut spots = Vec::with_capacity(count);
        let mut until = 0.0;
        for corners in &self.triangles {
            let normal = normal(corners);
            until += normal.norm();
            while spots.len() < count && (spots.len() as f64 + 0.5) * pitch <= until {
                let [mut u, mut v] = EVEN.map(|step| (step * (spots.len() as f64 + 0.5)).fract());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let [a, b, c] = corners;
                let position = a + u * (b - a) + v * (c - a);
                spots.push(self.half_axes.map_or_else(
                    || Spot { position: position.into(), normal: normal.normalize().into() },
                    |half_axes| on_ellipsoid(&half_axes, &position),
                ));
            }
        }
        spots
    }
}

/// Where the way from the centre of an ellipsoid to a place leaves the ellipsoid.
fn on_ellipsoid(half_axes: &Column<f64>, place: &Column<f64>) -> Spot {
    let on_ball = place.component_div(half_axes).normalize();
    Spot {
        position: on_ball.component_mul(half_axes).into(),
        normal: on_ball.component_div(half_axes).normalize().into(),
    }
}

/// Volume of the tetrahedron over a triangle, m³; negative if the triangle looks to its tip.
fn tetrahedron(corners: &[Column<f64>; 3], tip: Column<f64>) -> f64 {
    normal(corners).dot(&(corners[0] - tip)) / 6.0
}

#[cfg(test)]
mod tests;
