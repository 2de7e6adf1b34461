//! Chains of both samplers on the same maps, with the same prior: what they are at after so many seconds.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use bodyschema::files::tables::write_rows;
use bodyschema::internals::log_sum;
use bodyschema::internals::markdown::{row, rule};
use bodyschema::numerics::rng::stream;
use bodyschema::pipeline::{map_sensed, simulate_and_sense};
use bodyschema::stages::body_map::{BodyMap, MapOf};
use bodyschema::stages::evaluate::{adjusted_rand_index, parts};
use bodyschema::stages::mixture::{Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics};
use bodyschema::stages::schema::{EdgeWeight, Keep, Model, Sampler, Schema, infer, prior};
use rayon::prelude::*;
use serde::Deserialize;

use super::edges::graph;
use super::picture::{self, Line, Panel};
use super::{no_fluid, split_merge, synthetic};

/// Of the chains, the drawn body and the moving one; nothing else has it.
const SEED: u64 = 7_500_000;
const CHAINS: usize = 12;
/// A state of this adjusted Rand index with the likeliest one counts as at it: single sensors move.
const AT_BEST: f64 = 0.95;

/// A sampler, and the sweeps after which its chains are looked at.
const SAMPLERS: [(Sampler, &str, &[usize]); 2] = [
    (Sampler::Equations, "equations", &[1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000]),
    (Sampler::SplitMerge, "split-merge", &[1, 2, 5, 10, 20, 50, 100, 200, 400]),
];

