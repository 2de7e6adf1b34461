//! Read MJCF, the description that MuJoCo reads: its nested bodies, their joints and geoms.

mod defaults;

use std::collections::{HashMap, HashSet};

use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use roxmltree::Node;

use self::defaults::Defaults;
use super::placed::{Link, Solid, Turn, weigh, z_to};
use super::xml::{Element, Wrong};
use crate::stages::agent::Shape;

/// Elements that stand for others, which bodies may be among.
const UNREAD: [&str; 6] = ["include", "attach", "replicate", "composite", "flexcomp", "plugin"];

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

/// Bodies of a file, as far as they are read.
struct Bodies<'a> {
    defaults: Defaults<'a>,
    links: Vec<Link>,
    /// The geoms of each body, each with its frame.
    geoms: Vec<Vec<(Element<'a>, Isometry3<f64>)>>,
    /// The mass that each body names, kg.
    masses: Vec<Option<f64>>,
    /// Names of bodies that have one.
    taken: HashSet<&'a str>,
    unnamed: usize,
}

/// The bodies of the element `mujoco`, each after the one that carries it.
pub(super) fn links<'a>(root: Node<'a, 'a>) -> Result<Vec<Link>, Wrong> {
    if let Some(node) = root.descendants().find(|node| node.has_tag_name("include")) {
        return Err(Element::new("include", node)
            .wrong("is not supported; insert the content of that file in its place"));
    }
    let tied = |node: &Node| {
        ["connect", "weld"].contains(&node.tag_name().name()) && node.attribute("active") != Some("false")
    };
    let equalities = root.children().filter(|node| node.has_tag_name("equality"));
    if let Some(node) = equalities.flat_map(|node| node.children()).find(tied) {
        let label = format!("{} in equality", node.tag_name().name());
        return Err(Element::new(label, node).wrong("joins bodies in addition to the tree; remove it"));
    }
    let worlds = || root.children().filter(|node| node.has_tag_name("worldbody"));
    let named = worlds().flat_map(|world| world.descendants()).filter(|node| node.has_tag_name("body"));
    let mut bodies = Bodies {
        defaults: Defaults::new(root)?,
        links: Vec::new(),
        geoms: Vec::new(),
        masses: Vec::new(),
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
                self.links.push(Link { name, parent, origin, turns: Vec::new(), solids: Vec::new() });
                self.geoms.push(Vec::new());
                self.masses.push(None);
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
                self.masses[body] = Some(Element::new(label, node).needed_number("mass")?);
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

    /// The bodies, with their solids.
    fn finish(self) -> Result<Vec<Link>, Wrong> {
        let Self { defaults, mut links, geoms, masses, .. } = self;
        for ((link, geoms), mass) in links.iter_mut().zip(geoms).zip(masses) {
            let touches = geoms.iter().map(|(geom, _)| touches(geom)).collect::<Result<Vec<_>, _>>()?;
            // What touches nothing is a picture, if anything else does.
            let all = !touches.contains(&true);
            for ((geom, frame), touches) in geoms.iter().zip(touches) {
                if all || touches {
                    link.solids.push(solid(geom, frame, &defaults)?);
                }
            }
            if let Some(mass) = mass {
                weigh(&mut link.solids, mass);
            }
        }
        Ok(links)
    }
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

/// The solid that a geom of a body with this frame is.
fn solid(geom: &Element, frame: &Isometry3<f64>, defaults: &Defaults) -> Result<Solid, Wrong> {
    let kind = if geom.text("mesh").is_some() { "mesh" } else { geom.text("type").unwrap_or("sphere") };
    let lengths = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        "box" => 3,
        other => {
            return Err(
                geom.wrong(format!("is of type `{other}`; make it a box, sphere, cylinder or capsule"))
            );
        }
    };
    let ends = geom.numbers::<6>("fromto")?;
    if ends.is_some() && kind == "sphere" {
        return Err(geom.wrong("has fromto, but is a sphere; give its type: capsule, cylinder or box"));
    }
    let lengths = if ends.is_some() { 1 } else { lengths };
    let mut size = geom.overlaid("size")?;
    if size.len() < lengths {
        return Err(geom.wrong(format!("has {} numbers of size, but a {kind} needs {lengths}", size.len())));
    }
    let pose = match ends {
        None => defaults.pose(geom)?,
        Some([a, b, c, d, e, f]) => {
            let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
            let along = to - from;
            let direction = geom.direction("fromto", along.as_slice())?;
            // MuJoCo turns z to the first end, which shows in a box alone; otherwise `from` stays the first end.
            let turn = z_to(&if kind == "box" { -direction } else { direction });
            let half = along.norm() / 2.0;
            size = if kind == "box" { vec![size[0], size[0], half] } else { vec![size[0], half] };
            Isometry3::from_parts(Translation3::from(from + along / 2.0), turn)
        }
    };
    // Lengths are halves in MJCF.
    let shape = match size[..] {
        [radius, ..] if kind == "sphere" => Shape::Sphere { radius },
        [radius, half, ..] if kind == "capsule" => Shape::Capsule { radius, length: 2.0 * half },
        [radius, half, ..] if kind == "cylinder" => Shape::Cylinder { radius, length: 2.0 * half },
        [x, y, z, ..] => Shape::Box { sides: [x, y, z].map(|half| 2.0 * half) },
        _ => return Err(geom.wrong("has too few numbers of size")),
    };
    let density = geom.number("density")?.filter(|density| *density != 0.0);
    let mut solid = Solid { shape, pose: frame * pose, density };
    if let Some(mass) = geom.number("mass")? {
        weigh(std::slice::from_mut(&mut solid), mass);
    }
    Ok(solid)
}

#[cfg(test)]
mod tests;
