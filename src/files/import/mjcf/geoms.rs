//! What a geom of MJCF is: a solid with its mass, or none.

use std::f64::consts::PI;
use std::rc::Rc;

use nalgebra::{Isometry3, Translation3, Vector3};

use super::models::Model;
use crate::files::body::DENSITY;
use crate::files::import::document::Wrong;
use crate::files::import::mesh::Mesh;
use crate::files::import::placed::{Solid, z_to};
use crate::files::import::xml::Element;
use crate::stages::agent::Shape;

/// What a geom is.
pub(super) enum Found {
    Solid(Box<Solid>),
    /// A mesh that cannot be had, and why.
    Absent(String),
    /// A plane or a height field, which is no part of a robot.
    Endless,
}

/// Whether a geom touches others.
pub(super) fn touches(geom: &Element) -> Result<bool, Wrong> {
    let kinds = |key| geom.number(key).map(|kinds| kinds.unwrap_or(1.0));
    Ok(kinds("contype")? != 0.0 || kinds("conaffinity")? != 0.0)
}

impl<'a> Model<'a> {
    /// What a geom of a body with this frame is.
    pub(super) fn solid(&mut self, geom: &Element<'a>, frame: &Isometry3<f64>) -> Result<Found, Wrong> {
        let kind = if geom.text("mesh").is_some() { "mesh" } else { geom.text("type").unwrap_or("sphere") };
        let lengths = match kind {
            "sphere" => 1,
            "capsule" | "cylinder" => 2,
            "box" | "ellipsoid" => 3,
            "mesh" => {
                let pose = frame * self.defaults.pose(geom)?;
                return Ok(match self.assets.mesh(geom)? {
                    Ok(mesh) => Found::Solid(Box::new(self.weighed(geom, Solid::of_mesh(mesh, pose))?)),
                    Err(file) => Found::Absent(file),
                });
            }
            "plane" | "hfield" => return Ok(Found::Endless),
            other => {
                return Err(geom.wrong(format!(
                    "is of type `{other}`; make it a box, sphere, cylinder, capsule, ellipsoid or mesh"
                )));
            }
        };
        let ends = geom.numbers::<6>("fromto")?;
        if ends.is_some() && kind == "sphere" {
            return Err(geom.wrong("has fromto, but is a sphere; give its type: capsule, cylinder or box"));
        }
        let lengths = if ends.is_some() { 1 } else { lengths };
        let is_flat = ["box", "ellipsoid"].contains(&kind);
        let mut size = geom.overlaid("size")?;
        if size.len() < lengths {
            return Err(
                geom.wrong(format!("has {} numbers of size, but a {kind} needs {lengths}", size.len()))
            );
        }
        let pose = match ends {
            None => self.defaults.pose(geom)?,
            Some([a, b, c, d, e, f]) => {
                let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
                let along = to - from;
                let direction = geom.direction("fromto", along.as_slice())?;
                // MuJoCo turns z to the first end, which shows in a box alone; otherwise `from` stays the first end.
                let turn = z_to(&if is_flat { -direction } else { direction });
                let half = along.norm() / 2.0;
                size = if is_flat { vec![size[0], size[0], half] } else { vec![size[0], half] };
                Isometry3::from_parts(Translation3::from(from + along / 2.0), turn)
            }
        };
        let pose = frame * pose;
        // Lengths are halves in MJCF.
        let solid = match size[..] {
            [radius, ..] if kind == "sphere" => Solid::new(Shape::Sphere { radius }, pose),
            [radius, half, ..] if kind == "capsule" => {
                Solid::new(Shape::Capsule { radius, length: 2.0 * half }, pose)
            }
            [radius, half, ..] if kind == "cylinder" => {
                Solid::new(Shape::Cylinder { radius, length: 2.0 * half }, pose)
            }
            [x, y, z, ..] if kind == "ellipsoid" => {
                let mesh = Mesh::ellipsoid([x, y, z]).map_err(|wrong| geom.wrong(wrong))?;
                let mass = DENSITY * 4.0 / 3.0 * PI * x * y * z;
                Solid { mass: Some(mass), ..Solid::of_mesh(Rc::new(mesh), pose) }
            }
            [x, y, z, ..] => Solid::new(Shape::Box { sides: [x, y, z].map(|half| 2.0 * half) }, pose),
            _ => return Err(geom.wrong("has too few numbers of size")),
        };
        self.weighed(geom, solid).map(|solid| Found::Solid(Box::new(solid)))
    }

    /// A solid with the mass that its geom says.
    fn weighed(&self, geom: &Element, solid: Solid) -> Result<Solid, Wrong> {
        let mass = match (geom.number("mass")?, geom.number("density")?) {
            (Some(mass), _) => Some(mass),
            (None, density) if geom.text("shellinertia") == Some("true") => {
                Some(density.unwrap_or(DENSITY) * solid.area())
            }
            (None, Some(density)) => Some(density * solid.own_mass() / DENSITY),
            (None, None) => solid.mass,
        };
        Ok(Solid { mass, ..solid })
    }
}
