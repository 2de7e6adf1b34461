//! Change links to what a body can have: nothing slides, there is one tree, and what others rotate on has a shape and its mass.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Translation3};

use super::document::Wrong;
use super::joints::STAND_IN;
use super::notes::names;
use super::options::Options;
use super::placed::{DENSEST, Link, Solid, Turn, weigh};
use super::shares::{spread, wholes};
use super::tree::Tree;
use crate::files::body::DENSITY;
use crate::stages::agent::Shape;

/// Links that a body can have, and notes on what was changed. Messages call a link `word`.
pub(super) fn prepared(
    word: &str,
    links: Vec<Link>,
    options: &Options,
) -> Result<(Vec<Link>, Vec<String>), Wrong> {
    let (mut links, mut notes) = held(word, links, options.strict)?;
    links = one_tree(word, links, options, &mut notes)?;
    stand_ins(word, &mut links, options.strict, &mut notes)?;
    weigh_bare(word, &mut links, options.strict, &mut notes)?;
    Ok((links, notes))
}

/// Holds links at their rest places where they would slide on what carries them, and parts those that float.
fn held(word: &str, mut links: Vec<Link>, strict: bool) -> Result<(Vec<Link>, Vec<String>), Wrong> {
    let mut held = Vec::new();
    // Whether something with a shape carries it.
    let mut on_shape: Vec<bool> = Vec::new();
    for at in 0..links.len() {
        let on = links[at].parent.is_some_and(|parent| on_shape[parent] || !links[parent].solids.is_empty());
        on_shape.push(on);
        let link = &mut links[at];
        let Some(kind) = link.turns.iter().find_map(Turn::other) else { continue };
        if link.parent.is_none() {
            continue;
        }
        if ["free", "floating"].contains(&kind) {
            link.parent = None;
            continue;
        }
        if strict && on {
            let name = &link.name;
            return Err(format!(
                "{word} `{name}`: its joint is `{kind}`, which is not supported; make it a hinge, or fix it"
            ));
        }
        link.turns.retain(|turn| turn.other().is_none());
        if on {
            held.push(format!("{} ({kind})", link.name));
        }
    }
    let note = names(held.iter().map(String::as_str))
        .map(|names| format!("joints that do not turn are held at their rest place {names}"));
    Ok((links, Vec::from_iter(note)))
}

/// The links of one tree: the one whose root is asked for, or else that with most links that have a shape, the first of equals.
fn one_tree(
    word: &str,
    links: Vec<Link>,
    options: &Options,
    notes: &mut Vec<String>,
) -> Result<Vec<Link>, Wrong> {
    let mut root_of: Vec<usize> = Vec::with_capacity(links.len());
    for (at, link) in links.iter().enumerate() {
        let is_asked_for = options.root.as_ref() == Some(&link.name);
        root_of.push(link.parent.filter(|_| !is_asked_for).map_or(at, |parent| root_of[parent]));
    }
    let shapes = |root: usize| {
        (0..links.len()).filter(|at| root_of[*at] == root && !links[*at].solids.is_empty()).count()
    };
    let roots: Vec<usize> = (0..links.len()).filter(|at| root_of[*at] == *at).collect();
    let asked = options.front_end.name("root");
    let root = match &options.root {
        Some(name) => links
            .iter()
            .position(|link| link.name == *name)
            .ok_or_else(|| format!("no {word} is called `{name}` ({asked}); give the name of one"))?,
        None => roots
            .iter()
            .copied()
            .reduce(|best, next| if shapes(next) > shapes(best) { next } else { best })
            .unwrap_or(0),
    };
    if links.is_empty() || shapes(root) == 0 {
        return Err(format!("no {word} has a shape; give it a box, sphere, cylinder, capsule or mesh"));
    }
    let others = roots.iter().filter(|&&other| other != root && shapes(other) > 0);
    if let Some(names) = names(others.map(|&other| &*links[other].name)) {
        if options.strict && options.root.is_none() {
            return Err(format!(
                "`{}` and others are bodies without a joint between them; name one with {asked} {names}",
                links[root].name
            ));
        }
        notes.push(format!(
            "the body is the tree of `{}`; other trees are left out ({asked} keeps another) {names}",
            links[root].name
        ));
    }
    let mut new = vec![None; links.len()];
    let mut kept: Vec<Link> = Vec::new();
    for (at, mut link) in links.into_iter().enumerate().filter(|(at, _)| root_of[*at] == root) {
        new[at] = Some(kept.len());
        link.parent = link.parent.and_then(|parent| new[parent]);
        kept.push(link);
    }
    Ok(kept)
}

