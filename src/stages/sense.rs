//! Stage 2, `sense`: compute the pressure on each sensor from the movement of its part (equation 27).
//!
//! In: a [`Trajectory`]. Out: [`Tactile`] pressures, M × T, in Pa. It is a pure function and needs no physics engine.
//!
//! The paper's fluid has no viscosity: a sensor feels ρ (ṗ · n)² where it moves outward, along its normal
//! n, and nothing otherwise. The velocity ṗ is the backward difference of its position over Δt, the
//! normal is that of the later sample. A movement that has [`Instants`] is felt at each sample instead:
//! the difference is over a moment.

use rayon::prelude::*;

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, gain, moderate, positive};
use crate::numerics::simd::vectorised;
use crate::stages::agent::{Agent, Site, Vector3};
use crate::stages::simulate::{Instants, Pose, Trajectory};

/// The tactile sense (equation 27).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sense {
    /// Δt, s: time between two samples, and of the backward difference.
    pub interval: f64,
    /// ρ, kg/m³.
    pub fluid_density: f64,
    /// The weakest pressure that is felt, Pa; what is below is no pressure. With 0, as in the paper, any movement is felt,
    /// however slow: also rounding.
    pub threshold: f64,
}

impl Sense {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        positive("sense.interval", self.interval)?;
        moderate("sense.fluid_density", self.fluid_density)?;
        gain("sense.threshold", self.threshold)
    }
}

/// Tactile pressures of M sensors at T times, Pa. Those of [`sense`] are finite and not negative; a recording may have negative ones,
/// and NaN where a value is missing.
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

/// The pressure on each sensor of `agent` over a trajectory (equation 27).
///
/// In: T + 1 poses of each part, T ≥ 1. Out: M × T pressures in Pa, at least 0.
///
/// With R the rotation of the part now and R', p' its rotation and centre one sample before, the outward
/// speed of a sensor at l with normal n, both in the frame of the part, is linear in twelve numbers that all sensors of the
/// part share: ṗ · n = nᵀ [Rᵀ (p − p')] / Δt + nᵀ [Rᵀ (R − R')] l / Δt. These are computed once for each part and
/// sample; each sensor then takes twelve multiplications.
pub fn sense(agent: &Agent, trajectory: &Trajectory, settings: &Sense) -> Tactile {
    /// Sensors that read a block of motion while it is in the cache.
    const GROUP: usize = 8;
    let samples = trajectory.samples();
    let mut pressures = vec![0.0; agent.sites.len() * samples];
    let mut rest = pressures.as_mut_slice();
    for sites in agent.sites.chunk_by(|a, b| a.part == b.part) {
        let motion = motion(trajectory, sites[0].part, settings.interval);
        let own = rest.split_off_mut(..sites.len() * samples).expect("a series for each site");
        own.par_chunks_mut(GROUP * samples).zip(sites.par_chunks(GROUP)).for_each(|(group, sites)| {
            vectorised(
                #[inline(always)]
                || pressures_in_lanes(group, sites, &motion, samples, settings),
            );
        });
    }
    Tactile { samples, pressures }
}

/// Samples that are computed side by side.
const BLOCK: usize = 64;

/// The twelve numbers that all sensors of a part share, for a block of samples: Rᵀ (p − p') / Δt, then the rows of
/// Rᵀ (R − R') / Δt.
type Motion = [[f64; BLOCK]; 12];

fn motion<'a>(trajectory: &'a Trajectory, part: usize, interval: f64) -> Vec<Motion> {
    let (before, time) = match &trajectory.instants {
        Some(Instants { before, moment }) => (before, *moment),
        None => (&trajectory.poses, interval),
    };
    let own = |poses: &'a [Pose]| poses[part..].iter().step_by(trajectory.parts).collect::<Vec<_>>();
    let (before, now) = (own(before), own(&trajectory.poses));
    let mut blocks = vec![[[0.0; BLOCK]; 12]; trajectory.samples().div_ceil(BLOCK)];
    let pairs = before.par_chunks(BLOCK).zip(now[1..].par_chunks(BLOCK));
    blocks.par_iter_mut().zip(pairs).for_each(|(block, (before, now))| {
        for (lane, (before, now)) in before.iter().zip(now).enumerate() {
            for (numbers, number) in block.iter_mut().zip(shared(before, now, time)) {
                numbers[lane] = number;
            }
        }
    });
    blocks
}

/// The twelve numbers of a part between two samples.
fn shared(before: &Pose, now: &Pose, interval: f64) -> [f64; 12] {
    let turned_back = |v: Vector3| [0, 1, 2].map(|i| (0..3).map(|k| now.rotation[k][i] * v[k]).sum::<f64>());
    let moved = turned_back([0, 1, 2].map(|k| now.position[k] - before.position[k]));
    let columns =
        [0, 1, 2].map(|j| turned_back([0, 1, 2].map(|k| now.rotation[k][j] - before.rotation[k][j])));
    let mut numbers = [0.0; 12];
    for i in 0..3 {
        numbers[i] = moved[i] / interval;
        for j in 0..3 {
            numbers[3 + 3 * i + j] = columns[j][i] / interval;
        }
    }
    numbers
}

/// The factor of each of the twelve numbers for a sensor.
fn coefficients(site: &Site) -> [f64; 12] {
    let mut coefficients = [0.0; 12];
    for i in 0..3 {
        coefficients[i] = site.normal[i];
        for j in 0..3 {
            coefficients[3 + 3 * i + j] = site.normal[i] * site.position[j];
        }
    }
    coefficients
}

