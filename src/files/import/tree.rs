//! The tree of rigid bodies that links are: those that are fixed to each other are one.

use super::placed::{Link, Turn};

/// Links that are fixed to each other, the one that carries all others first.
pub(super) struct Rigid {
    pub links: Vec<usize>,
    /// The first link that has a shape: the others are fixed to it.
    pub lead: Option<usize>,
    /// Rigid bodies that it carries, if they have a shape or carry one that has.
    pub branches: Vec<usize>,
}

/// The tree of rigid bodies that links are.
pub(super) struct Tree<'a> {
    links: &'a [Link],
    pub rigids: Vec<Rigid>,
    /// The rigid body of each link.
    pub rigid_of: Vec<usize>,
}

impl<'a> Tree<'a> {
    pub(super) fn new(links: &'a [Link]) -> Self {
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
        for at in (0..tree.rigids.len()).rev() {
            tree.rigids[at].branches.reverse();
            let Rigid { links, lead, branches } = &tree.rigids[at];
            let is_empty = lead.is_none() && branches.is_empty();
            if let Some(parent) = tree.links[links[0]].parent.filter(|_| !is_empty) {
                let below = tree.rigid_of[parent];
                tree.rigids[below].branches.push(at);
            }
        }
        tree
    }

    /// The link that a rigid body is on, and how it moves on that: through those without shape. There is none below the
    /// first that has a shape.
    pub(super) fn turns(&self, mut rigid: usize) -> (Option<usize>, Vec<&Turn>) {
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
