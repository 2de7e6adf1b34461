//! Measure the stages from a synthetic trajectory of full size to the distances, in seconds on all cores: `cargo bench --bench distance`;
//! with `-- TACTILE.npy` also reading and quantising that file. `benches/peers/distance.py` says what others take.

use std::hint::black_box;
use std::time::Instant;

use bodyschema::files::npy;
use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::distance::information_metric;
use bodyschema::stages::quantise::quantise;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::Pose;
use bodyschema::stages::simulate::Trajectory;
use rand::RngExt;

/// T.
const SAMPLES: usize = 100_000;
/// Measurements, of which the least is printed: others may use the cores. One is enough where it takes long.
const MEASUREMENTS: usize = 5;
const LONG: f64 = 5.0;

fn main() {
    let mut settings = Settings::paper();
    let agent = Agent::new(&settings.agent, &settings.skin);
    let trajectory = wandering(agent.parts.len());
    let tactile = timed("sense", || sense(&agent, &trajectory, &settings.sense));
    if let Some(file) = std::env::args().find(|argument| argument.ends_with(".npy")) {
        let felt = timed("read", || npy::read_tactile(file.as_ref()).expect("the file can be read"));
        settings.quantise.levels = 8;
        timed("quantise what was read, N = 8", || quantise(&felt, &settings.quantise));
    }
    for levels in [4, 8, 16, 64, 256] {
        settings.quantise.levels = levels;
        let symbols = timed(&format!("quantise, N = {levels}"), || quantise(&tactile, &settings.quantise));
        // These symbols change at most samples, those of a body at few: with many levels, it takes longer than with a body.
        timed(&format!("distance, N = {levels}"), || information_metric(&symbols));
    }
}

/// Parts that simulate_movement at random, each on its own.
fn wandering(parts: usize) -> Trajectory {
    let mut rng = stream(1, 1, "bench", 0);
    let mut step = || rng.random_range(-0.05..0.05);
    let mut states = vec![([0.0; 3], 0.0_f64); parts];
    let mut poses = Vec::with_capacity((SAMPLES + 1) * parts);
    for _ in 0..=SAMPLES {
        for (position, angle) in &mut states {
            position.iter_mut().for_each(|coordinate| *coordinate += step());
            *angle += step();
            let (sine, cosine) = angle.sin_cos();
            let rotation = [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]];
            poses.push(Pose { position: *position, rotation });
        }
    }
    Trajectory { parts, joints: parts - 1, poses, ..Trajectory::default() }
}

/// What `work` makes, and a line with its least time.
fn timed<R>(name: &str, work: impl Fn() -> R) -> R {
    let (mut least, mut made) = (f64::INFINITY, None);
    for _ in 0..MEASUREMENTS {
        let start = Instant::now();
        made = Some(black_box(work()));
        least = least.min(start.elapsed().as_secs_f64());
        if least > LONG {
            break;
        }
    }
    println!("{name}: {least:.3} s");
    made.expect("it was measured")
}
