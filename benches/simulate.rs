//! Measure the movement of the paper's agent by each controller, its tactile sense, and bodies that move at the same time, in s:
//! `cargo bench --bench simulate`. `benches/peers/bare_loop.c` is the floor.

use std::time::Instant;

use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::{Controller, simulate};
use rayon::prelude::*;

/// Measurements, of which the median is printed.
const MEASUREMENTS: usize = 3;

fn main() {
    // The bare loop has no fluid.
    let fluid = Settings::paper().physics.fluid_density;
    for (name, controller, density) in [
        ("torque", Controller::Torque, 0.0),
        ("servo", Controller::Servo, 0.0),
        ("servo in a fluid that pushes", Controller::Servo, fluid),
    ] {
        let mut settings = Settings::paper();
        (settings.motion.controller, settings.physics.fluid_density) = (controller, density);
        one(name, &settings);
    }
    many(&Settings::paper());
}

/// One body.
fn one(name: &str, settings: &Settings) {
    let Settings { motion, physics, sense: tactile_sense, .. } = settings;
    let interval = tactile_sense.interval;
    let (samples, steps) = (physics.samples(interval), physics.steps_per_sample(interval));
    let agent = Agent::new(&settings.agent, &settings.skin);
    let mut times = Vec::new();
    for _ in 0..MEASUREMENTS {
        let start = Instant::now();
        let mut rng = stream(1, 1, "motion", 0);
        let trajectory =
            simulate(&agent, motion, physics, interval, &mut rng, &|| ()).expect("a stable body");
        let simulated = start.elapsed().as_secs_f64();
        let tactile = sense(&agent, &trajectory, tactile_sense);
        assert_eq!(tactile.samples, samples);
        times.push((start.elapsed().as_secs_f64(), simulated));
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (both, simulated) = times[MEASUREMENTS / 2];
    println!("simulate, {name}: {simulated:.3} s for {} steps", samples * steps);
    println!(
        "sense, {name}: {:.3} s for {} samples of {} sensors",
        both - simulated,
        samples,
        agent.sites.len()
    );
}

/// As many bodies as threads, at the same time and one after the other: 1 if each has a core of its own.
fn many(settings: &Settings) {
    let Settings { motion, physics, sense, .. } = settings;
    let agent = Agent::new(&settings.agent, &settings.skin);
    let bodies = rayon::current_num_threads();
    let run = |body: usize| {
        let mut rng = stream(1, 1 + body, "motion", 0);
        simulate(&agent, motion, physics, sense.interval, &mut rng, &|| ()).expect("a stable body")
    };
    let timed = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    let mut shares: Vec<f64> = (0..MEASUREMENTS)
        .map(|_| {
            let together = timed(&|| (0..bodies).into_par_iter().for_each(|body| drop(run(body))));
            let in_turn = timed(&|| (0..bodies).for_each(|body| drop(run(body))));
            in_turn / together / bodies as f64
        })
        .collect();
    shares.sort_by(f64::total_cmp);
    println!("{bodies} bodies on {bodies} threads: efficiency {:.3}", shares[MEASUREMENTS / 2]);
}