/// Gives a small ball without skin to each rigid body without shape on which several others turn.
fn stand_ins(word: &str, links: &mut [Link], strict: bool, notes: &mut Vec<String>) -> Result<(), Wrong> {
    let tree = Tree::new(links);
    let forks = tree.rigids.iter().filter(|rigid| rigid.lead.is_none() && rigid.branches.len() > 1);
    let mass = |members: &[usize]| members.iter().map(|&at| links[at].bare_mass).sum::<f64>();
    let forks: Vec<(usize, f64)> = forks.map(|rigid| (rigid.links[0], mass(&rigid.links))).collect();
    if let Some(names) = names(forks.iter().map(|(at, _)| &*links[*at].name)) {
        if strict {
            let name = &links[forks[0].0].name;
            return Err(format!(
                "{word} `{name}` has no shape, but several others rotate on it; give it a shape"
            ));
        }
        notes.push(format!(
            "what has no shape, but carries several that rotate on it, became a ball without skin {names}"
        ));
    }
    for (at, mass) in forks {
        let pose = Isometry3::from_parts(Translation3::from(links[at].origin), Default::default());
        // As large as its mass is as water.
        let radius = (mass / DENSITY * 0.75 / PI).cbrt().max(STAND_IN);
        let ball = Solid::new(Shape::Sphere { radius }, pose);
        links[at].solids.push(Solid { is_bare: true, ..ball });
    }
    Ok(())
}

/// Lets links that name no mass weigh as water where nothing that is fixed to them names one.
fn weigh_as_water(links: &mut [Link]) {
    let rigids: Vec<Vec<usize>> = Tree::new(links).rigids.iter().map(|rigid| rigid.links.clone()).collect();
    for members in rigids {
        let names_mass = |link: &Link| link.bare_mass > 0.0 || !link.is_unweighed && !link.solids.is_empty();
        if !members.iter().any(|&at| names_mass(&links[at])) {
            members.iter().for_each(|&at| links[at].is_unweighed = false);
        }
    }
}

/// Gives the mass of what has no shape to the rigid body that it is part of, or else to the one that carries it. Where masses cannot
/// stay where they are named, all that is fixed together is equally dense.
fn weigh_bare(word: &str, links: &mut [Link], strict: bool, notes: &mut Vec<String>) -> Result<(), Wrong> {
    weigh_as_water(links);
    let tree = Tree::new(links);
    let first_shaped = tree.rigids.iter().position(|rigid| rigid.lead.is_some());
    let mut added = vec![0.0; tree.rigids.len()];
    let mut bearers = Vec::with_capacity(links.len());
    for (at, link) in links.iter().enumerate() {
        let mut own = tree.rigid_of[at];
        while tree.rigids[own].lead.is_none() {
            match links[tree.rigids[own].links[0]].parent {
                Some(parent) => own = tree.rigid_of[parent],
                None => break,
            }
        }
        let bearer = if tree.rigids[own].lead.is_some() { Some(own) } else { first_shaped };
        if let Some(bearer) = bearer {
            added[bearer] += link.bare_mass;
        }
        bearers.push(bearer);
    }
    let rigids: Vec<Vec<usize>> = tree.rigids.iter().map(|rigid| rigid.links.clone()).collect();
    let (mut faults, mut sound) = (Vec::new(), links.to_vec());
    for link in sound.iter_mut().filter(|link| link.named.is_some_and(|named| !named.is_sound())) {
        faults.push(link.name.clone());
        link.named = None;
    }
    let wholes = wholes(&sound, rigids.len(), &bearers);
    for (members, added) in rigids.iter().zip(added) {
        let solids = || members.iter().flat_map(|&at| &links[at].solids);
        // A heavy link may have but a small shape, which marks a place.
        let too_dense = solids().any(|solid| solid.density().is_some_and(|density| density > DENSEST));
        if too_dense {
            let name = &links[members[0]].name;
            if strict {
                return Err(format!(
                    "{word} `{name}` has too small a shape for its mass; give it a larger one"
                ));
            }
            notes.push(format!(
                "{word} `{name}`: a mass too large for its shape is spread over all that is fixed to it"
            ));
        }
        // A ball that stands for what has no shape weighs what that weighs.
        let real = |solid: &&Solid| !solid.is_bare;
        let weighed = members.iter().filter(|&&at| !links[at].is_unweighed);
        let own: f64 = weighed.flat_map(|&at| &links[at].solids).filter(real).map(Solid::own_mass).sum();
        let all = own + added;
        let is_part_unweighed =
            members.iter().any(|&at| links[at].is_unweighed && !links[at].solids.is_empty());
        if too_dense || is_part_unweighed {
            let bulk: f64 = solids().map(Solid::bulk).sum();
            for &at in members {
                links[at].solids.iter_mut().for_each(|solid| solid.mass = Some(all * solid.bulk() / bulk));
            }
            continue;
        }
        if added == 0.0 {
            continue;
        }
        let shapes: Vec<(usize, f64)> = members
            .iter()
            .filter(|&&at| !links[at].solids.is_empty())
            .map(|&at| (at, links[at].solids.iter().filter(real).map(Solid::own_mass).sum::<f64>()))
            .collect();
        let count = shapes.len() as f64;
        for (at, mass) in shapes {
            let share = if own > 0.0 { mass / own } else { 1.0 / count };
            weigh(&mut links[at].solids, all * share);
        }
    }
    for (members, whole) in rigids.iter().zip(&wholes) {
        if whole.as_ref().is_some_and(|whole| !spread(links, members, whole)) {
            faults.push(links[members[0]].name.clone());
        }
    }
    if let Some(names) = names(faults.iter().map(String::as_str)) {
        if strict {
            return Err(format!(
                "{word} `{}` has an inertia that no rigid body has; correct or remove it",
                faults[0]
            ));
        }
        notes.push(format!("inertias that no rigid body has are replaced by those of the shapes {names}"));
    }
    Ok(())
}
