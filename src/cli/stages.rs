//! The subcommands of the stages after simulate: distance, map, infer.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Args;

use super::options::{SettingsAndSeed, SettingsFile, TruthFiles, choice, paper, set, with_default};
use super::output::say;
use super::posterior;
use crate::analysis::consensus::named_after;
use crate::analysis::posterior::Posterior;
use crate::analysis::statistics::{Estimate, mean, rate};
use crate::files::{npy, prepare_folder, tables};
use crate::pipeline::map_stream;
use crate::settings::{Base, Settings};
use crate::stages::body_map::{BodyMap, BodyMaps, ClassicalScaling, Improvement, MapMethod, MapOf, scaled};
use crate::stages::distance::information_metric;
use crate::stages::evaluate::{Score, parts, score};
use crate::stages::quantise::{Scheme, quantise};
use crate::stages::schema::{EdgeWeight, Keep, Model, Sample, Sampler, Start, best, infer};
use crate::tasks::progress::progress;

/// Stages 3 and 4: quantises pressures into symbols, and computes the information metric between sensors.
///
/// Reads pressures (float32, float64 or integers, T x M, Pa, not negative) and writes the distances
/// H(X|Y) + H(Y|X) between all pairs of sensors (float64, M x M, bits).
#[derive(Args)]
pub(super) struct Distance {
    /// Pressures, or symbols with --symbols: a .npy file with a row for each sample and a column for each sensor
    tactile: PathBuf,
    #[arg(long, value_parser = choice::<Scheme>(),
          help = with_default("Quantisation of pressures into levels", paper().quantise.scheme))]
    scheme: Option<Scheme>,
    #[arg(long, value_name = "N", conflicts_with = "symbols",
          help = with_default("Number of levels, 2 to 256, including level 0 for no pressure", paper().quantise.levels))]
    levels: Option<usize>,
    /// The file holds symbols, not pressures: whole numbers from 0 to 255
    #[arg(long, conflicts_with = "scheme")]
    symbols: bool,
    #[command(flatten)]
    file: SettingsFile,
    /// File for the distances (.npy)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

impl Distance {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let (input, out) = (&self.tactile, &self.out);
        let mut settings = self.file.load(false)?;
        set(&mut settings.quantise.scheme, self.scheme);
        set(&mut settings.quantise.levels, self.levels);
        settings.validate()?;
        let symbols = if self.symbols {
            npy::read_symbols(input)?
        } else {
            quantise(&npy::read_tactile(input)?, &settings.quantise)
        };
        let constant = symbols.constant_sensors();
        if !constant.is_empty() {
            eprintln!(
                "bodyschema: {}: {} of {} sensors never change, so their distances carry no information (the first is sensor {})",
                input.display(),
                constant.len(),
                symbols.sensors(),
                constant[0]
            );
        }
        npy::write_distances(out, &information_metric(&symbols))?;
        say(format!(
            "information metric of {} sensors over {} samples of {} levels, in {}",
            symbols.sensors(),
            symbols.samples,
            symbols.levels,
            out.display()
        ))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Stage 5: embeds the sensors in D dimensions by multidimensional scaling.
///
/// Reads distances (M x M) and writes coordinates (float64, M x D, in the unit of the distances; columns of a classical
/// map by descending eigenvalue). For smacof and nonmetric, which start from the classical map, and for smacof-random,
/// which starts from random ones, it prints Kruskal's stress-1.
#[derive(Args)]
pub(super) struct Map {
    /// Distances: a .npy file, M x M, symmetric
    distance: PathBuf,
    /// Number of dimensions
    #[arg(long, value_name = "D")]
    dims: usize,
    #[arg(long, value_parser = choice::<MapMethod>(),
          help = with_default("Variant of multidimensional scaling", paper().map.method))]
    method: Option<MapMethod>,
    #[arg(long, value_parser = choice::<MapOf>(), help = with_default("Distances that are scaled", paper().map.of))]
    of: Option<MapOf>,
    #[arg(long, value_name = "N", help = with_default("Number of random starts of smacof-random", paper().map.starts))]
    starts: Option<usize>,
    #[command(flatten)]
    common: SettingsAndSeed,
    /// File for the body map (.npy)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

