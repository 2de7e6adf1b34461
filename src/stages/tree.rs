//! Find the minimum spanning tree of weighted edges by Prim's algorithm (equation 22; Cormen et al.), and hold the true
//! tree.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};

use crate::numerics::partition::sizes;

/// An edge of a tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edge {
    /// The node that was added later.
    pub child: usize,
    /// The node of the tree that it was joined to.
    pub parent: usize,
}

/// The true parts and tree of a body, which the evaluation knows and the inference must not see.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Truth {
    /// The part of each sensor.
    pub labels: Vec<usize>,
    /// The tree as (child, parent) pairs of parts.
    pub tree: Vec<(usize, usize)>,
    /// The place of each edge's joint. Where several parts turn about one place, such as a trunk and two legs, touch cannot tell
    /// which of them carries which: edges of one place are as good as each other.
    pub places: Vec<usize>,
}

impl Truth {
    /// Each joint at a place of its own.
    pub fn new(labels: Vec<usize>, tree: Vec<(usize, usize)>) -> Self {
        Self { labels, places: (0..tree.len()).collect(), tree }
    }

    /// Whether a joint joins two parts, or could: they turn about one place.
    pub fn meet(&self, a: usize, b: usize) -> bool {
        let places = |part: usize| {
            let own =
                move |&(&(child, parent), _): &(&(usize, usize), &usize)| child == part || parent == part;
            self.tree.iter().zip(&self.places).filter(own).map(|(_, place)| *place)
        };
        a != b && places(a).any(|place| places(b).any(|other| other == place))
    }

    /// The parts that turn about one place with others, so that touch cannot tell which of them carries which.
    pub fn at_one_place(&self) -> Vec<usize> {
        let shared = |place: &usize| self.places.iter().filter(|other| *other == place).count() > 1;
        let edges = self.tree.iter().zip(&self.places).filter(|(_, place)| shared(place));
        let mut parts: Vec<usize> = edges.flat_map(|(&(child, parent), _)| [child, parent]).collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }

    /// Whether some joints are at one place.
    pub fn shares_places(&self) -> bool {
        !self.at_one_place().is_empty()
    }

    /// Number of parts. A part with a single sensor counts, although no estimate can contain it.
    pub fn parts(&self) -> usize {
        sizes(&self.labels).len()
    }
}

/// Prim's tree over `nodes`, grown from the first one; `weight(child, parent)` is asked once for each pair
/// in each direction that is considered. With n nodes there are n − 1 edges, parents before children.
///
/// Where the weight is symmetric, the tree is the minimum spanning tree. Where it depends on the direction
/// (a child that keeps its own joint), growing greedily from the root is what Prim's algorithm does, and
/// not always the minimum over all directed trees. Of equal weights the earlier node wins.
pub fn prim(nodes: &[usize], mut weight: impl FnMut(usize, usize) -> f64) -> Vec<Edge> {
    let Some((&root, rest)) = nodes.split_first() else { return Vec::new() };
    let mut outside: Vec<(f64, Edge)> =
        rest.iter().map(|&child| (weight(child, root), Edge { child, parent: root })).collect();
    let mut tree = Vec::with_capacity(rest.len());
    while let Some(nearest) =
        (0..outside.len()).reduce(|a, b| if outside[b].0 < outside[a].0 { b } else { a })
    {
        let (_, edge) = outside.remove(nearest);
        tree.push(edge);
        for (least, reach) in &mut outside {
            let candidate = weight(reach.child, edge.child);
            if candidate < *least {
                (*least, reach.parent) = (candidate, edge.child);
            }
        }
    }
    tree
}

/// The tree of least total distance over those of these points, of which `nodes` are the numbers.
pub fn shortest(nodes: &[usize], points: &[DVector<f64>]) -> Vec<Edge> {
    prim(nodes, |a, b| points[a].metric_distance(&points[b]))
}

#[cfg(test)]
mod tests;
