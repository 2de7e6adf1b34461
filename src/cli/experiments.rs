//! The subcommands that run experiments: reproduce, search, sensitivity, compare, multiverse.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::Args;

use super::options::{SettingsAndSeed, Threads, choice, paper, set, with_default};
use super::output::say;
use crate::analysis::claims::Verdict;
use crate::analysis::published::Experiment;
use crate::experiments::multiverse::{self, Shard};
use crate::experiments::reproduce::{self, Run};
use crate::experiments::{bodies, compare, design, search, sensitivity};
use crate::files::prepare_folder;
use crate::report::claims_table;
use crate::settings::read_toml;

/// Runs a whole experiment and judges the paper's claims; exit status 0 if all are reproduced, 1 if some
/// are not, 2 on an error.
///
/// Writes into DIR: report.html (all of it in one page), claims.csv and claims.md (a row for each claim),
/// figures/*.csv and *.svg (data and pictures of the paper's figures), samples.csv (a row for each draw),
/// baselines.csv (a row for each clustering), simulation-N/ (distances, body maps, truth; in experiment 2
/// p-P/simulation-N/ without distances), manifest.json and run.json. A run that was stopped continues from what it
/// finished.
#[derive(Args)]
pub struct Reproduce {
    /// The experiment
    #[arg(value_parser = choice::<Experiment>())]
    experiment: Experiment,
    /// Run small, in under a minute, to see the whole program work; its numbers are not a replication
    #[arg(long)]
    quick: bool,
    #[arg(long, value_name = "N",
          help = with_default("Number of independent simulations", paper().experiment.simulations))]
    simulations: Option<usize>,
    #[command(flatten)]
    common: SettingsAndSeed,
    #[command(flatten)]
    threads: Threads,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Reproduce {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        let mut settings = self.common.load(self.quick)?;
        set(&mut settings.experiment.simulations, self.simulations);
        settings.validate()?;
        self.threads.apply()?;
        let run = Run {
            experiment: self.experiment,
            settings: &settings,
            settings_file: self.common.file.settings.as_deref(),
            quick: self.quick,
            out: &self.out,
        };
        let (largest, sensors) = (run.largest_dimension(), settings.sensors());
        let setting = match self.experiment {
            Experiment::Exp1 => "experiment.dimensions",
            Experiment::Exp2 => "experiment.dimension",
        };
        ensure!(
            largest < sensors,
            "setting `{setting}` goes up to {largest}, but {sensors} sensors span fewer dimensions; lower it or add sensors"
        );
        prepare_folder(&self.out)?;
        let reproduce::Finished { preamble, judged } = reproduce::reproduce(&run)?;
        say(format!("{preamble}\n"))?;
        say(format!("{}\n", claims_table::terminal_table(&judged)))?;
        say(format!("All files are in {}; open report.html there.", self.out.display()))?;
        for line in judged.iter().filter_map(claims_table::comparison) {
            say(line)?;
        }
        // Those of the other reading do not count.
        let mut of_run = judged.iter().filter(|judged| judged.reading == settings.schema.sampler);
        let all = of_run.all(|judged| judged.verdict == Verdict::Reproduced);
        Ok(ExitCode::from(u8::from(!all)))
    }
}

/// Searches for settings under which the paper's claims hold together, by a score that is written down beforehand.
///
/// Reads a design (reproduce/search.toml explains one) and writes into DIR: search.md (rounds, and which claims
/// hold together), scores.csv (a row for each candidate and round), credits.csv (a row for each claim of the best
/// candidates), best.toml (the settings of the best candidate, for --settings), next.toml (the candidates of the next
/// round, for --from on another machine), design.toml and checkpoints/, from which a search that was stopped continues.
#[derive(Args)]
pub struct Search {
    /// Continue with the round and the candidates of this file, the next.toml of an earlier part of the search
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    #[command(flatten)]
    study: Study,
}