impl Map {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let (input, out, dims) = (&self.distance, &self.out, self.dims);
        let mut settings = self.common.load(false)?;
        set(&mut settings.map.method, self.method);
        set(&mut settings.map.of, self.of);
        set(&mut settings.map.starts, self.starts);
        settings.validate()?;
        ensure!(dims >= 1, "--dims is 0, but must be at least 1");
        let distances = npy::read_distances(input)?;
        let distances = scaled(&distances, settings.map.of);
        let in_file = || input.display().to_string();
        let scaling = ClassicalScaling::new(&distances, dims).with_context(in_file)?;
        let random = |d: usize, start: usize| map_stream(settings.experiment.seed, 1, d, start);
        let (maps, improvements) =
            BodyMaps::new(&distances, &scaling, &settings.map, &[dims], &random).with_context(in_file)?;
        let map = maps.in_dims(dims);
        npy::write_body_map(out, &map)?;
        let fit = match improvements.first() {
            None => format!(
                "its eigenvalues make up {:.2} % of the sum of all squared eigenvalues",
                100.0 * scaling.agreement(dims)
            ),
            Some(Improvement { start, stress, steps, .. }) => {
                let from = match settings.map.method {
                    MapMethod::SmacofRandom => format!("the best of {} random maps", settings.map.starts),
                    _ => "the classical map".to_owned(),
                };
                format!(
                    "its stress-1 is {stress:.4} after {steps} iterations ({start:.4} for the start, {from})"
                )
            }
        };
        say(format!(
            "body map of {} sensors in {dims} dimensions, in {}; {fit}",
            map.points(),
            out.display()
        ))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Stages 6 and 7: samples body schemas from the posterior and, if the truth is given, evaluates them.
///
/// Reads coordinates (M x D) and writes into DIR: assignments.npy (int32, posterior samples x M, component of each sensor),
/// samples.csv (a row for each posterior sample: chain,parts,log_posterior, and, if the truth is given,
/// ari,eligible,tree_correct) and trees.csv (chain,child,parent and, for dpgmm-lj, the position of the joint
/// on the body map, x1 ... xD). With --keep all, a column `sweep` follows the chain.
///
/// With --sampler split-merge, components are numbered like the parts of the consensus of all posterior samples that they
/// match, and there are also posterior.csv (parts,probability), parts.csv (sensor,part,probability: the consensus), edges.csv
/// (part,other,probability,in_tree: which parts are joined) and diagnostics.csv (quantity,r_hat,ess: convergence of the
/// chains).
#[derive(Args)]
pub(super) struct Infer {
    /// Body map: a .npy file, M x D
    body_map: PathBuf,
    /// Mixture model
    #[arg(long, value_parser = choice::<Model>(), default_value = "dpgmm-lj")]
    model: Model,
    #[arg(long, value_parser = choice::<Sampler>(), help = with_default("Sampler, and thereby the interpretation of the paper", paper().schema.sampler))]
    sampler: Option<Sampler>,
    #[arg(long, value_name = "K", help = with_default("Number of components of the weak-limit approximation", paper().schema.components))]
    components: Option<usize>,
    #[arg(long, value_name = "N", help = with_default("Number of independent chains", paper().schema.chains))]
    chains: Option<usize>,
    #[arg(long, value_name = "N", help = with_default("Gibbs sweeps of each chain", paper().schema.sweeps))]
    sweeps: Option<usize>,
    #[arg(long, value_parser = choice::<EdgeWeight>(),
          help = with_default("Edge weight of the minimum spanning tree", paper().schema.edge_weight))]
    edge_weight: Option<EdgeWeight>,
    #[arg(long, value_parser = choice::<Start>(),
          help = with_default("Initial components of the sensors of a chain", paper().schema.start))]
    start: Option<Start>,
    #[arg(long, value_parser = choice::<Keep>(),
          help = with_default("Samples of each chain that are kept", paper().schema.keep))]
    keep: Option<Keep>,
    #[arg(long, value_name = "N", help = with_default("Sweeps of each chain that are discarded as burn-in with --keep all", paper().schema.burn_in))]
    burn_in: Option<usize>,
    #[command(flatten)]
    common: SettingsAndSeed,
    #[command(flatten)]
    truth: TruthFiles,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Infer {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let settings = self.settings()?;
        let Settings { schema, evaluate, experiment, .. } = &settings;
        let (input, out) = (&self.body_map, &self.out);
        let map = npy::read_body_map(input)?;
        prepare_folder(out)?;
        let truth = self.truth.read(map.points())?;
        let bar = progress(schema.chains as u64, "infer".to_owned());
        let mut samples = infer(&map, self.model, schema, experiment.seed, 1, &|| bar.inc(1))
            .with_context(|| input.display().to_string())?;
        bar.finish_and_clear();
        let posterior = (schema.sampler == Sampler::SplitMerge)
            .then(|| Posterior::of(&map, self.model, &samples, schema, experiment.seed, 1))
            .transpose()?;
        if let Some(posterior) = &posterior {
            samples.iter_mut().for_each(|sample| named_after(&posterior.consensus.labels, sample));
        }
        let scores: Option<Vec<Score>> = truth.as_ref().map(|truth| {
            samples
                .iter()
                .map(|sample| score(&sample.labels, &sample.tree, truth, evaluate.eligible_ari))
                .collect()
        });
        npy::write_assignments(&out.join("assignments.npy"), &samples)?;
        tables::write_samples(&out.join("samples.csv"), &samples, schema.keep, scores.as_deref())?;
        tables::write_trees(&out.join("trees.csv"), &samples, schema.keep)?;
        print_run(self.model, &map, samples.len(), &settings, out)?;
        if let Some(posterior) = &posterior {
            posterior::write(out, posterior)?;
            posterior::print(posterior, truth.as_ref(), evaluate.eligible_ari)?;
        } else {
            print_samples(&samples, scores.as_deref())?;
        }
        Ok(ExitCode::SUCCESS)
    }

    fn settings(&self) -> Result<Settings> {
        let mut settings = self.common.load(false)?;
        if self.sampler.unwrap_or(settings.schema.sampler) == Sampler::SplitMerge {
            settings = self.common.load_over(Base::SPLIT_MERGE)?;
        }
        let schema = &mut settings.schema;
        set(&mut schema.sampler, self.sampler);
        set(&mut schema.components, self.components);
        set(&mut schema.chains, self.chains);
        set(&mut schema.sweeps, self.sweeps);
        set(&mut schema.edge_weight, self.edge_weight);
        set(&mut schema.start, self.start);
        set(&mut schema.keep, self.keep);
        set(&mut schema.burn_in, self.burn_in);
        settings.validate()?;
        Ok(settings)
    }
}

