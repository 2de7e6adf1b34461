//! Settings → the body: parts, joints and sensor sites; the ground truth of every evaluation lives here.
//!
//! Section 5.1 and figure 4: five cylinders, four universal joints, 840 sensors. The figure is all that
//! the paper says of the geometry, so the morphology and every length are settings (ours).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use crate::settings::{self, Morphology, Skin};

/// A position or direction in space.
pub type Vector3 = [f64; 3];

/// Parts of every body.
pub const PARTS: usize = 5;

/// A cylinder, in the rest pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Centre of mass, m.
    pub centre: Vector3,
    /// Unit vector along the cylinder, from its proximal to its distal end.
    pub axis: Vector3,
}

/// A universal joint, in the rest pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Index of the part that carries the child.
    pub parent: usize,
    /// Index of the part that is carried.
    pub child: usize,
    /// Where both parts meet, m: the middle of the gap between their ends.
    pub anchor: Vector3,
    /// The two axes of rotation, at right angles to each other and to the child's own axis.
    pub axes: [Vector3; 2],
}

/// A tactile sensor in the frame of its part, whose z axis is the cylinder's.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// The part it sits on.
    pub part: usize,
    /// Position, m.
    pub position: Vector3,
    /// Outward unit normal n_i of the surface.
    pub normal: Vector3,
}

/// The body and its skin.
#[derive(Debug, Clone, PartialEq)]
pub struct Agent {
    /// Part 0 is the root of the tree.
    pub parts: Vec<Part>,
    /// Joint j carries part j + 1.
    pub joints: Vec<Joint>,
    /// Sensors, those of part 0 first.
    pub sites: Vec<Site>,
}

/// A limb: the part that carries it, on which end (true: the distal one), and its direction in the plane
/// of the body, as an angle to the x axis.
type Limb = (usize, bool, f64);

fn limbs(morphology: Morphology) -> [Limb; PARTS - 1] {
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
    pub fn new(agent: &settings::Agent, skin: &Skin) -> Self {
        let along =
            |from: Vector3, axis: Vector3, distance: f64| [0, 1, 2].map(|i| from[i] + distance * axis[i]);
        let half = agent.part_length / 2.0;
        let mut parts = vec![Part { centre: [0.0; 3], axis: [1.0, 0.0, 0.0] }];
        let mut joints = Vec::new();
        for (parent, distal, angle) in limbs(agent.morphology) {
            let carrier = &parts[parent];
            let end = along(carrier.centre, carrier.axis, if distal { half } else { -half });
            let axis = [angle.cos(), angle.sin(), 0.0];
            joints.push(Joint {
                parent,
                child: parts.len(),
                anchor: along(end, axis, agent.gap / 2.0),
                axes: [[0.0, 0.0, 1.0], [-axis[1], axis[0], 0.0]],
            });
            parts.push(Part { centre: along(end, axis, agent.gap + half), axis });
        }
        let sites = (0..parts.len()).flat_map(|part| sites(part, agent, skin)).collect();
        Self { parts, joints, sites }
    }

    /// The true part of each sensor.
    pub fn labels(&self) -> Vec<usize> {
        self.sites.iter().map(|site| site.part).collect()
    }

    /// The true tree as (child, parent) pairs.
    pub fn tree(&self) -> Vec<(usize, usize)> {
        self.joints.iter().map(|joint| (joint.child, joint.parent)).collect()
    }
}

/// The sensors of one part: rings on the side, evenly spaced, then one ring on each cap at two thirds of
/// the radius (the mean radius of a disc).
fn sites(part: usize, agent: &settings::Agent, skin: &Skin) -> Vec<Site> {
    let ring = |count: usize| {
        (0..count).map(move |i| {
            let (sine, cosine) = (TAU * i as f64 / count as f64).sin_cos();
            [cosine, sine, 0.0]
        })
    };
    let on_ring =
        |direction: Vector3, radius: f64, height: f64| [radius * direction[0], radius * direction[1], height];
    let length = agent.part_length;
    let mut sites = Vec::with_capacity(skin.around * skin.along + skin.caps);
    for row in 0..skin.along {
        let height = length * ((row as f64 + 0.5) / skin.along as f64 - 0.5);
        sites.extend(ring(skin.around).map(|normal| Site {
            part,
            position: on_ring(normal, agent.part_radius, height),
            normal,
        }));
    }
    for side in [-1.0, 1.0] {
        sites.extend(ring(skin.caps / 2).map(|direction| Site {
            part,
            position: on_ring(direction, agent.part_radius * 2.0 / 3.0, side * length / 2.0),
            normal: [0.0, 0.0, side],
        }));
    }
    sites
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn agent(morphology: Morphology) -> Agent {
        let mut settings = Settings::paper();
        settings.agent.morphology = morphology;
        Agent::new(&settings.agent, &settings.skin)
    }

    #[test]
    fn the_paper_s_agent_has_five_parts_four_joints_and_840_sensors() {
        let agent = agent(Morphology::Chain);
        assert_eq!((agent.parts.len(), agent.joints.len(), agent.sites.len()), (5, 4, 840));
        for part in 0..5 {
            assert_eq!(agent.labels().iter().filter(|&&label| label == part).count(), 168);
        }
    }

    #[test]
    fn each_morphology_has_its_tree() {
        use Morphology::*;
        for (morphology, tree) in [
            (Chain, [(1, 0), (2, 1), (3, 2), (4, 3)]),
            (Star, [(1, 0), (2, 0), (3, 0), (4, 0)]),
            (Tee, [(1, 0), (2, 0), (3, 0), (4, 3)]),
            (Y, [(1, 0), (2, 0), (3, 0), (4, 3)]),
        ] {
            assert_eq!(agent(morphology).tree(), tree, "{morphology:?}");
        }
    }

    #[test]
    fn joints_sit_half_a_gap_from_both_ends_with_axes_across_the_child() {
        let settings = Settings::paper().agent;
        let reach = (settings.part_length + settings.gap) / 2.0;
        for morphology in [Morphology::Chain, Morphology::Star, Morphology::Tee, Morphology::Y] {
            let agent = agent(morphology);
            for joint in &agent.joints {
                let child = &agent.parts[joint.child];
                let dot = |a: Vector3, b: Vector3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
                let offset = [0, 1, 2].map(|i| child.centre[i] - joint.anchor[i]);
                assert!((dot(offset, child.axis) - reach).abs() < 1e-12, "{morphology:?}");
                assert!(dot(joint.axes[0], joint.axes[1]).abs() < 1e-12);
                assert!(joint.axes.iter().all(|&axis| dot(axis, child.axis).abs() < 1e-12));
            }
        }
    }

    #[test]
    fn sensors_lie_on_the_surface_and_look_outward() {
        let mut settings = Settings::paper();
        settings.skin = Skin { around: 12, along: 12, caps: 24 };
        let agent = Agent::new(&settings.agent, &settings.skin);
        assert_eq!(agent.sites.len(), 840);
        let (radius, half) = (settings.agent.part_radius, settings.agent.part_length / 2.0);
        for Site { position: [x, y, z], normal, .. } in &agent.sites {
            if normal[2] == 0.0 {
                assert!((x.hypot(*y) - radius).abs() < 1e-12 && z.abs() < half);
                assert!((x * normal[0] + y * normal[1] - radius).abs() < 1e-12);
            } else {
                assert!(x.hypot(*y) < radius && (z * normal[2] - half).abs() < 1e-12);
            }
        }
    }
}
