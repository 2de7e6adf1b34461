//! Tell parts from loose sets: sensors that share nothing of their motion with the rest of their part.
//!
//! The motion of a loose set, such as the ends of a cylinder, does not say which part it is on, so that the search gives it to any.
//! Where one motion explains all sensors of a set, what its faces say of this motion tells which share some. Where it does not, the set
//! may be a mixture of faces of several parts, and falls apart if its pieces cost less. Large pieces that feel how they
//! turn are parts; others find a part, or each other, by what sets cost. What finds none is a part if it is large, or else loose.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::super::faces::{alike, connected, faces};
use super::super::motion::{LEAST_COMPONENTS, LEAST_OF_FACE};
use super::set::{Set, TOLERANCE, set};
use super::{MARGIN, SUPPORT, Search, least, limit, middle_of_sensors};

/// What two faces say of the same components of a motion, over what the lesser says of all, from which on they share some: more than
/// the end of a thin cylinder says of its turning, and less than two faces of a box.
const SHARED: f64 = 0.05;

/// The share of what a mixture leaves from which on it is tried whether a set costs less in pieces.
const LITTLE: f64 = 0.25;

/// Some faces, and how many components of the motion of their set they say.
type Group = (Vec<Vec<usize>>, f64);

impl Search<'_> {
    /// Parts, and loose sets.
    pub fn separated(&self, sets: Vec<Set>) -> (Vec<Set>, Vec<Set>) {
        let most = most_left(&sets);
        let whole: Vec<Vec<usize>> = sets.iter().map(|set| set.sensors.clone()).collect();
        let small = middle_of_sensors(whole.iter().map(Vec::len).collect()).div_ceil(2);
        let pieces: Vec<Vec<usize>> =
            sets.par_iter().flat_map_iter(|own| self.pieces(own, most, small)).collect();
        let says = |set: &Set, components: usize, support: f64| {
            set.fit.components() >= components && set.fit.spare >= support && !is_mixed(set, most)
        };
        let is_large = |set: &Set| set.sensors.len() >= small;
        let is_part = |set: &Set| is_large(set) || says(set, LEAST_COMPONENTS, set.fit.components() as f64);
        let pieces = self.told_by_three(self.sets(pieces, sets));
        // A large face that hardly feels how its part turns may still share that with the rest of it.
        let is_face = |set: &Set| says(set, LEAST_OF_FACE, SUPPORT);
        let is_whole =
            |set: &Set| is_large(set) && (set.fit.components() > LEAST_COMPONENTS || !is_face(set));
        let (mut parts, pieces): (Vec<Set>, Vec<Set>) = pieces.into_iter().partition(is_whole);
        let (faces, loose): (Vec<Set>, Vec<Set>) = pieces.into_iter().partition(is_face);
        let sensors: Vec<usize> = loose.iter().flat_map(|set| set.sensors.iter().copied()).collect();
        let mut loose = self.sets(alike(&self.roots, &sorted(sensors)), loose);
        // Faces that say enough find their part, or become one, by what sets cost.
        let fixed = parts.len();
        parts.extend(faces);
        if parts.len() > fixed {
            // A set of two begins with as many components as the one that had more, which may be more than both need.
            let anew = |own: Set| if is_part(&own) { own } else { self.set(own.sensors) };
            let merged: Vec<Set> =
                self.merged(parts, usize::MAX, MARGIN, fixed).into_par_iter().map(anew).collect();
            let (found, others): (Vec<Set>, Vec<Set>) =
                self.told_by_three(merged).into_iter().partition(is_part);
            parts = found;
            loose.extend(others);
        }
        // Where nothing is left that could be a part, the sets stay as they were.
        if parts.is_empty() { (self.sets(whole, Vec::new()), Vec::new()) } else { self.adopted(parts, loose) }
    }

    /// Loose sensors that the motion of a part explains go to it.
    fn adopted(&self, parts: Vec<Set>, loose: Vec<Set>) -> (Vec<Set>, Vec<Set>) {
        let sensors: Vec<usize> = loose.iter().flat_map(|set| set.sensors.iter().copied()).collect();
        let roots = self.roots.select(&sensors);
        let left: Vec<Vec<f64>> = parts.par_iter().map(|part| roots.left(&part.fit)).collect();
        let mut members: Vec<Vec<usize>> = parts.iter().map(|part| part.sensors.clone()).collect();
        let mut rest = Vec::new();
        for (at, &sensor) in sensors.iter().enumerate() {
            match least(left.iter().map(|left| left[at])) {
                Some((part, left)) if left < TOLERANCE => members[part].push(sensor),
                _ => rest.push(sensor),
            }
        }
        let sets =
            loose.iter().map(|set| set.sensors.iter().copied().filter(|at| rest.contains(at)).collect());
        let sets: Vec<Vec<usize>> = sets.filter(|set: &Vec<usize>| !set.is_empty()).collect();
        (self.sets(members.into_iter().map(sorted).collect(), parts), self.sets(sets, loose))
    }

    /// Sets of two components, of which these leave more than a tolerance, with a third if that costs hardly more.
    fn told_by_three(&self, sets: Vec<Set>) -> Vec<Set> {
        let more = |own: Set| {
            let leaves = own.fit.residual > TOLERANCE * own.fit.spare;
            if own.fit.components() + 1 != LEAST_COMPONENTS || !leaves {
                return own;
            }
            let more = set(&self.roots, own.sensors.clone(), LEAST_COMPONENTS, self.rounds);
            if more.cost < own.cost + MARGIN { more } else { own }
        };
        sets.into_par_iter().map(more).collect()
    }

    /// What a set falls into: faces that share nothing of its motion with the others; or, where one motion does not explain what it
    /// feels, and by themselves they cost less, all that feels alike.
    fn pieces(&self, own: &Set, most: f64, small: usize) -> Vec<Vec<usize>> {
        let faces = faces(&self.roots, &own.sensors);
        let joined = |groups: Vec<Group>| groups.into_iter().map(|(group, _)| sorted(group.concat()));
        // A little may well be a few sensors of another part; the costs tell.
        let little = LITTLE * most;
        if is_mixed(own, little) {
            let pure = |face: &Vec<usize>| -> Vec<Vec<usize>> {
                let own = self.set(face.clone());
                let alike = alike(&self.roots, face);
                if is_mixed(&own, little) { alike } else { joined(self.groups(&own, alike)).collect() }
            };
            let pieces: Vec<Vec<usize>> = faces.iter().flat_map(pure).collect();
            let pieces = self.merged(self.sets(pieces, Vec::new()), usize::MAX, MARGIN, 0);
            if pieces.iter().map(|piece| piece.cost).sum::<f64>() + MARGIN < own.cost {
                return pieces.into_iter().map(|piece| piece.sensors).collect();
            }
        }
        let groups = self.groups(own, faces);
        if own.sensors.len() < small {
            return joined(groups).collect();
        }
        // Two pairs of faces of a flat box share little, but each says much.
        let (much, little): (Vec<Group>, Vec<Group>) =
            groups.into_iter().partition(|(_, says)| *says > LEAST_COMPONENTS as f64 - 0.5);
        let core = sorted(much.into_iter().flat_map(|(group, _)| group.concat()).collect());
        std::iter::once(core).filter(|core| !core.is_empty()).chain(joined(little)).collect()
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
    limit(sets.iter().filter(|set| set.fit.spare > 0.0).map(left).collect(), TOLERANCE)
}

/// Whether one motion does not explain what a set feels.
fn is_mixed(set: &Set, most: f64) -> bool {
    set.fit.residual > most * set.fit.spare
}

fn sorted(mut sensors: Vec<usize>) -> Vec<usize> {
    sensors.sort_unstable();
    sensors
}
