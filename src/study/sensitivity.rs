//! A study design → how much each open setting moves each result, by varying it around the default.
//!
//! One setting at a time, and pairs where one may hang on another. All values of all settings run on the same
//! simulations (the same random numbers), so that differences from the default are paired.

use std::collections::HashSet;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::Table;

use super::search::flat;
use super::{Outcome, StudyError, deviations, run, write_manifest};
use crate::conditions::{Condition, Conditions};
use crate::pipeline::Record;
use crate::plot;
use crate::record::provenance::read_manifest;
use crate::record::{FileError, one_line, read_text, tables, write_text};
use crate::schema::Model;
use crate::settings::Settings;
use crate::statistics::Estimate;

/// `reproduce/sensitivity.toml`, the design of the study of what the paper leaves open.
pub const DESIGN: &str = include_str!("../../reproduce/sensitivity.toml");

/// Where the study's design is kept beside its results, and where its table is.
const COPY: &str = "design.toml";
const TABLE: &str = "sensitivity.csv";

/// What is varied, and how each configuration is run.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Master seed of all simulations.
    pub seed: u64,
    /// What every configuration has instead of `reproduce/paper.toml`'s values: how much is simulated and drawn.
    settings: Table,
    /// The open settings.
    pub part: Vec<Part>,
}

/// An open setting, or a pair of them.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Short name, for `--only` and for the file of its picture.
    pub name: String,
    /// What it is.
    pub title: String,
    /// What the paper says, and where.
    pub paper: String,
    /// The settings, `section.key`.
    pub settings: Vec<String>,
    /// Why the default is what it is.
    pub why: String,
    /// What is tried instead.
    pub values: Vec<Table>,
}

/// What is measured of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Mean number of estimated parts.
    Parts,
    /// Mean adjusted Rand index.
    Ari,
    /// Share of draws that are eligible: right number of parts and ARI.
    Eligible,
    /// Share of eligible draws whose tree is right.
    Tree,
    /// Share of simulations in which the tree of the draw of highest log posterior is right (an extension).
    BestTree,
}

impl Measure {
    const ALL: [Self; 5] = [Self::Parts, Self::Ari, Self::Eligible, Self::Tree, Self::BestTree];

    /// Whether it is a rate of ones among ones and zeros.
    fn is_rate(self) -> bool {
        !matches!(self, Self::Parts | Self::Ari)
    }

    fn of(self, record: &Record) -> Option<f64> {
        let one = |holds: bool| f64::from(u8::from(holds));
        match self {
            Self::Parts => Some(record.parts as f64),
            Self::Ari => Some(record.ari),
            Self::Eligible => Some(one(record.eligible)),
            Self::Tree => record.eligible.then(|| one(record.tree_correct)),
            Self::BestTree => Some(one(record.tree_correct)),
        }
    }
}

/// A measure of a condition under one value of a setting: a row of `sensitivity.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The part of the study; [`DEFAULT`] for the default.
    pub part: String,
    /// The value; empty for the default.
    pub value: String,
    /// p.
    pub coordination: f64,
    /// d.
    pub dimension: usize,
    /// The mixture.
    pub model: Model,
    /// What is measured.
    pub measure: Measure,
    /// The mean or rate.
    pub estimate: Option<f64>,
    /// Samples that it is over.
    pub n: usize,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of its 95 % interval.
    pub high: Option<f64>,
    /// Simulations with a sample.
    pub simulations: usize,
    /// Lowest value of a single simulation.
    pub lowest: Option<f64>,
    /// Highest value of a single simulation.
    pub highest: Option<f64>,
    /// The mean or rate minus the default's.
    pub difference: Option<f64>,
    /// Lower end of the difference's 95 % interval.
    pub difference_low: Option<f64>,
    /// Upper end of the difference's 95 % interval.
    pub difference_high: Option<f64>,
    /// Simulations that failed, as by unstable movement.
    pub failed: usize,
    /// The first failure's reason.
    pub failure: String,
}

