//! Run the specifications of a multiverse, or one shard of them.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

use super::super::configurations::Configurations;
use super::super::error::ExperimentError;
use super::super::progress::progress;
use super::design::Design;
use super::draw::{Drawn, specifications};
use super::specification;
use crate::analysis::published::claims;
use crate::files::{FileError, read_text, write_same_text};
use crate::settings::Settings;

/// Where the design is kept beside the results.
pub const COPY: &str = "design.toml";

/// A part of the work: the `index`-th of `of`, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Whether it has a movement, from 1.
    fn has(self, movement: usize) -> bool {
        movement % self.of == self.index % self.of
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `I/N`.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (index, of) = text.split_once('/').unwrap_or_default();
        match (index.parse(), of.parse()) {
            (Ok(index), Ok(of)) if (1..=of).contains(&index) => Ok(Self { index, of }),
            _ => Err("a shard is I/N, with I from 1 to N, such as 3/8".to_owned()),
        }
    }
}

/// Runs the specifications of a shard that are not finished yet, each into a folder of its own in `out`.
///
/// Shards may work on one folder at the same time: each has the movements of its own. A specification that fails is a
/// result.
///
/// # Errors
/// If `out` holds results of another design, the settings of a specification cannot be used, or a file cannot be written.
pub fn work(design: &Design, text: &str, shard: Shard, out: &Path) -> Result<(), ExperimentError> {
    let all = specifications(design);
    // Before hours are spent on those that come first.
    let settings: Vec<Settings> =
        all.iter().map(|drawn| settings(design, drawn)).collect::<Result<_, _>>()?;
    keep_design(text, out)?;
    let is_left =
        |drawn: &Drawn| shard.has(drawn.movement) && !specification::folder(out, drawn.number).exists();
    let left: Vec<(&Drawn, Settings)> =
        all.iter().zip(settings).filter(|(drawn, _)| is_left(drawn)).collect();
    let movements: Vec<Vec<(&Drawn, Settings)>> =
        left.chunk_by(|(one, _), (other, _)| one.movement == other.movement).map(<[_]>::to_vec).collect();
    let configurations = |movements: &[Vec<(&Drawn, Settings)>]| {
        let settings: Vec<Settings> =
            movements.iter().flatten().map(|(_, settings)| settings.clone()).collect();
        Configurations::new(&settings, out)
    };
    let bar = progress(configurations(&movements).length(), format!("{} specifications", left.len()));
    let (claims, begun, mut finished) = (claims(), Instant::now(), 0);
    for together in movements.chunks(left.first().map_or(1, |(_, settings)| at_once(settings))) {
        let configurations = configurations(together);
        let outcomes = configurations.run(&bar)?;
        for ((drawn, settings), outcome) in together.iter().flatten().zip(&outcomes) {
            specification::write(out, design, &claims, drawn, settings, outcome)?;
        }
        configurations.forget()?;
        finished += outcomes.len();
        if bar.is_hidden() {
            tell(finished, left.len(), begun.elapsed());
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// Says in a log how far the work is.
fn tell(finished: usize, all: usize, spent: Duration) {
    let left = spent.mul_f64((all - finished) as f64 / finished as f64);
    let left = humantime::format_duration(Duration::from_secs(left.as_secs()));
    eprintln!("bodyschema: {finished} of {all} specifications are finished; about {left} left");
}

/// Runs one specification, whether or not it is finished, and returns its folder.
///
/// # Errors
/// As [`work`], and if the design has no such specification.
pub fn rerun(design: &Design, text: &str, number: usize, out: &Path) -> Result<PathBuf, ExperimentError> {
    let all = specifications(design);
    let drawn = all.iter().find(|drawn| drawn.number == number).ok_or_else(|| {
        let message = format!("there is no specification {number}; the design draws 1 to {}", all.len());
        ExperimentError::Stage(message)
    })?;
    let settings = settings(design, drawn)?;
    keep_design(text, out)?;
    let configurations = Configurations::new(std::slice::from_ref(&settings), out);
    let bar = progress(configurations.length(), format!("specification {number}"));
    let outcomes = configurations.run(&bar)?;
    bar.finish_and_clear();
    specification::write(out, design, &claims(), drawn, &settings, &outcomes[0])?;
    configurations.forget()?;
    Ok(specification::folder(out, number))
}

/// The settings of a specification.
///
/// # Errors
/// If they cannot be used.
pub fn settings(design: &Design, drawn: &Drawn) -> Result<Settings, ExperimentError> {
    design.settings(&drawn.options, design.seed + drawn.movement as u64, &drawn.number.to_string())
}

/// Movements whose specifications are run together, so that every thread has one of their simulations.
fn at_once(settings: &Settings) -> usize {
    let experiment = &settings.experiment;
    rayon::current_num_threads().div_ceil(experiment.simulations * (experiment.coordinations.len() + 1))
}

/// Keeps the design beside the results, if it is not there.
///
/// # Errors
/// If the folder holds another one.
fn keep_design(text: &str, out: &Path) -> Result<(), ExperimentError> {
    let path = out.join(COPY);
    if !path.exists() {
        // Other shards may do so at the same time.
        write_same_text(&path, text)?;
    }
    check_design(text, out)
}

/// Whether the results in a folder are of this design.
///
/// # Errors
/// If they are not.
pub fn check_design(text: &str, out: &Path) -> Result<(), ExperimentError> {
    let path = out.join(COPY);
    if read_text(&path)? == text {
        return Ok(());
    }
    let message = "is another design, whose results are in this folder; choose another folder or that design";
    Err(FileError::new(&path, message).into())
}
