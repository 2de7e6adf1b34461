//! Sample the latent joints q and set the tree C over the active components (equations 18 and 22).

use std::collections::BTreeMap;

use nalgebra::DVector;
use rand::Rng;

use super::departures::{Departures, Root};
use super::error::InferenceError;
use super::joints::{collapsed_cost, cost, draw_between};
use super::settings::EdgeWeight;
use crate::stages::mixture::{Augmented, Gaussian, Rounding};
use crate::stages::tree::{Edge, prim};

/// A latent joint with its edge of the tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The components it connects.
    pub edge: Edge,
    /// q, in the coordinates of the centred points.
    pub position: DVector<f64>,
}

/// The joints and the tree of a chain.
#[derive(Debug, Clone)]
pub struct LatentTree {
    /// q and C: a joint for each edge between active components.
    pub joints: Vec<Joint>,
    /// The joints of all other components to the root ([`Departures::stale_joints`]).
    pub stale: Vec<Joint>,
    /// The last joint that was drawn for each pair of components, the smaller number first; kept for stale joints alone.
    drawn: BTreeMap<(usize, usize), DVector<f64>>,
    /// Where the map's origin is among the centred points.
    origin: DVector<f64>,
}

/// What an update of the tree goes by.
#[derive(Clone, Copy)]
pub struct Update<'a> {
    /// All K components.
    pub components: &'a [Gaussian],
    /// Numbers of the active ones, rising.
    pub active: &'a [usize],
    /// The weight of an edge.
    pub edge_weight: EdgeWeight,
    /// How it departs from the equations.
    pub departures: &'a Departures,
}

impl LatentTree {
    /// No joints; `origin` is where the map's origin is among the centred points.
    pub fn new(origin: DVector<f64>) -> Self {
        Self { joints: Vec::new(), stale: Vec::new(), drawn: BTreeMap::new(), origin }
    }

    /// Drops the joints of components that are no longer active: a joint is drawn "for each activated component" (section
    /// 3.2). Where stale joints stay, nothing is dropped.
    pub fn drop_inactive(&mut self, departures: &Departures, is_active: impl Fn(usize) -> bool) {
        if !departures.stale_joints {
            self.joints.retain(|Joint { edge, .. }| is_active(edge.child) && is_active(edge.parent));
        }
    }

    /// Draws q, and sets C to the minimum spanning tree over the active components (equations 18 and 22).
    ///
    /// # Errors
    /// [`InferenceError::Rounding`] if a sum of precisions is not positive definite in floating point.
    pub fn update(&mut self, update: Update, rng: &mut impl Rng) -> Result<(), InferenceError> {
        let joints = match update.edge_weight {
            EdgeWeight::Literal => self.literal(update, rng),
            EdgeWeight::Pairwise => self.pairwise(update, rng),
            EdgeWeight::Collapsed => collapsed(update, rng),
        }?;
        self.joints = joints;
        if update.departures.stale_joints {
            self.remember_stale(update);
        }
        Ok(())
    }

    /// The tree weighed by the joint that each child has ([`EdgeWeight::Literal`]).
    ///
    /// Each component but the root has one joint, drawn given the parent it has. A component that has no parent (newly
    /// active, or the root of the last tree) draws its joint from its own Gaussian.
    fn literal(&self, update: Update, rng: &mut impl Rng) -> Result<Vec<Joint>, InferenceError> {
        let Update { components, active, .. } = update;
        let informations = Informations::of(update);
        let mut own: Vec<Option<DVector<f64>>> = vec![None; components.len()];
        for &s in active {
            let of = |edge: &Edge| edge.child == s && active.contains(&edge.parent);
            let edge = self.joints.iter().map(|joint| joint.edge).find(of);
            own[s] = Some(match edge {
                Some(edge) => informations.draw_joint(edge, rng)?,
                None => components[s].draw(rng),
            });
        }
        let joint = |s: usize| own[s].as_ref().expect("every active component has a joint");
        let edges = tree(update, |s, c| update.cost(joint(s), s, c));
        Ok(edges.into_iter().map(|edge| Joint { edge, position: joint(edge.child).clone() }).collect())
    }

