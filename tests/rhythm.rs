//! Rhythmic movement: joints swing as the settings ask, a body swims by it and by nothing else, and a random movement is what it was.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use bodyschema::estimate::{Fit, Verdict};
use bodyschema::files::body::read_body;
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::{Controller, Movement, Targets, Trajectory, simulate};
use rayon::prelude::*;

use crate::support::estimated::estimated;
use crate::support::folder::Folder;
use crate::support::small::small_chain;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Settings of a body that swims.
fn swimming() -> Settings {
    Settings::load(false, Some(&root().join("reproduce/rhythmic.toml"))).unwrap()
}

fn moved(agent: &Agent, settings: &Settings, seed: u64) -> Trajectory {
    let Settings { motion, physics, sense, .. } = settings;
    simulate(agent, motion, physics, sense.interval, &mut stream(seed, 1, "motion", 0), &|| ()).unwrap()
}

/// The chain of the paper's settings.
fn chain(settings: &Settings) -> Agent {
    Agent::new(&settings.agent, &settings.skin)
}

/// How far the centre of mass of equal parts is from where it began, in lengths of the chain.
fn lengths_travelled(settings: &Settings, seed: u64) -> f64 {
    let trajectory = moved(&chain(settings), settings, seed);
    let parts = trajectory.parts;
    let centre = |poses: &[bodyschema::stages::simulate::Pose]| {
        [0, 1, 2].map(|i| poses.iter().map(|pose| pose.position[i]).sum::<f64>() / parts as f64)
    };
    let first = centre(&trajectory.poses[..parts]);
    let last = centre(&trajectory.poses[trajectory.poses.len() - parts..]);
    let way = (0..3).map(|i| (last[i] - first[i]).powi(2)).sum::<f64>().sqrt();
    let body = &settings.agent;
    way / (parts as f64 * body.part_length + (parts - 1) as f64 * body.gap)
}

/// The threshold was chosen before the first run. A wave that runs back at V through a slender body with slopes s, in a fluid that
/// pushes by the square of the normal speed, carries it at U, where thrust and drag balance: c (V − U)² ⟨|s|³⟩ = d U². Side and front
/// faces of the chain have c / d = (4/3 · 0.03 · 2.5) / (5 π 0.03²) = 7. Joints that swing by A with a lag of 1 rad make
/// s = A / (2 sin 0.5) = 0.5, V is 0.2 Hz · 0.6 m · 2π = 0.75 m/s, and so U = 0.3 m/s: 20 lengths of 2.9 m in 200 s. A quarter of that
/// leaves room for a short body that recoils, and for turns. Random movement has no direction: kicks of up to 0.1 m/s that last for an
/// epoch of 5 s lead some 0.5 m · √40 = 3 m or 1 length away in 40 epochs; 2.5 is rare.
#[test]
fn a_chain_swims_by_its_rhythm_and_not_at_random() {
    let (swims, stays) = (5.0, 2.5);
    let mut settings = swimming();
    settings.physics.duration = 200.0;
    for seed in 1..=3 {
        let way = |change: &dyn Fn(&mut Settings)| {
            let mut changed = settings.clone();
            change(&mut changed);
            lengths_travelled(&changed, seed)
        };
        let rhythmic = way(&|_| ());
        assert!(rhythmic > swims, "seed {seed}: {rhythmic} lengths");
        let each = way(&|settings| settings.motion.targets = Targets::Each);
        assert!(each > swims, "seed {seed}, axes apart: {each} lengths");
        let random = way(&|settings| settings.motion.movement = Movement::Random);
        assert!(random < stays, "seed {seed}, at random: {random} lengths");
        // What swims is the wave: joints that swing together go to and fro. And the fluid: without it nothing pushes from outside.
        let standing = way(&|settings| {
            let rhythm = settings.motion.rhythm.as_mut().unwrap();
            (rhythm.phase_lag, rhythm.phase_spread) = (0.0, 0.0);
        });
        assert!(standing < stays, "seed {seed}, a standing wave: {standing} lengths");
        let alone = way(&|settings| settings.physics.fluid_density = 0.0);
        assert!(alone < 1e-6, "seed {seed}, without a fluid that acts back: {alone} lengths");
    }
}

