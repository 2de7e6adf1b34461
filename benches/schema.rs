//! Measure the time of one Gibbs sweep on a synthetic body map, in ms on one thread: `cargo bench --bench schema`.

#[allow(dead_code, reason = "the truth is of no use here")]
#[path = "../tests/support/synthetic.rs"]
mod synthetic;

use std::time::Instant;

use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::mixture::Points;
use bodyschema::stages::schema::{Chain, Model, Sampler, Schema, prior};

/// Sweeps before the clock starts.
const BURN_IN: usize = 200;
/// Sweeps of one measurement.
const SWEEPS: usize = 200;
/// Measurements, of which the median is printed.
const MEASUREMENTS: usize = 31;

fn main() {
    let body = synthetic::body(14, 1.0, &mut stream(1, 1, "synthetic", 0));
    let points = Points::new(&body.map);
    for (name, sampler) in [("", Sampler::Equations), (", authors-code", Sampler::AuthorsCode)] {
        let settings = Schema { sampler, ..Settings::paper().schema };
        let prior = prior(&points, &settings).expect("the body spans its space");
        for model in Model::ALL {
            let mut rng = stream(1, 1, "bench", 0);
            let mut chain = Chain::start(&points, &prior, &settings, model, &mut rng).unwrap();
            (0..BURN_IN).for_each(|_| chain.sweep(&mut rng).unwrap());
            let mut times: Vec<f64> = (0..MEASUREMENTS)
                .map(|_| {
                    let start = Instant::now();
                    (0..SWEEPS).for_each(|_| chain.sweep(&mut rng).unwrap());
                    start.elapsed().as_secs_f64() * 1e3 / SWEEPS as f64
                })
                .collect();
            times.sort_by(f64::total_cmp);
            println!(
                "{}{name}: {:.4} ms per sweep (n = {}, d = {}, {} of {} components active)",
                model.name(),
                times[MEASUREMENTS / 2],
                points.count,
                points.dims,
                chain.active().len(),
                settings.components
            );
        }
    }
}
