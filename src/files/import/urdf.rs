//! Read URDF, the description that ROS reads: links, and joints between them.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::document::Wrong;
use super::inertia::Mass;
use super::known::{URDF, unknown, urdf_elements};
use super::located::Located;
use super::mesh;
use super::notes::{absent, names};
use super::placed::{Link, Read, Solid, Turn, settled};
use super::xml::Element;
use crate::stages::agent::Shape;

/// The link that needs no element.
const WORLD: &str = "world";

/// A joint by the places of its links among all links.
struct Joint<'a> {
    element: Element<'a>,
    node: Node<'a, 'a>,
    parent: usize,
    child: usize,
}

/// The links of the element `robot`, each after the one that carries it. `strict` refuses attributes that are not known.
pub(super) fn links<'a>(root: Node<'a, 'a>, files: &Located, strict: bool) -> Result<Read, Wrong> {
    let mut notes = Vec::from_iter(not_expanded(root, strict)?);
    notes.extend(unknown(urdf_elements(root), &URDF, strict)?);
    let mut nodes = Vec::new();
    let mut places = HashMap::new();
    for node in root.children().filter(|node| node.has_tag_name("link")) {
        let name = Element::new("link", node).needed("name")?;
        if places.insert(name, nodes.len()).is_some() {
            return Err(labelled("link", name, node).wrong("exists twice; rename one"));
        }
        nodes.push((name, node));
    }
    let is_joint = |node: &Node| node.has_tag_name("joint");
    // Some readers know the world without a link for it.
    let on_world =
        |joint: Node<'a, 'a>| child(joint, "parent").filter(|end| end.attribute("link") == Some(WORLD));
    if let Some(world) = root.children().filter(is_joint).find_map(on_world)
        && !places.contains_key(WORLD)
    {
        places.insert(WORLD, nodes.len());
        nodes.push((WORLD, world));
    }
    let mut joints = Vec::new();
    for node in root.children().filter(is_joint) {
        let name = Element::new("joint", node).needed("name")?;
        let element = labelled("joint", name, node);
        let end = |tag: &'static str| {
            let end = child(node, tag).ok_or_else(|| element.wrong(format!("lacks <{tag}>; add it")))?;
            let link = element.part(end).needed("link")?;
            places.get(link).copied().ok_or_else(|| {
                element.wrong(format!(
                    "has {tag} `{link}`, which is not a link; add the link or correct the name"
                ))
            })
        };
        let (parent, child) = (end("parent")?, end("child")?);
        joints.push(Joint { element, node, parent, child });
    }
    let link_names: Vec<&str> = nodes.iter().map(|(name, _)| *name).collect();
    let mut links = Vec::new();
    let mimics = joints.iter().filter(|joint| child(joint.node, "mimic").is_some());
    if let Some(names) = names(mimics.filter_map(|joint| joint.node.attribute("name"))) {
        notes.push(format!("joints that follow others (mimic) move by themselves {names}"));
    }
    let mut frames: Vec<Isometry3<f64>> = Vec::new();
    for (at, joint) in ordered(&link_names, &joints)? {
        // Where the link is among those that are read, and its frame.
        let (name, node) = nodes[at];
        let (mut parent, mut frame, mut turns) = (None, Isometry3::identity(), Vec::new());
        if let Some((joint, below)) = joint {
            frame = frames[below] * origin(&joint.element, joint.node)?;
            parent = Some(below);
            turns.extend(turn(joint, &frame)?);
        }
        let reader = Reader { name, node, frame, files, strict };
        let (solids, bare_mass, named) = reader.solids(&mut notes)?;
        let is_unweighed = reader.mass()? == 0.0;
        let origin = frame.translation.vector;
        links.push(Link {
            name: name.to_owned(),
            parent,
            origin,
            turns,
            solids,
            bare_mass,
            named,
            is_unweighed,
        });
        frames.push(frame);
    }
    Ok(Read { links, notes })
}

/// Elements by which xacro builds a robot. Others call a macro, which a file without any macros no longer has.
const BUILDS: [&str; 10] =
    ["macro", "include", "property", "arg", "if", "unless", "insert_block", "call", "element", "attribute"];

