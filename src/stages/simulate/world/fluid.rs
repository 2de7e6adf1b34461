//! A fluid that pushes what moves in it, by the pressure that sensors feel (equation 27).
//!
//! Where the surface moves outward, the pressure ρ (ṗ · n)² pushes it back; elsewhere there is none. That takes energy from a
//! part at every moment; the body as a whole may be set in motion, as one that swims, and glides on when its joints stop. It
//! is the form drag of a plate or a cylinder in about its real size: no friction, no wake, and no mass of the fluid that
//! moves along.

use super::Pose;
use super::momentum::Moving;
use super::places::{places, side};
use crate::numerics::simd::vectorised;
use crate::stages::agent::{Shape, Spot, Vector3};

/// Places or rings whose pressures are added side by side.
const LANES: usize = 8;
type Lanes = [f64; LANES];

/// The surface of a part, as what a push takes of it.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    rings: Vec<Rings>,
    places: Vec<Places>,
}

/// Force, N, and torque about the centre of the part, N m, in the world's frame.
pub(super) type Push = (Vector3, Vector3);

/// What of a push acts over a step, s: all of it over a short one, and never so much that the part gains energy. It makes the step
/// of a glide exact, v / (1 + c v h): an explicit push would turn a fast part round.
pub(super) fn over_step((force, torque): Push, part: &Moving, step: f64) -> Push {
    let dot = |a: Vector3, b: Vector3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let power = -dot(force, part.linear) - dot(torque, part.angular);
    // Twice the kinetic energy that the push would give the part if it rested, over the square of the step.
    let gain = dot(force, force) / part.inertia.mass + dot(torque, part.turned_by(torque));
    let share = if power > 0.0 { 1.0 / (1.0 + step * gain / power) } else { 1.0 };
    (force.map(|x| share * x), torque.map(|x| share * x))
}

/// Some rings about the axis of the part.
#[derive(Debug, Clone, Default)]
struct Rings {
    /// Height along the axis, m.
    heights: Lanes,
    /// 4/3 of density, radius and width, kg/m.
    weights: Lanes,
}

/// Some places, in the frame of the part.
#[derive(Debug, Clone, Default)]
struct Places {
    /// Normal, and position × normal: the lever of a force along it.
    factors: [Lanes; 6],
    /// Density times area, kg/m.
    weights: Lanes,
}

impl Surface {
    /// That of a part in a fluid of this density, kg/m³.
    pub(super) fn new(shape: &Shape, density: f64) -> Self {
        let gathered = |spots: &[(Spot, f64)]| {
            let mut places = Places::default();
            for (lane, (spot, area)) in spots.iter().enumerate() {
                let ([x, y, z], [a, b, c]) = (spot.position, spot.normal);
                let factors = [a, b, c, y * c - z * b, z * a - x * c, x * b - y * a];
                places.factors.iter_mut().zip(factors).for_each(|(lanes, factor)| lanes[lane] = factor);
                places.weights[lane] = density * area;
            }
            places
        };
        let ring = |some: &[(f64, f64)]| {
            let mut rings = Rings::default();
            for (lane, (height, area)) in some.iter().enumerate() {
                rings.heights[lane] = *height;
                rings.weights[lane] = 4.0 / 3.0 * density * area;
            }
            rings
        };
        Self {
            rings: side(shape).chunks(LANES).map(ring).collect(),
            places: places(shape).chunks(LANES).map(gathered).collect(),
        }
    }

    /// The push on the part, where it moves with these velocities of the world's frame, m/s and rad/s.
    ///
    /// The outward speed of a place is linear in both: n · (v + ω × r) = n · v + (r × n) · ω.
    pub(super) fn push(&self, pose: &Pose, linear: Vector3, angular: Vector3) -> Push {
        let own = |x: Vector3| {
            [0, 1, 2].map(|column| (0..3).map(|row| pose.rotation[row][column] * x[row]).sum::<f64>())
        };
        let ([a, b, c], [d, e, f]) = (own(linear), own(angular));
        let mut lanes = [[0.0; LANES]; 6];
        vectorised(
            #[inline(always)]
            || self.add(&[a, b, c, d, e, f], &mut lanes),
        );
        let [a, b, c, d, e, f] = lanes.map(|lanes| -lanes.iter().sum::<f64>());
        let world = |x: Vector3| pose.rotation.map(|row| row.iter().zip(x).map(|(r, x)| r * x).sum());
        (world([a, b, c]), world([d, e, f]))
    }

    /// Adds the pressures times the factors.
    ///
    /// A ring whose centre moves across the axis with u feels (|u| cos θ)² on the half that goes ahead, θ from u; its sum is
    /// 4/3 |u| u, because ∫ cos³ over a half turn is 4/3.
    #[inline(always)]
    fn add(&self, velocity: &[f64; 6], sums: &mut [Lanes; 6]) {
        let [along_x, along_y, _, about_x, about_y, _] = *velocity;
        for Rings { heights, weights } in &self.rings {
            for lane in 0..LANES {
                let height = heights[lane];
                let (x, y) = (height.mul_add(about_y, along_x), height.mul_add(-about_x, along_y));
                let size = weights[lane] * x.mul_add(x, y * y).sqrt();
                let (x, y) = (size * x, size * y);
                sums[0][lane] += x;
                sums[1][lane] += y;
                sums[3][lane] = height.mul_add(-y, sums[3][lane]);
                sums[4][lane] = height.mul_add(x, sums[4][lane]);
            }
        }
        for Places { factors, weights } in &self.places {
            let mut speeds = [0.0; LANES];
            for (factors, velocity) in factors.iter().zip(velocity) {
                for lane in 0..LANES {
                    speeds[lane] = factors[lane].mul_add(*velocity, speeds[lane]);
                }
            }
            let mut forces = [0.0; LANES];
            for lane in 0..LANES {
                let outward = f64::max(speeds[lane], 0.0);
                forces[lane] = weights[lane] * outward * outward;
            }
            for (sums, factors) in sums.iter_mut().zip(factors) {
                for lane in 0..LANES {
                    sums[lane] = factors[lane].mul_add(forces[lane], sums[lane]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