/// The angles of an axis, from some sample on.
fn angles(trajectory: &Trajectory, joint: usize, axis: usize, from: usize) -> Vec<f64> {
    trajectory.angles[joint..].iter().step_by(trajectory.joints).skip(from).map(|own| own[axis]).collect()
}

/// Amplitude and phase of a frequency in some angles 0.1 s apart.
fn component(angles: &[f64], frequency: f64) -> (f64, f64) {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (at, angle) in angles.iter().enumerate() {
        let phase = TAU * frequency * 0.1 * at as f64;
        (sine, cosine) = (sine + angle * phase.sin(), cosine + angle * phase.cos());
    }
    (2.0 * sine.hypot(cosine) / angles.len() as f64, cosine.atan2(sine))
}

#[test]
fn joints_swing_by_the_amplitudes_and_lags_that_the_settings_ask_for() {
    let mut settings = swimming();
    settings.motion.targets = Targets::Each;
    settings.physics.duration = 200.0;
    settings.motion.rhythm.as_mut().unwrap().frequency_spread = 0.0;
    // The servo takes away what a joint was off when it was let go, 1/e of it in 3.3 s; then 32 whole cycles.
    let trajectory = moved(&chain(&settings), &settings, 1);
    for axis in 0..2 {
        let found: Vec<(f64, f64)> =
            (0..4).map(|joint| component(&angles(&trajectory, joint, axis, 401), 0.2)).collect();
        for (joint, (amplitude, _)) in found.iter().enumerate() {
            assert!((0.245..=0.755).contains(amplitude), "joint {joint}: {amplitude} rad");
            let own = angles(&trajectory, joint, axis, 401);
            let power = 2.0 * own.iter().map(|angle| angle * angle).sum::<f64>() / own.len() as f64;
            let share = amplitude * amplitude / power;
            assert!((share - 1.0).abs() < 0.01, "joint {joint}: {share} of its power is at 0.2 Hz");
            // The broken twin: another frequency than the one that was asked for.
            assert!(component(&own, 0.25).0.powi(2) < 0.01 * power);
        }
        for pair in found.windows(2) {
            let lag = (pair[0].1 - pair[1].1).rem_euclid(TAU);
            assert!((0.49..=1.51).contains(&lag), "{lag} rad");
        }
    }
    // A torque is soft: its joints swing in about the same measure.
    settings.motion.controller = Controller::Torque;
    let trajectory = moved(&chain(&settings), &settings, 1);
    for joint in 0..4 {
        let (amplitude, _) = component(&angles(&trajectory, joint, 0, 401), 0.2);
        assert!((0.1..=1.0).contains(&amplitude), "joint {joint}: {amplitude} rad");
    }
}

#[test]
fn the_spectrum_of_a_wandering_rhythm_lies_about_its_frequency() {
    // Median frequency of the power of all joints, and the share within three standard deviations of ln f.
    let measured = |settings: &Settings| {
        let trajectory = moved(&chain(settings), settings, 2);
        let own: Vec<Vec<f64>> = (0..4).map(|joint| angles(&trajectory, joint, 0, 401)).collect();
        let frequencies: Vec<f64> = (1..600).map(|at| f64::from(at) / 600.0).collect();
        let power = |f: &f64| own.iter().map(|angles| component(angles, *f).0.powi(2)).sum::<f64>();
        let powers: Vec<f64> = frequencies.par_iter().map(power).collect();
        let total: f64 = powers.iter().sum();
        let mut below = 0.0;
        let median = frequencies.iter().zip(&powers).find(|(_, power)| {
            below += *power;
            below >= total / 2.0
        });
        let within = |f: f64| (f / 0.2).ln().abs() <= 0.6;
        let near: f64 =
            frequencies.iter().zip(&powers).filter(|(f, _)| within(**f)).map(|(_, power)| power).sum();
        (*median.unwrap().0, near / total)
    };
    let mut settings = swimming();
    settings.physics.duration = 1240.0;
    // Sixty time constants: the median of one realisation is known to some 5 %.
    settings.motion.rhythm.as_mut().unwrap().frequency_time = 20.0;
    let (median, near) = measured(&settings);
    assert!((median / 0.2).ln().abs() < 0.15 && near > 0.97, "{median} Hz, {near}");
    // Broken twins: a third more, and random movement, which is slow.
    settings.motion.rhythm.as_mut().unwrap().frequency = 0.27;
    assert!((measured(&settings).0 / 0.2).ln() > 0.15);
    settings.motion.movement = Movement::Random;
    assert!(measured(&settings).1 < 0.5);
}