fn print_run(model: Model, map: &BodyMap, samples: usize, settings: &Settings, out: &Path) -> Result<()> {
    say(format!(
        "{} of {} sensors in {} dimensions: {samples} posterior samples from {} chains of {} sweeps, seed {}, in {}",
        model.name(),
        map.points(),
        map.dims,
        settings.schema.chains,
        settings.schema.sweeps,
        settings.experiment.seed,
        out.display()
    ))
}

fn print_samples(samples: &[Sample], scores: Option<&[Score]>) -> Result<()> {
    let counts: Vec<f64> = samples.iter().map(|sample| parts(&sample.labels) as f64).collect();
    say(format!("number of parts: {}", line(&mean(&counts), "mean")))?;
    let best = best(samples);
    say(format!(
        "most probable sample (highest log posterior): chain {}, {} parts",
        best.chain,
        parts(&best.labels)
    ))?;
    let Some(scores) = scores else { return Ok(()) };
    let aris: Vec<f64> = scores.iter().map(|score| score.ari).collect();
    say(format!("adjusted Rand index: {}", line(&mean(&aris), "mean")))?;
    let eligible = scores.iter().filter(|score| score.eligible);
    let right = eligible.clone().filter(|score| score.tree_correct).count();
    let rate = rate(right, eligible.count());
    say(format!(
        "tree accuracy (eligible samples that recover the true tree): {}",
        line(&rate, &format!("{right} of {}:", rate.n))
    ))
}

/// An estimate with its interval.
fn line(estimate: &Estimate, what: &str) -> String {
    match (estimate.value, estimate.interval) {
        (None, _) => format!("{what} no value"),
        (Some(value), None) => format!("{what} {value:.3} (n = {})", estimate.n),
        (Some(value), Some((low, high))) => {
            format!("{what} {value:.3} (95 % interval {low:.3} to {high:.3}, n = {})", estimate.n)
        }
    }
}
