//! Measure time and memory of every stage against the size of its input, with the fitted and the expected exponent:
//! `cargo bench --bench scaling`. Writes benches/scaling.csv, .md and .svg.

use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use bodyschema::estimate::estimate;
use bodyschema::files::tables::write_rows;
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::body_map::{BodyMap, ClassicalScaling};
use bodyschema::stages::distance::{Distances, information_metric};
use bodyschema::stages::parameters::Parameters;
use bodyschema::stages::quantise::{Symbols, quantise};
use bodyschema::stages::schema::{Model, infer};
use bodyschema::stages::sense::{Tactile, sense};
use bodyschema::stages::simulate::{Trajectory, simulate};
use plotters::prelude::*;
use rand::RngExt;
use serde::Serialize;

/// Measurements, of which the least is taken: noise of the machine only adds.
const MEASUREMENTS: usize = 3;

/// What takes more seconds than this is measured once.
const LONG: f64 = 5.0;

/// Argument by which this program measures one size only: the number of its series, and the size.
const ONE: &str = "--one";

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

/// Sizes of a variable, and the exponents of time and memory that theory expects; none where it expects no power.
struct Series {
    stage: &'static str,
    variable: &'static str,
    sizes: &'static [usize],
    time: Option<f64>,
    memory: Option<f64>,
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
        if best > LONG {
            break;
        }
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
            {
                let (motion, physics, interval) =
                    (&settings.motion, &settings.physics, settings.sense.interval);
                simulate(&agent, motion, physics, interval, &mut stream(1, 1, "motion", 0), &|| ())
            }
        },
    )
}

/// The paper's agent, and a movement of it.
fn moved(settings: &Settings) -> (Agent, Trajectory) {
    let agent = Agent::new(&settings.agent, &settings.skin);
    let rng = &mut stream(1, 1, "motion", 0);
    let interval = settings.sense.interval;
    let trajectory =
        simulate(&agent, &settings.motion, &settings.physics, interval, rng, &|| ()).expect("a stable body");
    (agent, trajectory)
}

fn sense_size(samples: usize, sensors: usize) -> Measured {
    let settings = settings(samples, sensors);
    let (agent, trajectory) = moved(&settings);
    measure(|| (), |()| sense(&agent, &trajectory, &settings.sense))
}

/// Parts and tree from touch alone; half of the joints are locked at any time.
fn estimate_size(samples: usize, sensors: usize) -> Measured {
    let mut settings = settings(samples, sensors);
    settings.motion.coordination = 0.5;
    let (agent, trajectory) = moved(&settings);
    let tactile = sense(&agent, &trajectory, &settings.sense);
    drop((agent, trajectory));
    let recording = Recording::new(tactile);
    let rng = || stream(1, 1, "co-motion", 0);
    measure(
        || (),
        |()| {
            estimate(&recording, &settings.quantise, &Parameters::default(), &mut rng(), &|| ())
                .expect("enough sensors")
        },
    )
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
    measure(|| (), |()| infer(&map, Model::DpgmmLj, &schema, 1, 1, &|| ()))
}