/// What `estimate` says of a movement of three parts of 1,000 s.
fn verdict(settings: &Settings) -> Fit {
    let folder = Folder::new();
    folder.write("chain.toml", small_chain());
    let agent = read_body(&folder.at("chain.toml")).unwrap().agent;
    let tactile = sense(&agent, &moved(&agent, settings, 1), &settings.sense);
    estimated(&Recording::new(tactile)).fit
}

#[test]
fn a_movement_in_one_gait_does_not_tell_parts_apart_and_estimate_says_so() {
    let mut settings = swimming();
    settings.physics.duration = 1000.0;
    let fit = verdict(&settings);
    assert!(fit.verdict == Verdict::DoesNotFit && fit.cause.unwrap().contains("repeats itself"), "{fit}");
    // The same body at random.
    settings.motion.movement = Movement::Random;
    let fit = verdict(&settings);
    assert_eq!(fit.verdict, Verdict::Good, "{fit}");
}

/// Four times as long as in the study of rhythmic movement: far away from where it began, a body still moves within what the step resolves, by the same rhythm.
#[test]
fn long_movements_of_all_kinds_of_joints_stay_finite_and_resolved() {
    let mut settings = swimming();
    // As in the study of bodies.
    (settings.physics.step, settings.motion.epoch) = (0.02, 250);
    (settings.physics.duration, settings.motion.targets) = (4000.0, Targets::Each);
    // Universal joints, hinges, and a ball joint with both.
    let names = ["paper", "snake", "quadruped"];
    names.par_iter().for_each(|name| {
        let agent = read_body(&root().join(format!("bodies/{name}.toml"))).unwrap().agent;
        let trajectory = moved(&agent, &settings, 1);
        assert_eq!(trajectory.samples(), 40_000);
        let finite = |x: &f64| x.is_finite() && x.abs() < 1e5;
        assert!(trajectory.poses.iter().all(|pose| pose.position.iter().all(finite)), "{name}");
        let resolution = trajectory.resolution;
        assert!(resolution.is_resolved() && resolution.anchor_separation < 0.002, "{name}: {resolution:?}");
        // No joint drifts away from where it swings.
        for joint in 0..trajectory.joints {
            for axis in 0..agent.joints[joint].freedom.angles() {
                let late = angles(&trajectory, joint, axis, 32_000);
                let largest = late.iter().fold(0.0, |most: f64, angle| most.max(angle.abs()));
                assert!((0.2..0.8).contains(&largest), "{name}, joint {joint}: {largest} rad");
            }
        }
    });
}

#[test]
fn p_locks_joints_as_in_random_movement() {
    let mut settings = swimming();
    settings.physics.duration = 1000.0;
    let still = |settings: &Settings| {
        let trajectory = moved(&chain(settings), settings, 3);
        let steps = (1..trajectory.samples()).flat_map(|at| (0..4).map(move |joint| (at, joint)));
        let locked = steps.filter(|(at, joint)| {
            let [before, now] = [at - 1, *at].map(|at| trajectory.angles[at * 4 + joint][0]);
            (now - before).abs() < 1e-4
        });
        locked.count() as f64 / (4 * trajectory.samples()) as f64
    };
    // 200 epochs of 4 joints: a standard deviation of 0.018.
    settings.motion.coordination = 0.5;
    assert!((still(&settings) - 0.5).abs() < 0.06, "{}", still(&settings));
    // All but the first epoch, and turning points.
    settings.motion.coordination = 0.0;
    assert!(still(&settings) < 0.02, "{}", still(&settings));
    settings.motion.coordination = 1.0;
    let trajectory = moved(&chain(&settings), &settings, 3);
    assert!(trajectory.poses.chunks(5).all(|poses| poses == &trajectory.poses[..5]));
}

