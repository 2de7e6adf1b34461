//! Spread the mass of rigid bodies, as the description names it, over the parts that they are.

use nalgebra::Matrix3;

use super::inertia::Mass;
use super::placed::{Link, Solid};
use crate::files::body::DENSITY;

/// The mass of an even solid.
fn of_solid(solid: &Solid) -> Mass {
    let mass = solid.own_mass();
    let axes = solid.pose.rotation.to_rotation_matrix();
    let moments = Matrix3::from_diagonal(&solid.shape.moments(mass).into());
    let tensor = axes.matrix() * moments * axes.matrix().transpose();
    Mass { mass, centre: solid.pose.translation.vector, tensor }
}

/// The mass of each rigid body, where the description names that of one of its links at least; of the other links, those that
/// weigh something are even solids, or at a point if they have no shape. `bearers` are the rigid bodies that the links count for.
pub(super) fn wholes(links: &[Link], count: usize, bearers: &[Option<usize>]) -> Vec<Option<Mass>> {
    let mut borne = vec![(Vec::new(), false); count];
    for (link, bearer) in links.iter().zip(bearers) {
        let Some((masses, is_named)) = bearer.map(|bearer| &mut borne[bearer]) else { continue };
        *is_named |= link.named.is_some();
        match link.named {
            Some(named) => masses.push(named),
            None if link.is_unweighed => {}
            None => {
                masses.extend(link.solids.iter().filter(|solid| !solid.is_bare).map(of_solid));
                let point = Mass { mass: link.bare_mass, centre: link.origin, tensor: Matrix3::zeros() };
                masses.extend((point.mass > 0.0).then_some(point));
            }
        }
    }
    borne.into_iter().map(|(masses, is_named)| is_named.then(|| Mass::together(&masses))).collect()
}

/// Gives the solids of a rigid body a share of its inertia, each by its mass; not if it is none that they can have.
pub(super) fn spread(links: &mut [Link], members: &[usize], whole: &Mass) -> bool {
    let all: f64 = members.iter().flat_map(|&at| &links[at].solids).map(Solid::own_mass).sum();
    let share = |solid: &Solid| whole.share(solid.own_mass() / all);
    let mass = |solid: &Solid| solid.density().unwrap_or(DENSITY) * solid.bulk();
    let fits = |solid: &Solid| share(solid).fault(mass(solid)).is_none();
    let fits = whole.is_sound() && members.iter().flat_map(|&at| &links[at].solids).all(fits);
    for &at in members.iter().filter(|_| fits) {
        links[at].solids.iter_mut().for_each(|solid| solid.inertia = Some(share(solid)));
    }
    fits
}

#[cfg(test)]
mod tests;