const SERIES: &[Series] = &[
    Series {
        stage: "simulate",
        variable: "T",
        sizes: &[6_250, 12_500, 25_000, 50_000, 100_000],
        time: Some(1.0),
        memory: Some(1.0),
        run: simulate_samples,
    },
    Series {
        stage: "sense",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000],
        time: Some(1.0),
        memory: Some(1.0),
        run: |t| sense_size(t, 840),
    },
    Series {
        stage: "sense",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(1.0),
        memory: Some(1.0),
        run: |m| sense_size(10_000, m),
    },
    Series {
        stage: "quantise",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000, 1_000_000],
        time: Some(1.0),
        memory: Some(1.0),
        run: |t| quantise_size(t, 840),
    },
    Series {
        stage: "quantise",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(1.0),
        memory: Some(1.0),
        run: |m| quantise_size(10_000, m),
    },
    Series {
        stage: "distance",
        variable: "T",
        sizes: &[12_500, 25_000, 50_000, 100_000, 1_000_000],
        time: Some(1.0),
        memory: Some(1.0),
        run: |t| distance_size(t, 840, 4),
    },
    Series {
        stage: "distance",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(2.0),
        memory: None,
        run: |m| distance_size(10_000, m, 4),
    },
    Series {
        stage: "distance",
        variable: "N - 1",
        sizes: &[1, 3, 5, 7],
        time: Some(2.0),
        memory: Some(1.0),
        run: |n| distance_size(50_000, 840, n + 1),
    },
    Series {
        stage: "map",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(2.0),
        memory: Some(2.0),
        run: map_size,
    },
    Series {
        stage: "schema",
        variable: "n",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(1.0),
        memory: None,
        run: |n| sweeps(n, 14, 10, 5),
    },
    Series {
        stage: "schema",
        variable: "d",
        sizes: &[7, 15, 31, 47],
        time: Some(2.0),
        memory: None,
        run: |d| sweeps(840, d, 10, 5),
    },
    Series {
        stage: "schema",
        variable: "K",
        sizes: &[10, 20, 40, 80],
        time: Some(1.0),
        memory: None,
        run: |k| sweeps(840, 14, k, 5),
    },
    Series {
        stage: "schema",
        variable: "parts",
        sizes: &[2, 4, 8, 16],
        time: Some(2.0),
        memory: None,
        run: |parts| sweeps(840, 14, 20, parts),
    },
    Series {
        stage: "schema",
        variable: "chains",
        sizes: &[2, 4, 8, 16],
        time: Some(1.0),
        memory: None,
        run: |count| chains(840, 14, 10, 5, count),
    },
    Series {
        stage: "schema",
        variable: "threads",
        sizes: &[1, 2],
        time: Some(-1.0),
        memory: None,
        run: |threads| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            pool.install(|| chains(840, 14, 10, 5, 16))
        },
    },
    Series {
        stage: "estimate",
        variable: "T",
        sizes: &[1_000, 10_000, 100_000, 1_000_000],
        time: Some(1.0),
        memory: None,
        run: |t| estimate_size(t, 840),
    },
    Series {
        stage: "estimate",
        variable: "M",
        sizes: &[420, 840, 2_100, 4_200, 8_400],
        time: Some(1.0),
        memory: None,
        run: |m| estimate_size(10_000, m),
    },
];

/// The exponent of the power of size that fits values best; none where one is nothing.
fn exponent(rows: &[&Row], value: impl Fn(&Row) -> f64) -> Option<f64> {
    if rows.iter().any(|row| value(row) <= 0.0) {
        return None;
    }
    let logs: Vec<(f64, f64)> = rows.iter().map(|row| ((row.size as f64).ln(), value(row).ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + log.0 / n, sum.1 + log.1 / n));
    let over: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
    Some(over / logs.iter().map(|log| (log.0 - x).powi(2)).sum::<f64>())
}

