//! Sizes of every stage's input → its time and memory, with the fitted exponent beside the expected one:
//! `cargo bench --bench scaling`. Writes benches/scaling.csv, .md and .svg.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use bodyschema::agent::Agent;
use bodyschema::body_map::{BodyMap, ClassicalScaling};
use bodyschema::distance::{Distances, information_metric};
use bodyschema::quantise::{Symbols, quantise};
use bodyschema::record::tables::write_rows;
use bodyschema::schema::{Model, infer};
use bodyschema::sense::{Tactile, sense};
use bodyschema::settings::Settings;
use bodyschema::simulate::simulate;
use bodyschema::streams::stream;
use indicatif::ProgressBar;
use plotters::prelude::*;
use rand::RngExt;
use serde::Serialize;

/// Measurements, of which the least is taken: noise of the machine only adds.
const MEASUREMENTS: usize = 3;

/// A stage at one size of one of its inputs.
#[derive(Serialize)]
struct Row {
    stage: &'static str,
    variable: &'static str,
    size: usize,
    seconds: f64,
    /// Memory that the stage needed beyond its input, MiB.
    memory_mib: f64,
}

/// Sizes of a variable, and the exponent of time that theory expects; none where it expects no power.
struct Series {
    stage: &'static str,
    variable: &'static str,
    sizes: &'static [usize],
    expected: Option<f64>,
    run: fn(usize) -> Measured,
}

/// Seconds, and MiB.
type Measured = (f64, f64);

/// Times a stage; `prepare` makes its input, which does not count.
fn measure<T, R>(prepare: impl Fn() -> T, work: impl Fn(&T) -> R) -> Measured {
    let input = prepare();
    let mut best = f64::INFINITY;
    let mut memory = 0.0_f64;
    for _ in 0..MEASUREMENTS {
        // Sets the peak of the process's memory back to what it holds now.
        let _ = std::fs::write("/proc/self/clear_refs", "5");
        let before = status("VmRSS");
        let start = Instant::now();
        drop(work(&input));
        best = best.min(start.elapsed().as_secs_f64());
        memory = memory.max(status("VmHWM") - before);
    }
    (best, memory)
}

/// A size of /proc/self/status, MiB; 0 where there is none.
fn status(name: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(':'));
    let kib: Option<f64> = line.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
    kib.unwrap_or(0.0) / 1024.0
}

fn settings(samples: usize, sensors: usize) -> Settings {
    let mut settings = Settings::paper();
    settings.physics.duration = samples as f64 * settings.sense.interval;
    // Rings of as many sensors as divide the number on a part.
    settings.skin.along = 7;
    settings.skin.around = sensors / 5 / settings.skin.along;
    settings
}

fn simulate_samples(samples: usize) -> Measured {
    measure(
        || settings(samples, 840),
        |settings| {
            let agent = Agent::new(&settings.agent, &settings.skin);
            simulate(&agent, settings, &mut stream(1, 1, "motion", 0), &ProgressBar::hidden())
        },
    )
}

fn sense_size(samples: usize, sensors: usize) -> Measured {
    let settings = settings(samples, sensors);
    let agent = Agent::new(&settings.agent, &settings.skin);
    let rng = &mut stream(1, 1, "motion", 0);
    let trajectory = simulate(&agent, &settings, rng, &ProgressBar::hidden()).expect("a stable body");
    measure(|| (), |()| sense(&agent, &trajectory, &settings.sense))
}

fn quantise_size(samples: usize, sensors: usize) -> Measured {
    let mut rng = stream(1, 1, "pressures", 0);
    let pressure = |_| if rng.random_bool(0.5) { 0.0 } else { rng.random::<f32>().powi(4) };
    let tactile = Tactile { samples, pressures: (0..samples * sensors).map(pressure).collect() };
    measure(|| (), |()| quantise(&tactile, &Settings::paper().quantise))
}

fn distance_size(samples: usize, sensors: usize, levels: usize) -> Measured {
    let mut rng = stream(1, 1, "symbols", 0);
    let values = (0..samples * sensors).map(|_| rng.random_range(0..levels as u8)).collect();
    let symbols = Symbols { samples, levels, values };
    measure(|| (), |()| information_metric(&symbols))
}

