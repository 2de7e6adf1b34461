//! Test what sensors feel of movements whose velocities are known in closed form, and the rules of playing.

use std::f64::consts::PI;

use super::super::attach::Misfit;
use super::super::jumps::longest_stretch;
use super::super::skeleton::{Channel, RecordedJoint};
use super::*;
use crate::stages::agent::{Freedom, Part, Shape, Site, across};
use Channel::{Position, Rotation};

const FRAME: f64 = 0.01; // s
const UNIT: f64 = 0.01; // m

fn joint(name: &str, parent: Option<usize>, offset: Vector3, channels: &[Channel]) -> RecordedJoint {
    RecordedJoint { name: name.to_owned(), parent, offset, channels: channels.to_vec(), ends: Vec::new() }
}

fn ball(centre: Vector3) -> Part {
    let shape = Shape::Sphere { radius: 0.1 };
    Part { shape, centre, rotation: across([0.6, 0.0, 0.8]), density: 1000.0, inertia: None }
}

/// A trunk at the origin, and an arm that turns on it at y = 30 units about z.
fn body() -> (Agent, Vec<String>) {
    let joint = Joint { parent: 0, child: 1, anchor: [0.0, 0.3, 0.0], freedom: Freedom::Ball };
    let site = |part, position, normal| Site { part, position, normal };
    let agent = Agent {
        parts: vec![ball([0.0; 3]), ball([0.2, 0.3, 0.0])],
        joints: vec![joint],
        sites: vec![
            site(0, [0.1, 0.0, 0.0], [1.0, 0.0, 0.0]),
            site(1, [0.0, 0.1, 0.0], [0.0, 1.0, 0.0]),
            site(1, [0.03, -0.1, 0.02], [0.0, -1.0, 0.0]),
        ],
    };
    (agent, ["trunk", "arm/2"].map(str::to_owned).to_vec())
}

fn recorded(frames: &[[f64; 2]]) -> RecordedMovement {
    let joints = vec![
        joint("trunk", None, [5.0, 0.0, 0.0], &[Position(0)]),
        joint("arm", Some(0), [0.0, 30.0, 0.0], &[Rotation(2)]),
    ];
    RecordedMovement::new(joints, FRAME, frames.concat())
}

/// A pendulum: the arm at angle 0.9 sin(2 π t / 2 s) rad, on a trunk that moves at 40 units a second.
fn pendulum() -> RecordedMovement {
    let frame = |frame: i32| {
        let time = f64::from(frame) * FRAME;
        [5.0 + 40.0 * time, (0.9 * (PI * time).sin()).to_degrees()]
    };
    recorded(&(0..=400).map(frame).collect::<Vec<_>>())
}

/// Speeds of a sensor of the arm along its normal in closed form: v·n + (ω × arm)·n at a time in s.
fn outward(agent: &Agent, site: &Site, time: f64) -> f64 {
    let (angle, rate) = (0.9 * (PI * time).sin(), 0.9 * PI * (PI * time).cos());
    let part = &agent.parts[site.part];
    let turn =
        nalgebra::Rotation3::from_axis_angle(&Column::z_axis(), if site.part == 1 { angle } else { 0.0 });
    let own = |v: Vector3| Column::from(part.rotation.map(|row| (0..3).map(|k| row[k] * v[k]).sum::<f64>()));
    let normal = turn * own(site.normal);
    if site.part == 0 {
        return 0.4 * normal.x;
    }
    let arm = turn * (Column::from(part.centre) + own(site.position) - Column::new(0.0, 0.3, 0.0));
    (Column::new(0.4, 0.0, 0.0) + Column::new(0.0, 0.0, rate).cross(&arm)).dot(&normal)
}

/// Largest error of the felt speed, m/s, of samples every `interval`.
fn error(interval: f64, mutant: bool) -> f64 {
    let (agent, names) = body();
    let movement = pendulum();
    let attached = Attached::new(&agent, &names, &movement, None).unwrap();
    assert!((attached.scale() - UNIT).abs() < 1e-15);
    let frames = 0..movement.frames();
    let trajectory =
        play(&agent, &attached, &movement, &frames, interval, samples(&movement, &frames, interval));
    assert_eq!(trajectory.samples(), (4.0 / interval + 1e-6) as usize);
    let Instants { before, moment } = trajectory.instants.as_ref().unwrap();
    let mut worst = 0.0_f64;
    for site in &agent.sites {
        let own = |poses: &[Pose]| -> Vec<Pose> {
            poses[site.part..].iter().step_by(agent.parts.len()).copied().collect()
        };
        for (sample, (before, now)) in own(before).iter().zip(&own(&trajectory.poses)[1..]).enumerate() {
            let time = (sample + if mutant { 2 } else { 1 }) as f64 * interval;
            let felt = difference(before, now, site, *moment).max(0.0);
            worst = worst.max((felt - outward(&agent, site, time).max(0.0)).abs());
        }
    }
    worst
}

/// The outward speed of a sensor by a backward difference, as equation 27 has it, m/s.
fn difference(before: &Pose, now: &Pose, site: &Site, time: f64) -> f64 {
    let (from, to) = (before.place(site.position), now.place(site.position));
    let normal = now.rotation.map(|row| (0..3).map(|i| row[i] * site.normal[i]).sum::<f64>());
    (0..3).map(|k| (to[k] - from[k]) / time * normal[k]).sum()
}