/// The part of the study that is the default itself.
pub const DEFAULT: &str = "default";

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, or two parts share a name.
    pub fn parse(text: &str, origin: &str) -> Result<Self, StudyError> {
        let design: Self =
            toml::from_str(text).map_err(|error| StudyError::design(origin, &error.to_string()))?;
        let paper = design.defaults()?;
        let mut names = HashSet::from([DEFAULT]);
        for part in &design.part {
            let plain = |name: &str| {
                !name.is_empty()
                    && name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'-')
            };
            if !plain(&part.name) || !names.insert(&part.name) {
                let message =
                    format!("`{}` is no name of a part: letters, digits and -, each once", part.name);
                return Err(StudyError::design(origin, &message));
            }
            let mut values = HashSet::new();
            if !part.values.iter().all(|value| values.insert(label(value))) {
                return Err(StudyError::design(origin, &format!("part `{}` has a value twice", part.name)));
            }
            if let Some(key) = part.settings.iter().find(|key| default_value(&paper, key).is_none()) {
                let message = format!("part `{}` names `{key}`, which is no setting", part.name);
                return Err(StudyError::design(origin, &message));
            }
        }
        Ok(design)
    }

    /// The same with one part alone.
    ///
    /// # Errors
    /// If there is no such part.
    pub fn only(self, name: &str, origin: &str) -> Result<Self, StudyError> {
        let names: Vec<String> = self.part.iter().map(|part| part.name.clone()).collect();
        let part: Vec<Part> = self.part.into_iter().filter(|part| part.name == name).collect();
        if part.is_empty() {
            return Err(StudyError::design(
                origin,
                &format!("has no part `{name}`; it has {}", names.join(", ")),
            ));
        }
        Ok(Self { part, ..self })
    }

    fn configure(&self, name: &str, value: &Table) -> Result<Settings, StudyError> {
        let origin = format!("the study's {name}");
        let mut settings = Settings::overlaid([&self.settings, value], &origin)?;
        settings.experiment.seed = self.seed;
        Ok(settings)
    }

    /// The settings of the default as the study runs it.
    ///
    /// # Errors
    /// If the design's settings cannot be used.
    pub fn defaults(&self) -> Result<Settings, StudyError> {
        self.configure(DEFAULT, &Table::new())
    }

    /// The part and the value of each configuration, the default's first, and its settings.
    ///
    /// # Errors
    /// If the settings of one cannot be used.
    pub fn configurations(&self) -> Result<Vec<([String; 2], Settings)>, StudyError> {
        let mut all = vec![([DEFAULT.to_owned(), String::new()], self.defaults()?)];
        for part in &self.part {
            for value in &part.values {
                let place = [part.name.clone(), label(value)];
                let settings = self.configure(&place.join(": "), value)?;
                all.push((place, settings));
            }
        }
        Ok(all)
    }

    /// How each configuration is run, in words.
    pub fn summary(&self) -> String {
        format!("{}, seed {}", flat(&self.settings).join(", "), self.seed)
    }
}

/// What a table calls a value: its settings without their sections.
pub fn label(value: &Table) -> String {
    let short = |line: String| line.split_once('.').map_or(line.clone(), |(_, short)| short.to_owned());
    flat(value).into_iter().map(short).collect::<Vec<_>>().join(", ")
}

/// The default of a setting `section.key`, as settings files write it.
pub fn default_value(settings: &Settings, key: &str) -> Option<String> {
    let all = serde_json::to_value(settings).expect("settings are plain data");
    let (section, name) = key.split_once('.')?;
    Some(all.get(section)?.get(name)?.to_string().replace('"', ""))
}

/// Runs a study, and writes into `out`: sensitivity.csv, design.toml, and what [`redraw`] makes of them.
///
/// # Errors
/// If a value's settings cannot be used, or a file cannot be written.
pub fn study(design: &Design, text: &str, out: &Path) -> Result<(), StudyError> {
    let (places, configurations): (Vec<_>, Vec<_>) = design.configurations()?.into_iter().unzip();
    let outcomes = run(&configurations, out, "sensitivity")?;
    let mut of_default = None;
    let mut rows = Vec::new();
    for (([part, value], settings), outcome) in places.iter().zip(&configurations).zip(&outcomes) {
        let counted = Counted::new(settings, outcome);
        let default = of_default.get_or_insert_with(|| counted.clone());
        rows.extend(counted.rows(part, value, outcome, default));
    }
    tables::write_rows(&out.join(TABLE), &rows)?;
    write_text(&out.join(COPY), text)?;
    write_manifest(out, "sensitivity", design.seed, &[TABLE, COPY])?;
    redraw(out)?;
    Ok(())
}

