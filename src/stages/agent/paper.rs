//! The body of the paper (section 5.1 and figure 4): five cylinders, four universal joints, 840 sensors.
//!
//! The figure is all that the paper says of the geometry, so the morphology and every length are settings (ours).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use serde::{Deserialize, Serialize};

use super::body::{Agent, Freedom, Joint, Part, Site, across};
use super::shape::{Shape, Vector3};
use crate::numerics::range::{Checked, check, count, length, moderate};

/// How the parts are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Morphology {
    /// Five parts in a row.
    Chain,
    /// A trunk with two limbs at each end.
    Star,
    /// A trunk with two arms at right angles on one end, and two further parts in line on the other.
    Tee,
    /// As the tee, with the arms raised by 45°.
    Y,
}

/// Geometry of the body; lengths in m, density in kg/m³.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Geometry {
    /// Which part is joined to which.
    pub morphology: Morphology,
    /// Length of each cylinder, m.
    pub part_length: f64,
    /// Radius of each cylinder, m.
    pub part_radius: f64,
    /// Distance between the two ends that a joint connects, m.
    pub gap: f64,
    /// Density of the parts, kg/m³.
    pub density: f64,
}

/// Layout of the sensors on each part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Sensors in a ring around the cylinder.
    pub around: usize,
    /// Rings along the cylinder.
    pub along: usize,
    /// Sensors on both end caps together; half of them on each.
    pub caps: usize,
}

impl Geometry {
    /// Number of parts.
    pub fn parts(&self) -> usize {
        1 + limbs(self.morphology).len()
    }

    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        length("agent.part_length", self.part_length)?;
        length("agent.part_radius", self.part_radius)?;
        let flat = self.part_radius > 10.0 * self.part_length;
        check("agent.part_radius", self.part_radius, !flat, "at most ten times agent.part_length")?;
        check("agent.gap", self.gap, (0.0..=1e3).contains(&self.gap), "0 to 1000")?;
        moderate("agent.density", self.density)
    }
}

impl Skin {
    /// Sensors on each part.
    pub fn sensors_per_part(&self) -> usize {
        self.around.saturating_mul(self.along).saturating_add(self.caps)
    }

    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        count("skin.around", self.around)?;
        count("skin.along", self.along)?;
        check("skin.caps", self.caps, self.caps.is_multiple_of(2), "even: half on each cap")
    }
}

/// A limb: the part that carries it, on which end (true: the distal one), and its direction in the plane
/// of the body, as an angle to the x axis.
type Limb = (usize, bool, f64);

fn limbs(morphology: Morphology) -> [Limb; 4] {
    match morphology {
        Morphology::Chain => [(0, true, 0.0), (1, true, 0.0), (2, true, 0.0), (3, true, 0.0)],
        Morphology::Star => [
            (0, true, FRAC_PI_4),
            (0, true, -FRAC_PI_4),
            (0, false, PI - FRAC_PI_4),
            (0, false, PI + FRAC_PI_4),
        ],
        Morphology::Tee => [(0, true, FRAC_PI_2), (0, true, -FRAC_PI_2), (0, false, PI), (3, true, PI)],
        Morphology::Y => [(0, true, FRAC_PI_4), (0, true, -FRAC_PI_4), (0, false, PI), (3, true, PI)],
    }
}

impl Agent {
    /// Builds the body in its rest pose: the trunk along x, all parts in the plane z = 0.
    pub fn new(geometry: &Geometry, skin: &Skin) -> Self {
        let along =
            |from: Vector3, axis: Vector3, distance: f64| [0, 1, 2].map(|i| from[i] + distance * axis[i]);
        let half = geometry.part_length / 2.0;
        let cylinder = |centre, axis| Part {
            shape: Shape::Cylinder { radius: geometry.part_radius, length: geometry.part_length },
            centre,
            rotation: across(axis),
            density: geometry.density,
            inertia: None,
        };
        let mut parts = vec![cylinder([0.0; 3], [1.0, 0.0, 0.0])];
        let mut joints = Vec::new();
        for (parent, distal, angle) in limbs(geometry.morphology) {
            let carrier = &parts[parent];
            let end = along(carrier.centre, carrier.axis(), if distal { half } else { -half });
            let axis = [angle.cos(), angle.sin(), 0.0];
            joints.push(Joint {
                parent,
                child: parts.len(),
                anchor: along(end, axis, geometry.gap / 2.0),
                freedom: Freedom::Universal([[0.0, 0.0, 1.0], [-axis[1], axis[0], 0.0]]),
            });
            parts.push(cylinder(along(end, axis, geometry.gap + half), axis));
        }
        let sites = (0..parts.len()).flat_map(|part| sites(part, geometry, skin)).collect();
        Self { parts, joints, sites }
    }
}

/// The sensors of one part: rings on the side, evenly spaced, then one ring on each cap at two thirds of
/// the radius (the mean radius of a disc).
fn sites(part: usize, geometry: &Geometry, skin: &Skin) -> Vec<Site> {
    let ring = |count: usize| {
        (0..count).map(move |i| {
            let (sine, cosine) = (TAU * i as f64 / count as f64).sin_cos();
            [cosine, sine, 0.0]
        })
    };
    let on_ring =
        |direction: Vector3, radius: f64, height: f64| [radius * direction[0], radius * direction[1], height];
    let (length, radius) = (geometry.part_length, geometry.part_radius);
    let mut sites = Vec::with_capacity(skin.sensors_per_part());
    for row in 0..skin.along {
        let height = length * ((row as f64 + 0.5) / skin.along as f64 - 0.5);
        sites.extend(ring(skin.around).map(|normal| Site {
            part,
            position: on_ring(normal, radius, height),
            normal,
        }));
    }
    for side in [-1.0, 1.0] {
        sites.extend(ring(skin.caps / 2).map(|direction| Site {
            part,
            position: on_ring(direction, radius * 2.0 / 3.0, side * length / 2.0),
            normal: [0.0, 0.0, side],
        }));
    }
    sites
}

#[cfg(test)]
mod tests;
