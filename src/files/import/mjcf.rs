//! Read MJCF, the description that MuJoCo reads: its nested bodies, their joints and geoms.

mod assets;
mod defaults;

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;
use std::rc::Rc;

use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Vector3};
use roxmltree::Node;

use self::assets::Assets;
use self::defaults::Defaults;
use super::document::Wrong;
use super::located::Located;
use super::mesh::Mesh;
use super::notes::names;
use super::placed::{Link, Read, Solid, Turn, settled, z_to};
use super::xml::Element;
use crate::files::body::DENSITY;
use crate::stages::agent::Shape;

/// Elements that stand for others, which bodies may be among.
const UNREAD: [&str; 4] = ["attach", "composite", "flexcomp", "plugin"];

/// Elements of bodies that say nothing of parts, joints or shapes.
const BESIDE: [&str; 5] = ["site", "camera", "light", "inertial", "geom"];

/// A frame, and what holds for all within it.
#[derive(Clone, Copy)]
struct Frame<'a> {
    /// From this frame to the common one.
    pose: Isometry3<f64>,
    /// Class of elements that name none.
    class: Option<&'a str>,
    /// The body that it belongs to; none for the world.
    body: Option<usize>,
}

/// What a body names as its inertia.
struct Inertial {
    /// kg.
    mass: f64,
    /// About the centre of mass, kg m².
    tensor: Matrix3<f64>,
    /// From the frame of the tensor to the common one.
    pose: Isometry3<f64>,
}

/// Bodies of a file, as far as they are read.
struct Bodies<'a> {
    defaults: Defaults<'a>,
    assets: Assets<'a>,
    notes: Vec<String>,
    links: Vec<Link>,
    /// The geoms of each body, each with its frame.
    geoms: Vec<Vec<(Element<'a>, Isometry3<f64>)>>,
    /// The inertia that each body names.
    inertials: Vec<Option<Inertial>>,
    /// Names of bodies that have one.
    taken: HashSet<&'a str>,
    unnamed: usize,
}

/// The bodies of the element `mujoco`, each after the one that carries it. `strict` refuses bodies that are tied together in
/// addition to the tree.
pub(super) fn links<'a>(root: Node<'a, 'a>, files: &'a Located, strict: bool) -> Result<Read, Wrong> {
    let defaults = Defaults::new(root)?;
    let notes = Vec::from_iter(ties(root, &defaults, strict)?);
    let worlds = || root.children().filter(|node| node.has_tag_name("worldbody"));
    let named = worlds().flat_map(|world| world.descendants()).filter(|node| node.has_tag_name("body"));
    let mut bodies = Bodies {
        assets: Assets::new(root, files, &defaults)?,
        defaults,
        notes,
        links: Vec::new(),
        geoms: Vec::new(),
        inertials: Vec::new(),
        taken: named.filter_map(|node| node.attribute("name")).collect(),
        unnamed: 0,
    };
    for world in worlds() {
        // Elements come before those within them.
        let mut frames = HashMap::new();
        let still = Frame { pose: Isometry3::identity(), class: world.attribute("childclass"), body: None };
        frames.insert(world.id(), still);
        for node in world.descendants().filter(Node::is_element) {
            let around = node.parent_element().and_then(|parent| frames.get(&parent.id()).copied());
            let Some(around) = around else {
                let tag = node.tag_name().name();
                if ["body", "geom", "joint", "freejoint", "frame"].contains(&tag) {
                    return Err(Element::new(tag, node)
                        .wrong("is within an element that cannot contain it; move it out"));
                }
                continue;
            };
            if let Some(frame) = bodies.read(node, around)? {
                frames.insert(node.id(), frame);
            }
        }
    }
    bodies.finish()
}