impl Search {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        self.study.threads.apply()?;
        let (text, origin) = self.study.design((design::SEARCH, "reproduce/search.toml"))?;
        let (design, out) = (search::Design::parse(&text, &origin)?, &self.study.out);
        let from = match &self.from {
            None => None,
            Some(path) => {
                let (text, origin) = (read_toml(path)?, path.display().to_string());
                Some(search::Continuation::parse(&text, &origin, &design)?)
            }
        };
        prepare_folder(out)?;
        say(search::search(&design, &text, from, out)?)?;
        say(format!("All files are in {}.", out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Varies each setting that the paper leaves open around the default, and says how much each changes the results.
///
/// Reads a design (reproduce/sensitivity.toml explains one) and writes into DIR: sensitivity.md (a page for people),
/// figures/*.svg (a picture for each setting), sensitivity.csv (a row for each value, condition and measure),
/// design.toml, and checkpoints/, from which a study that was stopped continues.
#[derive(Args)]
pub struct Sensitivity {
    /// Only one setting (or group of settings) of the design, by its name
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    #[command(flatten)]
    study: Study,
}

impl Sensitivity {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        self.study.threads.apply()?;
        let (text, origin) = self.study.design((design::SENSITIVITY, "reproduce/sensitivity.toml"))?;
        let out = &self.study.out;
        let mut design = sensitivity::Design::parse(&text, &origin)?;
        if let Some(name) = &self.only {
            design = design.only(name, &origin)?;
        }
        prepare_folder(out)?;
        sensitivity::study(&design, &text, out)?;
        say(format!("All files are in {}; open sensitivity.md there.", out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Compares named configurations by the paper's claims, each with the first one, on the same simulations.
///
/// Reads a design (reproduce/ablation.toml explains one) and writes into DIR: comparison.md (a page for people),
/// figures/*.svg (pictures of the claims), comparison.csv (a row for each configuration and claim), design.toml, and
/// checkpoints/, from which a comparison that was stopped continues.
#[derive(Args)]
pub struct Compare {
    #[command(flatten)]
    study: Study,
}

impl Compare {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        self.study.threads.apply()?;
        let (text, origin) = self.study.design((design::ABLATION, "reproduce/ablation.toml"))?;
        let (design, out) = (compare::Design::parse(&text, &origin)?, &self.study.out);
        prepare_folder(out)?;
        compare::compare(&design, &text, out)?;
        say(format!("All files are in {}; open comparison.md there.", out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Runs many reasonable readings of the paper, each a replication of its own, and says in what share of them its claims hold
/// and which choices decide.
///
/// Reads a design (reproduce/multiverse.toml explains one) and writes into DIR: specifications/NUMBER/ (settings and claims of
/// each reading), multiverse.md (a page for people), multiverse.csv (a row for each specification and claim),
/// specifications.csv (what each one is), shares.csv, variance.csv, joint.csv, figures/*.svg and design.toml. A run that was stopped
/// continues. On several machines: run each shard into one folder, then gather.
#[derive(Args)]
pub struct Multiverse {
    /// Run only the I-th of N parts of the work, and write no tables
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Run nothing, and write the tables of what all shards finished
    #[arg(long, conflicts_with_all = ["shard", "only"])]
    gather: bool,
    /// Run only one specification, again if it is finished, and write no tables
    #[arg(long, value_name = "NUMBER", conflicts_with = "shard")]
    only: Option<usize>,
    #[command(flatten)]
    study: Study,
}

impl Multiverse {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        self.study.threads.apply()?;
        let (text, origin) = self.study.design((design::MULTIVERSE, "reproduce/multiverse.toml"))?;
        let (design, out) = (multiverse::Design::parse(&text, &origin)?, &self.study.out);
        prepare_folder(out)?;
        if let Some(number) = self.only {
            let folder = multiverse::rerun(&design, &text, number, out)?;
            say(format!("Specification {number} is in {}.", folder.display()))?;
            return Ok(ExitCode::SUCCESS);
        }
        if !self.gather {
            multiverse::work(&design, &text, self.shard.unwrap_or(Shard::WHOLE), out)?;
        }
        if self.shard.is_some() {
            say(format!("This shard is finished in {}. After all shards: --gather.", out.display()))?;
        } else {
            multiverse::gather(&design, &text, out)?;
            say(format!("All files are in {}; open multiverse.md there.", out.display()))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Where a study's design comes from, and where its files go.
#[derive(Args)]
struct Study {
    /// Design, instead of the one in reproduce/
    #[arg(long, value_name = "FILE")]
    design: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Study {
    /// The text of the design and where it is from: the user's file, or `default` with its name.
    fn design(&self, default: (&str, &str)) -> Result<(String, String)> {
        match &self.design {
            None => Ok((default.0.to_owned(), default.1.to_owned())),
            Some(path) => Ok((read_toml(path)?, path.display().to_string())),
        }
    }
}

/// How often parts and tree are found on any body, beside other methods (not in the paper).
///
/// Writes into DIR: recordings.csv (a row for each recording), edges.csv (a row for each edge of each estimated tree) and
/// bodies.md. Start it again to go on where it was, or, with more movements, from those in checkpoints/. Each thread holds one
/// movement: 0.4 GB for 840 sensors and 100,000 samples.
#[derive(Args)]
pub struct Bodies {
    /// Design, such as reproduce/bodies.toml; its bodies are files from its folder
    #[arg(long, value_name = "FILE")]
    design: PathBuf,
    /// Movements of each body at each p, in place of those of the design
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    movements: Option<u32>,
    #[command(flatten)]
    threads: Threads,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Bodies {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        self.threads.apply()?;
        let mut text = read_toml(&self.design)?;
        let mut design = bodies::Design::parse(&text, &self.design)?;
        if let Some(movements) = self.movements {
            design.movements = movements as usize;
            text = toml::to_string(&design)?;
        }
        prepare_folder(&self.out)?;
        bodies::study(&design, &text, &self.design, &self.out)?;
        say(format!("All files are in {}; open bodies.md there.", self.out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}