/// Equation 27 for some sensors of one part, one series after another, Pa.
#[inline(always)]
fn pressures_in_lanes(
    pressures: &mut [f32],
    sites: &[Site],
    motion: &[Motion],
    samples: usize,
    settings: &Sense,
) {
    for (at, block) in motion.iter().enumerate() {
        let first = at * BLOCK;
        let lanes = BLOCK.min(samples - first);
        for (site, series) in sites.iter().zip(pressures.chunks_exact_mut(samples)) {
            let mut outward = [0.0; BLOCK];
            for (coefficient, numbers) in coefficients(site).iter().zip(block) {
                for lane in 0..BLOCK {
                    outward[lane] = coefficient.mul_add(numbers[lane], outward[lane]);
                }
            }
            let mut felt = [0.0; BLOCK];
            for lane in 0..BLOCK {
                let outward = if outward[lane] > 0.0 { outward[lane] } else { 0.0 };
                let pressure = settings.fluid_density * outward * outward;
                felt[lane] = if pressure >= settings.threshold { pressure as f32 } else { 0.0 };
            }
            series[first..first + lanes].copy_from_slice(&felt[..lanes]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rng::stream;
    use crate::stages::agent::Skin;
    use crate::stages::simulate::fixtures::{INTERVAL, Scene};
    use crate::stages::simulate::simulate;

    const WATER: Sense = Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 };

    /// Two samples of an agent whose parts all move by `pose`, and the pressures they feel.
    fn felt(now: Pose) -> (Agent, Tactile) {
        let skin = Skin { around: 12, along: 14, caps: 2 };
        let agent = Agent::new(&Scene::new().geometry, &skin);
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let before = Pose { position: [0.3, -0.2, 0.1], rotation: identity };
        let poses = [[before; 5], [now; 5]].concat();
        let trajectory = Trajectory { parts: 5, joints: 4, poses, ..Trajectory::default() };
        let tactile = sense(&agent, &trajectory, &WATER);
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
        let agent = Agent { parts: Vec::new(), joints: Vec::new(), sites: vec![site] };
        let pressure_from = |threshold: f64, way: f64, interval: f64, fluid_density: f64| {
            let poses = vec![pose(0.0), pose(way)];
            let trajectory = Trajectory { parts: 1, poses, ..Trajectory::default() };
            let settings = Sense { interval, fluid_density, threshold };
            f64::from(sense(&agent, &trajectory, &settings).pressures[0])
        };
        let pressure =
            |way: f64, interval: f64, fluid_density: f64| pressure_from(0.0, way, interval, fluid_density);
        let speed = 0.2 / 0.1;
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6 * expected);
        close(pressure(0.2, 0.1, 1010.0), 2.0 * (0.5 * 1010.0 * speed * speed));
        close(pressure(0.2, 0.2, 1010.0), pressure(0.2, 0.1, 1010.0) / 4.0);
        close(pressure(0.2, 0.1, 505.0), pressure(0.2, 0.1, 1010.0) / 2.0);
        assert_eq!(pressure(-0.2, 0.1, 1010.0), 0.0, "backwards is exactly nothing");
        assert!(pressure(1e-12, 0.1, 1010.0) > 0.0, "however slow");
        let weak = pressure(0.1, 0.1, 1010.0);
        assert_eq!(pressure_from(0.99 * weak, 0.1, 0.1, 1010.0), weak);
        assert_eq!(pressure_from(1.01 * weak, 0.1, 0.1, 1010.0), 0.0, "below the threshold");
    }

    /// Equation 27 as it is written, for one sensor between two samples, Pa.
    fn plain(before: &Pose, now: &Pose, site: &Site, settings: &Sense) -> f64 {
        let (from, to) = (before.place(site.position), now.place(site.position));
        let normal = now.rotation.map(|row| (0..3).map(|i| row[i] * site.normal[i]).sum::<f64>());
        let outward: f64 = (0..3).map(|k| (to[k] - from[k]) / settings.interval * normal[k]).sum();
        if outward > 0.0 { settings.fluid_density * outward * outward } else { 0.0 }
    }

    #[test]
    fn a_moving_agent_feels_equation_27_on_any_processor() {
        let mut scene = Scene::new();
        // Neither samples nor sensors are whole blocks and groups.
        scene.physics.duration = 100.1;
        scene.motion.coordination = 0.3;
        let agent = Agent::new(&scene.geometry, &Skin { around: 5, along: 3, caps: 2 });
        let rng = &mut stream(1, 1, "motion", 0);
        let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
        let tactile = sense(&agent, &trajectory, &WATER);
        let mut felt = 0;
        for (site, series) in agent.sites.iter().zip(tactile.series()) {
            let poses: Vec<&Pose> = trajectory.poses[site.part..].iter().step_by(5).collect();
            for (pair, &found) in poses.windows(2).zip(series) {
                let expected = plain(pair[0], pair[1], site, &WATER);
                let error = (f64::from(found) - expected).abs();
                assert!(error <= 1e-6 * expected + 1e-12, "{found} {expected}");
                felt += usize::from(expected > 1.0);
            }
        }
        assert!(felt > 10_000, "it moved: {felt}");

        let motion = motion(&trajectory, 0, INTERVAL);
        let own = agent.sites.len() / 5;
        let mut portable = vec![0.0; own * tactile.samples];
        pressures_in_lanes(&mut portable, &agent.sites[..own], &motion, tactile.samples, &WATER);
        assert_eq!(portable, tactile.pressures[..own * tactile.samples]);
    }
}
