//! Links as all kinds of file give them (MJCF, URDF, BVH): solids in the common frame, and turns about places and axes in it.

use std::rc::Rc;

use nalgebra::{Isometry3, Matrix3, Point3, UnitQuaternion, UnitVector3, Vector3 as Column};

use super::document::Wrong;
use super::inertia::{Mass, entry};
use super::mesh::{Mesh, THIN, principal};
use super::rounding::{round, rounded, significant};
use crate::files::body::{DENSITY, PartEntry, ShapeName, SkinEntry};
use crate::stages::agent::{Inertia, Shape, Spot, Vector3};

/// Volume of the smallest solid, m³: a little more than a cube of 2 mm, with which robots mark a place.
const TINY: f64 = 1e-8;
/// Density, kg/m³, above which a mass is not that of its shape: four times that of osmium, the densest metal.
pub(super) const DENSEST: f64 = 1e5;

/// A solid where it is in the rest pose.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    /// Its shape.
    pub shape: Shape,
    /// From the shape's frame to the common one.
    pub pose: Isometry3<f64>,
    /// Mass, kg, if it is known.
    pub mass: Option<f64>,
    /// The mesh that it stands for, and from its frame to the common one. Sensors are on the mesh.
    pub mesh: Option<(Rc<Mesh>, Isometry3<f64>)>,
    /// Whether it only stands for what has no shape, and carries no skin.
    pub is_bare: bool,
    /// Its share of the inertia that the description names, if it names one.
    pub inertia: Option<Inertia>,
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

impl Turn {
    /// The place about which it turns, if it does.
    pub(super) fn anchor(&self) -> Option<Column<f64>> {
        match self {
            Self::Hinge { anchor, .. } | Self::Ball { anchor } => Some(*anchor),
            Self::Other(_) => None,
        }
    }

    /// The name of a way that is no rotation.
    pub(super) fn other(&self) -> Option<&'static str> {
        match self {
            Self::Other(kind) => Some(kind),
            Self::Hinge { .. } | Self::Ball { .. } => None,
        }
    }
}

/// A body of MJCF, a link of URDF, or a bone of a skeleton.
#[derive(Debug, Clone, Default)]
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
    /// Mass of what has no shape on it, kg.
    pub bare_mass: f64,
    /// All of its mass, as the description names it.
    pub named: Option<Mass>,
    /// Whether it names no mass in a description where that is none (URDF). Its shapes weigh as water all the same where nothing that is
    /// fixed to it names a mass.
    pub is_unweighed: bool,
}

/// What was read of a description.
#[derive(Debug, Clone, Default)]
pub(super) struct Read {
    /// Its links, each after the one that carries it.
    pub links: Vec<Link>,
    /// What is in another way than the description has it, in a line each.
    pub notes: Vec<String>,
}

/// Gives solids this mass, kg, together: in the ratio of the masses that they have, or of their volumes if one has none. A mass of 0 says
/// nothing of them; neither does any mass of what has no volume, which is refused as a part.
pub(super) fn weigh(solids: &mut [Solid], mass: f64) {
    let masses: Vec<f64> = solids.iter().map(Solid::own_mass).collect();
    let volumes: Vec<f64> = solids.iter().map(Solid::bulk).collect();
    let shares = if masses.iter().all(|mass| *mass > 0.0) { masses } else { volumes };
    let all: f64 = shares.iter().sum();
    for (solid, share) in solids.iter_mut().zip(shares) {
        solid.mass = (mass != 0.0 && all > 0.0).then(|| mass * (share / all));
    }
}

