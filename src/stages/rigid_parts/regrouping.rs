//! Regroup flat faces into parts, where merging pairs of clusters went wrong.
//!
//! All sensors of a flat face feel three numbers: the velocity along its normal, and how the part rotates about two axes in the face.
//! Opposite faces feel the same three. Two faces at an edge share one of them. So do two faces of different boxes whose normals lie along
//! the hinge between them: they have the same velocity along it. Merging pairs cannot tell which is right, and no single move corrects it
//! later. Three faces can tell: those at a corner have six numbers, and those of different parts have more. So clusters are taken apart
//! into flat faces (random sample consensus: Fischler and Bolles 1981, here with all triples of a few sensors). A part then grows from
//! each face, as long as one motion explains it. The part that saves most is kept, and its faces are taken; and so on. The result counts
//! if the description of all is shorter.
//!
//! Where clusters have taken faces of a part, the rest of it may be in none. At last, groups of sensors in no cluster count as faces, too. A
//! sensor in none always costs what it takes alone.

use rayon::prelude::*;

use super::cluster::Cluster;
use super::face_growth::Faces;
use super::search::{MIN_GROUP, SEED_SENSORS, Search, smallest};
use super::stratified::stratified;
use super::subspace::ROTATION_RANK;

/// What all sensors of a flat face feel: this many numbers.
const FACE_RANK: usize = ROTATION_RANK;
/// Fewest sensors of a flat face. Any three span a subspace; only more than three tell a face.
const MIN_FACE: usize = 5;
/// Sensors of a cluster whose triples are tried as what spans a face.
const MAX_TRIED: usize = 20;

impl Search {
    /// The parts that grow from the faces of these clusters, and from groups of sensors that are in none, if the description of all sensors
    /// is shorter: by what a merge must save, for each cluster.
    pub(super) fn regrouped(&mut self, clusters: &[Cluster]) -> Option<Vec<Cluster>> {
        let faces = |(at, own)| self.flat_faces(own).into_iter().map(move |face| (at, face));
        let mut faces: Vec<(usize, Vec<usize>)> =
            clusters.par_iter().enumerate().flat_map_iter(faces).collect();
        let every = self.every();
        if self.rest_takes_part {
            // Any cluster explains a few sensors, and the end of a thin cylinder.
            let is_face = |own: &Vec<usize>| {
                own.len() >= MIN_FACE && Cluster::new(&self.felt, own.clone()).rank() >= FACE_RANK
            };
            let rest = self.linked(&self.in_none(clusters), SEED_SENSORS[1]);
            let rest: Vec<Vec<usize>> = rest.into_par_iter().filter(is_face).collect();
            faces.extend((clusters.len()..).zip(rest));
        }
        let mut faces = Faces::new(self, faces);
        let contested = faces.contested();
        if contested.is_empty() {
            return None;
        }
        let grown = faces.parts(&contested);
        let stay = clusters.iter().enumerate().filter(|(at, _)| !contested.contains(at));
        let parts: Vec<Cluster> = stay.map(|(_, own)| own.clone()).chain(grown).collect();
        let before = self.felt.completed.clone();
        let length = self.length_of(clusters, &every);
        parts.iter().for_each(|part| part.complete_roots(&mut self.felt));
        let parts = self.assigned(parts, &every);
        if length - self.length_of(&parts, &every) > self.felt.parameters.min_saving * clusters.len() as f64 {
            return Some(parts);
        }
        self.felt.completed = before;
        None
    }

    /// The flat faces that the sensors of a cluster are on, and those on none as one more group.
    fn flat_faces(&self, cluster: &Cluster) -> Vec<Vec<usize>> {
        let most = self.felt.explained();
        let flats = flats(&rows(cluster), most);
        let flats: Vec<Cluster> = flats
            .into_iter()
            .map(|flat| flat.into_iter().map(|at| cluster.representatives[at]).collect())
            .map(|sensors| Cluster::of_rank(&self.felt, sensors, FACE_RANK))
            .collect();
        let residuals: Vec<Vec<f64>> =
            flats.iter().map(|flat| flat.residuals_of(&self.felt, &cluster.sensors)).collect();
        let mut faces = vec![Vec::new(); flats.len() + 1];
        for (at, &sensor) in cluster.sensors.iter().enumerate() {
            let best = smallest(residuals.iter().map(|of| of[at])).filter(|(_, least)| *least <= most);
            faces[best.map_or(flats.len(), |(flat, _)| flat)].push(sensor);
        }
        faces.retain(|face| face.len() >= MIN_GROUP);
        faces
    }
}

/// c of the representatives of a cluster, one by one.
fn rows(cluster: &Cluster) -> Vec<Vec<f64>> {
    let loadings = cluster.whitened_loadings();
    (0..loadings.nrows()).map(|row| loadings.row(row).iter().copied().collect()).collect()
}

/// Groups of vectors that lie in one subspace of three dimensions, up to this square outside of it: the largest, the largest of the others,
/// and so on.
fn flats(vectors: &[Vec<f64>], most: f64) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..vectors.len()).collect();
    let mut found = Vec::new();
    loop {
        let tried: Vec<usize> = stratified(left.len(), MAX_TRIED).map(|at| left[at]).collect();
        let mut best: Vec<usize> = Vec::new();
        for (first, &a) in tried.iter().enumerate() {
            for (second, &b) in tried.iter().enumerate().skip(first + 1) {
                for &c in &tried[second + 1..] {
                    let Some(basis) = basis([a, b, c].map(|at| vectors[at].as_slice()), most) else {
                        continue;
                    };
                    let inside: Vec<usize> =
                        left.iter().copied().filter(|&at| outside(&basis, &vectors[at]) <= most).collect();
                    if inside.len() > best.len() {
                        best = inside;
                    }
                }
            }
        }
        if best.len() < MIN_FACE {
            return found;
        }
        left.retain(|at| !best.contains(at));
        found.push(best);
    }
}

/// An orthonormal basis of three vectors, unless one lies in the span of the others.
fn basis(vectors: [&[f64]; FACE_RANK], least: f64) -> Option<Vec<Vec<f64>>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for vector in vectors {
        let mut rest = vector.to_vec();
        for own in &basis {
            let along = dot(own, &rest);
            rest.iter_mut().zip(own).for_each(|(rest, own)| *rest -= along * own);
        }
        let square = dot(&rest, &rest);
        if square <= least {
            return None;
        }
        rest.iter_mut().for_each(|value| *value /= square.sqrt());
        basis.push(rest);
    }
    Some(basis)
}

/// The square of a vector outside of a subspace.
fn outside(basis: &[Vec<f64>], vector: &[f64]) -> f64 {
    dot(vector, vector) - basis.iter().map(|own| dot(own, vector).powi(2)).sum::<f64>()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
