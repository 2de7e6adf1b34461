//! Tell parts from unassigned clusters: faces that share nothing of their motion with the rest of a part.
//!
//! The motion of such a face, as of the end of a cylinder, does not say which part it is on, so that the search assigns it to
//! any. Where one motion explains a cluster, the components that its faces feel tell which of them share some. Where it does
//! not, the cluster may mix faces of several parts, and is broken into faces if these have a shorter description. Large pieces
//! that feel how they rotate are parts. Others join a part, or each other, by description length. A piece that joins none is a
//! part if it is large, or else unassigned.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::cluster::{Cluster, TOLERANCE};
use super::faces::{connected_components, faces, similar};
use super::medians::{outlier_limit, typical_size};
use super::roots::product;
use super::search::{MIN_FREEDOM, MIN_SAVING, Search, smallest};
use super::subspace::{FACE_RANK, ROTATION_RANK};

/// Components that two faces have in common, as a share of those that the lesser of them feels, from which on they are linked:
/// more than the end of a thin cylinder feels of its rotation, and less than two faces of a box have in common.
const SHARED: f64 = 0.05;
/// Share of the residual of a mixed cluster from which on it is tried whether its pieces have a shorter description.
const LITTLE: f64 = 0.25;

/// Some faces, and how many components of the motion of their cluster they feel.
type Group = (Vec<Vec<usize>>, f64);

