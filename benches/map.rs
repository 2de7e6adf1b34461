//! Measure the time from distances to a body map, in ms on all threads: `cargo bench --bench map`, with `-- --large` also
//! for ten times as many sensors. Classical maps of 15 dimensions, and 300 metric and 30 nonmetric steps of majorisation from a random start in
//! 14.

use std::time::Instant;

use bodyschema::numerics::rng::stream;
use bodyschema::stages::body_map::{ClassicalScaling, Fit, Majorisation, descend, random_map};
use bodyschema::stages::distance::Distances;
use rand::RngExt;
use rayon::prelude::*;

/// d of the largest body map of the paper.
const DIMS: usize = 15;

/// City-block distances between points of 30 dimensions, each of less spread than the one before: eigenvalues
/// that fall as slowly as those of the information metric, and some of them negative. `map.py` has the same.
fn distances(sensors: usize) -> Distances {
    let mut rng = stream(1, 1, "bench", 0);
    let spread = |k: usize| 1.0 / (1.0 + k as f64 / 5.0);
    let points: Vec<f64> =
        (0..sensors * 30).map(|at| spread(at % 30) * rng.random_range(-1.0..1.0)).collect();
    let between = |i: usize, j: usize| {
        let pairs = points[30 * i..][..30].iter().zip(&points[30 * j..][..30]);
        pairs.map(|(a, b)| (a - b).abs()).sum()
    };
    let values = (0..sensors * sensors).into_par_iter().map(|at| between(at / sensors, at % sensors));
    Distances { sensors, values: values.collect() }
}

fn main() {
    let large = std::env::args().any(|argument| argument == "--large");
    for (sensors, measurements) in [(840, 31), (8_400, 3)] {
        if sensors > 840 && !large {
            continue;
        }
        let distances = distances(sensors);
        let mut times: Vec<f64> = (0..measurements)
            .map(|_| {
                let start = Instant::now();
                let scaling = ClassicalScaling::new(&distances, DIMS).expect("it converges");
                scaling.coordinates(DIMS).expect("the distances span more");
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        times.sort_by(f64::total_cmp);
        println!("{sensors} sensors to {DIMS} dimensions: {:.1} ms", times[measurements / 2]);
    }
    let distances = distances(840);
    let start = |number| random_map(840, 14, &mut stream(1, 1, "start", number));
    let median = |work: &dyn Fn(usize)| {
        let mut times: Vec<f64> = (0..5)
            .map(|number| {
                let clock = Instant::now();
                work(number);
                clock.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        times.sort_by(f64::total_cmp);
        times[2]
    };
    let metric = median(&|number| drop(descend(&distances, &start(number), 300, 0.0)));
    println!("300 steps of smacof-random, 840 sensors to 14 dimensions: {metric:.1} ms");
    let nonmetric = median(&|number| {
        let mut fit = Majorisation::new(&distances, start(number), Fit::Nonmetric);
        (0..30).for_each(|_| fit.step());
    });
    println!("30 nonmetric steps, 840 sensors to 14 dimensions: {nonmetric:.1} ms");
}
