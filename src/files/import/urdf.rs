//! Read URDF, the description that ROS reads: links, and joints between them.

use std::collections::{HashMap, HashSet};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::placed::{Link, Solid, Turn, weigh};
use super::xml::{Element, Wrong};
use crate::stages::agent::Shape;

/// A joint by the places of its links among all links.
struct Joint<'a> {
    element: Element<'a>,
    node: Node<'a, 'a>,
    parent: usize,
    child: usize,
}

/// The links of the element `robot`, each after the one that carries it.
pub(super) fn links<'a>(root: Node<'a, 'a>) -> Result<Vec<Link>, Wrong> {
    let is_macro = |node: &Node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
    if let Some(node) = root.descendants().find(is_macro) {
        let wrong = Element::new(node.tag_name().name(), node);
        return Err(wrong.wrong("is an element of xacro; expand the file first: xacro FILE > robot.urdf"));
    }
    let mut nodes = Vec::new();
    let mut places = HashMap::new();
    for node in root.children().filter(|node| node.has_tag_name("link")) {
        let name = Element::new("link", node).needed("name")?;
        if places.insert(name, nodes.len()).is_some() {
            return Err(labelled("link", name, node).wrong("exists twice; rename one"));
        }
        nodes.push((name, node));
    }
    let mut joints = Vec::new();
    for node in root.children().filter(|node| node.has_tag_name("joint")) {
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
    let names: Vec<&str> = nodes.iter().map(|(name, _)| *name).collect();
    let mut links: Vec<Link> = Vec::new();
    let mut frames: Vec<Isometry3<f64>> = Vec::new();
    for (at, joint) in ordered(&names, &joints)? {
        // Where the link is among those that are read, and its frame.
        let (name, node) = nodes[at];
        let (mut parent, mut frame, mut turns) = (None, Isometry3::identity(), Vec::new());
        if let Some((joint, below)) = joint {
            frame = frames[below] * origin(&joint.element, joint.node)?;
            parent = Some(below);
            turns.extend(turn(joint, &frame)?);
        }
        let solids = solids(name, node, &frame)?;
        links.push(Link { name: name.to_owned(), parent, origin: frame.translation.vector, turns, solids });
        frames.push(frame);
    }
    Ok(links)
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
    let roots: Vec<usize> = (0..names.len()).filter(|at| !is_carried.contains(at)).collect();
    if let [first, second, ..] = roots[..] {
        return Err(format!(
            "links `{}` and `{}` are both roots, which no joint carries; join one to the other or remove it",
            names[first], names[second]
        ));
    }
    let mut order = Vec::new();
    let mut next: Vec<(usize, Option<(&Joint, usize)>)> =
        roots.into_iter().map(|root| (root, None)).collect();
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
    let [roll, pitch, yaw] = origin.numbers("rpy")?.unwrap_or_default();
    let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
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
                    axis.direction("xyz", &axis.needed_numbers::<3>("xyz")?)?
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

/// What a link with this frame consists of: what it collides with, or else what it looks like.
fn solids(name: &str, link: Node, frame: &Isometry3<f64>) -> Result<Vec<Solid>, Wrong> {
    let element = labelled("link", name, link);
    let mut meshes = false;
    for tag in ["collision", "visual"] {
        let mut solids = Vec::new();
        let mut is_whole = true;
        for node in link.children().filter(|node| node.has_tag_name(tag)) {
            let geometry = child(node, "geometry").and_then(|geometry| geometry.first_element_child());
            let Some(geometry) = geometry else {
                return Err(
                    labelled("link", name, node).wrong(format!("has a {tag} without geometry; add it"))
                );
            };
            match shape(&element.part(geometry))? {
                Some(shape) => {
                    let pose = frame * origin(&element, node)?;
                    solids.push(Solid { shape, pose, density: None });
                }
                None => is_whole = false,
            }
        }
        meshes |= !is_whole;
        if is_whole && !solids.is_empty() {
            if let Some(inertial) = child(link, "inertial")
                && let Some(mass) = child(inertial, "mass")
            {
                weigh(&mut solids, element.part(mass).needed_number("value")?);
            }
            return Ok(solids);
        }
    }
    if meshes {
        Err(element.wrong("has a mesh; give it boxes, spheres, cylinders or capsules as its collision"))
    } else {
        Ok(Vec::new())
    }
}

/// The shape that a geometry names, in whole lengths; none of a mesh.
fn shape(geometry: &Element) -> Result<Option<Shape>, Wrong> {
    let radius = || geometry.needed_number("radius");
    let length = || geometry.needed_number("length");
    Ok(Some(match geometry.tag() {
        "box" => Shape::Box { sides: geometry.needed_numbers("size")? },
        "sphere" => Shape::Sphere { radius: radius()? },
        "cylinder" => Shape::Cylinder { radius: radius()?, length: length()? },
        "capsule" => Shape::Capsule { radius: radius()?, length: length()? },
        "mesh" => return Ok(None),
        _ => return Err(geometry.wrong("is not supported; make it a box, sphere, cylinder or capsule")),
    }))
}

#[cfg(test)]
mod tests;
