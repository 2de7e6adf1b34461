//! The subcommands that run experiments: reproduce, search, sensitivity, compare, multiverse.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Result, ensure};
use clap::Args;

use super::options::{SettingsAndSeed, Threads, choice, paper, set, with_default};
use super::output::say;
use crate::analysis::claims::{Judged, Verdict};
use crate::analysis::published::{Experiment, HEADLINE};
use crate::experiments::multiverse::{self, Shard};
use crate::experiments::reproduce::{self, Run};
use crate::experiments::{bodies, compare, design, search, sensitivity};
use crate::files::prepare_folder;
use crate::report::claims_table;
use crate::report::headline::Headline;
use crate::settings::read_toml;
use crate::stages::schema::Sampler;

/// Runs an experiment of the paper and judges the paper's claims.
///
/// Exit status: 0 if the headline (tree accuracy at p = 0.9, d = 14) lies within its accepted range, 1 if it does not, 2 on an error.
///
/// Writes into DIR: report.html (all of it in one page), claims.csv and claims.md (a row for each claim),
/// figures/*.csv and *.svg (data and pictures of the paper's figures), samples.csv (a row for each posterior sample),
/// baselines.csv (a row for each clustering), simulation-N/ (distances, body maps, truth; in experiment 2
/// p-P/simulation-N/ without distances), manifest.json and run.json. A run that was stopped continues from what it
/// finished.
#[derive(Args)]
pub struct Reproduce {
    /// The experiment
    #[arg(value_parser = choice::<Experiment>())]
    experiment: Experiment,
    /// Check the installation: run every stage on little data, in under a minute, and judge nothing; exit status 0 if all
    /// stages ran
    #[arg(long)]
    quick: bool,
    /// Exit with 1 if any claim that can be tested is not reproduced
    #[arg(long, conflicts_with = "quick")]
    strict: bool,
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
        let begun = Instant::now();
        let finished = reproduce::reproduce(&run)?;
        if self.quick {
            say(format!("{}\n", self.installation_works(begun.elapsed().as_secs())))?;
        }
        if let Some(headline) = Headline::of(&finished.rows) {
            say(format!("{}\n", headline.in_terminal()))?;
        }
        say(format!("{}\n", finished.preamble))?;
        say(format!("{}\n", claims_table::terminal_table(&finished.rows)))?;
        say(format!("All files are in {}; open report.html there.", self.out.display()))?;
        Ok(ExitCode::from(u8::from(
            !self.quick && !self.is_reproduced(&finished.judged, settings.schema.sampler),
        )))
    }

    /// What a quick run is for, and what a full one takes.
    fn installation_works(&self, seconds: u64) -> String {
        let minutes = match self.experiment {
            Experiment::Exp1 => "7 to 20",
            Experiment::Exp2 => "10 to 30",
        };
        format!(
            "The installation works: all stages ran, in {seconds} s. The numbers below only illustrate the output; a full run (without \
             --quick) takes about {minutes} minutes on two cores."
        )
    }

    /// Whether the headline by the run's own interpretation is reproduced; if `strict`, also every other claim that can be tested.
    fn is_reproduced(&self, judged: &[Judged], sampler: Sampler) -> bool {
        let mut of_run = judged.iter().filter(|judged| judged.reading == sampler);
        let fails = |judged: &Judged| match judged.claim.id.as_str() {
            HEADLINE => judged.verdict != Verdict::Reproduced,
            _ => self.strict && judged.verdict == Verdict::NotReproduced,
        };
        !of_run.any(fails)
    }
}

/// Searches for settings that reproduce the paper's claims together, by a score that was fixed beforehand.
///
/// Reads a design (reproduce/search.toml explains one) and writes into DIR: search.md (the rounds, and which claims single
/// candidates reproduce together), scores.csv (a row for each candidate and round), credits.csv (a row for each claim of
/// the best candidates), best.toml (the settings of the best candidate, for --settings), next.toml (the candidates of the
/// next round, for --from on another machine) and design.toml. A search that was stopped continues from checkpoints/.
#[derive(Args)]
pub struct Search {
    /// Continue with the round and the candidates in this file: the next.toml of an earlier part of the search
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

/// Varies each setting that the paper leaves open around its default, and reports how much the results change (sensitivity
/// analysis).
///
/// Reads a design (reproduce/sensitivity.toml explains one) and writes into DIR: sensitivity.md (the report), figures/*.svg (a
/// figure for each setting), sensitivity.csv (a row for each value, condition and measure) and design.toml. A study that
/// was stopped continues from checkpoints/.
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

/// Compares named configurations with the first one, claim by claim, on the same simulations.
///
/// Reads a design (reproduce/ablation.toml explains one) and writes into DIR: comparison.md (the report), figures/*.svg
/// (figures of the claims), comparison.csv (a row for each configuration and claim) and design.toml. A comparison that
/// was stopped continues from checkpoints/.
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

/// Runs many reasonable interpretations of the paper as replications, and reports what share of them reproduces each claim, and
/// which choices matter (multiverse analysis).
///
/// A specification is one interpretation. Reads a design (reproduce/multiverse.toml explains one) and writes into DIR:
/// specifications/NUMBER/ (settings and claims of each specification), multiverse.md (the report), multiverse.csv (a row for
/// each specification and claim), specifications.csv (the choices of each), shares.csv, variance.csv, joint.csv,
/// figures/*.svg and design.toml. A run that was stopped continues. On several machines: run each shard into one shared
/// folder, then gather.
#[derive(Args)]
pub struct Multiverse {
    /// Run only the I-th of N parts of the work, and write no tables
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Run nothing; write the tables from the results of all shards
    #[arg(long, conflicts_with_all = ["shard", "only"])]
    gather: bool,
    /// Run only this specification (again, if it is finished), and write no tables
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
            say(format!("This shard is finished, in {}. After all shards, run --gather.", out.display()))?;
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
    /// Design file, instead of the one in reproduce/
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

/// Evaluates how often `estimate` and other methods recover parts and tree of any body (not in the paper).
///
/// Writes into DIR: recordings.csv (a row for each recording), edges.csv (a row for each edge of each estimated tree) and
/// bodies.md (the report). A study that was stopped continues; with more movements, it reuses those in checkpoints/. Each
/// thread holds one simulated movement in memory: 0.4 GB for 840 sensors and 100,000 samples.
#[derive(Args)]
pub struct Bodies {
    /// Design file, such as reproduce/bodies.toml; paths of body files are relative to its folder
    #[arg(long, value_name = "FILE")]
    design: PathBuf,
    /// Simulated movements of each body at each p, instead of the number in the design
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
