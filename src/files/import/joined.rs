//! Make parts of links: those that are fixed to each other are one rigid body, and one without a shape goes to what it is
//! on.

use nalgebra::Vector3 as Column;

use super::placed::{Link, Turn, rounded};
use super::xml::Wrong;
use crate::files::body::{JointName, PartEntry};
use crate::stages::agent::Vector3;

/// Distance, m, within which two hinges count as at the same place.
const SAME_PLACE: f64 = 1e-6;
/// Cosine from which on two axes no longer count as at right angles; the sine of two that are the same.
const OBLIQUE: f64 = 1e-6;

/// Links that are fixed to each other, the one that carries all others first.
struct Rigid {
    links: Vec<usize>,
    /// The first link that has a shape: the others are fixed to it.
    lead: Option<usize>,
    /// Rigid bodies that it carries, if they have a shape or carry one that has.
    branches: Vec<usize>,
}

/// The tree of rigid bodies that links are.
struct Tree<'a> {
    links: &'a [Link],
    rigids: Vec<Rigid>,
    /// The rigid body of each link.
    rigid_of: Vec<usize>,
}

/// The parts of links, each after its parent, and notes on what was changed. Messages call a link `word`.
pub(super) fn joined(word: &str, links: &[Link]) -> Result<(Vec<PartEntry>, Vec<String>), Wrong> {
    let tree = Tree::new(word, links)?;
    let (mut parts, mut notes) = (Vec::new(), Vec::new());
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
                let mut part = solid.part(name);
                if number > 0 {
                    fix(&mut part, link, link);
                } else if rigid.lead != Some(at) {
                    let parent = link.parent.and_then(holder).unwrap_or(at);
                    fix(&mut part, &links[parent], link);
                } else {
                    let (carrier, turns) = tree.turns(index);
                    match carrier.and_then(holder) {
                        Some(parent) => {
                            let here = |message| format!("{word} `{}`: {message}", link.name);
                            let (joint, note) = Joint::new(&turns).map_err(here)?;
                            joint.write(&mut part, &links[parent]);
                            notes.extend(note.map(here));
                        }
                        None if turns
                            .iter()
                            .any(|turn| !matches!(turn, Turn::Other("free" | "floating"))) =>
                        {
                            notes.push(format!(
                                "{word} `{}` is the root: its joints with the world are ignored",
                                link.name
                            ));
                        }
                        None => {}
                    }
                }
                parts.push(part);
            }
        }
    }
    Ok((parts, notes))
}

impl<'a> Tree<'a> {
    fn new(word: &str, links: &'a [Link]) -> Result<Self, Wrong> {
        let mut tree = Self { links, rigids: Vec::new(), rigid_of: Vec::new() };
        for (at, link) in links.iter().enumerate() {
            let rigid = match link.parent.filter(|_| link.turns.is_empty()) {
                Some(parent) => tree.rigid_of[parent],
                None => {
                    tree.rigids.push(Rigid { links: Vec::new(), lead: None, branches: Vec::new() });
                    tree.rigids.len() - 1
                }
            };
            tree.rigid_of.push(rigid);
            tree.rigids[rigid].links.push(at);
            if !link.solids.is_empty() {
                tree.rigids[rigid].lead.get_or_insert(at);
            }
        }
        let mut roots = Vec::new();
        for at in (0..tree.rigids.len()).rev() {
            tree.rigids[at].branches.reverse();
            let Rigid { links, lead, branches } = &tree.rigids[at];
            let name = tree.name(at);
            match (lead, &branches[..]) {
                (None, []) => continue,
                (None, [first, second, ..]) => {
                    let [first, second] = [first, second].map(|&branch| tree.name(branch));
                    return Err(format!(
                        "{word} `{name}` has no shape, but `{first}` and `{second}` rotate on it; give it a shape, or fix one of \
                         them to it"
                    ));
                }
                _ => {}
            }
            match tree.links[links[0]].parent {
                Some(parent) => {
                    let below = tree.rigid_of[parent];
                    tree.rigids[below].branches.push(at);
                }
                None => roots.push(at),
            }
        }
        match roots[..] {
            [] => Err(format!("no {word} has a shape; give it a box, sphere, cylinder or capsule")),
            [_] => Ok(tree),
            [.., second, first] => Err(format!(
                "`{}` and `{}` are two bodies without a joint between them; keep one",
                tree.name(first),
                tree.name(second)
            )),
        }
    }