#[test]
fn a_pendulum_is_felt_at_the_speed_that_it_has() {
    // At its frames, between them, and at every other one: what is left is the error of the curve between frames.
    for interval in [FRAME, FRAME / 3.0, 2.0 * FRAME] {
        let found = error(interval, false);
        assert!(found < 1e-3, "{interval}: {found}");
        assert!(error(interval, true) > 1e-3, "{interval}: the next sample is told apart");
    }
}

#[test]
fn joints_hold_and_angles_are_those_of_the_recording() {
    let (agent, names) = body();
    let movement = pendulum();
    let attached = Attached::new(&agent, &names, &movement, None).unwrap();
    let trajectory = play(&agent, &attached, &movement, &(0..401), FRAME, 400);
    assert!(trajectory.resolution.anchor_separation < 1e-12);
    assert!(
        (trajectory.resolution.turn - 0.9 * PI * FRAME / TAU).abs() < 1e-5,
        "{:?}",
        trajectory.resolution
    );
    for (sample, angles) in trajectory.angles.iter().enumerate() {
        let expected = -0.9 * (PI * sample as f64 * FRAME).sin();
        assert!(angles[2] - expected < 1e-12 && angles[..2] == [0.0; 2], "{sample}: {angles:?}");
    }
    assert_eq!(still_on(&agent, &trajectory), [None]);
    // The same bits on one thread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = pool.install(|| play(&agent, &attached, &movement, &(0..401), FRAME, 400));
    assert_eq!(alone, trajectory);
    let still =
        play(&agent, &attached, &recorded(&[[0.0, 25.0], [7.0, 25.0], [9.0, 25.0]]), &(0..3), 0.004, 5);
    assert_eq!(still_on(&agent, &still), [Some(0)]);
}

#[test]
fn what_moves_alike_on_one_part_never_moves_against_each_other() {
    let (mut agent, names) = body();
    let movement = pendulum();
    let attached = Attached::new(&agent, &names, &movement, None).unwrap();
    let mut trajectory = play(&agent, &attached, &movement, &(0..101), FRAME, 100);
    // A second arm that moves as the first does.
    let arm = agent.parts[1].clone();
    agent.parts.push(arm);
    agent.joints.push(Joint { child: 2, ..agent.joints[0].clone() });
    trajectory.poses = trajectory.poses.chunks(2).flat_map(|own| [own[0], own[1], own[1]]).collect();
    trajectory.parts = 3;
    assert_eq!(still_on(&agent, &trajectory), [None, Some(1)]);
}

#[test]
fn a_body_of_another_skeleton_or_unit_is_refused() {
    let (agent, names) = body();
    let movement = pendulum();
    let attach = |names: &[&str], scale: Option<f64>, agent: &Agent| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        Attached::new(agent, &names, &movement, scale)
    };
    assert_eq!(Attached::new(&agent, &names, &movement, Some(UNIT)).unwrap().scale(), UNIT);
    for name in ["leg", "arm/x", "arm/2/3", ""] {
        assert_eq!(attach(&["trunk", name], None, &agent), Err(Misfit::NoJoint(name.to_owned())));
    }
    assert!(matches!(attach(&["trunk", "arm"], Some(0.0254), &agent), Err(Misfit::Elsewhere { .. })));
    let mut tilted = agent.clone();
    tilted.joints[0].anchor = [0.01, 0.3, 0.0];
    assert!(matches!(attach(&["trunk", "arm"], None, &tilted), Err(Misfit::Elsewhere { .. })));
    tilted.joints[0].anchor = [0.0, -0.3, 0.0];
    assert_eq!(attach(&["trunk", "arm"], None, &tilted), Err(Misfit::NoScale));
    assert_eq!(attach(&["trunk", "trunk"], None, &agent), Err(Misfit::NoScale));
}

#[test]
fn the_longest_stretch_without_a_jump_is_found() {
    let (agent, names) = body();
    let attached = Attached::new(&agent, &names, &pendulum(), None).unwrap();
    let stretch = |frames: &[[f64; 2]]| longest_stretch(&agent, &attached, &recorded(frames));
    assert_eq!(longest_stretch(&agent, &attached, &pendulum()).frames, 0..401);
    // A rest pose first; a place lost for a frame; a turn that is too fast: 37° in a hundredth of a second.
    let found = stretch(&[[0.0, 0.0], [0.0, 90.0], [0.0, 91.0], [0.0, 92.0]]);
    assert_eq!((found.frames, found.jumps), (1..4, vec![1]));
    let found = stretch(&[[0.0, 0.0], [1.0, 0.0], [60.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
    assert_eq!((found.frames, found.jumps), (0..2, vec![2, 3]));
    let found = stretch(&[[0.0, 0.0], [0.0, 37.0], [0.0, 72.0]]);
    assert_eq!((found.frames, found.jumps), (1..3, vec![1]));
    assert_eq!(stretch(&[[0.0, 0.0]]).frames, 0..1);
}