impl Search<'_> {
    /// The parts, and the unassigned clusters.
    pub(super) fn parts_and_unassigned(&self, clusters: Vec<Cluster>) -> (Vec<Cluster>, Vec<Cluster>) {
        let most = most_residual(&clusters);
        let whole: Vec<Vec<usize>> = clusters.iter().map(|cluster| cluster.sensors.clone()).collect();
        let small = typical_size(whole.iter().map(Vec::len).collect()).div_ceil(2);
        let pieces: Vec<Vec<usize>> =
            clusters.par_iter().flat_map_iter(|own| self.pieces(own, most, small)).collect();
        let is_pure = |cluster: &Cluster, rank: usize, freedom: f64| {
            cluster.fit.rank() >= rank && cluster.fit.freedom >= freedom && !cluster.is_mixed(most)
        };
        let is_large = |cluster: &Cluster| cluster.sensors.len() >= small;
        let is_part = |cluster: &Cluster| {
            is_large(cluster) || is_pure(cluster, ROTATION_RANK, cluster.fit.rank() as f64)
        };
        let pieces = self.with_rotation(self.clusters(pieces, clusters));
        // A large face that hardly feels how its part rotates may still share that with the rest of it.
        let is_face = |cluster: &Cluster| is_pure(cluster, FACE_RANK, MIN_FREEDOM);
        let is_whole = |cluster: &Cluster| {
            is_large(cluster) && (cluster.fit.rank() > ROTATION_RANK || !is_face(cluster))
        };
        let (mut parts, pieces): (Vec<Cluster>, Vec<Cluster>) = pieces.into_iter().partition(is_whole);
        let (faces, rest): (Vec<Cluster>, Vec<Cluster>) = pieces.into_iter().partition(is_face);
        let sensors: Vec<usize> = rest.iter().flat_map(|cluster| cluster.sensors.iter().copied()).collect();
        let mut unassigned = self.clusters(similar(&self.roots, &sorted(sensors)), rest);
        // Faces that feel enough join a part, or become one, by description length.
        let fixed = parts.len();
        parts.extend(faces);
        if parts.len() > fixed {
            // A union starts with the higher of two ranks, which may be higher than it needs.
            let again = |own: Cluster| if is_part(&own) { own } else { self.cluster(own.sensors) };
            let merged: Vec<Cluster> =
                self.merged(parts, usize::MAX, MIN_SAVING, fixed).into_par_iter().map(again).collect();
            let (found, others): (Vec<Cluster>, Vec<Cluster>) =
                self.with_rotation(merged).into_iter().partition(is_part);
            parts = found;
            unassigned.extend(others);
        }
        // Where nothing is left that could be a part, the clusters stay as they were.
        if parts.is_empty() {
            (self.clusters(whole, Vec::new()), Vec::new())
        } else {
            self.joined(parts, unassigned)
        }
    }

    /// Assigns unassigned sensors to the part whose motion explains them, if one does.
    fn joined(&self, parts: Vec<Cluster>, unassigned: Vec<Cluster>) -> (Vec<Cluster>, Vec<Cluster>) {
        let sensors: Vec<usize> =
            unassigned.iter().flat_map(|cluster| cluster.sensors.iter().copied()).collect();
        let roots = self.roots.select(&sensors);
        let residuals: Vec<Vec<f64>> = parts.par_iter().map(|part| roots.residuals(&part.fit)).collect();
        let mut members: Vec<Vec<usize>> = parts.iter().map(|part| part.sensors.clone()).collect();
        let mut rest = Vec::new();
        for (at, &sensor) in sensors.iter().enumerate() {
            match smallest(residuals.iter().map(|residuals| residuals[at])) {
                Some((part, residual)) if residual < TOLERANCE => members[part].push(sensor),
                _ => rest.push(sensor),
            }
        }
        let left = unassigned
            .iter()
            .map(|cluster| cluster.sensors.iter().copied().filter(|at| rest.contains(at)).collect());
        let left: Vec<Vec<usize>> = left.filter(|own: &Vec<usize>| !own.is_empty()).collect();
        (self.clusters(members.into_iter().map(sorted).collect(), parts), self.clusters(left, unassigned))
    }

    /// Raises clusters of rank two, whose residual exceeds the tolerance, to rank three if their description is hardly longer.
    fn with_rotation(&self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let raised = |own: Cluster| {
            if own.fit.rank() + 1 != ROTATION_RANK || !own.is_mixed(TOLERANCE) {
                return own;
            }
            let raised = Cluster::new(&self.roots, own.sensors.clone(), ROTATION_RANK, self.iterations);
            if raised.description_length < own.description_length + MIN_SAVING { raised } else { own }
        };
        clusters.into_par_iter().map(raised).collect()
    }

    /// The pieces of a cluster: groups of faces that share nothing of its motion with each other. Where one motion does not
    /// explain it, they are what feels alike, if that has a shorter description.
    fn pieces(&self, own: &Cluster, most: f64, small: usize) -> Vec<Vec<usize>> {
        let faces = faces(&self.roots, &own.sensors);
        let joined = |groups: Vec<Group>| groups.into_iter().map(|(group, _)| sorted(group.concat()));
        // A small residual may well be that of a few sensors of another part; the description lengths tell.
        let little = LITTLE * most;
        if own.is_mixed(little) {
            let pure = |face: &Vec<usize>| -> Vec<Vec<usize>> {
                let own = self.cluster(face.clone());
                let similar = similar(&self.roots, face);
                if own.is_mixed(little) { similar } else { joined(self.groups(&own, similar)).collect() }
            };
            let pieces: Vec<Vec<usize>> = faces.iter().flat_map(pure).collect();
            let pieces = self.merged(self.clusters(pieces, Vec::new()), usize::MAX, MIN_SAVING, 0);
            let sum = pieces.iter().map(|piece| piece.description_length).sum::<f64>();
            if sum + MIN_SAVING < own.description_length {
                return pieces.into_iter().map(|piece| piece.sensors).collect();
            }
        }
        let groups = self.groups(own, faces);
        if own.sensors.len() < small {
            return joined(groups).collect();
        }
        // Two pairs of faces of a flat box share little, but each feels nearly three components.
        let (much, little): (Vec<Group>, Vec<Group>) =
            groups.into_iter().partition(|(_, components)| *components > ROTATION_RANK as f64 - 0.5);
        let core = sorted(much.into_iter().flat_map(|(group, _)| group.concat()).collect());
        std::iter::once(core).filter(|core| !core.is_empty()).chain(joined(little)).collect()
    }

    /// The faces of a cluster, those in one group that share some of its motion.
    fn groups(&self, cluster: &Cluster, faces: Vec<Vec<usize>>) -> Vec<Group> {
        if faces.len() < 2 {
            return vec![(faces, cluster.fit.rank() as f64)];
        }
        let felt = self.information(cluster, &faces);
        let shared = |a: usize, b: usize| {
            let least = felt[a].trace().min(felt[b].trace());
            if least > 0.0 { (&felt[a] * &felt[b]).trace() / least } else { 0.0 }
        };
        let found = connected_components(faces.len(), |a, b| shared(a, b) > SHARED);
        let group = |own: Vec<usize>| -> Group {
            let components = own.iter().map(|at| felt[*at].trace()).sum();
            (own.into_iter().map(|at| faces[at].clone()).collect(), components)
        };
        found.into_iter().map(group).collect()
    }

    /// The information of each face on the motion of their cluster, as a share: k × k, which sum up to the identity. The traces
    /// are numbers of components; the products of faces that share none are 0.
    fn information(&self, cluster: &Cluster, faces: &[Vec<usize>]) -> Vec<DMatrix<f64>> {
        let k = cluster.fit.rank();
        let squares = |face: &Vec<usize>| {
            let loadings = self.roots.select(face).loadings(&cluster.fit);
            let own = product(loadings.transpose(), loadings.as_ref());
            DMatrix::from_fn(k, k, |i, j| own[(i, j)])
        };
        let squares: Vec<DMatrix<f64>> = faces.iter().map(squares).collect();
        let all: DMatrix<f64> = squares.iter().sum();
        let ridge = DMatrix::from_diagonal_element(k, k, f64::EPSILON.sqrt() * all.trace());
        let Some(factor) = (all + ridge).cholesky() else {
            return vec![DMatrix::identity(k, k); faces.len()];
        };
        let factor = factor.unpack();
        let whitened = |square: &DMatrix<f64>| {
            let half = factor.solve_lower_triangular(square).expect("a factor is regular");
            factor.solve_lower_triangular(&half.transpose()).expect("a factor is regular")
        };
        squares.iter().map(whitened).collect()
    }
}

/// The largest residual variance of a cluster that is not mixed: with noise, more than without.
fn most_residual(clusters: &[Cluster]) -> f64 {
    let variance = |cluster: &Cluster| cluster.fit.residual / cluster.fit.freedom;
    let some = clusters.iter().filter(|cluster| cluster.fit.freedom > 0.0);
    outlier_limit(some.map(variance).collect(), TOLERANCE)
}

fn sorted(mut sensors: Vec<usize>) -> Vec<usize> {
    sensors.sort_unstable();
    sensors
}
