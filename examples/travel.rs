//! Measure how far bodies travel by rhythmic and by random movement, as a table: `cargo run --release --example travel`, from the
//! folder of the repository. Arguments are body files; without any, all of the folder bodies.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use bodyschema::files::body::read_body;
use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::simulate::{Movement, Pose, Resolution, Trajectory, simulate};
use rayon::prelude::*;

/// Simulated time, s.
const DURATION: f64 = 1000.0;
/// Movements of each kind, of which the mean is shown.
const SEEDS: u64 = 4;
/// Movements by kind and p.
const WAYS: [(Movement, f64); 4] =
    [(Movement::Random, 0.9), (Movement::Random, 0.0), (Movement::Rhythmic, 0.5), (Movement::Rhythmic, 0.0)];

type Found<T> = Result<T, Box<dyn Error + Send + Sync>>;

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The largest distance of two sensors in the rest pose, m.
fn length(agent: &Agent, rest: &[Pose]) -> f64 {
    let places: Vec<_> = agent.sites.iter().map(|site| rest[site.part].place(site.position)).collect();
    let from = |a: &[f64; 3]| places.iter().map(|b| distance(*a, *b)).fold(0.0, f64::max);
    places.iter().map(from).fold(0.0, f64::max)
}

/// The mean of the centres of all parts, m.
fn centre(poses: &[Pose]) -> [f64; 3] {
    [0, 1, 2].map(|i| poses.iter().map(|pose| pose.position[i]).sum::<f64>() / poses.len() as f64)
}

/// How far a movement ends from where it began, in body lengths.
fn travelled(agent: &Agent, Trajectory { parts, poses, .. }: &Trajectory) -> f64 {
    let (rest, end) = (&poses[..*parts], &poses[poses.len() - parts..]);
    distance(centre(rest), centre(end)) / length(agent, rest)
}

/// The row of a body.
fn row(path: &Path, swimming: &Settings) -> Found<String> {
    let agent = read_body(path)?.agent;
    let (mut cells, mut worst) = (Vec::new(), Resolution::default());
    for (movement, coordination) in WAYS {
        let Settings { mut motion, mut physics, sense, .. } = swimming.clone();
        (motion.movement, motion.coordination, physics.duration) = (movement, coordination, DURATION);
        let mut sum = 0.0;
        for seed in 1..=SEEDS {
            let rng = &mut stream(seed, 1, "motion", 0);
            let trajectory = simulate(&agent, &motion, &physics, sense.interval, rng, &|| ())?;
            sum += travelled(&agent, &trajectory);
            if movement == Movement::Rhythmic {
                worst = worst.worse(trajectory.resolution);
            }
        }
        cells.push(format!("{:.1}", sum / SEEDS as f64));
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    cells.extend([format!("{:.2}", 1e3 * worst.anchor_separation), format!("{:.4}", worst.turn)]);
    Ok(format!("| `{name}` | {} |", cells.join(" | ")))
}

fn main() -> Found<()> {
    let swimming = Settings::load(false, Some(Path::new("reproduce/rhythmic.toml")))?;
    let mut paths: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if paths.is_empty() {
        paths = fs::read_dir("bodies")?.map(|entry| Ok(entry?.path())).collect::<Found<_>>()?;
        paths.sort();
    }
    let rows: Vec<String> = paths.par_iter().map(|path| row(path, &swimming)).collect::<Found<_>>()?;
    let way = |(movement, p): (Movement, f64)| {
        format!("{}, p = {p}", if movement == Movement::Random { "random" } else { "rhythmic" })
    };
    println!("| body | {} | anchors, mm | turns |", WAYS.map(way).join(" | "));
    println!("|{}", "---|".repeat(3 + WAYS.len()));
    rows.iter().for_each(|row| println!("{row}"));
    Ok(())
}