/// What a link of this name consists of: these shapes, and the box of its inertia if meshes are missing and what is left is too small for the mass; all with
/// the mass, kg, of the link, and without what only marks a place. Also the mass if it has no shape, 0 otherwise. Messages call a
/// link `word`.
///
/// # Errors
/// If it is `strict`, and a shape is thinner than a part may be.
pub(super) fn settled(
    [word, name]: [&str; 2],
    mut solids: Vec<Solid>,
    mass: f64,
    missing: Option<&str>,
    inertia_box: Option<Solid>,
    strict: bool,
    notes: &mut Vec<String>,
) -> Result<(Vec<Solid>, f64), Wrong> {
    if let Some(missing) = missing {
        // A small shape beside a mesh that is missing, such as a logo, does not stand for the link.
        let others = mass < DENSEST * solids.iter().map(Solid::bulk).sum::<f64>();
        let stand_in = inertia_box.filter(|_| !others);
        let what = match &stand_in {
            Some(_) => "a box with its inertia stands for it",
            None if solids.is_empty() => "it has no shape",
            None => "its other shapes stand for it",
        };
        notes.push(format!("{word} `{name}`: {missing}; {what}"));
        solids.extend(stand_in);
    }
    weigh(&mut solids, mass);
    let all = solids.len();
    solids.retain(|solid| !solid.is_dummy());
    if solids.len() < all {
        let left = all - solids.len();
        notes
            .push(format!("{word} `{name}`: {left} of {all} shapes are too small or too light and left out"));
        weigh(&mut solids, mass);
    }
    let mut thin = 0;
    for solid in &mut solids {
        let thick = thickened(solid.shape);
        if thick != solid.shape {
            (solid.mass, solid.shape) = (Some(solid.own_mass()), thick);
            thin += 1;
        }
    }
    if thin > 0 {
        let all = solids.len();
        let what = format!("{word} `{name}`: {thin} of {all} shapes have a length or radius below 1 mm");
        if strict {
            return Err(format!("{what}; make it larger"));
        }
        notes.push(format!("{what}, which became 1 mm"));
    }
    let bare_mass = if solids.is_empty() { mass } else { 0.0 };
    Ok((solids, bare_mass))
}

/// A shape that is nowhere thinner than a part may be.
fn thickened(shape: Shape) -> Shape {
    // What is not positive is a mistake, which is refused as a part.
    let thick = |length: f64| if length > 0.0 { length.max(THIN) } else { length };
    match shape {
        Shape::Cylinder { radius, length } => {
            Shape::Cylinder { radius: thick(radius), length: thick(length) }
        }
        Shape::Capsule { radius, length } => Shape::Capsule { radius: thick(radius), length: thick(length) },
        // A smaller ball is a mark, and gone before.
        Shape::Sphere { radius } => Shape::Sphere { radius },
        Shape::Box { sides } => Shape::Box { sides: sides.map(thick) },
    }
}

/// The least rotation that takes z to a direction; about x if it is the opposite one.
pub(super) fn z_to(direction: &UnitVector3<f64>) -> UnitQuaternion<f64> {
    let axis = Column::z().cross(direction);
    let axis = UnitVector3::try_new(axis, 1e-10).unwrap_or(Column::x_axis());
    UnitQuaternion::from_axis_angle(&axis, direction.xy().norm().atan2(direction.z))
}

impl Solid {
    /// A solid of this shape.
    pub(super) fn new(shape: Shape, pose: Isometry3<f64>) -> Self {
        Self { shape, pose, mass: None, mesh: None, is_bare: false, inertia: None }
    }

    /// The box around a mesh in this frame.
    pub(super) fn of_mesh(mesh: Rc<Mesh>, pose: Isometry3<f64>) -> Self {
        let (sides, within) = mesh.bounds();
        let shape = Shape::Box { sides: sides.map(|side| side.max(THIN)) };
        Self { mesh: Some((mesh, pose)), ..Self::new(shape, pose * within) }
    }

    /// The box that has the inertia of a body of this mass, kg, which is about the centre of this frame, kg m². None if no box has it.
    pub(super) fn of_inertia(mass: f64, tensor: Matrix3<f64>, pose: Isometry3<f64>) -> Option<Self> {
        if !(mass > 0.0 && tensor.iter().all(|number| number.is_finite())) {
            return None;
        }
        let (turn, [x, y, z]) = principal(tensor);
        let pose = pose * turn;
        let sides =
            [y + z - x, z + x - y, x + y - z].map(|twice| (6.0 * twice / mass).max(0.0).sqrt().max(THIN));
        sides
            .iter()
            .all(|side| side.is_finite())
            .then(|| Self { mass: Some(mass), ..Self::new(Shape::Box { sides }, pose) })
    }

    /// Volume of its shape, m³; of a mesh that of the box.
    pub(super) fn bulk(&self) -> f64 {
        self.shape.volume()
    }

