//! Arguments → calls of the library, and their results on the screen.

use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use bodyschema::agent::Agent;
use bodyschema::body_map::ClassicalScaling;
use bodyschema::body_maps::BodyMaps;
use bodyschema::claims::{Verdict, table};
use bodyschema::distance::information_metric;
use bodyschema::evaluate::{Score, Truth, parts, score};
use bodyschema::plot;
use bodyschema::progress::progress;
use bodyschema::quantise::quantise;
use bodyschema::record::{npy, prepare_folder, tables};
use bodyschema::report;
use bodyschema::reproduce::{self, Experiment, Run};
use bodyschema::schema::{self, Model, Sample, infer};
use bodyschema::sense::sense;
use bodyschema::settings::{self, EdgeWeight, Keep, MapMethod, Scheme, Settings, Start};
use bodyschema::simulate::simulate;
use bodyschema::smacof::Improvement;
use bodyschema::statistics;
use bodyschema::streams::stream;
use bodyschema::study::{search, sensitivity};
use bodyschema::verify::{self, Finding, Outcome};
use clap::{Args, Parser, Subcommand};
use serde::Serialize;

/// Finds out from tactile information alone how many parts a body has, which sensor sits on which part,
/// and how the parts are joined: a replication of Mimura, Hagiwara, Taniguchi & Inamura (2017).
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Stages 1 and 2: moves a body at random in a fluid and records the pressure on its sensors.
    ///
    /// Writes into DIR: tactile.npy (float32, T x M, Pa), labels.csv (sensor,part), tree.csv (child,parent)
    /// and joint-angles.csv (time_s, then two angles a joint in rad; T + 1 rows).
    Simulate {
        #[command(flatten)]
        common: Common,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Stages 3 and 4: turns pressures into symbols, and these into the information metric.
    ///
    /// Reads pressures (float32, float64 or integers, T x M, Pa, not negative) and writes the distances
    /// H(X|Y) + H(Y|X) between all pairs of sensors (float64, M x M, bits).
    Distance {
        /// Pressures, or with --symbols symbols: a .npy file, a row a time, a column a sensor.
        tactile: PathBuf,
        #[arg(long, value_enum,
              help = with_default("How pressures become levels", paper().quantise.scheme))]
        scheme: Option<Scheme>,
        #[arg(long, value_name = "N", conflicts_with = "symbols",
              help = with_default("Number of levels, no pressure included, 2 to 256", paper().quantise.levels))]
        levels: Option<usize>,
        /// The input is symbols already: whole numbers from 0 to 255.
        #[arg(long, conflicts_with = "scheme")]
        symbols: bool,
        #[command(flatten)]
        file: SettingsFile,
        /// The distances to write.
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Stage 5: places the sensors in D dimensions by multidimensional scaling.
    ///
    /// Reads distances (M x M) and writes coordinates (float64, M x D, in the unit of the distances; columns of
    /// the classical map by descending eigenvalue). Of smacof and nonmetric, which start from the classical map, it
    /// prints Kruskal's stress-1.
    Map {
        /// Distances: a .npy file, M x M, symmetric.
        distance: PathBuf,
        /// Number of dimensions.
        #[arg(long, value_name = "D")]
        dims: usize,
        #[arg(long, value_enum,
              help = with_default("Variant of multidimensional scaling", paper().map.method))]
        method: Option<MapMethod>,
        #[command(flatten)]
        file: SettingsFile,
        /// The body map to write.
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
    /// Stages 6 and 7: samples the body schema; with the truth given, evaluates it.
    ///
    /// Reads coordinates (M x D) and writes into DIR: assignments.npy (int32, draws x M, component of each
    /// sensor), samples.csv (a row a draw: chain,parts,log_posterior, and with the truth given
    /// ari,eligible,tree_correct) and trees.csv (chain,child,parent and, of dpgmm-lj, the joint's place on the
    /// body map, x1 ... xD). With --keep all, a column `sweep` follows the chain.
    Infer {
        /// Body map: a .npy file, M x D.
        body_map: PathBuf,
        /// The mixture; the tree of dpgmm is found by Prim's algorithm on the centres.
        #[arg(long, value_enum, default_value_t = Model::DpgmmLj)]
        model: Model,
        #[arg(long, value_name = "K", help = with_default("Components of the weak limit", paper().schema.components))]
        components: Option<usize>,
        #[arg(long, value_name = "N", help = with_default("Independent chains", paper().schema.chains))]
        chains: Option<usize>,
        #[arg(long, value_name = "N", help = with_default("Gibbs sweeps of each chain", paper().schema.sweeps))]
        sweeps: Option<usize>,
        #[arg(long, value_enum,
              help = with_default("Edge weight of the minimum spanning tree", paper().schema.edge_weight))]
        edge_weight: Option<EdgeWeight>,
        #[arg(long, value_enum,
              help = with_default("Labels that each chain starts with", paper().schema.start))]
        start: Option<Start>,
        #[arg(long, value_enum,
              help = with_default("The last draw of each chain, or all after burn-in", paper().schema.keep))]
        keep: Option<Keep>,
        #[arg(long, value_name = "N", help = with_default("Sweeps dropped with --keep all", paper().schema.burn_in))]
        burn_in: Option<usize>,
        #[command(flatten)]
        common: Common,
        /// True part of each sensor: a .csv file with columns sensor,part.
        #[arg(long, value_name = "FILE", requires = "tree")]
        labels: Option<PathBuf>,
        /// True tree: a .csv file with columns child,parent.
        #[arg(long, value_name = "FILE", requires = "labels")]
        tree: Option<PathBuf>,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Runs a whole experiment and judges the paper's claims; exit status 0 if all are reproduced, 1 if some
    /// are not, 2 on trouble.
    ///
    /// Writes into DIR: report.html (all of it in one page), claims.csv and claims.md (a row a claim),
    /// figures/*.csv and *.svg (data and pictures of the paper's figures), samples.csv (a row a draw),
    /// baselines.csv (a row a clustering), simulation-N/ (distances, body maps, truth; in experiment 2
    /// p-P/simulation-N/ without distances) and manifest.json.
    Reproduce {
        /// The experiment.
        #[arg(value_enum)]
        experiment: Experiment,
        /// A small run of under a minute that shows all parts working; its numbers are no replication.
        #[arg(long)]
        quick: bool,
        #[arg(long, value_name = "N",
              help = with_default("Independent simulations", paper().experiment.simulations))]
        simulations: Option<usize>,
        #[command(flatten)]
        common: Common,
        #[command(flatten)]
        threads: Threads,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Looks for settings under which the paper's claims hold together, by a score written down beforehand.
    ///
    /// Reads a design (reproduce/search.toml explains one) and writes into DIR: search.md (rounds, and which claims
    /// hold together), scores.csv (a row a candidate and round), credits.csv (a row a claim of it), best.toml (the
    /// settings of the best, for --settings) and checkpoints/, from which a search that was stopped goes on.
    Search {
        /// The design; that of reproduce/search.toml if not given.
        #[arg(long, value_name = "FILE")]
        design: Option<PathBuf>,
        #[command(flatten)]
        threads: Threads,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Varies each setting that the paper leaves open around the default, and says how much each moves the results.
    ///
    /// Reads a design (reproduce/sensitivity.toml explains one) and writes into DIR: DEVIATIONS.md (a page for
    /// people), figures/*.svg (a picture a setting), sensitivity.csv (a row a value, condition and measure),
    /// design.toml, and checkpoints/, from which a study that was stopped goes on.
    Sensitivity {
        /// One part of the design alone, by its name.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
        /// The design; that of reproduce/sensitivity.toml if not given.
        #[arg(long, value_name = "FILE")]
        design: Option<PathBuf>,
        #[command(flatten)]
        threads: Threads,
        /// Folder for the files.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Draws the pictures of an experiment again, each from its table, and makes the report around them.
    ///
    /// Reads DIR/figures/*.csv and writes an .svg beside each; then, where DIR holds a finished experiment,
    /// report.html from its claims.csv and manifest.json. Where DIR holds a sensitivity study: its pictures and
    /// DEVIATIONS.md, from sensitivity.csv and design.toml.
    Plot {
        /// Folder of an experiment.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Compares results with the hashes that their manifest states, or with other results; exit status 0 if all
    /// agree, 1 if some do not, 2 on trouble.
    ///
    /// With --against, every .csv and .npy file of REFERENCE is compared with that of DIR: the same bytes; or all
    /// numbers within 1e-6 of the larger one or of 1; or, for samples.csv with scores, other draws whose rates
    /// (eligible, trees right) are within 4 standard errors in each condition. Lists what is not the same.
    Verify {
        /// Folder of results.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Folder of results to compare with.
        #[arg(long, value_name = "REFERENCE")]
        against: Option<PathBuf>,
    },
}

#[derive(Args)]
struct Threads {
    /// Threads; results do not depend on it [default: one a core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

impl Threads {
    fn apply(&self) -> Result<()> {
        if let Some(jobs) = self.jobs {
            ensure!((1..=1024).contains(&jobs), "--jobs is {jobs}, but must be 1 to 1024");
            rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global()?;
        }
        Ok(())
    }
}

#[derive(Args)]
struct SettingsFile {
    /// Settings that differ from reproduce/paper.toml, which names and explains all of them.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
}

#[derive(Args)]
struct Common {
    #[command(flatten)]
    file: SettingsFile,
    #[arg(long, value_name = "S", help = with_default("Master seed of all random numbers", paper().experiment.seed))]
    seed: Option<u64>,
}

fn paper() -> Settings {
    Settings::paper()
}

/// The name of a setting's value, as settings files write it.
fn name(value: impl Serialize) -> String {
    serde_json::to_value(value).expect("a setting's value is plain").to_string().replace('"', "")
}

fn with_default(text: &str, default: impl Serialize) -> String {
    format!("{text} [default: {}]", name(default))
}

/// Puts an option's value over a setting.
fn set<T>(setting: &mut T, option: Option<T>) {
    if let Some(value) = option {
        *setting = value;
    }
}

impl Arguments {
    /// Does what the arguments say.
    pub fn run(self) -> Result<ExitCode> {
        match self.command {
            Command::Simulate { common, out } => run_simulate(&common.load(false)?, &out)?,
            Command::Distance { tactile, scheme, levels, symbols, file, out } => {
                let mut settings = Settings::load(false, file.settings.as_deref())?;
                set(&mut settings.quantise.scheme, scheme);
                set(&mut settings.quantise.levels, levels);
                settings.validate()?;
                run_distance(&tactile, symbols, &settings, &out)?;
            }
            Command::Map { distance, dims, method, file, out } => {
                let mut settings = Settings::load(false, file.settings.as_deref())?;
                set(&mut settings.map.method, method);
                run_map(&distance, dims, settings.map.method, &out)?;
            }
            Command::Infer {
                body_map,
                model,
                components,
                chains,
                sweeps,
                edge_weight,
                start,
                keep,
                burn_in,
                common,
                labels,
                tree,
                out,
            } => {
                let mut settings = common.load(false)?;
                let schema = &mut settings.schema;
                set(&mut schema.components, components);
                set(&mut schema.chains, chains);
                set(&mut schema.sweeps, sweeps);
                set(&mut schema.edge_weight, edge_weight);
                set(&mut schema.start, start);
                set(&mut schema.keep, keep);
                set(&mut schema.burn_in, burn_in);
                settings.validate()?;
                run_infer(&body_map, model, labels.zip(tree), &settings, &out)?;
            }
            Command::Plot { folder } => run_plot(&folder)?,
            Command::Verify { folder, against } => return run_verify(&folder, against.as_deref()),
            Command::Search { design, threads, out } => {
                threads.apply()?;
                run_search(design.as_deref(), &out)?;
            }
            Command::Sensitivity { only, design, threads, out } => {
                threads.apply()?;
                run_sensitivity(design.as_deref(), only.as_deref(), &out)?;
            }
            Command::Reproduce { experiment, quick, simulations, common, threads, out } => {
                let mut settings = common.load(quick)?;
                set(&mut settings.experiment.simulations, simulations);
                settings.validate()?;
                threads.apply()?;
                let settings_file = common.file.settings.as_deref();
                return run_reproduce(&Run {
                    experiment,
                    settings: &settings,
                    settings_file,
                    quick,
                    out: &out,
                });
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}

impl Common {
    fn load(&self, quick: bool) -> Result<Settings> {
        let mut settings = Settings::load(quick, self.file.settings.as_deref())?;
        set(&mut settings.experiment.seed, self.seed);
        Ok(settings)
    }
}

/// Prints a line. A reader that has gone away is no trouble: the files are written all the same.
fn say(line: impl Display) -> Result<()> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("standard output"),
        _ => Ok(()),
    }
}

fn run_verify(folder: &Path, reference: Option<&Path>) -> Result<ExitCode> {
    let mut agree = true;
    let mut tell = |findings: Vec<Finding>, with: &str| -> Result<()> {
        for finding in findings.iter().filter(|finding| finding.outcome != Outcome::Same) {
            say(finding)?;
        }
        let count = |found: fn(&Outcome) -> bool| findings.iter().filter(|f| found(&f.outcome)).count();
        let (same, agreeing) = (count(|outcome| *outcome == Outcome::Same), count(Outcome::agrees));
        agree &= agreeing == findings.len();
        say(format!(
            "{}: {} compared with {with}: {same} the same, {} within tolerance, {} not",
            folder.display(),
            findings.len(),
            agreeing - same,
            findings.len() - agreeing
        ))
    };
    if reference.is_none() || verify::has_manifest(folder) {
        tell(verify::against_manifest(folder)?, "the hashes in manifest.json")?;
    }
    if let Some(reference) = reference {
        tell(verify::against_reference(folder, reference)?, &reference.display().to_string())?;
    }
    Ok(if agree { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn run_simulate(settings: &Settings, out: &Path) -> Result<()> {
    prepare_folder(out)?;
    let agent = Agent::new(&settings.agent, &settings.skin);
    let bar = progress(settings.samples() as u64 + 1, "simulate".to_owned());
    let mut rng = stream(settings.experiment.seed, 1, "motion", 0);
    let trajectory = simulate(&agent, settings, &mut rng, &bar)?;
    bar.finish_and_clear();
    let truth = Truth { labels: agent.labels(), tree: agent.tree() };
    tables::write_truth(&out.join("labels.csv"), &out.join("tree.csv"), &truth)?;
    tables::write_joint_angles(&out.join("joint-angles.csv"), &trajectory, settings.sense.interval)?;
    let tactile = sense(&agent, &trajectory, &settings.sense);
    npy::write_tactile(&out.join("tactile.npy"), &tactile)?;
    say(format!(
        "{} samples of {} sensors on {} parts, seed {}, in {}",
        tactile.samples,
        tactile.sensors(),
        agent.parts.len(),
        settings.experiment.seed,
        out.display()
    ))
}

fn run_distance(input: &Path, are_symbols: bool, settings: &Settings, out: &Path) -> Result<()> {
    let symbols = if are_symbols {
        npy::read_symbols(input)?
    } else {
        quantise(&npy::read_tactile(input)?, &settings.quantise)
    };
    let constant = symbols.constant_sensors();
    if !constant.is_empty() {
        eprintln!(
            "bodyschema: {}: {} of {} sensors never change and tell nothing (the first is sensor {})",
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
    ))
}

fn run_map(input: &Path, dims: usize, method: MapMethod, out: &Path) -> Result<()> {
    ensure!(dims >= 1, "--dims is 0, but must be at least 1");
    let distances = npy::read_distances(input)?;
    let in_file = || input.display().to_string();
    let scaling = ClassicalScaling::new(&distances, dims).with_context(in_file)?;
    let (maps, improvements) = BodyMaps::new(&distances, &scaling, method, &[dims]).with_context(in_file)?;
    let map = maps.in_dims(dims);
    npy::write_body_map(out, &map)?;
    let fit = match improvements.first() {
        None => format!(
            "its eigenvalues make up {:.2} % of the sum of squares of all",
            100.0 * scaling.agreement(dims)
        ),
        Some(Improvement { start, stress, steps, .. }) => {
            format!("its stress-1 is {stress:.4} after {steps} steps from {start:.4} of the classical map")
        }
    };
    say(format!("body map of {} sensors in {dims} dimensions, in {}; {fit}", map.points(), out.display()))
}

fn run_infer(
    input: &Path,
    model: Model,
    truth: Option<(PathBuf, PathBuf)>,
    settings: &Settings,
    out: &Path,
) -> Result<()> {
    let map = npy::read_body_map(input)?;
    prepare_folder(out)?;
    let truth = truth.map(|(labels, tree)| tables::read_truth(&labels, &tree, map.points())).transpose()?;
    let bar = progress(settings.schema.chains as u64, "infer".to_owned());
    let samples = infer(&map, model, &settings.schema, settings.experiment.seed, 1, &bar)
        .with_context(|| input.display().to_string())?;
    bar.finish_and_clear();
    let scores: Option<Vec<Score>> = truth.map(|truth| {
        samples.iter().map(|sample| score(sample, &truth, settings.evaluate.eligible_ari)).collect()
    });
    let keep = settings.schema.keep;
    npy::write_assignments(&out.join("assignments.npy"), &samples)?;
    tables::write_samples(&out.join("samples.csv"), &samples, keep, scores.as_deref())?;
    tables::write_trees(&out.join("trees.csv"), &samples, keep)?;
    print_summary(model, &map, &samples, scores.as_deref(), settings, out)
}

fn print_summary(
    model: Model,
    map: &bodyschema::body_map::BodyMap,
    samples: &[Sample],
    scores: Option<&[Score]>,
    settings: &Settings,
    out: &Path,
) -> Result<()> {
    say(format!(
        "{} of {} sensors in {} dimensions: {} draws of {} chains of {} sweeps, seed {}, in {}",
        model.name(),
        map.points(),
        map.dims,
        samples.len(),
        settings.schema.chains,
        settings.schema.sweeps,
        settings.experiment.seed,
        out.display()
    ))?;
    let counts: Vec<f64> = samples.iter().map(|sample| parts(&sample.labels) as f64).collect();
    say(format!("parts: {}", line(&statistics::mean(&counts), "mean")))?;
    let best = schema::best(samples);
    say(format!("draw of highest log posterior: chain {}, {} parts", best.chain, parts(&best.labels)))?;
    if let Some(scores) = scores {
        let aris: Vec<f64> = scores.iter().map(|score| score.ari).collect();
        say(format!("adjusted Rand index: {}", line(&statistics::mean(&aris), "mean")))?;
        let eligible = scores.iter().filter(|score| score.eligible);
        let right = eligible.clone().filter(|score| score.tree_correct).count();
        let rate = statistics::rate(right, eligible.count());
        say(format!("tree right among eligible draws: {}", line(&rate, &format!("{right} of {}:", rate.n))))?;
    }
    Ok(())
}

fn line(estimate: &statistics::Estimate, what: &str) -> String {
    match (estimate.value, estimate.interval) {
        (None, _) => format!("{what} no rate"),
        (Some(value), None) => format!("{what} {value:.3} (n = {})", estimate.n),
        (Some(value), Some((low, high))) => {
            format!("{what} {value:.3} (95 % interval {low:.3} to {high:.3}, n = {})", estimate.n)
        }
    }
}

fn run_plot(folder: &Path) -> Result<()> {
    if sensitivity::is_study(folder) {
        let drawn = sensitivity::redraw(folder)?;
        return say(format!("{} pictures and DEVIATIONS.md in {}", drawn.len(), folder.display()));
    }
    let figures = folder.join("figures");
    let drawn = plot::draw(&figures)?;
    ensure!(
        !drawn.is_empty(),
        "{}: has none of the tables fig04-agent.csv to fig11b-tree.csv",
        figures.display()
    );
    say(format!("{} pictures in {}", drawn.len(), figures.display()))?;
    if folder.join("manifest.json").exists() {
        report::write(folder)?;
        say(format!("report in {}", folder.join("report.html").display()))?;
    }
    Ok(())
}

/// The text of a design and where it is from: a file, or `default` with its name.
fn design(file: Option<&Path>, default: (&str, &str)) -> Result<(String, String)> {
    match file {
        None => Ok((default.0.to_owned(), default.1.to_owned())),
        Some(path) => Ok((settings::read(path)?, path.display().to_string())),
    }
}

fn run_search(file: Option<&Path>, out: &Path) -> Result<()> {
    let (text, origin) = design(file, (search::DESIGN, "reproduce/search.toml"))?;
    let design = search::Design::parse(&text, &origin)?;
    prepare_folder(out)?;
    say(search::search(&design, out)?)?;
    say(format!("All files are in {}.", out.display()))
}

fn run_sensitivity(file: Option<&Path>, only: Option<&str>, out: &Path) -> Result<()> {
    let (text, origin) = design(file, (sensitivity::DESIGN, "reproduce/sensitivity.toml"))?;
    let mut design = sensitivity::Design::parse(&text, &origin)?;
    if let Some(name) = only {
        design = design.only(name, &origin)?;
    }
    prepare_folder(out)?;
    sensitivity::study(&design, &text, out)?;
    say(format!("All files are in {}; open DEVIATIONS.md there.", out.display()))
}

fn run_reproduce(run: &Run) -> Result<ExitCode> {
    let (largest, sensors) = (run.largest_dimension(), run.sensors());
    let setting = match run.experiment {
        Experiment::Exp1 => "experiment.dimensions",
        Experiment::Exp2 => "experiment.dimension",
    };
    ensure!(
        largest < sensors,
        "setting `{setting}` goes up to {largest}, but {sensors} sensors span fewer dimensions"
    );
    prepare_folder(run.out)?;
    let judged = reproduce::reproduce(run)?;
    say(format!("{}\n", reproduce::preamble(run)))?;
    say(format!("{}\n", table::terminal_table(&judged)))?;
    say(format!("All files are in {}; open report.html there.", run.out.display()))?;
    for line in judged.iter().filter_map(table::comparison) {
        say(line)?;
    }
    let all = judged.iter().all(|judged| judged.verdict == Verdict::Reproduced);
    Ok(ExitCode::from(u8::from(!all)))
}