/// A map of tests/reference/authors.json.
#[derive(Deserialize)]
struct Reference {
    points: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct References {
    chains: Vec<Reference>,
}

/// A chain after some sweeps.
#[derive(serde::Serialize)]
struct State {
    map: &'static str,
    sampler: &'static str,
    chain: usize,
    sweep: usize,
    parts: usize,
    log_posterior: f64,
    at_best: bool,
    #[serde(skip)]
    labels: Vec<usize>,
}

/// Seconds of one core for a sweep.
#[derive(serde::Serialize)]
struct Timing {
    map: &'static str,
    sampler: &'static str,
    seconds: f64,
}

/// Runs the study, writes its tables and its picture, and returns its section of the page.
pub(crate) fn study(folder: &Path) -> Result<String, Box<dyn Error>> {
    let (mut states, mut timings) = (Vec::new(), Vec::new());
    for (name, map) in maps()? {
        let own = chains(name, &map)?;
        states.extend(own);
        for (sampler, label, _) in SAMPLERS {
            timings.push(Timing { map: name, sampler: label, seconds: seconds(&map, sampler)? });
        }
        eprintln!("mixing: chains on “{name}” done");
    }
    write_rows(&folder.join("traces.csv"), &states)?;
    write_rows(&folder.join("traces-seconds.csv"), &timings)?;
    let names: Vec<&str> = timings.chunk_by(|a, b| a.map == b.map).map(|own| own[0].map).collect();
    let rows = [parts_panel, log_posterior_panel, share_panel]
        .map(|panel| names.iter().map(|name| panel(name, &states, &timings)).collect());
    picture::traces(&folder.join("figures/traces.svg"), &rows)?;
    Ok(page(&names, &states, &timings))
}

/// The maps: those of the tests of the authors' code, a synthetic body of separation 2, and a body that moves.
fn maps() -> Result<Vec<(&'static str, BodyMap)>, Box<dyn Error>> {
    let references: References = serde_json::from_str(include_str!("../../tests/reference/authors.json"))?;
    let names = ["reference map 1", "reference map 2", "reference map 3"];
    let mut maps: Vec<(&str, BodyMap)> = names
        .into_iter()
        .zip(references.chains)
        .map(|(name, reference)| {
            let dims = reference.points[0].len();
            (name, BodyMap { dims, coordinates: reference.points.concat() })
        })
        .collect();
    maps.push(("synthetic, d = 5", synthetic::body(5, 2.0, &mut stream(SEED, 1, "synthetic", 0)).map));
    let mut settings = no_fluid();
    (settings.experiment.seed, settings.map.of) = (SEED, MapOf::Distances);
    let body = map_sensed(&simulate_and_sense(&settings, 1, &|| ())?, &settings, 1, &[9])?.body;
    maps.push(("body that moves, d = 9", body.maps.ok_or("a body that moves has a map")?.in_dims(9)));
    Ok(maps)
}

/// The settings of both samplers: one prior, and chains that start apart.
fn schema(sampler: Sampler, sweeps: usize) -> Schema {
    let edge_weight = EdgeWeight::Collapsed;
    Schema { sampler, edge_weight, sweeps, chains: CHAINS, keep: Keep::Last, ..split_merge() }
}

/// The states of the chains of both samplers on a map.
fn chains(name: &'static str, map: &BodyMap) -> Result<Vec<State>, Box<dyn Error>> {
    let points = Points::new(map);
    let prior = prior(&points, &split_merge())?;
    let mut states = Vec::new();
    for (sampler, label, sweeps) in SAMPLERS {
        // A chain has one stream: run again for longer, it passes through the same states.
        for &sweep in sweeps {
            let draws = infer(map, Model::DpgmmLj, &schema(sampler, sweep), SEED, 1, &|| ())?;
            states.extend(draws.into_iter().map(|draw| State {
                map: name,
                sampler: label,
                chain: draw.chain,
                sweep,
                parts: parts(&draw.labels),
                log_posterior: f64::NAN,
                at_best: false,
                labels: draw.labels,
            }));
        }
    }
    let compute = |state: &mut State| {
        state.log_posterior = log_posterior(&points, &prior, &state.labels)?;
        Ok(())
    };
    states.par_iter_mut().try_for_each(compute).map_err(|error: Rounding| error.to_string())?;
    let best =
        states.iter().max_by(|a, b| a.log_posterior.total_cmp(&b.log_posterior)).ok_or("there are chains")?;
    let (labels, count) = (best.labels.clone(), best.parts);
    for state in &mut states {
        state.at_best = state.parts == count && adjusted_rand_index(&state.labels, &labels) >= AT_BEST;
    }
    Ok(states)
}

/// log p(x, z) of the target of docs/method.md, up to a constant, for the labels of either sampler. The factor of the
/// joints, M(μ, Σ), is averaged over draws of the Gaussians.
fn log_posterior(points: &Points, prior: &NormalInverseWishart, labels: &[usize]) -> Result<f64, Rounding> {
    const DRAWS: usize = 100;
    let mut rng = stream(SEED, 1, "joints", 0);
    let concentration = split_merge().concentration;
    let size = labels.iter().max().map_or(0, |largest| largest + 1);
    let clusters = (0..size).map(|k| (0..labels.len()).filter(|&i| labels[i] == k).collect::<Vec<_>>());
    let statistics: Vec<SufficientStatistics> = clusters
        .filter(|members| !members.is_empty())
        .map(|members| SufficientStatistics::of(points, &members))
        .collect();
    let own = |statistics: &SufficientStatistics| {
        Ok(concentration.ln() + libm::lgamma(statistics.count()) + prior.log_marginal(statistics)?)
    };
    let mixture: f64 = statistics.iter().map(own).sum::<Result<f64, Rounding>>()?;
    let posteriors: Vec<NormalInverseWishart> =
        statistics.iter().map(|statistics| prior.posterior(statistics)).collect::<Result<_, Rounding>>()?;
    let count = posteriors.len() as f64;
    if count < 2.0 {
        return Ok(mixture);
    }
    let mut joints = || {
        let gaussians: Vec<Gaussian> = posteriors.iter().map(|posterior| posterior.draw(&mut rng)).collect();
        Ok(graph(&gaussians)?.log_sum() - (count - 2.0) * count.ln())
    };
    let joints: Vec<f64> = (0..DRAWS).map(|_| joints()).collect::<Result<_, Rounding>>()?;
    Ok(mixture + log_sum(joints.iter().copied()) - (DRAWS as f64).ln())
}

/// Seconds for a sweep, by one chain alone from one part on, set-up included.
fn seconds(map: &BodyMap, sampler: Sampler) -> Result<f64, Box<dyn Error>> {
    let sweeps = 200;
    let settings = Schema { chains: 1, ..schema(sampler, sweeps) };
    let before = Instant::now();
    infer(map, Model::DpgmmLj, &settings, SEED, 1, &|| ())?;
    Ok(before.elapsed().as_secs_f64() / sweeps as f64)
}

/// The colour of each sampler.
fn colour(sampler: &str) -> plotters::style::RGBColor {
    if sampler == "equations" { picture::ORANGE } else { picture::BLUE }
}

fn seconds_of(timings: &[Timing], map: &str, sampler: &str) -> f64 {
    let own = timings.iter().find(|timing| timing.map == map && timing.sampler == sampler);
    own.map_or(f64::NAN, |timing| timing.seconds)
}

/// A panel with a thin line for each chain.
fn chain_lines(map: &str, states: &[State], timings: &[Timing], value: impl Fn(&State) -> f64) -> Vec<Line> {
    let mut lines = Vec::new();
    for (_, sampler, sweeps) in SAMPLERS {
        let own: Vec<&State> =
            states.iter().filter(|state| state.map == map && state.sampler == sampler).collect();
        let second = seconds_of(timings, map, sampler);
        let at = |states: &[&State]| -> Vec<(f64, f64)> {
            states.iter().map(|state| (state.sweep as f64 * second, value(state))).collect()
        };
        for chain in 0..CHAINS {
            let own: Vec<&State> = own.iter().copied().filter(|state| state.chain == chain).collect();
            lines.push(Line { colour: colour(sampler), name: sampler, bold: false, points: at(&own) });
        }
        let mean = |&sweep: &usize| {
            let own: Vec<f64> =
                own.iter().filter(|state| state.sweep == sweep).map(|state| value(state)).collect();
            (sweep as f64 * second, own.iter().sum::<f64>() / own.len() as f64)
        };
        let points = sweeps.iter().map(mean).collect();
        lines.push(Line { colour: colour(sampler), name: sampler, bold: true, points });
    }
    lines
}

fn parts_panel(map: &&str, states: &[State], timings: &[Timing]) -> Panel {
    Panel {
        title: (*map).to_owned(),
        axis: "number of parts",
        lines: chain_lines(map, states, timings, |state| state.parts as f64),
    }
}

fn log_posterior_panel(map: &&str, states: &[State], timings: &[Timing]) -> Panel {
    let own = states.iter().filter(|state| state.map == *map);
    let best = own.map(|state| state.log_posterior).fold(f64::NEG_INFINITY, f64::max);
    // Far below the best all is the same.
    let below = |state: &State| -(1.0 + best - state.log_posterior).log10();
    Panel {
        title: String::new(),
        axis: "−log10(1 + best log p − log p)",
        lines: chain_lines(map, states, timings, below),
    }
}

fn share_panel(map: &&str, states: &[State], timings: &[Timing]) -> Panel {
    let mut lines = chain_lines(map, states, timings, |state| f64::from(u8::from(state.at_best)));
    lines.retain(|line| line.bold);
    Panel { title: String::new(), axis: "share of chains at the best", lines }
}

fn page(maps: &[&str], states: &[State], timings: &[Timing]) -> String {
    let mut lines = vec![
        "## Both samplers on the same maps\n".to_owned(),
        format!(
            "{CHAINS} chains of each, with the same prior, from the same starts (one part, k-means, labels at random; seed \
             {SEED}). The best is the partition of highest log p(x, z), joints and trees included, that any chain of either \
             sampler had. A chain is at it with an adjusted Rand index from {AT_BEST} and as many parts. Thin lines are \
             chains, thick ones their means. That score is the target of the split-merge sampler. The sampler of the equations \
             has ten components, and its tree is the most probable one. A chain that mixes need not be at the best. \
             [All states](traces.csv), [seconds](traces-seconds.csv).\n"
        ),
        "![Number of parts, log posterior, and share of chains at the best, over seconds](figures/traces.svg)\n".to_owned(),
        row(["map", "sampler", "ms a sweep", "sweeps", "seconds", "chains at the best"]),
        rule(6),
    ];
    for map in maps {
        for (_, sampler, sweeps) in SAMPLERS {
            let (last, second) = (sweeps[sweeps.len() - 1], seconds_of(timings, map, sampler));
            let own = states
                .iter()
                .filter(|state| state.map == *map && state.sampler == sampler && state.sweep == last);
            let at_best = own.filter(|state| state.at_best).count();
            lines.push(row([
                (*map).to_owned(),
                sampler.to_owned(),
                format!("{:.2}", 1e3 * second),
                last.to_string(),
                format!("{:.2}", last as f64 * second),
                format!("{at_best} of {CHAINS}"),
            ]));
        }
    }
    lines.join("\n") + "\n"
}