    /// The tree weighed by a joint for each pair of components ([`EdgeWeight::Pairwise`]).
    fn pairwise(&mut self, update: Update, rng: &mut impl Rng) -> Result<Vec<Joint>, InferenceError> {
        let Update { components, active, .. } = update;
        let informations = Informations::of(update);
        let size = components.len();
        let mut drawn: Vec<Option<(f64, DVector<f64>)>> = vec![None; size * size];
        for (at, &s) in active.iter().enumerate() {
            for &c in &active[..at] {
                let q = informations.draw_joint(Edge { child: s, parent: c }, rng)?;
                if update.departures.stale_joints {
                    self.drawn.insert((c, s), q.clone());
                }
                drawn[c * size + s] = Some((update.cost(&q, s, c), q));
            }
        }
        let pair = |s: usize, c: usize| {
            drawn[s.min(c) * size + s.max(c)].as_ref().expect("drawn for every active pair")
        };
        let edges = tree(update, |s, c| pair(s, c).0);
        let joint = |edge: Edge| Joint { edge, position: pair(edge.child, edge.parent).1.clone() };
        Ok(edges.into_iter().map(joint).collect())
    }

    /// Gives every component that the tree does not join, but the root, the last joint between it and the root.
    fn remember_stale(&mut self, update: Update) {
        let pair = |edge: Edge| (edge.child.min(edge.parent), edge.child.max(edge.parent));
        for Joint { edge, position } in &self.joints {
            self.drawn.insert(pair(*edge), position.clone());
        }
        let root = match update.departures.root {
            Root::ComponentZero => 0,
            Root::FirstActive => update.active.first().copied().unwrap_or(0),
        };
        let joined = |k: usize| self.joints.iter().any(|joint| joint.edge.child == k);
        let others = (0..update.components.len()).filter(|&k| k != root && !joined(k));
        let stale = |child: usize| {
            let edge = Edge { child, parent: root };
            Joint { edge, position: self.drawn.get(&pair(edge)).unwrap_or(&self.origin).clone() }
        };
        self.stale = others.map(stale).collect();
    }
}

impl Update<'_> {
    fn cost(&self, q: &DVector<f64>, s: usize, c: usize) -> f64 {
        cost(q, &self.components[s], &self.components[c], self.departures.density_floor)
    }
}

/// The tree weighed with the joints integrated out, and then a joint for each of its edges ([`EdgeWeight::Collapsed`]).
fn collapsed(update: Update, rng: &mut impl Rng) -> Result<Vec<Joint>, InferenceError> {
    let Update { components, active, .. } = update;
    let informations = Informations::of(update);
    let mut moments = vec![None; components.len()];
    active.iter().for_each(|&k| moments[k] = Some(components[k].moments()));
    let moments = |k: usize| moments[k].as_ref().expect("a tree has active components");
    let mut lost = None;
    let cost = |s: usize, c: usize| {
        collapsed_cost(moments(s), moments(c)).unwrap_or_else(|error| {
            lost = Some(error);
            f64::INFINITY
        })
    };
    let edges = tree(update, cost);
    if let Some(error) = lost {
        return Err(error.into());
    }
    let joint = |edge| Ok(Joint { edge, position: informations.draw_joint(edge, rng)? });
    edges.into_iter().map(joint).collect()
}

/// Prim's tree over the active components, from where the departures have its root.
pub fn tree(update: Update, mut weight: impl FnMut(usize, usize) -> f64) -> Vec<Edge> {
    let active = update.active;
    match update.departures.root {
        Root::FirstActive => prim(active, weight),
        Root::ComponentZero if active.first() != Some(&0) => Vec::new(),
        Root::ComponentZero => {
            let edges = prim(active, &mut weight);
            edges
                .into_iter()
                .take_while(|edge| weight(edge.child, edge.parent) < Departures::NO_EDGE)
                .collect()
        }
    }
}

/// The [information](Gaussian::information) of each active component, which the draws of its joints need.
struct Informations(Vec<Option<Augmented>>);

impl Informations {
    fn of(update: Update) -> Self {
        let mut informations = vec![None; update.components.len()];
        update.active.iter().for_each(|&k| informations[k] = Some(update.components[k].information()));
        Self(informations)
    }

    /// Draws a joint on an edge between two active components (equation 18).
    fn draw_joint(&self, edge: Edge, rng: &mut impl Rng) -> Result<DVector<f64>, Rounding> {
        let information = |k: usize| self.0[k].as_ref().expect("joints connect active components");
        draw_between(information(edge.child), information(edge.parent), rng)
    }
}
