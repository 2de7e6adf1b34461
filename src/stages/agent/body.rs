//! A body of any shape: a tree of parts, the joints between them, and the sensors on them.

use std::f64::consts::FRAC_1_SQRT_2;

use super::inertia::Inertia;
use super::shape::{Shape, Vector3};
use crate::numerics::partition::{Connected, named_by_appearance};
use crate::stages::tree::Truth;

/// Joints of one part that are nearer to each other than this are at one place, m.
const ONE_PLACE: f64 = 1e-3;

/// A rigid part, in the rest pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its shape.
    pub shape: Shape,
    /// Centre of the shape, m.
    pub centre: Vector3,
    /// Rotation matrix from the part's frame to the world's, by rows.
    pub rotation: [Vector3; 3],
    /// Density, kg/m³.
    pub density: f64,
    /// Centre of mass and inertia, if they are not those of the shape.
    pub inertia: Option<Inertia>,
}

impl Part {
    /// Unit vector along the part: the z axis of its frame.
    pub fn axis(&self) -> Vector3 {
        self.rotation.map(|row| row[2])
    }
}

/// A rotation, by rows, that turns z into the direction of `axis`; where x and y go is as in ODE's `dRFromZAxis`.
///
/// `axis` must not be 0.
pub fn across(axis: Vector3) -> [Vector3; 3] {
    let largest = axis.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let [x, y, z] = axis.map(|x| x / largest);
    let scale = 1.0 / (x * x + y * y + z * z).sqrt();
    let axis @ [x, y, z] = [x * scale, y * scale, z * scale];
    let (first, second) = if z.abs() > FRAC_1_SQRT_2 {
        let square = y * y + z * z;
        let scale = 1.0 / square.sqrt();
        let first = [0.0, -z * scale, y * scale];
        (first, [square * scale, -x * first[2], x * first[1]])
    } else {
        let square = x * x + y * y;
        let scale = 1.0 / square.sqrt();
        let first = [-y * scale, x * scale, 0.0];
        (first, [-z * first[1], z * first[0], square * scale])
    };
    [0, 1, 2].map(|row| [first[row], second[row], axis[row]])
}

/// How a joint lets its parts turn against each other. Axes are unit vectors in the rest pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Freedom {
    /// About two axes at right angles; the paper's joint.
    Universal([Vector3; 2]),
    /// About one axis.
    Hinge(Vector3),
    /// About every axis.
    Ball,
    /// Not at all: both parts are one rigid body.
    Fixed,
}

impl Freedom {
    /// Number of angles, at most three.
    pub fn angles(&self) -> usize {
        match self {
            Self::Universal(_) => 2,
            Self::Hinge(_) => 1,
            Self::Ball => 3,
            Self::Fixed => 0,
        }
    }
}

/// A joint, in the rest pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Index of the part that carries the child.
    pub parent: usize,
    /// Index of the part that is carried.
    pub child: usize,
    /// Where both parts meet, m.
    pub anchor: Vector3,
    /// How they turn.
    pub freedom: Freedom,
}

/// A tactile sensor in the frame of its part.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// The part it sits on.
    pub part: usize,
    /// Position, m.
    pub position: Vector3,
    /// Outward unit normal n_i of the surface.
    pub normal: Vector3,
}

impl Site {
    /// With a normal that has this direction; `None` if it is 0 or not finite.
    pub fn facing(part: usize, position: Vector3, direction: Vector3) -> Option<Self> {
        let [x, y, z] = direction;
        let length = x.hypot(y).hypot(z);
        let normal = direction.map(|along| along / length);
        (length > 0.0 && length.is_finite()).then_some(Self { part, position, normal })
    }
}

/// The body and its skin.
#[derive(Debug, Clone, PartialEq)]
pub struct Agent {
    /// Parts; part 0 is the root of the tree.
    pub parts: Vec<Part>,
    /// Joints; joint j carries part j + 1, and its parent comes before that.
    pub joints: Vec<Joint>,
    /// Sensors, those of part 0 first.
    pub sites: Vec<Site>,
}

impl Agent {
    /// The rigid body that each part belongs to: parts that are fixed to each other are one. Numbered by their first parts.
    pub fn rigid_bodies(&self) -> Vec<usize> {
        let mut bodies = vec![0];
        for joint in &self.joints {
            let new = bodies.iter().max().map_or(0, |last| last + 1);
            bodies.push(if joint.freedom == Freedom::Fixed { bodies[joint.parent] } else { new });
        }
        bodies
    }

    /// The true part of each sensor; parts that are fixed to each other are one.
    pub fn labels(&self) -> Vec<usize> {
        let bodies = self.rigid_bodies();
        self.sites.iter().map(|site| bodies[site.part]).collect()
    }

    /// The true part of each sensor and the true tree. Parts that are fixed to each other are one. A part without sensors is none:
    /// what it carries is joined to what carries it, and on the root to the first of them. Joints are at one place if they are
    /// less than a millimetre apart, or on one part without sensors.
    pub fn truth(&self) -> Truth {
        let bodies = self.rigid_bodies();
        let mut is_felt = vec![false; bodies.len()];
        self.sites.iter().for_each(|site| is_felt[bodies[site.part]] = true);
        // What stands for each rigid body; nothing yet for those without sensors from the root on.
        let mut stands: Vec<Option<usize>> =
            (0..bodies.len()).map(|body| is_felt[body].then_some(body)).collect();
        let (mut first, mut tree, mut joints_of_tree) = (None, Vec::new(), Vec::new());
        for (at, joint) in self.joints.iter().enumerate().filter(|(_, joint)| joint.freedom != Freedom::Fixed)
        {
            let (child, parent) = (bodies[joint.child], stands[bodies[joint.parent]].or(first));
            match parent {
                Some(parent) if is_felt[child] => {
                    tree.push((child, parent));
                    joints_of_tree.push(at);
                }
                None if is_felt[child] => first = Some(child),
                parent => stands[child] = parent,
            }
        }
        let mut places = self.places(&bodies, &is_felt);
        let places = joints_of_tree.into_iter().map(|joint| places.representative(joint)).collect::<Vec<_>>();
        Truth { places: named_by_appearance(&places), ..Truth::new(self.labels(), tree) }
    }

    /// Which joints are at one place.
    fn places(&self, bodies: &[usize], is_felt: &[bool]) -> Connected {
        let mut places = Connected::new(self.joints.len());
        let moving: Vec<(usize, &Joint)> =
            self.joints.iter().enumerate().filter(|(_, joint)| joint.freedom != Freedom::Fixed).collect();
        let near = |a: &Joint, b: &Joint| {
            a.anchor.iter().zip(&b.anchor).map(|(a, b)| (a - b).powi(2)).sum::<f64>() < ONE_PLACE.powi(2)
        };
        let parts = |joint: &Joint| [bodies[joint.parent], bodies[joint.child]];
        for (at, &(a, joint)) in moving.iter().enumerate() {
            for &(b, other) in &moving[..at] {
                let mut common = parts(joint).into_iter().filter(|part| parts(other).contains(part));
                if common.any(|part| !is_felt[part] || near(joint, other)) {
                    places.connect(a, b);
                }
            }
        }
        places
    }
}

#[cfg(test)]
mod tests;
