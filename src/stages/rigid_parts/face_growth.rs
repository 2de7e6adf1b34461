//! Let parts grow from flat faces, as long as one motion explains each.
//!
//! A part grows from each face, by the face that saves most description length, again and again. The part that saves most is kept, and its
//! faces are taken. Those of the others that had one of them grow anew; and so on. Clusters whose faces save nothing with a face of another
//! cluster stay out of this, since growth would only find them again.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::cluster::Cluster;
use super::search::{MIN_CLUSTER, Search, smallest};

/// Some faces of clusters, and what is known of their unions.
pub(super) struct Faces<'a> {
    search: &'a Search,
    /// Of each face.
    sensors: Vec<Vec<usize>>,
    /// The cluster that each face is of.
    clusters: Vec<usize>,
    /// Description length of each face.
    lengths: Vec<f64>,
    /// The same of unions of several faces, in ascending order; `None` where one motion does not explain all.
    unions: BTreeMap<Vec<usize>, Option<f64>>,
}

/// A part that has grown from a face.
struct Grown {
    from: usize,
    /// In ascending order.
    faces: Vec<usize>,
    /// In the order in which their faces came.
    sensors: Vec<usize>,
    description_length: f64,
    /// Nats per sample that it saves against its faces one by one.
    saving: f64,
}

impl<'a> Faces<'a> {
    /// Of faces, each of a cluster.
    pub(super) fn new(search: &'a Search, faces: Vec<(usize, Vec<usize>)>) -> Self {
        let (clusters, sensors): (Vec<usize>, Vec<Vec<usize>>) = faces.into_iter().unzip();
        let length = |face: &Vec<usize>| Cluster::new(&search.felt, face.clone()).description_length;
        let lengths = sensors.par_iter().map(length).collect();
        Self { search, sensors, clusters, lengths, unions: BTreeMap::new() }
    }

    /// The clusters that may be wrong: those with a face that saves something with one of another cluster.
    pub(super) fn contested(&mut self) -> BTreeSet<usize> {
        let all: Vec<usize> = (0..self.sensors.len()).collect();
        let alone: Vec<Grown> = all.iter().map(|&face| self.alone(face)).collect();
        let near = self.near(&alone, &all);
        let mut contested = BTreeSet::new();
        for (face, near) in alone.iter().zip(near) {
            let own = self.clusters[face.from];
            for face_of_other in near.into_iter().filter(|other| self.clusters[*other] != own) {
                if self.with_best(face, &[face_of_other]).is_some() {
                    contested.extend([own, self.clusters[face_of_other]]);
                }
            }
        }
        contested
    }

    /// The parts that grow from the faces of some clusters, those that save most first.
    pub(super) fn parts(&mut self, clusters: &BTreeSet<usize>) -> Vec<Cluster> {
        let search = self.search;
        let mut grown = self.grown_of(clusters);
        grown.retain(|part| part.sensors.len() >= MIN_CLUSTER);
        let part = |grown: Grown| {
            let mut part = Cluster::new(&search.felt, grown.sensors);
            // Faces are explained, but sensors that are on none may not be.
            search.explains_in_the_end(&mut part).then_some(part)
        };
        grown.into_par_iter().filter_map(part).collect()
    }

    fn grown_of(&mut self, clusters: &BTreeSet<usize>) -> Vec<Grown> {
        let is_of_these = |face: &usize| clusters.contains(&self.clusters[*face]);
        let mut left: Vec<usize> = (0..self.sensors.len()).filter(is_of_these).collect();
        let mut grown: Vec<Grown> = self.grown_from(&left, &left);
        let mut parts = Vec::new();
        while let Some((best, _)) = smallest(grown.iter().map(|own| -own.saving)) {
            let part = grown.swap_remove(best);
            left.retain(|face| !part.faces.contains(face));
            // Parts that had none of these faces stay as they are.
            grown.retain(|own| !own.faces.iter().any(|face| part.faces.contains(face)));
            let anew: Vec<usize> =
                left.iter().copied().filter(|face| !grown.iter().any(|own| own.from == *face)).collect();
            grown.extend(self.grown_from(&anew, &left));
            grown.sort_by_key(|own| own.from);
            parts.push(part);
        }
        parts
    }

    /// The part that grows from each of some faces, of those that are left. All grow by one face at a time, so that what several try is
    /// learned once.
    fn grown_from(&mut self, faces: &[usize], left: &[usize]) -> Vec<Grown> {
        let mut growing: Vec<Grown> = faces.iter().map(|&face| self.alone(face)).collect();
        let mut grown = Vec::new();
        while !growing.is_empty() {
            let near = self.near(&growing, left);
            let before = std::mem::take(&mut growing);
            for (own, near) in before.into_iter().zip(&near) {
                match self.with_best(&own, near) {
                    Some(larger) => growing.push(larger),
                    None => grown.push(own),
                }
            }
        }
        grown
    }

    fn alone(&self, from: usize) -> Grown {
        Grown {
            from,
            faces: vec![from],
            sensors: self.sensors[from].clone(),
            description_length: self.lengths[from],
            saving: 0.0,
        }
    }

    /// For each part, the faces of highest affinity with it, of those that are left. Its unions with them are learned.
    fn near(&mut self, parts: &[Grown], left: &[usize]) -> Vec<Vec<usize>> {
        let near = |part: &Grown| {
            let others = left.iter().copied().filter(|face| !part.faces.contains(face)).collect();
            self.search.nearest(&part.sensors, others, |face| &self.sensors[face])
        };
        let near: Vec<Vec<usize>> = parts.par_iter().map(near).collect();
        let both = parts.iter().zip(&near);
        let unions = both.flat_map(|(part, near)| near.iter().map(|&face| with(&part.faces, face)));
        let new: BTreeSet<Vec<usize>> = unions.filter(|union| !self.unions.contains_key(union)).collect();
        let learned: Vec<_> = new.into_par_iter().map(|faces| (self.length_of(&faces), faces)).collect();
        self.unions.extend(learned.into_iter().map(|(length, faces)| (faces, length)));
        near
    }

    /// The description length of the union of some faces, if one motion explains it.
    fn length_of(&self, faces: &[usize]) -> Option<f64> {
        let sensors = faces.iter().flat_map(|&face| self.sensors[face].iter().copied()).collect();
        let mut union = self.search.may_be_one(Cluster::new(&self.search.felt, sensors))?;
        self.search.explains_in_the_end(&mut union).then_some(union.description_length)
    }

    /// A part with the face that saves most, of those near it, if that saves enough.
    fn with_best(&self, part: &Grown, near: &[usize]) -> Option<Grown> {
        let larger = near.iter().filter_map(|&face| {
            let faces = with(&part.faces, face);
            let description_length = self.unions[&faces]?;
            let saving = part.description_length + self.lengths[face] - description_length;
            Some((saving, face, faces, description_length))
        });
        let best = larger.reduce(|best, other| if other.0 > best.0 { other } else { best });
        let (saving, face, faces, description_length) =
            best.filter(|(saving, ..)| *saving > self.search.felt.parameters.min_saving)?;
        Some(Grown {
            from: part.from,
            faces,
            sensors: [part.sensors.as_slice(), &self.sensors[face]].concat(),
            description_length,
            saving: part.saving + saving,
        })
    }
}

/// Faces in ascending order, and one more.
fn with(faces: &[usize], face: usize) -> Vec<usize> {
    let mut all = [faces, &[face]].concat();
    all.sort_unstable();
    all
}