/// Says which bodies are tied together in addition to the tree, which they then are not. A tie with the world is none: a body
/// floats.
fn ties<'a>(root: Node<'a, 'a>, defaults: &Defaults<'a>, strict: bool) -> Result<Option<String>, Wrong> {
    let sections = root.children().filter(|node| node.has_tag_name("equality"));
    let mut tied = Vec::new();
    for node in sections.flat_map(|node| node.children()) {
        let tag = node.tag_name().name();
        if !["connect", "weld"].contains(&tag) {
            continue;
        }
        let element = defaults.over_as(format!("{tag} in equality"), node, "equality")?;
        let (Some(first), Some(second)) = (node.attribute("body1"), node.attribute("body2")) else {
            continue;
        };
        if element.text("active") == Some("false") || [first, second].contains(&"world") {
            continue;
        }
        if strict {
            return Err(element.wrong("joins bodies in addition to the tree; remove it"));
        }
        tied.push(format!("{first} with {second}"));
    }
    let names = names(tied.iter().map(String::as_str));
    Ok(names.map(|names| format!("ties between bodies beside the tree are left out {names}")))
}

impl<'a> Bodies<'a> {
    /// Reads an element that is in a frame, but not what is within it; gives the frame that it is itself.
    fn read(&mut self, node: Node<'a, 'a>, around: Frame<'a>) -> Result<Option<Frame<'a>>, Wrong> {
        let tag = node.tag_name().name();
        let label = match around.body {
            Some(body) => format!("{tag} of body `{}`", self.links[body].name),
            None => tag.to_owned(),
        };
        if UNREAD.contains(&tag) {
            return Err(Element::new(label, node).wrong("is not supported; write out what it stands for"));
        }
        match (tag, around.body) {
            ("body", parent) => {
                let name = node.attribute("name").map_or_else(|| self.free_name(), str::to_owned);
                let frame = self.frame(Element::new(format!("body `{name}`"), node), node, around)?;
                let origin = frame.pose.translation.vector;
                let (turns, solids) = (Vec::new(), Vec::new());
                self.links.push(Link { name, parent, origin, turns, solids, bare_mass: 0.0 });
                self.geoms.push(Vec::new());
                self.inertials.push(None);
                Ok(Some(Frame { body: Some(self.links.len() - 1), ..frame }))
            }
            ("frame", _) => self.frame(Element::new(label, node), node, around).map(Some),
            ("geom", Some(body)) => {
                let geom = self.defaults.over(label, node, around.class)?;
                self.geoms[body].push((geom, around.pose));
                Ok(None)
            }
            ("joint" | "freejoint", Some(body)) => {
                let joint = self.defaults.over(label, node, around.class)?;
                let turn = if tag == "joint" { turn(&joint, &around.pose)? } else { Turn::Other("free") };
                self.links[body].turns.push(turn);
                Ok(None)
            }
            ("inertial", Some(body)) if !self.defaults.weighs_geoms => {
                self.inertials[body] = Some(self.inertial(&Element::new(label, node), &around)?);
                Ok(None)
            }
            _ if BESIDE.contains(&tag) => Ok(None),
            _ => Err(Element::new(label, node).wrong("is unknown here; check its name and where it is")),
        }
    }

    /// The frame that an element is.
    fn frame(&self, element: Element<'a>, node: Node<'a, 'a>, around: Frame<'a>) -> Result<Frame<'a>, Wrong> {
        let pose = around.pose * self.defaults.pose(&element)?;
        Ok(Frame { pose, class: node.attribute("childclass").or(around.class), body: around.body })
    }

    /// A name for a body that has none.
    fn free_name(&mut self) -> String {
        loop {
            self.unnamed += 1;
            let name = format!("body{}", self.unnamed);
            if !self.taken.contains(name.as_str()) {
                return name;
            }
        }
    }

    fn inertial(&self, element: &Element, around: &Frame) -> Result<Inertial, Wrong> {
        let pose = around.pose * self.defaults.pose(element)?;
        let tensor = match element.numbers("fullinertia")? {
            Some([xx, yy, zz, xy, xz, yz]) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            None => Matrix3::from_diagonal(&element.numbers("diaginertia")?.unwrap_or_default().into()),
        };
        Ok(Inertial { mass: element.needed_number("mass")?, tensor, pose })
    }