/// Arguments for a simulation by these settings.
fn by(folder: &Folder, settings: &str, out: &str) -> String {
    folder.write("settings.toml", settings);
    format!("simulate --settings settings.toml --seed 7 --out {out}")
}

#[test]
fn the_same_seed_gives_the_same_files_and_mistakes_are_named() {
    let folder = Folder::new();
    let short = "physics = { duration = 50.0 }\n";
    let rhythmic = format!("{short}motion = {{ movement = \"rhythmic\", coordination = 0.0 }}\n");
    for (settings, out) in [(&rhythmic, "first"), (&rhythmic, "second"), (&short.to_owned(), "random")] {
        folder.done(&by(&folder, settings, out));
    }
    folder.has_files("second", &folder.files("first"));
    assert_ne!(folder.files("first"), folder.files("random"));
    // A random movement has no use for a rhythm, and is not changed by one.
    let idle = format!("{short}motion = {{ rhythm = {{ frequency = 1.0 }} }}\n");
    folder.done(&by(&folder, &idle, "idle"));
    folder.has_files("idle", &folder.files("random"));
    for (wrong, expected) in [
        (
            "motion = { movement = \"circular\" }",
            "unknown variant `circular`, expected `random` or `rhythmic`",
        ),
        (
            "motion = { rhythm = { frequency = 11.0 } }",
            "`motion.rhythm.frequency` is 11.0, but must be 0.0001 to 10 (Hz)",
        ),
        (
            "motion = { movement = \"rhythmic\", rhythm = { gait_time = 4.0 } }",
            "`motion.rhythm.gait_time` is 4.0, but must be 0, or from 1 / motion.rhythm.frequency",
        ),
        ("motion = { rhythm = { speed = 1.0 } }", "unknown setting `motion.rhythm.speed`"),
        (
            "motion = { movement = \"rhythmic\", rhythm = { frequency = 6.0 } }",
            "`motion.rhythm.frequency` is 6.0, but must be at most 0.05 / physics.step",
        ),
        (
            "motion = { rhythm = { least_amplitude = 0.8 } }",
            "`motion.rhythm.least_amplitude` is 0.8, but must be 0 to motion.rhythm.largest_amplitude",
        ),
    ] {
        folder.refuse(&by(&folder, wrong, "wrong"), expected);
        assert!(!folder.at("wrong").exists(), "{wrong}");
    }
}

/// Files of a random movement are those from before there was another.
#[test]
fn settings_are_written_with_a_rhythm_only_if_it_counts() {
    let written = |settings: &Settings| toml::to_string(settings).unwrap();
    let random = written(&Settings::paper());
    assert!(!random.contains("rhythm") && !random.contains("movement"), "{random}");
    let rhythmic = written(&swimming());
    assert!(
        rhythmic.contains("movement = \"rhythmic\"\n") && rhythmic.contains("[motion.rhythm]\n"),
        "{rhythmic}"
    );
    // They are read as they were written, and one may lead to the other.
    let folder = tempfile::tempdir().unwrap();
    for settings in [Settings::paper(), swimming()] {
        let path = folder.path().join("settings.toml");
        fs::write(&path, written(&settings)).unwrap();
        assert_eq!(Settings::load(false, Some(&path)).unwrap(), settings);
        let read: Settings = serde_json::from_value(serde_json::to_value(&settings).unwrap()).unwrap();
        assert_eq!(read, settings);
    }
    let text = fs::read_to_string(root().join("reproduce/rhythmic.toml")).unwrap();
    assert_eq!(Settings::paper().with(&text, "rhythmic.toml").unwrap(), swimming());
}