    fn name(&self, rigid: usize) -> &str {
        &self.links[self.rigids[rigid].links[0]].name
    }

    /// The link that a rigid body is on, and how it moves on that: through those without shape. There is none below the
    /// first that has a shape.
    fn turns(&self, mut rigid: usize) -> (Option<usize>, Vec<&Turn>) {
        let mut turns = Vec::new();
        let carrier = loop {
            let first = &self.links[self.rigids[rigid].links[0]];
            turns.extend(first.turns.iter().rev());
            let Some(parent) = first.parent else { break None };
            rigid = self.rigid_of[parent];
            if self.rigids[rigid].lead.is_some() {
                break Some(parent);
            }
        };
        turns.reverse();
        (carrier, turns)
    }
}

/// Fixes a part of `link` to the first part of `parent`.
fn fix(part: &mut PartEntry, parent: &Link, link: &Link) {
    Joint { anchor: link.origin, name: JointName::Fixed, axes: None }.write(part, parent);
}

/// A joint as a body file has it.
struct Joint {
    name: JointName,
    anchor: Column<f64>,
    axes: Option<Vec<Vector3>>,
}

impl Joint {
    /// The joint that lets a part turn in all these ways, and a note if it is another one than they are together.
    fn new(turns: &[&Turn]) -> Result<(Self, Option<String>), Wrong> {
        let (mut anchors, mut axes, mut balls) = (Vec::new(), Vec::new(), 0);
        for turn in turns {
            match turn {
                Turn::Hinge { anchor, axis } => {
                    anchors.push(anchor);
                    axes.push(axis);
                }
                Turn::Ball { anchor } => {
                    anchors.push(anchor);
                    balls += 1;
                }
                Turn::Other(kind) => {
                    return Err(format!(
                        "its joint is `{kind}`, which is not supported; make it a hinge, or fix it"
                    ));
                }
            }
        }
        let [anchor, others @ ..] = &anchors[..] else {
            return Ok((Self { name: JointName::Fixed, anchor: Column::zeros(), axes: None }, None));
        };
        if others.iter().any(|other| (*other - *anchor).norm() > SAME_PLACE) {
            return Err(format!(
                "it rotates about {} points of its parent; give what is between them a shape, or let them coincide",
                anchors.len()
            ));
        }
        let joint = |name, axes: Option<Vec<Column<f64>>>| Self {
            name,
            anchor: **anchor,
            axes: axes.map(|axes| axes.into_iter().map(rounded).collect()),
        };
        Ok(match axes[..] {
            [] if balls == 1 => (joint(JointName::Ball, None), None),
            [&axis] if balls == 0 => (joint(JointName::Hinge, Some(vec![axis])), None),
            [&first, ref others @ ..]
                if balls == 0 && others.iter().all(|axis| first.cross(axis).norm() < OBLIQUE) =>
            {
                let note = format!("its {} hinges have the same axis and became one hinge", axes.len());
                (joint(JointName::Hinge, Some(vec![first])), Some(note))
            }
            [&first, &second] if balls == 0 => {
                let cosine = first.dot(&second);
                let note = || {
                    format!(
                        "its two hinges are at {:.1} degrees and became a universal joint, whose second axis was rotated to \
                         a right angle",
                        cosine.acos().to_degrees()
                    )
                };
                let axes = vec![first, (second - first * cosine).normalize()];
                (joint(JointName::Universal, Some(axes)), (cosine.abs() > OBLIQUE).then(note))
            }
            _ => {
                let note = format!("its {} joints at one place became a ball joint", anchors.len());
                (joint(JointName::Ball, None), Some(note))
            }
        })
    }

    fn write(self, part: &mut PartEntry, parent: &Link) {
        part.parent = Some(parent.name.clone());
        part.joint = Some(self.name);
        part.anchor = Some(rounded(self.anchor));
        part.axes = self.axes;
    }
}

#[cfg(test)]
mod tests;