/// A note on what is left of macros in a file that xacro has expanded.
///
/// # Errors
/// If xacro still has to expand it, or if it is `strict`.
fn not_expanded(root: Node, strict: bool) -> Result<Option<String>, Wrong> {
    // Without a namespace where the file does not declare its prefix.
    let own_name = |node: Node<'_, '_>| {
        let tag = node.tag_name();
        let is_of_xacro = tag.namespace().is_some_and(|space| space.contains("xacro"));
        tag.name().strip_prefix("xacro.").or(is_of_xacro.then_some(tag.name())).map(str::to_owned)
    };
    let left: Vec<(String, Node)> =
        root.descendants().filter_map(|node| own_name(node).map(|name| (name, node))).collect();
    if let Some((name, node)) = left.iter().find(|(name, _)| strict || BUILDS.contains(&&**name)) {
        let wrong = Element::new(name, *node);
        return Err(wrong.wrong("is an element of xacro; expand the file first: xacro FILE > robot.urdf"));
    }
    let names = names(left.iter().map(|(name, _)| &**name));
    Ok(names.map(|names| format!("macros of xacro that were not expanded are left out {names}")))
}

/// Links in the order in which each comes after the one that carries it, and all on one together; each with its joint and
/// where in that order the one is that carries it.
#[expect(clippy::type_complexity, reason = "used once")]
fn ordered<'j, 'a>(
    names: &[&str],
    joints: &'j [Joint<'a>],
) -> Result<Vec<(usize, Option<(&'j Joint<'a>, usize)>)>, Wrong> {
    let mut carried: Vec<Vec<&Joint>> = names.iter().map(|_| Vec::new()).collect();
    let mut is_carried = HashSet::new();
    for joint in joints {
        if !is_carried.insert(joint.child) {
            let name = names[joint.child];
            return Err(joint.element.wrong(format!("carries `{name}`, as another joint does; remove one")));
        }
        carried[joint.parent].push(joint);
    }
    let roots = (0..names.len()).rev().filter(|at| !is_carried.contains(at));
    let mut order = Vec::new();
    let mut next: Vec<(usize, Option<(&Joint, usize)>)> = roots.map(|root| (root, None)).collect();
    while let Some((at, joint)) = next.pop() {
        next.extend(carried[at].iter().rev().map(|joint| (joint.child, Some((*joint, order.len())))));
        order.push((at, joint));
    }
    // What no root leads to goes round in a circle.
    let reached: HashSet<usize> = order.iter().map(|(at, _)| *at).collect();
    match (0..names.len()).find(|at| !reached.contains(at)) {
        Some(at) => {
            Err(format!("link `{}` is in a loop of joints or on one; remove a joint of it", names[at]))
        }
        None => Ok(order),
    }
}

fn labelled<'a>(tag: &str, name: &str, node: Node<'a, 'a>) -> Element<'a> {
    Element::new(format!("{tag} `{name}`"), node)
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|child| child.has_tag_name(tag))
}

/// From the frame of an element with this label to the one around it. Angles turn about fixed axes: x, then y, then z.
fn origin(element: &Element, node: Node) -> Result<Isometry3<f64>, Wrong> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let origin = element.part(origin);
    let place = Vector3::from(origin.numbers("xyz")?.unwrap_or_default());
    let turn = match origin.numbers::<4>("quat_xyzw")? {
        Some([x, y, z, w]) => UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9)
            .ok_or_else(|| origin.wrong("has quat_xyzw of length 0; give it a rotation"))?,
        None => {
            let [roll, pitch, yaw] = origin.numbers("rpy")?.unwrap_or_default();
            UnitQuaternion::from_euler_angles(roll, pitch, yaw)
        }
    };
    Ok(Isometry3::from_parts(Translation3::from(place), turn))
}

/// How a joint turns that leads to this frame; not at all if it is fixed.
fn turn(joint: &Joint, frame: &Isometry3<f64>) -> Result<Option<Turn>, Wrong> {
    let element = &joint.element;
    Ok(Some(match element.needed("type")? {
        "revolute" | "continuous" => {
            let axis = match child(joint.node, "axis") {
                Some(axis) => {
                    let axis = element.part(axis);
                    axis.direction("xyz", &axis.numbers::<3>("xyz")?.unwrap_or([1.0, 0.0, 0.0]))?
                }
                None => Vector3::x_axis(),
            };
            Turn::Hinge { anchor: frame.translation.vector, axis: frame * axis.into_inner() }
        }
        "fixed" => return Ok(None),
        "spherical" | "ball" => Turn::Ball { anchor: frame.translation.vector },
        "floating" => Turn::Other("floating"),
        "prismatic" => Turn::Other("prismatic"),
        "planar" => Turn::Other("planar"),
        other => {
            return Err(
                element.wrong(format!("has type `{other}`, which must be revolute, continuous or fixed"))
            );
        }
    }))
}

/// A link that is read.
struct Reader<'a, 'f> {
    name: &'a str,
    node: Node<'a, 'a>,
    frame: Isometry3<f64>,
    files: &'f Located,
    strict: bool,
}

