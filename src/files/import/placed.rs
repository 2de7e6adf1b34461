//! Links as both kinds of file give them: solids in the common frame, and turns about places and axes in it.

use std::f64::consts::PI;

use nalgebra::{Isometry3, UnitQuaternion, UnitVector3, Vector3 as Column};

use crate::files::body::{PartEntry, ShapeName};
use crate::stages::agent::{Shape, Vector3};

/// A solid where it is in the rest pose.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    /// Its shape.
    pub shape: Shape,
    /// From the shape's frame to the common one.
    pub pose: Isometry3<f64>,
    /// Density, kg/m³, if it is known.
    pub density: Option<f64>,
}

/// One way in which a link moves on its parent.
#[derive(Debug, Clone)]
pub(super) enum Turn {
    /// About one axis.
    Hinge {
        /// A place on the axis.
        anchor: Column<f64>,
        /// Its direction, of length one.
        axis: Column<f64>,
    },
    /// About every axis through a place.
    Ball {
        /// The place.
        anchor: Column<f64>,
    },
    /// Another way, by the name that the description has for it.
    Other(&'static str),
}

/// A body of MJCF or a link of URDF.
#[derive(Debug, Clone)]
pub(super) struct Link {
    /// Its name.
    pub name: String,
    /// The earlier link that carries it.
    pub parent: Option<usize>,
    /// Origin of its frame, m.
    pub origin: Column<f64>,
    /// How it moves on its parent, from that on; it is fixed if there is none.
    pub turns: Vec<Turn>,
    /// What it consists of.
    pub solids: Vec<Solid>,
}

/// Volume, m³.
fn volume(shape: &Shape) -> f64 {
    match *shape {
        Shape::Cylinder { radius, length } => PI * radius * radius * length,
        Shape::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
        Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
        Shape::Box { sides: [x, y, z] } => x * y * z,
    }
}

/// Gives solids the density at which they have this mass, kg, together. A mass of 0 says nothing of them; neither does
/// any mass of what has no volume, which is refused as a part.
pub(super) fn weigh(solids: &mut [Solid], mass: f64) {
    let volume: f64 = solids.iter().map(|solid| volume(&solid.shape)).sum();
    let density = (mass != 0.0 && volume > 0.0).then(|| mass / volume);
    solids.iter_mut().for_each(|solid| solid.density = density);
}

/// The least rotation that takes z to a direction; about x if it is the opposite one.
pub(super) fn z_to(direction: &UnitVector3<f64>) -> UnitQuaternion<f64> {
    let axis = Column::z().cross(direction);
    let axis = UnitVector3::try_new(axis, 1e-10).unwrap_or(Column::x_axis());
    UnitQuaternion::from_axis_angle(&axis, direction.xy().norm().atan2(direction.z))
}

/// Without what rounding added on the way: 0.3 for 0.30000000000000004.
pub(super) fn rounded(numbers: impl Into<Vector3>) -> Vector3 {
    numbers.into().map(round)
}

fn round(number: f64) -> f64 {
    // A negative zero becomes zero.
    (number * 1e12).round() / 1e12 + 0.0
}

impl Solid {
    /// The solid as a part that is not joined yet.
    pub(super) fn part(&self, name: String) -> PartEntry {
        let at = |height: f64| Some(rounded((self.pose * nalgebra::Point3::new(0.0, 0.0, height)).coords));
        let mut part = PartEntry {
            name,
            shape: ShapeName::Box,
            radius: None,
            from: None,
            to: None,
            centre: None,
            size: None,
            quaternion: None,
            density: self.density,
            parent: None,
            joint: None,
            anchor: None,
            axes: None,
            skin: None,
        };
        match self.shape {
            Shape::Cylinder { radius, length } | Shape::Capsule { radius, length } => {
                let is_cylinder = matches!(self.shape, Shape::Cylinder { .. });
                part.shape = if is_cylinder { ShapeName::Cylinder } else { ShapeName::Capsule };
                (part.from, part.to) = (at(-length / 2.0), at(length / 2.0));
                part.radius = Some(round(radius));
            }
            Shape::Sphere { radius } => {
                part.shape = ShapeName::Sphere;
                (part.centre, part.radius) = (at(0.0), Some(round(radius)));
            }
            Shape::Box { sides } => {
                (part.centre, part.size) = (at(0.0), Some(rounded(sides)));
                let turn = self.pose.rotation;
                let quaternion = [turn.w, turn.i, turn.j, turn.k].map(round);
                // Turned by nothing, or by a whole turn.
                let is_turned = quaternion[1..] != [0.0; 3];
                part.quaternion = is_turned.then_some(quaternion);
            }
        }
        part
    }
}
