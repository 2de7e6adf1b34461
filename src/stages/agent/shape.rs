//! Shapes of parts, and sensors that are spread evenly over their surface.

use std::f64::consts::{PI, TAU};

/// A position or direction in space.
pub type Vector3 = [f64; 3];

/// A solid in the frame of its part: its centre is the origin, and its axis, if it has one, is z. Lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A cylinder with flat ends.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Length.
        length: f64,
    },
    /// A cylinder with a half ball on each end.
    Capsule {
        /// Radius of the cylinder and the balls.
        radius: f64,
        /// Length of the cylinder, without the balls.
        length: f64,
    },
    /// A ball.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A box.
    Box {
        /// Lengths of its edges, along x, y and z.
        sides: Vector3,
    },
}

/// A place on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Position, m.
    pub position: Vector3,
    /// Outward unit normal.
    pub normal: Vector3,
}

/// Share of a turn between two neighbours of a spiral that is as even as can be (the golden angle).
const GOLDEN: f64 = 0.381_966_011_250_105_1;

impl Shape {
    /// Area of the surface, m².
    pub fn area(&self) -> f64 {
        match *self {
            Self::Cylinder { radius, length } => TAU * radius * (length + radius),
            Self::Capsule { radius, length } => TAU * radius * (length + 2.0 * radius),
            Self::Sphere { radius } => 2.0 * TAU * radius * radius,
            Self::Box { sides: [x, y, z] } => 2.0 * (x * y + y * z + z * x),
        }
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        match *self {
            Self::Cylinder { radius, length } => PI * radius * radius * length,
            Self::Capsule { radius, length } => PI * radius * radius * (length + 4.0 / 3.0 * radius),
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Self::Box { sides: [x, y, z] } => x * y * z,
        }
    }

    /// Moments of inertia about its axes if it is an even solid of this mass, kg m².
    pub fn moments(&self, mass: f64) -> Vector3 {
        let [across, along] = match *self {
            Self::Cylinder { radius, length } => {
                let square = radius * radius;
                [mass * (3.0 * square + length * length) / 12.0, mass * square / 2.0]
            }
            Self::Capsule { radius, length } => {
                let ball = mass * Self::Sphere { radius }.volume() / self.volume();
                let [across, _, along] = Self::Cylinder { radius, length }.moments(mass - ball);
                // Each half of the ball has its centre of mass 3/8 of the radius from its flat side.
                let own = 0.4 * radius * radius;
                let apart = length * (length / 4.0 + 3.0 / 8.0 * radius);
                [across + ball * (own + apart), along + ball * own]
            }
            Self::Sphere { radius } => [0.4 * mass * radius * radius; 2],
            Self::Box { sides } => {
                let [x, y, z] = sides.map(|side| mass * side * side / 12.0);
                return [y + z, z + x, x + y];
            }
        };
        [across, across, along]
    }

    /// Half of its extent along z, m.
    pub fn half_length(&self) -> f64 {
        match *self {
            Self::Cylinder { length, .. } => length / 2.0,
            Self::Capsule { radius, length } => length / 2.0 + radius,
            Self::Sphere { radius } => radius,
            Self::Box { sides } => sides[2] / 2.0,
        }
    }

    /// So many places that share the surface evenly, on a spiral from the lowest to the highest; on a box, in rows
    /// on each face.
    pub fn spread(&self, count: usize) -> Vec<Spot> {
        match *self {
            Self::Box { sides } => on_box(sides, count),
            _ => (0..count).map(|at| self.on_spiral(at, count)).collect(),
        }
    }

    /// A place of a solid of revolution, by the share of the surface that lies below it.
    fn on_spiral(&self, at: usize, count: usize) -> Spot {
        let below = (at as f64 + 0.5) / count as f64 * self.area();
        let (sine, cosine) = (TAU * (at as f64 * GOLDEN).fract()).sin_cos();
        let spot = |off: f64, height: f64, out: f64, up: f64| Spot {
            position: [off * cosine, off * sine, height],
            normal: [out * cosine, out * sine, up],
        };
        // Archimedes: the area of a ball between two heights is that of the cylinder around it.
        let round = |radius: f64, length: f64| {
            let height = below / (TAU * radius) - length / 2.0 - radius;
            let up = (height - height.clamp(-length / 2.0, length / 2.0)) / radius;
            let out = (1.0 - up * up).max(0.0).sqrt();
            spot(radius * out, height, out, up)
        };
        match *self {
            Self::Capsule { radius, length } => round(radius, length),
            Self::Sphere { radius } => round(radius, 0.0),
            Self::Cylinder { radius, length } => {
                let cap = PI * radius * radius;
                let side = TAU * radius * length;
                if below < cap {
                    spot(radius * (below / cap).sqrt(), -length / 2.0, 0.0, -1.0)
                } else if below < cap + side {
                    spot(radius, (below - cap) / (TAU * radius) - length / 2.0, 1.0, 0.0)
                } else {
                    let left = (1.0 - (below - cap - side) / cap).max(0.0);
                    spot(radius * left.sqrt(), length / 2.0, 0.0, 1.0)
                }
            }
            Self::Box { .. } => unreachable!("a box is no solid of revolution"),
        }
    }
}

/// Places on the faces of a box, as many on each as its share of the surface says.
fn on_box(sides: Vector3, count: usize) -> Vec<Spot> {
    let faces = (0..6).map(|face| (face / 2, if face % 2 == 0 { -1.0 } else { 1.0 }));
    let area = Shape::Box { sides }.area();
    let (mut spots, mut below) = (Vec::with_capacity(count), 0.0);
    for (axis, side) in faces {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        below += sides[u] * sides[v] / area;
        // Whole numbers of places, none lost by rounding.
        let until = ((below * count as f64).round() as usize).min(count);
        let own = until - spots.len();
        // Rows along v, as far from each other as their places are.
        let rows = ((own as f64 * sides[u] / sides[v]).sqrt().round() as usize).clamp(1, own.max(1));
        for row in 0..rows {
            let places = (row + 1) * own / rows - row * own / rows;
            spots.extend((0..places).map(|place| {
                let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
                position[axis] = side * sides[axis] / 2.0;
                normal[axis] = side;
                position[u] = sides[u] * ((row as f64 + 0.5) / rows as f64 - 0.5);
                position[v] = sides[v] * ((place as f64 + 0.5) / places as f64 - 0.5);
                Spot { position, normal }
            }));
        }
    }
    spots
}

#[cfg(test)]
mod tests;