impl<'a> Reader<'a, '_> {
    fn element(&self) -> Element<'a> {
        labelled("link", self.name, self.node)
    }

    /// What the link consists of: what it collides with, or else what it looks like, or else a box of its inertia; the mass of
    /// a link without any, kg; and its mass as it names it.
    fn solids(&self, notes: &mut Vec<String>) -> Result<(Vec<Solid>, f64, Option<Mass>), Wrong> {
        let inertial = child(self.node, "inertial");
        let mass = self.mass()?;
        let (mut solids, mut missing) = (Vec::new(), None);
        for tag in ["collision", "visual"] {
            let (found, absent) = self.shapes(tag)?;
            missing = missing.or(absent.clone());
            // What only marks a place is no shape, if there is another one.
            let is_real = found.iter().any(|solid| !solid.is_dummy());
            if solids.is_empty() || is_real && absent.is_none() {
                solids = found;
            }
            if is_real && absent.is_none() {
                break;
            }
        }
        let missing = missing.as_deref().map(absent);
        let inertia = self.inertia(inertial)?;
        let named = inertia.as_ref().and_then(|(tensor, pose)| Mass::new(mass, *tensor, pose));
        let inertia_box = inertia.and_then(|(tensor, pose)| Solid::of_inertia(mass, tensor, pose));
        let label = ["link", self.name];
        let (solids, bare_mass) =
            settled(label, solids, mass, missing.as_deref(), inertia_box, self.strict, notes)?;
        Ok((solids, bare_mass, named))
    }

    /// The mass that the link names, kg; 0 if it names none.
    fn mass(&self) -> Result<f64, Wrong> {
        match child(self.node, "inertial").and_then(|inertial| child(inertial, "mass")) {
            Some(mass) => self.element().part(mass).needed_number("value"),
            None => Ok(0.0),
        }
    }

    /// The shapes that the link has as `tag`, and the first mesh that is not there.
    fn shapes(&self, tag: &str) -> Result<(Vec<Solid>, Option<String>), Wrong> {
        let (mut solids, mut missing) = (Vec::new(), None);
        for node in self.node.children().filter(|node| node.has_tag_name(tag)) {
            let geometry = child(node, "geometry").and_then(|geometry| geometry.first_element_child());
            let Some(geometry) = geometry else {
                return Err(
                    labelled("link", self.name, node).wrong(format!("has a {tag} without geometry; add it"))
                );
            };
            let geometry = self.element().part(geometry);
            let pose = self.frame * origin(&self.element(), node)?;
            if geometry.tag() != "mesh" {
                solids.push(Solid::new(shape(&geometry)?, pose));
                continue;
            }
            let file = geometry.needed("filename")?;
            match self.files.find("", file).map_err(|wrong| geometry.wrong(wrong))? {
                Some(path) => {
                    let scale = geometry.numbers("scale")?.unwrap_or([1.0; 3]);
                    let mesh = mesh::read(&path).and_then(|mesh| mesh.scaled(scale));
                    solids.push(Solid::of_mesh(
                        Rc::new(mesh.map_err(|wrong| geometry.wrong(format!("cannot be read: {wrong}")))?),
                        pose,
                    ));
                }
                None => missing = missing.or(Some(file.to_owned())),
            }
        }
        Ok((solids, missing))
    }

    /// The link's inertia and its frame, if it names them.
    #[expect(clippy::type_complexity, reason = "used once")]
    fn inertia(
        &self,
        inertial: Option<Node<'a, 'a>>,
    ) -> Result<Option<(Matrix3<f64>, Isometry3<f64>)>, Wrong> {
        let Some((inertial, inertia)) = inertial.and_then(|node| Some((node, child(node, "inertia")?)))
        else {
            return Ok(None);
        };
        let inertia = self.element().part(inertia);
        let number = |key: &str| Ok::<_, Wrong>(inertia.number(key)?.unwrap_or_default());
        let [xx, yy, zz] = [number("ixx")?, number("iyy")?, number("izz")?];
        let [xy, xz, yz] = [number("ixy")?, number("ixz")?, number("iyz")?];
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        Ok(Some((tensor, self.frame * origin(&self.element(), inertial)?)))
    }
}

/// The shape that a geometry names, in whole lengths.
fn shape(geometry: &Element) -> Result<Shape, Wrong> {
    let radius = || geometry.needed_number("radius");
    let length = || geometry.needed_number("length");
    Ok(match geometry.tag() {
        "box" => Shape::Box { sides: geometry.needed_numbers("size")? },
        "sphere" => Shape::Sphere { radius: radius()? },
        "cylinder" => Shape::Cylinder { radius: radius()?, length: length()? },
        "capsule" => Shape::Capsule { radius: radius()?, length: length()? },
        _ => return Err(geometry.wrong("is not supported; make it a box, sphere, cylinder, capsule or mesh")),
    })
}

#[cfg(test)]
mod tests;