    /// Area of what it stands for, m².
    pub(super) fn area(&self) -> f64 {
        self.mesh.as_ref().map_or_else(|| self.shape.area(), |(mesh, _)| mesh.area())
    }

    /// Volume of what it stands for, m³.
    pub(super) fn volume(&self) -> f64 {
        self.mesh.as_ref().map_or_else(|| self.bulk(), |(mesh, _)| mesh.volume())
    }

    /// Its mass, kg; that of water if it is not known.
    pub(super) fn own_mass(&self) -> f64 {
        self.mass.unwrap_or_else(|| DENSITY * self.volume())
    }

    /// Whether it is too small or too light to be a part, such as a sphere of radius 0 that only marks a place.
    pub(super) fn is_dummy(&self) -> bool {
        let density = self.mass.map_or(DENSITY, |mass| mass / self.bulk());
        // What is negative is a mistake, which is refused as a part.
        (0.0..TINY).contains(&self.bulk()) || (0.0..1e-6).contains(&density)
    }

    /// Its density as a part, kg/m³, if its mass is known.
    pub(super) fn density(&self) -> Option<f64> {
        let mass = self.mass.or_else(|| self.mesh.as_ref().map(|_| self.own_mass()));
        mass.map(|mass| significant(mass / self.bulk()))
    }

    /// Whether a skin is too sparse for even one sensor on it. It then has one: a part that feels nothing would be none in truth.
    pub(super) fn is_sparse(&self, skin: SkinEntry) -> bool {
        let wanted = skin.per_area.is_some_and(|density| density > 0.0);
        wanted && !self.is_bare && skin.count(self.area()) == Ok(0)
    }

    /// Its sensors on the mesh that it stands for: place and direction of each in the common frame. None of a shape that is no mesh:
    /// sensors are then spread over the shape.
    fn places(&self, skin: SkinEntry) -> Result<Option<Vec<[f64; 6]>>, Wrong> {
        let Some((mesh, pose)) = &self.mesh else { return Ok(None) };
        let count = if self.is_sparse(skin) { 1 } else { skin.count(mesh.area())? };
        let placed = |spot: Spot| {
            let [x, y, z] = rounded((pose * Point3::from(spot.position)).coords);
            let [a, b, c] = rounded(pose.rotation * Column::from(spot.normal));
            [x, y, z, a, b, c]
        };
        Ok(Some(mesh.spread(count).into_iter().map(placed).collect()))
    }

    /// The surface of the mesh that it stands for, in the frame of its shape, in as few triangles as a picture needs.
    /// None if the mesh is so slender that nothing is left of it: then the shape is drawn.
    pub(super) fn surface(&self) -> Option<Vec<[Vector3; 3]>> {
        let (mesh, pose) = self.mesh.as_ref()?;
        let within = self.pose.inverse() * pose;
        let corner = |corner: Column<f64>| (within * Point3::from(corner)).coords.into();
        let triangles: Vec<_> = mesh.simplified().into_iter().map(|corners| corners.map(corner)).collect();
        Some(triangles).filter(|triangles| !triangles.is_empty())
    }

    /// The solid as a part that is not joined yet, with this skin if it is a mesh.
    ///
    /// # Errors
    /// If the skin has more sensors than a body may have.
    pub(super) fn part(&self, name: String, skin: SkinEntry) -> Result<PartEntry, Wrong> {
        let at = |height: f64| Some(rounded((self.pose * Point3::new(0.0, 0.0, height)).coords));
        let mut part = PartEntry {
            name,
            shape: ShapeName::Box,
            radius: None,
            from: None,
            to: None,
            centre: None,
            size: None,
            quaternion: None,
            density: self.density(),
            inertia: self.inertia.map(entry),
            parent: None,
            joint: None,
            anchor: None,
            axes: None,
            skin: None,
            places: self.places(skin)?,
        };
        let own = if self.is_bare { Some(0) } else { self.is_sparse(skin).then_some(1) };
        if part.places.is_none() {
            part.skin = own.map(|sensors| SkinEntry { sensors: Some(sensors), per_area: None });
        }
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
        Ok(part)
    }
}