    /// The bodies, with their solids.
    fn finish(mut self) -> Result<Read, Wrong> {
        let geoms = std::mem::take(&mut self.geoms);
        let inertials = std::mem::take(&mut self.inertials);
        for (body, (geoms, inertial)) in geoms.into_iter().zip(inertials).enumerate() {
            let (solids, bare_mass) = self.solids(body, &geoms, inertial.as_ref())?;
            self.links[body].bare_mass = bare_mass;
            self.links[body].solids = solids;
        }
        if let Some(total) = self.defaults.total_mass {
            let solids = || self.links.iter().flat_map(|link| &link.solids);
            let own = solids().map(Solid::own_mass).sum::<f64>()
                + self.links.iter().map(|link| link.bare_mass).sum::<f64>();
            for link in &mut self.links {
                link.bare_mass *= total / own;
                link.solids.iter_mut().for_each(|solid| solid.mass = Some(solid.own_mass() * total / own));
            }
        }
        Ok(Read { links: self.links, notes: self.notes })
    }

    /// What a body consists of, and its mass, kg, if it has no shape.
    fn solids(
        &mut self,
        body: usize,
        geoms: &[(Element<'a>, Isometry3<f64>)],
        inertial: Option<&Inertial>,
    ) -> Result<(Vec<Solid>, f64), Wrong> {
        let touches = geoms.iter().map(|(geom, _)| touches(geom)).collect::<Result<Vec<_>, _>>()?;
        // What touches nothing is a picture, if anything else does.
        let all = !touches.contains(&true);
        let (mut solids, mut mass, mut missing) = (Vec::new(), 0.0, None);
        for ((geom, frame), touches) in geoms.iter().zip(touches) {
            // Of a picture nothing counts then.
            if inertial.is_some() && !all && !touches {
                continue;
            }
            let mut solid = match self.solid(geom, frame)? {
                Found::Solid(solid) => solid,
                Found::Absent(file) => {
                    missing = missing.or(Some(file));
                    continue;
                }
                Found::Endless => continue,
            };
            if !self.defaults.weighs(geom)? {
                solid.mass = Some(0.0);
            }
            mass += solid.own_mass();
            if all || touches {
                solids.push(solid);
            }
        }
        let mass = inertial.map_or(mass, |inertial| inertial.mass);
        let inertia_box = inertial.and_then(|own| Solid::of_inertia(own.mass, own.tensor, own.pose));
        let label = ["body", &self.links[body].name];
        Ok(settled(label, solids, mass, missing.as_deref(), inertia_box, &mut self.notes))
    }
}

/// What a geom is.
enum Found {
    Solid(Solid),
    /// A mesh that cannot be had, and why.
    Absent(String),
    /// A plane or a height field, which is no part of a robot.
    Endless,
}

/// How a joint of a body with this frame turns.
fn turn(joint: &Element, frame: &Isometry3<f64>) -> Result<Turn, Wrong> {
    let anchor = (frame * Point3::from(joint.numbers::<3>("pos")?.unwrap_or_default())).coords;
    Ok(match joint.text("type").unwrap_or("hinge") {
        "hinge" => {
            let axis = joint.numbers::<3>("axis")?.unwrap_or([0.0, 0.0, 1.0]);
            Turn::Hinge { anchor, axis: frame * joint.direction("axis", &axis)?.into_inner() }
        }
        "ball" => Turn::Ball { anchor },
        "slide" => Turn::Other("slide"),
        "free" => Turn::Other("free"),
        other => {
            return Err(joint.wrong(format!("has type `{other}`, which must be hinge, ball, slide or free")));
        }
    })
}

/// Whether a geom touches others.
fn touches(geom: &Element) -> Result<bool, Wrong> {
    let kinds = |key| geom.number(key).map(|kinds| kinds.unwrap_or(1.0));
    Ok(kinds("contype")? != 0.0 || kinds("conaffinity")? != 0.0)
}

impl<'a> Bodies<'a> {
    /// What a geom of a body with this frame is.
    fn solid(&mut self, geom: &Element<'a>, frame: &Isometry3<f64>) -> Result<Found, Wrong> {
        let kind = if geom.text("mesh").is_some() { "mesh" } else { geom.text("type").unwrap_or("sphere") };
        let lengths = match kind {
            "sphere" => 1,
            "capsule" | "cylinder" => 2,
            "box" | "ellipsoid" => 3,
            "mesh" => {
                let pose = frame * self.defaults.pose(geom)?;
                return Ok(match self.assets.mesh(geom)? {
                    Ok(mesh) => Found::Solid(self.weighed(geom, Solid::of_mesh(mesh, pose))?),
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
        self.weighed(geom, solid).map(Found::Solid)
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

#[cfg(test)]
mod tests;