/// Measures one size in a process of its own, whose memory holds nothing of other sizes.
fn in_own_process(series: usize, size: usize) -> Result<Measured, Box<dyn Error>> {
    let arguments = [ONE.to_owned(), series.to_string(), size.to_string()];
    let output = Command::new(std::env::current_exe()?).args(arguments).output()?;
    let text = String::from_utf8(output.stdout)?;
    let (seconds, memory) = text.trim().split_once(' ').ok_or("the measurement failed")?;
    Ok((seconds.parse()?, memory.parse()?))
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, one, series, size] = &arguments[..]
        && one == ONE
    {
        let (seconds, memory) = (SERIES[series.parse::<usize>()?].run)(size.parse()?);
        println!("{seconds} {memory}");
        return Ok(());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches");
    let mut rows = Vec::new();
    let mut table = String::from(
        "| stage | grows with | sizes | seconds | exponent | expected | MiB | exponent | expected |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for (at, &Series { stage, variable, sizes, time, memory, .. }) in SERIES.iter().enumerate() {
        let first = rows.len();
        for &size in sizes {
            let (seconds, memory_mib) = in_own_process(at, size)?;
            eprintln!("{stage}: {variable} = {size}: {seconds:.4} s, {memory_mib:.1} MiB");
            rows.push(Row { stage, variable, size, seconds, memory_mib });
        }
        let own: Vec<&Row> = rows[first..].iter().collect();
        let list =
            |text: &dyn Fn(&Row) -> String| own.iter().map(|row| text(row)).collect::<Vec<_>>().join(", ");
        let or_none =
            |exponent: Option<f64>| exponent.map_or("none".to_owned(), |power| format!("{power:.2}"));
        table += &format!(
            "| {stage} | {variable} | {} | {} | {} | {} | {} | {} | {} |\n",
            list(&|row| row.size.to_string()),
            list(&|row| format!("{:.3}", row.seconds)),
            or_none(exponent(&own, |row| row.seconds)),
            or_none(time),
            list(&|row| format!("{:.0}", row.memory_mib)),
            // Below a few MiB, what is measured is the allocator's habits.
            or_none(exponent(&own, |row| if row.memory_mib < 4.0 { 0.0 } else { row.memory_mib })),
            or_none(memory),
        );
    }
    write_rows(&folder.join("scaling.csv"), &rows)?;
    std::fs::write(folder.join("scaling.md"), table)?;
    render(&folder.join("scaling.svg"), &rows)
}

/// A panel for each series, all axes logarithmic: time on the left, memory on the right.
fn render(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let (time, memory, power) = (RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(150, 150, 150));
    let area = SVGBackend::new(path, (1080, 1200)).into_drawing_area();
    area.fill(&WHITE)?;
    let title = "filled, left: time, s; open, right: memory, MiB; grey: the expected power of time";
    let area = area.titled(title, ("sans-serif", 15))?;
    for (panel, series) in area.split_evenly((6, 3)).iter().zip(SERIES) {
        let own: Vec<&Row> =
            rows.iter().filter(|row| (row.stage, row.variable) == (series.stage, series.variable)).collect();
        let points = |value: &dyn Fn(&Row) -> f64| -> Vec<(f64, f64)> {
            own.iter().map(|row| (row.size as f64, value(row))).filter(|at| at.1 > 0.0).collect()
        };
        let (times, memories) = (points(&|row| row.seconds), points(&|row| row.memory_mib));
        let ends = |values: &[(f64, f64)], value: &dyn Fn(&(f64, f64)) -> f64| {
            let low = values.iter().map(value).fold(f64::INFINITY, f64::min);
            let high = values.iter().map(value).fold(0.0, f64::max);
            if high > 0.0 { (low / 1.5)..(high * 1.5) } else { 0.1..10.0 }
        };
        let sizes = ends(&times, &|at| at.0);
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("{} against {}", series.stage, series.variable), ("sans-serif", 15))
            .margin(6)
            .x_label_area_size(24)
            .y_label_area_size(44)
            .right_y_label_area_size(44)
            .build_cartesian_2d(sizes.clone().log_scale(), ends(&times, &|at| at.1).log_scale())?
            .set_secondary_coord(sizes.log_scale(), ends(&memories, &|at| at.1).log_scale());
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(4)
            .y_labels(4)
            .x_label_formatter(&|size| size.to_string())
            .y_label_formatter(&|seconds| format!("{seconds:.0e}"))
            .label_style(("sans-serif", 12))
            .draw()?;
        chart
            .configure_secondary_axes()
            .y_labels(4)
            .y_label_formatter(&|mib| format!("{mib:.0e}"))
            .label_style(("sans-serif", 12))
            .draw()?;
        if let (Some(expected), Some(&(x, y))) = (series.time, times.last()) {
            // The expected power through the largest size.
            let line = times.iter().map(|at| (at.0, y * (at.0 / x).powf(expected)));
            chart.draw_series(LineSeries::new(line, power))?;
        }
        chart.draw_series(times.iter().map(|&at| Circle::new(at, 4, time.filled())))?;
        chart.draw_secondary_series(memories.iter().map(|&at| Circle::new(at, 4, memory)))?;
    }
    area.present()?;
    Ok(())
}
