//! The subcommands that run experiments: reproduce, bodies.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Result, ensure};
use clap::Args;

use super::options::{SettingsAndSeed, Threads, choice, paper, set, with_default};
use super::output::say;
use crate::analysis::claims::{Judged, Verdict};
use crate::analysis::published::{Experiment, HEADLINE};
use crate::experiments::bodies;
use crate::experiments::reproduce::{self, Run};
use crate::files::prepare_folder;
use crate::report::claims_table;
use crate::report::headline::Headline;
use crate::settings::read_toml;
use crate::stages::schema::Sampler;
use crate::tasks::seeds::used_before;
use crate::tasks::shard::Shard;

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
pub(super) struct Reproduce {
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
    pub(super) fn run(self) -> Result<ExitCode> {
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

/// Evaluates how often `estimate` and other methods recover parts and tree of any body (not in the paper).
///
/// Writes into DIR: recordings.csv (a row for each recording), edges.csv (a row for each edge of each estimated tree) and
/// bodies.md (the report). A study that was stopped continues; with more movements, it reuses those in checkpoints/. Each
/// thread holds one simulated movement in memory: 0.4 GB for 840 sensors and 100,000 samples. On several machines: run each shard
/// into one shared folder, then the same command without --shard, which runs what is missing and writes the tables.
#[derive(Args)]
pub(super) struct Bodies {
    /// Design file, such as reproduce/bodies.toml; paths of body files are relative to its folder
    #[arg(long, value_name = "FILE")]
    design: PathBuf,
    /// Simulated movements of each body at each p, instead of the number in the design
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    movements: Option<u32>,
    /// Run only the I-th of N parts of the work, and write no tables
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    #[command(flatten)]
    threads: Threads,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Bodies {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        self.threads.apply()?;
        let mut text = read_toml(&self.design)?;
        let mut design = bodies::Design::parse(&text, &self.design)?;
        if let Some(movements) = self.movements {
            design.movements = movements as usize;
            text = toml::to_string(&design)?;
        }
        prepare_folder(&self.out)?;
        bodies::study(&design, &text, &self.design, self.shard, &self.out)?;
        if let Some(used) = used_before(design.seed..=design.seed) {
            say(used)?;
        }
        let out = self.out.display();
        say(match self.shard {
            Some(_) => {
                format!(
                    "This shard is finished, in {out}. After all shards, run the same command without --shard."
                )
            }
            None => format!("All files are in {out}; open bodies.md there."),
        })?;
        Ok(ExitCode::SUCCESS)
    }
}
