//! Make parts, joints and sensors of what a body file says of them.

use nalgebra::{Quaternion, UnitQuaternion, Vector3 as Column};

use super::{InertiaEntry, JointName, PartEntry, ShapeName};
use crate::numerics::range::{is_length, is_moderate};
use crate::stages::agent::{Freedom, Inertia, Joint, Part, Shape, Spot, Vector3, across};

/// Cosine from which on two axes no longer count as at right angles.
const OBLIQUE: f64 = 1e-6;

/// What is wrong with a part.
type Wrong = String;

/// A number that the physics engine can compute with, or what is wrong with it.
fn length(key: &str, value: f64) -> Result<f64, Wrong> {
    if is_length(value) { Ok(value) } else { Err(format!("{key} is {value}, but must be 0.001 to 1000 (m)")) }
}

fn place(key: &str, value: Vector3) -> Result<Vector3, Wrong> {
    let fits = value.iter().all(|x| x.abs() <= 1e3);
    if fits {
        Ok(value)
    } else {
        Err(format!("{key} is {value:?}, but must be numbers from -1000 to 1000 (m)"))
    }
}

/// A direction of length one.
fn direction(key: &str, value: Vector3) -> Result<Vector3, Wrong> {
    let found = Column::from(value);
    if value.iter().all(|x| x.is_finite()) && (1e-6..=1e6).contains(&found.norm()) {
        Ok(found.normalize().into())
    } else {
        Err(format!("{key} is {value:?}, but must be a direction that is not 0"))
    }
}

fn needed<T>(key: &str, value: Option<T>, shape: &str) -> Result<T, Wrong> {
    value.ok_or_else(|| format!("it lacks {key}, which a {shape} needs"))
}

/// The inertia of a part of this mass, kg, and this centre.
fn inertia(given: InertiaEntry, centre: Vector3, mass: f64) -> Result<Inertia, Wrong> {
    let InertiaEntry { centre: own, moments: [xx, yy, zz], products } = given;
    let centre = own.map_or(Ok(centre), |own| place("inertia.centre", own))?;
    let [xy, xz, yz] = products.unwrap_or_default();
    let inertia = Inertia { centre, tensor: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] };
    match inertia.fault(mass) {
        None => Ok(inertia),
        Some(fault) => Err(format!("its inertia {fault} (its mass is {mass:.3e} kg)")),
    }
}

/// A sensor that is given in the frame of the file, in that of its part.
pub(super) fn spot(part: &Part, &[x, y, z, a, b, c]: &[f64; 6]) -> Result<Spot, Wrong> {
    let position = place("a place", [x, y, z])?;
    let normal = direction("the direction of a place", [a, b, c])?;
    let own = |way: Vector3| {
        [0, 1, 2].map(|column| (0..3).map(|row| part.rotation[row][column] * way[row]).sum::<f64>())
    };
    let off = [0, 1, 2].map(|axis| position[axis] - part.centre[axis]);
    Ok(Spot { position: own(off), normal: own(normal) })
}

