//! Tell parts from loose sets: sensors that share nothing of their motion with the rest of their part.
//!
//! The motion of a loose set, such as the ends of a cylinder, does not say which part it is on, so that the search gives it to any.
//! Where one motion explains all sensors of a set, what its faces say of this motion tells which share some. Where it does not,
//! the set is a mixture of faces of several parts, and falls apart into these.

use std::cmp::Reverse;

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::super::faces::{alike, connected, faces};
use super::super::motion::{LEAST_COMPONENTS, LEAST_OF_FACE};
use super::set::{Set, set};
use super::{MARGIN, SUPPORT, Search, UNEXPLAINED, limit};

/// What two faces say of the same components of a motion, over what the lesser says of all, from which on they share some: more than
/// the end of a thin cylinder says of its turning, and less than two faces of a box.
const SHARED: f64 = 0.05;

/// Some faces, and how many components of the motion of their set they say.
type Group = (Vec<Vec<usize>>, f64);

impl Search<'_> {
    /// Parts, and loose sets.
    pub fn separated(&self, sets: Vec<Set>) -> (Vec<Set>, Vec<Set>) {
        let most = most_left(&sets);
        let is_mixed = |set: &Set| is_mixed(set, most);
        let whole: Vec<Vec<usize>> = sets.iter().map(|set| set.sensors.clone()).collect();
        let (cores, pieces): (Vec<_>, Vec<_>) = sets.par_iter().map(|own| self.divided(own, most)).unzip();
        let cores: Vec<Vec<usize>> = cores.into_iter().filter(|core| !core.is_empty()).collect();
        let pieces: Vec<Vec<usize>> = pieces.into_iter().flatten().collect();
        let small = middle_of_sensors(cores.iter().chain(&pieces).map(Vec::len).collect()).div_ceil(2);
        let says = |set: &Set, components: usize, support: f64| {
            set.fit.components() >= components && set.fit.spare >= support && !is_mixed(set)
        };
        let is_part = |set: &Set| {
            set.sensors.len() >= small || says(set, LEAST_COMPONENTS, set.fit.components() as f64)
        };
        let (mut parts, mut loose): (Vec<Set>, Vec<Set>) =
            self.sets(cores, sets).into_iter().partition(is_part);
        let (faces, others): (Vec<Set>, Vec<Set>) =
            self.sets(pieces, Vec::new()).into_iter().partition(|set| says(set, LEAST_OF_FACE, SUPPORT));
        loose.extend(others);
        let sensors: Vec<usize> = loose.iter().flat_map(|set| set.sensors.iter().copied()).collect();
        let mut loose = self.sets(alike(&self.roots, &sorted(sensors)), loose);
        // Faces that say enough find their part, or become one, by what sets cost.
        let fixed = parts.len();
        parts.extend(faces);
        if parts.len() > fixed {
            let merged = self.merged(parts, usize::MAX, MARGIN, fixed);
            // A set of two begins with as many components as the one that had more, which may be more than both need.
            let anew = |own: Set| if is_part(&own) { own } else { set(&self.roots, own.sensors) };
            let merged: Vec<Set> = merged.into_par_iter().map(anew).collect();
            let (found, others): (Vec<Set>, Vec<Set>) = merged.into_iter().partition(is_part);
            parts = found;
            loose.extend(others);
        }
        // Where nothing is left that could be a part, the sets stay as they were.
        if parts.is_empty() { (self.sets(whole, Vec::new()), Vec::new()) } else { (parts, loose) }
    }

    /// What of a set is a part, and what comes off it.
    fn divided(&self, own: &Set, most: f64) -> (Vec<usize>, Vec<Vec<usize>>) {
        let faces = faces(&self.roots, &own.sensors);
        if !is_mixed(own, most) {
            return self.core(own, faces);
        }
        let pure = |face: Vec<usize>| {
            let own = set(&self.roots, face.clone());
            let alike = alike(&self.roots, &face);
            if is_mixed(&own, most) {
                return alike;
            }
            self.groups(&own, alike).into_iter().map(|(group, _)| sorted(group.concat())).collect()
        };
        (Vec::new(), faces.into_iter().flat_map(pure).collect())
    }

    /// The faces of a set that share some of its motion with the largest one, or say much of it; and the others.
    fn core(&self, set: &Set, faces: Vec<Vec<usize>>) -> (Vec<usize>, Vec<Vec<usize>>) {
        let mut groups = self.groups(set, faces);
        groups.sort_by_key(|(group, _)| Reverse(group.iter().map(Vec::len).sum::<usize>()));
        let (mut core, mut others) = (Vec::new(), Vec::new());
        for (at, (group, says)) in groups.into_iter().enumerate() {
            if at == 0 || says > LEAST_COMPONENTS as f64 - 0.5 {
                core.extend(group.concat());
            } else {
                others.extend(group);
            }
        }
        (sorted(core), others)
    }

    /// The faces of a set, those together that share some of its motion.
    fn groups(&self, set: &Set, faces: Vec<Vec<usize>>) -> Vec<Group> {
        if faces.len() < 2 {
            return vec![(faces, set.fit.components() as f64)];
        }
        let says = self.says(set, &faces);
        let shared = |a: usize, b: usize| {
            let least = says[a].trace().min(says[b].trace());
            if least > 0.0 { (&says[a] * &says[b]).trace() / least } else { 0.0 }
        };
        let found = connected(faces.len(), |a, b| shared(a, b) > SHARED);
        let group = |own: Vec<usize>| -> Group {
            let components = own.iter().map(|at| says[*at].trace()).sum();
            (own.into_iter().map(|at| faces[at].clone()).collect(), components)
        };
        found.into_iter().map(group).collect()
    }

    /// What each face says of the components of the motion of their set: k × k, which sum up to the identity. Two faces that share
    /// nothing say it of different directions.
    fn says(&self, set: &Set, faces: &[Vec<usize>]) -> Vec<DMatrix<f64>> {
        let k = set.fit.components();
        let squares = |face: &Vec<usize>| {
            let loadings = self.roots.select(face).loadings(&set.fit);
            let own = loadings.transpose() * &loadings;
            DMatrix::from_fn(k, k, |i, j| own[(i, j)])
        };
        let squares: Vec<DMatrix<f64>> = faces.iter().map(squares).collect();
        let all: DMatrix<f64> = squares.iter().sum();
        let ridge = DMatrix::from_diagonal_element(k, k, f64::EPSILON.sqrt() * all.trace());
        let Some(factor) = (all + ridge).cholesky() else {
            return vec![DMatrix::identity(k, k); faces.len()];
        };
        let factor = factor.unpack();
        let white = |square: &DMatrix<f64>| {
            let half = factor.solve_lower_triangular(square).expect("a factor is regular");
            factor.solve_lower_triangular(&half.transpose()).expect("a factor is regular")
        };
        squares.iter().map(white).collect()
    }
}

/// The share of squares that a set may leave if it is no mixture: with noise, more than without.
fn most_left(sets: &[Set]) -> f64 {
    let left = |set: &Set| set.fit.residual / set.fit.spare;
    limit(sets.iter().filter(|set| set.fit.spare > 0.0).map(left).collect(), UNEXPLAINED)
}

/// Whether one motion does not explain what a set feels.
fn is_mixed(set: &Set, most: f64) -> bool {
    set.fit.residual > most * set.fit.spare
}

fn sorted(mut sensors: Vec<usize>) -> Vec<usize> {
    sensors.sort_unstable();
    sensors
}

/// Of the sizes of sets, that of the set which the sensor in the middle is in.
fn middle_of_sensors(mut sizes: Vec<usize>) -> usize {
    sizes.sort_unstable();
    let half = sizes.iter().sum::<usize>().div_ceil(2);
    let mut below = 0;
    let reaches = |size: &usize| {
        below += size;
        below >= half
    };
    sizes.into_iter().find(reaches).unwrap_or(0)
}
