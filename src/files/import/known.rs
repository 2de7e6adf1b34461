//! Find attributes that nobody knows, such as misspelt ones, on the elements that decide shapes, joints and masses.

use std::collections::HashMap;

use roxmltree::Node;

use super::document::{Wrong, place};
use super::notes::names;
use super::xml::Element;

/// How many are told with their line, which takes as long as the text.
const MOST_WORDED: usize = 16;

/// Elements, and the attributes that they have.
type Known = [(&'static str, &'static str)];

/// Of MJCF, as of MuJoCo 3, with those of former versions. `suffix` is that of [`super::text`].
pub(super) const MJCF: [(&str, &str); 12] = [
    (
        "compiler",
        "autolimits boundmass boundinertia settotalmass balanceinertia strippath coordinate angle fitaabb eulerseq meshdir \
         texturedir assetdir discardvisual usethread fusestatic inertiafromgeom inertiagrouprange saveinertial alignfree \
         conflict convexhull exactmeshinertia",
    ),
    ("default", "class"),
    ("body", "pos quat axisangle xyaxes zaxis euler name childclass mocap gravcomp sleep simple fuse user"),
    ("frame", "pos quat axisangle xyaxes zaxis euler name childclass"),
    ("inertial", "pos quat axisangle xyaxes zaxis euler mass diaginertia fullinertia"),
    (
        "joint",
        "name class type group pos axis springdamper limited actuatorfrclimited solreflimit solimplimit solreffriction \
         solimpfriction stiffness range actuatorfrcrange actuatorgravcomp margin ref springref armature damping \
         frictionloss user",
    ),
    ("freejoint", "name class group align"),
    (
        "geom",
        "pos quat axisangle xyaxes zaxis euler name class type contype conaffinity condim group priority size material \
         friction mass density shellinertia solmix solref solimp margin gap surfacevel adhesion fromto hfield mesh fitscale \
         rgba fluidshape fluidcoef user",
    ),
    (
        "mesh",
        "name class content_type file vertex normal texcoord face refpos refquat scale smoothnormal maxhullvert inertia \
         builtin params material octree_maxdepth",
    ),
    ("model", "name file content_type"),
    ("attach", "model body frame prefix suffix"),
    ("equality", "class active solref solimp"),
];

/// Of URDF; `group`, `mask` and `concave` are Bullet's, and `dont_collapse` is Isaac Gym's. Some write both halves of a tensor.
pub(super) const URDF: [(&str, &str); 18] = [
    ("link", "name type concave"),
    ("joint", "name type dont_collapse"),
    ("origin", "xyz rpy quat_xyzw"),
    ("parent", "link"),
    ("child", "link"),
    ("axis", "xyz"),
    ("inertial", ""),
    ("mass", "value"),
    ("inertia", "ixx iyy izz ixy ixz iyz iyx izx izy"),
    ("collision", "name group mask concave"),
    ("visual", "name group"),
    ("geometry", "name"),
    ("box", "size"),
    ("sphere", "radius"),
    ("cylinder", "radius length"),
    ("capsule", "radius length"),
    ("mesh", "filename scale"),
    ("mimic", "joint multiplier offset"),
];

/// The elements of the element `mujoco` that bodies are made of. Soft bodies have elements of the same names, but others.
pub(super) fn mjcf_elements<'a>(root: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    let section =
        |node: &Node| ["worldbody", "default", "asset", "compiler"].contains(&node.tag_name().name());
    let is_soft = |node: &Node| ["composite", "flexcomp"].contains(&node.tag_name().name());
    let sections = root.children().filter(section);
    outside(sections.flat_map(|section| section.descendants()), is_soft)
}

/// The elements of the element `robot` that links and joints are made of: those that are within known ones.
pub(super) fn urdf_elements<'a>(root: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    let is_alien = |node: &Node| node.is_element() && !URDF.iter().any(|(tag, _)| node.has_tag_name(*tag));
    outside(root.descendants().skip(1), is_alien)
}

/// Nodes, in the order of the text, without some and what is in them.
fn outside<'a>(
    nodes: impl Iterator<Item = Node<'a, 'a>>,
    is_left_out: impl Fn(&Node) -> bool,
) -> impl Iterator<Item = Node<'a, 'a>> {
    let mut until = 0;
    nodes.filter(move |node| {
        if node.range().start < until {
            return false;
        }
        let left_out = is_left_out(node);
        if left_out {
            until = node.range().end;
        }
        !left_out
    })
}

/// Says which attributes of these elements are not known, each once. `strict` refuses the first one.
pub(super) fn unknown<'a>(
    elements: impl Iterator<Item = Node<'a, 'a>>,
    known: &Known,
    strict: bool,
) -> Result<Option<String>, Wrong> {
    // Where each is first, and how often it is.
    let mut found: Vec<(String, Node, usize)> = Vec::new();
    let mut places = HashMap::new();
    for node in elements {
        let Some((tag, keys)) = known.iter().find(|(tag, _)| node.has_tag_name(*tag)) else { continue };
        let own = node.attributes().filter(|attribute| attribute.namespace().is_none());
        let is_known = |key: &str| keys.split_whitespace().any(|known| known == key);
        for key in own.map(|attribute| attribute.name()).filter(|key| !is_known(key)) {
            if strict {
                return Err(Element::new(*tag, node)
                    .wrong(format!("has an attribute `{key}`, which is not known; correct or remove it")));
            }
            let at = *places.entry((*tag, key)).or_insert(found.len());
            match found.get_mut(at) {
                Some((_, _, times)) => *times += 1,
                None => found.push((format!("`{key}` of {tag}"), node, 1)),
            }
        }
    }
    let word = |(what, node, times): &(String, Node, usize)| match times {
        1 => format!("{what} ({})", place(*node)),
        _ => format!("{what} ({} and {} more)", place(*node), times - 1),
    };
    let words: Vec<String> = found.iter().take(MOST_WORDED).map(word).collect();
    let rest = found.iter().skip(MOST_WORDED).map(|(what, ..)| what.as_str());
    Ok(names(words.iter().map(String::as_str).chain(rest))
        .map(|names| format!("attributes that are not known are ignored {names}")))
}

#[cfg(test)]
mod tests;