impl PartEntry {
    /// The part, with `density` if it names none.
    pub(super) fn part(&self, density: f64) -> Result<Part, Wrong> {
        let word = match self.shape {
            ShapeName::Cylinder => "cylinder",
            ShapeName::Capsule => "capsule",
            ShapeName::Sphere => "sphere",
            ShapeName::Box => "box",
        };
        let is_long = matches!(self.shape, ShapeName::Cylinder | ShapeName::Capsule);
        let is_box = self.shape == ShapeName::Box;
        for (key, given, belongs) in [
            ("radius", self.radius.is_some(), !is_box),
            ("from", self.from.is_some(), is_long),
            ("to", self.to.is_some(), is_long),
            ("centre", self.centre.is_some(), !is_long),
            ("size", self.size.is_some(), is_box),
            ("quaternion", self.quaternion.is_some(), is_box),
        ] {
            if given && !belongs {
                return Err(format!("it has {key}, which a {word} does not have"));
            }
        }
        let radius = || length("radius", needed("radius", self.radius, word)?);
        let centre = || place("centre", needed("centre", self.centre, word)?);
        let (shape, centre, rotation) = match self.shape {
            ShapeName::Cylinder | ShapeName::Capsule => {
                let from = Column::from(place("from", needed("from", self.from, word)?)?);
                let to = Column::from(place("to", needed("to", self.to, word)?)?);
                let long = length("the distance of from and to", (to - from).norm())?;
                let radius = radius()?;
                let shape = match self.shape {
                    ShapeName::Cylinder => Shape::Cylinder { radius, length: long },
                    _ => Shape::Capsule { radius, length: long },
                };
                (shape, (from + (to - from) / 2.0).into(), across((to - from).into()))
            }
            ShapeName::Sphere => (Shape::Sphere { radius: radius()? }, centre()?, across([0.0, 0.0, 1.0])),
            ShapeName::Box => {
                let sides = needed("size", self.size, word)?;
                for side in sides {
                    length("each number of size", side)?;
                }
                let [w, x, y, z] = self.quaternion.unwrap_or([1.0, 0.0, 0.0, 0.0]);
                let turn = Quaternion::new(w, x, y, z);
                if !(1e-6..=1e6).contains(&turn.norm()) {
                    return Err(format!("quaternion is [{w}, {x}, {y}, {z}], but must not be 0"));
                }
                let turn = UnitQuaternion::from_quaternion(turn).to_rotation_matrix();
                let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| turn[(row, column)]));
                (Shape::Box { sides }, centre()?, rows)
            }
        };
        // After the lengths: a density of a mass and wrong lengths is wrong, too.
        let density = self.density.unwrap_or(density);
        if !is_moderate(density) {
            return Err(format!("density is {density}, but must be 0.000001 to 1000000 (kg/m³)"));
        }
        let inertia =
            self.inertia.map(|given| inertia(given, centre, density * shape.volume())).transpose()?;
        Ok(Part { shape, centre, rotation, density, inertia })
    }

    /// The joint of part `at`, which comes after `earlier` ones; the first has none.
    pub(super) fn joint(&self, at: usize, earlier: &[Self], part: &Part) -> Result<Option<Joint>, Wrong> {
        let Some(parent) = &self.parent else {
            if at > 0 {
                return Err("it lacks parent; only the first part may lack it".to_owned());
            }
            if self.joint.is_some() || self.anchor.is_some() || self.axes.is_some() {
                return Err("it has a joint but no parent".to_owned());
            }
            return Ok(None);
        };
        let Some(parent) = earlier.iter().position(|other| other.name == *parent) else {
            return Err(format!("its parent `{parent}` is not an earlier part"));
        };
        let Some(anchor) = self.anchor.or(self.from) else {
            return Err("it lacks anchor, the place of its joint".to_owned());
        };
        let axes = self
            .axes
            .as_deref()
            .map(|axes| axes.iter().map(|&axis| direction("an axis", axis)).collect::<Result<Vec<_>, _>>());
        let axes = axes.transpose()?;
        let freedom = match (self.joint, axes.as_deref()) {
            (None, _) => return Err("it lacks joint: universal, hinge, ball or fixed".to_owned()),
            (Some(JointName::Universal), None) => {
                Freedom::Universal([0, 1].map(|column| part.rotation.map(|row| row[column])))
            }
            (Some(JointName::Universal), Some(&[first, second])) => {
                let cosine = Column::from(first).dot(&Column::from(second));
                if cosine.abs() > OBLIQUE {
                    return Err(format!(
                        "its axes are not at right angles (the cosine between them is {cosine:.6})"
                    ));
                }
                Freedom::Universal([first, second])
            }
            (Some(JointName::Hinge), Some(&[axis])) => Freedom::Hinge(axis),
            (Some(JointName::Ball), None) => Freedom::Ball,
            (Some(JointName::Fixed), None) => Freedom::Fixed,
            (Some(JointName::Universal), _) => return Err("a universal joint has two axes".to_owned()),
            (Some(JointName::Hinge), _) => {
                return Err("a hinge needs axes = [[x, y, z]], one axis".to_owned());
            }
            (Some(_), _) => return Err("it has axes, which a ball or fixed joint does not have".to_owned()),
        };
        Ok(Some(Joint { parent, child: at, anchor: place("anchor", anchor)?, freedom }))
    }
}
