//! Test what a sensor feels.

use super::*;
use crate::numerics::rng::stream;
use crate::stages::agent::{Skin, Vector3};
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
