//! Measure the movement of the paper's agent and its tactile sense, in s: `cargo bench --bench simulate`.
//! `benches/peers/bare_loop.c` is the floor.

use std::time::Instant;

use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::simulate;

/// Measurements, of which the median is printed.
const MEASUREMENTS: usize = 3;

fn main() {
    let settings = Settings::paper();
    let Settings { motion, physics, sense: tactile_sense, .. } = &settings;
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
    println!("simulate: {simulated:.3} s for {} steps", samples * steps);
    println!("sense: {:.3} s for {} samples of {} sensors", both - simulated, samples, agent.sites.len());
}
