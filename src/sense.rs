//! Stage 2. Trajectory → tactile pressures (equation 25), a pure function that needs no physics engine.
//!
//! The paper's fluid has no viscosity: a sensor feels ρ (ṗ · n)² where it moves outward, along its normal
//! n, and nothing otherwise. The velocity ṗ is the backward difference of its position over Δt, the
//! normal is that of the later sample.

use rayon::prelude::*;

use crate::agent::{Agent, Site, Vector3};
use crate::settings::Sense;
use crate::simulate::Trajectory;
use crate::simulate::world::Pose;

/// Tactile pressures of M sensors at T times, Pa; never negative, never NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Tactile {
    /// T.
    pub samples: usize,
    /// M × T: the whole series of one sensor after that of another.
    pub pressures: Vec<f32>,
}

impl Tactile {
    /// M.
    pub fn sensors(&self) -> usize {
        self.pressures.len() / self.samples
    }

    /// The series of each sensor.
    pub fn series(&self) -> std::slice::ChunksExact<'_, f32> {
        self.pressures.chunks_exact(self.samples)
    }
}

/// The pressures on every sensor of `agent` over a trajectory of at least one sample.
pub fn sense(agent: &Agent, trajectory: &Trajectory, settings: &Sense) -> Tactile {
    let samples = trajectory.samples();
    let mut pressures = vec![0.0; agent.sites.len() * samples];
    pressures.par_chunks_exact_mut(samples).zip(&agent.sites).for_each(|(series, site)| {
        let poses = trajectory.poses[site.part..].iter().step_by(trajectory.parts);
        for ((pressure, before), now) in series.iter_mut().zip(poses.clone()).zip(poses.skip(1)) {
            *pressure = pressure_between(before, now, site, settings) as f32;
        }
    });
    Tactile { samples, pressures }
}

/// Equation 25 for one sensor between two samples, Pa.
fn pressure_between(before: &Pose, now: &Pose, site: &Site, settings: &Sense) -> f64 {
    let dot = |a: &Vector3, b: &Vector3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let outward: f64 = (0..3)
        .map(|i| {
            let moved = now.position[i] - before.position[i] + dot(&now.rotation[i], &site.position)
                - dot(&before.rotation[i], &site.position);
            moved / settings.interval * dot(&now.rotation[i], &site.normal)
        })
        .sum();
    if outward > 0.0 { settings.fluid_density * outward * outward } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    /// Two samples of an agent whose parts all move by `pose`, and the pressures they feel.
    fn felt(now: Pose) -> (Agent, Tactile) {
        let mut settings = Settings::paper();
        settings.skin.caps = 2;
        let agent = Agent::new(&settings.agent, &settings.skin);
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let before = Pose { position: [0.3, -0.2, 0.1], rotation: identity };
        let poses = [[before; 5], [now; 5]].concat();
        let trajectory = Trajectory { parts: 5, joints: 4, poses, angles: vec![] };
        let tactile = sense(&agent, &trajectory, &settings.sense);
        (agent, tactile)
    }

    #[test]
    fn pure_translation_agrees_with_the_closed_form() {
        let velocity = [0.2, -0.1, 0.4];
        let position = [0.3 + 0.02, -0.2 - 0.01, 0.1 + 0.04];
        let (agent, tactile) =
            felt(Pose { position, rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] });
        for (site, series) in agent.sites.iter().zip(tactile.series()) {
            let outward: f64 = (0..3).map(|i| velocity[i] * site.normal[i]).sum();
            if outward > 1e-12 {
                let expected = 1010.0 * outward * outward;
                assert!((f64::from(series[0]) - expected).abs() < 1e-5 * expected, "{site:?}");
            } else if outward < -1e-12 {
                assert_eq!(series[0], 0.0, "{site:?} moves backwards");
            }
        }
    }

    /// Whether each sensor feels ρ max(0, l·n − l·Rn)² / Δt² when its part turns by `angle` about its own
    /// centre: the closed form of the backward difference for a rotation R about the x axis, for sensors at
    /// l with normal n. The mutant takes the normal of the earlier sample.
    fn rotation_agrees(angle: f64, mutant: bool) -> bool {
        let (sine, cosine) = angle.sin_cos();
        let rotation = [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]];
        let (agent, tactile) = felt(Pose { position: [0.3, -0.2, 0.1], rotation });
        agent.sites.iter().zip(tactile.series()).all(|(Site { position: l, normal: n, .. }, series)| {
            let turned = |v: &Vector3| [v[0], cosine * v[1] - sine * v[2], sine * v[1] + cosine * v[2]];
            let dot = |a: &Vector3, b: &Vector3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
            let moved = if mutant { dot(&turned(l), n) - dot(l, n) } else { dot(l, n) - dot(l, &turned(n)) };
            let outward = moved.max(0.0) / 0.1;
            let expected = 1010.0 * outward * outward;
            (f64::from(series[0]) - expected).abs() <= 1e-5 * expected + 1e-12
        })
    }

    #[test]
    fn pure_rotation_agrees_with_the_closed_form_at_each_sensor() {
        for angle in [0.001, 0.1, -0.7, 2.0] {
            assert!(rotation_agrees(angle, false), "{angle}");
            assert!(!rotation_agrees(angle, true), "the earlier normal is told apart at {angle}");
        }
    }

    #[test]
    fn pressure_is_density_times_speed_squared() {
        // kg/m³ · (m/s)² = Pa: twice the kinetic energy of a unit volume of fluid at the sensor's speed.
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let pose = |x: f64| Pose { position: [x, 0.0, 0.0], rotation: identity };
        let site = Site { part: 0, position: [0.0; 3], normal: [1.0, 0.0, 0.0] };
        let pressure = |way: f64, interval: f64, fluid_density: f64| {
            pressure_between(&pose(0.0), &pose(way), &site, &Sense { interval, fluid_density })
        };
        let speed = 0.2 / 0.1;
        assert!((pressure(0.2, 0.1, 1010.0) - 2.0 * (0.5 * 1010.0 * speed * speed)).abs() < 1e-9);
        assert!((pressure(0.2, 0.2, 1010.0) - pressure(0.2, 0.1, 1010.0) / 4.0).abs() < 1e-9);
        assert!((pressure(0.2, 0.1, 505.0) - pressure(0.2, 0.1, 1010.0) / 2.0).abs() < 1e-9);
        assert_eq!(pressure(-0.2, 0.1, 1010.0), 0.0, "backwards is exactly nothing");
    }
}