/// Distances between points of five clusters in 20 dimensions, and a little more than Euclidean.
fn map_size(sensors: usize) -> Measured {
    let mut rng = stream(1, 1, "points", 0);
    let points: Vec<[f64; 20]> = (0..sensors)
        .map(|i| {
            std::array::from_fn(|k| f64::from(u8::from(k == i * 5 / sensors)) + 0.2 * rng.random::<f64>())
        })
        .collect();
    let mut values = vec![0.0; sensors * sensors];
    for i in 0..sensors {
        for j in 0..i {
            let square: f64 = points[i].iter().zip(&points[j]).map(|(a, b)| (a - b).powi(2)).sum();
            let distance = square.sqrt() + 0.01;
            values[i * sensors + j] = distance;
            values[j * sensors + i] = distance;
        }
    }
    let distances = Distances { sensors, values };
    measure(|| (), |()| ClassicalScaling::new(&distances, 15))
}

/// 200 sweeps of one chain over points of `parts` far clusters.
fn sweeps(points: usize, dims: usize, components: usize, parts: usize) -> Measured {
    chains(points, dims, components, parts, 1)
}

fn chains(points: usize, dims: usize, components: usize, parts: usize, chains: usize) -> Measured {
    let mut rng = stream(1, 1, "clusters", 0);
    let coordinates = (0..points * dims)
        .map(|at| {
            let part = at / dims * parts / points;
            let centre = if at % dims == part % dims { 1.0 + (part / dims) as f64 } else { 0.0 };
            centre + 0.1 * rng.random::<f64>()
        })
        .collect();
    let map = BodyMap { dims, coordinates };
    let mut schema = Settings::paper().schema;
    (schema.components, schema.chains, schema.sweeps) = (components, chains, 200);
    measure(|| (), |()| infer(&map, Model::DpgmmLj, &schema, 1, 1, &ProgressBar::hidden()))
}

const SERIES: &[Series] = &[
    Series {
        stage: "simulate",
        variable: "T",
        sizes: &[6_250, 12_500, 25_000, 50_000, 100_000],
        expected: Some(1.0),
        run: simulate_samples,
    },
    Series {
        stage: "sense",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000],
        expected: Some(1.0),
        run: |t| sense_size(t, 840),
    },
    Series {
        stage: "sense",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        expected: Some(1.0),
        run: |m| sense_size(10_000, m),
    },
    Series {
        stage: "quantise",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000],
        expected: Some(1.0),
        run: |t| quantise_size(t, 840),
    },
    Series {
        stage: "quantise",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        expected: Some(1.0),
        run: |m| quantise_size(10_000, m),
    },
    Series {
        stage: "distance",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000],
        expected: Some(1.0),
        run: |t| distance_size(t, 840, 4),
    },
    Series {
        stage: "distance",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        expected: Some(2.0),
        run: |m| distance_size(10_000, m, 4),
    },
    Series {
        stage: "distance",
        variable: "N - 1",
        sizes: &[1, 3, 5, 7],
        expected: Some(2.0),
        run: |n| distance_size(50_000, 840, n + 1),
    },
    Series {
        stage: "map",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        expected: Some(2.0),
        run: map_size,
    },
    Series {
        stage: "schema",
        variable: "n",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        expected: Some(1.0),
        run: |n| sweeps(n, 14, 10, 5),
    },
    Series {
        stage: "schema",
        variable: "d",
        sizes: &[7, 15, 31, 47],
        expected: Some(2.0),
        run: |d| sweeps(840, d, 10, 5),
    },
    Series {
        stage: "schema",
        variable: "K",
        sizes: &[10, 20, 40, 80],
        expected: Some(1.0),
        run: |k| sweeps(840, 14, k, 5),
    },
    Series {
        stage: "schema",
        variable: "parts",
        sizes: &[2, 4, 8, 16],
        expected: Some(2.0),
        run: |parts| sweeps(840, 14, 20, parts),
    },
    Series {
        stage: "schema",
        variable: "chains",
        sizes: &[2, 4, 8, 16],
        expected: Some(1.0),
        run: |count| chains(840, 14, 10, 5, count),
    },
    Series {
        stage: "schema",
        variable: "threads",
        sizes: &[1, 2],
        expected: Some(-1.0),
        run: |threads| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            pool.install(|| chains(840, 14, 10, 5, 16))
        },
    },
];