/// Whether a folder holds a finished study.
pub fn is_study(folder: &Path) -> bool {
    folder.join(TABLE).exists()
}

/// Makes DEVIATIONS.md and the pictures of a study again, from its table and design alone.
///
/// # Errors
/// If they are not what a study wrote, or a file cannot be written.
pub fn redraw(folder: &Path) -> Result<Vec<String>, StudyError> {
    let path = folder.join(COPY);
    let text = read_text(&path)?;
    let mut design = Design::parse(&text, &path.display().to_string())?;
    let rows: Vec<Row> = tables::read_rows(&folder.join(TABLE))?;
    // A study of some parts alone.
    design.part.retain(|part| rows.iter().any(|row| row.part == part.name));
    let table = deviations::Table::new(&design, &rows);
    write_text(&folder.join("DEVIATIONS.md"), &table.page(&revision(folder)?))?;
    let columns = deviations::columns();
    let mut written = Vec::new();
    for part in &design.part {
        let name = format!("figures/{}.svg", part.name);
        let picture = plot::effects::draw(&columns, &table.lines(&part.name));
        let picture = picture.map_err(|trouble| FileError::new(&folder.join(TABLE), trouble.0))?;
        write_text(&folder.join(&name), &picture)?;
        written.push(name);
    }
    Ok(written)
}

/// The revision of the program that made a study, which may not be this one.
fn revision(folder: &Path) -> Result<String, FileError> {
    let manifest = read_manifest(&folder.join("manifest.json"))?;
    Ok(one_line(manifest["revision"].as_str().unwrap_or("unknown")))
}

/// A configuration's draws by condition.
#[derive(Clone)]
struct Counted {
    all: Conditions,
    best: Conditions,
}

impl Counted {
    fn new(settings: &Settings, outcome: &Outcome) -> Self {
        let all = outcome.conditions(settings, |_| true);
        Self { best: all.best(), all }
    }

    /// Values of a measure of a condition, by simulation.
    fn groups(&self, measure: Measure, condition: Condition) -> Vec<Vec<f64>> {
        let of = if measure == Measure::BestTree { &self.best } else { &self.all };
        of.by_simulation(condition, |record| measure.of(record))
    }

    fn rows(&self, part: &str, value: &str, outcome: &Outcome, default: &Self) -> Vec<Row> {
        let mut rows = Vec::new();
        // Of the default's conditions: a configuration that fails has none itself.
        for condition in default.all.all() {
            let failures = outcome.failures.iter();
            let failures: Vec<_> =
                failures.filter(|failure| failure.coordination == condition.coordination).collect();
            for measure in Measure::ALL {
                let (groups, defaults) =
                    (self.groups(measure, condition), default.groups(measure, condition));
                let found = match measure {
                    Measure::Ari => self.all.mean_ari(condition),
                    _ if measure.is_rate() => self.all.rate(&groups),
                    _ => self.all.mean(&groups),
                };
                let moved = match value {
                    "" => Estimate::default(),
                    _ => self.all.difference(&defaults, &groups, measure.is_rate()),
                };
                let ((low, high), (lowest, highest)) = (found.interval.unzip(), found.spread.unzip());
                let (difference_low, difference_high) = moved.interval.unzip();
                rows.push(Row {
                    part: part.to_owned(),
                    value: value.to_owned(),
                    coordination: condition.coordination,
                    dimension: condition.dimension,
                    model: condition.model,
                    measure,
                    estimate: found.value,
                    n: found.n,
                    low,
                    high,
                    simulations: found.simulations,
                    lowest,
                    highest,
                    difference: moved.value,
                    difference_low,
                    difference_high,
                    failed: failures.len(),
                    failure: failures.first().map_or(String::new(), |failure| failure.reason.clone()),
                });
            }
        }
        rows
    }
}
