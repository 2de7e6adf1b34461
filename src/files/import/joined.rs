//! Make parts of links: those that are fixed to each other are one rigid body, and one without a shape goes to what it is
//! on.

use super::document::Wrong;
use super::joints::{Joint, chain, joints};
use super::notes::names;
use super::options::{Options, Surface};
use super::placed::{Link, Solid};
use super::prepared::prepared;
use super::tree::Tree;
use crate::files::body::{JointName, PartEntry};

/// Links that were made parts.
#[derive(Debug)]
pub(super) struct Joined {
    /// The parts, each after its parent.
    pub parts: Vec<PartEntry>,
    /// The surfaces of those that stand for meshes.
    pub surfaces: Vec<Surface>,
    /// What was changed, in a line each.
    pub notes: Vec<String>,
}

/// Makes parts of links. Messages call a link `word`.
pub(super) fn joined(word: &str, links: Vec<Link>, options: &Options) -> Result<Joined, Wrong> {
    let (links, mut notes) = prepared(word, links, options)?;
    let tree = Tree::new(&links);
    let (mut parts, mut surfaces, mut sparse) = (Vec::new(), Vec::new(), Vec::new());
    // The first link that has a shape, of a link and those it is fixed on, up to its rigid body's first.
    let mut shaped: Vec<Option<usize>> = Vec::new();
    for (at, link) in links.iter().enumerate() {
        let is_fixed = tree.rigids[tree.rigid_of[at]].links[0] != at;
        let below = link.parent.filter(|_| is_fixed).and_then(|parent| shaped[parent]);
        shaped.push(if link.solids.is_empty() { below } else { Some(at) });
    }
    let holder = |at: usize| shaped[at].or(tree.rigids[tree.rigid_of[at]].lead);
    for (index, rigid) in tree.rigids.iter().enumerate() {
        for &at in rigid.links.iter().filter(|&&at| !links[at].solids.is_empty()) {
            let link = &links[at];
            for (number, solid) in link.solids.iter().enumerate() {
                let name =
                    if number == 0 { link.name.clone() } else { format!("{}/{}", link.name, number + 1) };
                let here = |message: Wrong| format!("{word} `{}`: {message}", link.name);
                sparse.extend(solid.is_sparse(options.skin).then(|| name.clone()));
                let mut part = solid.part(name, options.skin).map_err(here)?;
                if number > 0 {
                    fix(&mut part, link, link);
                } else if rigid.lead != Some(at) {
                    let parent = link.parent.and_then(holder).unwrap_or(at);
                    fix(&mut part, &links[parent], link);
                } else {
                    let (carrier, turns) = tree.turns(index);
                    match carrier.and_then(holder) {
                        Some(parent) => {
                            let (joints, more) = joints(&turns, options.strict).map_err(here)?;
                            notes.extend(more.into_iter().map(here));
                            let mass = rigid
                                .links
                                .iter()
                                .flat_map(|&at| &links[at].solids)
                                .map(Solid::own_mass)
                                .sum();
                            let parent = links[parent].name.clone();
                            parts.extend(chain(parent, joints, mass, &mut part, options)?);
                        }
                        None if turns
                            .iter()
                            .any(|turn| !matches!(turn.other(), Some("free" | "floating"))) =>
                        {
                            notes.push(format!(
                                "{word} `{}` is the root: its joints with the world are ignored",
                                link.name
                            ));
                        }
                        None => {}
                    }
                }
                surfaces.extend(solid.surface().map(|triangles| Surface { part: parts.len(), triangles }));
                parts.push(part);
            }
        }
    }
    if let Some(names) = names(sparse.iter().map(String::as_str)) {
        notes.push(format!("parts too small for a sensor at this number per area have one {names}"));
    }
    Ok(Joined { parts, surfaces, notes })
}

/// Fixes a part of `link` to the first part of `parent`.
fn fix(part: &mut PartEntry, parent: &Link, link: &Link) {
    Joint { anchor: link.origin, name: JointName::Fixed, axes: None }.write(part, parent.name.clone());
}

#[cfg(test)]
mod tests;