/// The exponent of the power of size that fits times best.
fn exponent(rows: &[&Row], value: impl Fn(&Row) -> f64) -> f64 {
    let logs: Vec<(f64, f64)> = rows.iter().map(|row| ((row.size as f64).ln(), value(row).ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + log.0 / n, sum.1 + log.1 / n));
    let over: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
    over / logs.iter().map(|log| (log.0 - x).powi(2)).sum::<f64>()
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches");
    let mut rows = Vec::new();
    let mut table = String::from(
        "| stage | grows with | sizes | seconds | MiB | exponent of time | expected |\n|---|---|---|---|---|---|---|\n",
    );
    for &Series { stage, variable, sizes, expected, run } in SERIES {
        let first = rows.len();
        for &size in sizes {
            let (seconds, memory_mib) = run(size);
            eprintln!("{stage}: {variable} = {size}: {seconds:.4} s, {memory_mib:.1} MiB");
            rows.push(Row { stage, variable, size, seconds, memory_mib });
        }
        let own: Vec<&Row> = rows[first..].iter().collect();
        let list =
            |text: &dyn Fn(&Row) -> String| own.iter().map(|row| text(row)).collect::<Vec<_>>().join(", ");
        table += &format!(
            "| {stage} | {variable} | {} | {} | {} | {:.2} | {} |\n",
            list(&|row| row.size.to_string()),
            list(&|row| format!("{:.3}", row.seconds)),
            list(&|row| format!("{:.0}", row.memory_mib)),
            exponent(&own, |row| row.seconds),
            expected.map_or("none".to_owned(), |expected| expected.to_string()),
        );
    }
    write_rows(&folder.join("scaling.csv"), &rows)?;
    std::fs::write(folder.join("scaling.md"), table)?;
    draw(&folder.join("scaling.svg"), &rows)
}

/// A panel for each series, both axes logarithmic.
fn draw(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let colour = RGBColor(0, 114, 178);
    let area = SVGBackend::new(path, (900, 900)).into_drawing_area();
    area.fill(&WHITE)?;
    for (panel, series) in area.split_evenly((5, 3)).iter().zip(SERIES) {
        let own: Vec<(f64, f64)> = rows
            .iter()
            .filter(|row| (row.stage, row.variable) == (series.stage, series.variable))
            .map(|row| (row.size as f64, row.seconds))
            .collect();
        let ends = |values: &dyn Fn(&(f64, f64)) -> f64| {
            let all = own.iter().map(values);
            (all.clone().fold(f64::INFINITY, f64::min) / 1.5)..(all.fold(0.0, f64::max) * 1.5)
        };
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("{} against {}", series.stage, series.variable), ("sans-serif", 15))
            .margin(6)
            .x_label_area_size(24)
            .y_label_area_size(48)
            .build_cartesian_2d(ends(&|at| at.0).log_scale(), ends(&|at| at.1).log_scale())?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(4)
            .y_labels(4)
            .y_desc("s")
            .y_label_formatter(&|seconds| format!("{seconds:.0e}"))
            .label_style(("sans-serif", 12))
            .draw()?;
        if let (Some(expected), Some(&(x, y))) = (series.expected, own.last()) {
            // The expected power through the largest size.
            let power = own.iter().map(|at| (at.0, y * (at.0 / x).powf(expected)));
            chart.draw_series(LineSeries::new(power, RGBColor(150, 150, 150)))?;
        }
        chart.draw_series(own.iter().map(|&at| Circle::new(at, 4, colour.filled())))?;
    }
    area.present()?;
    Ok(())
}
