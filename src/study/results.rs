//! The tables of a study: what each configuration is, and each claim's value by it.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::design::{COLUMNS, Design, JudgedClaim, Section};
use super::measures::{MeasureRow, Measured};
use super::outcome::Outcome;
use super::plan::{Configuration, plan};
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::{Verdict, judge_claim};
use crate::analysis::measure::Evidence;
use crate::analysis::paired::change;
use crate::analysis::published::{Claim, Experiment, claims};
use crate::files::tables::read_rows;
use crate::files::{FileError, result_folder::ResultFolder};
use crate::pipeline::Condition;
use crate::stages::schema::{Keep, Model};

const CONFIGURATIONS: &str = "configurations.csv";
const CLAIMS: &str = "study.csv";
const MEASURES: &str = "measures.csv";
const HEADLINE_SAMPLES: &str = "headline.csv";

/// What a configuration is, and whether the physics step resolves it: a row of `configurations.csv`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ConfigurationRow {
    /// Its number, from 1.
    pub number: usize,
    /// Its name.
    pub name: String,
    /// The movement, the matrix of distances and the body maps that it shares with others, from 1.
    pub shared_stages: [usize; 3],
    /// Whether the physics step resolves all its movements.
    pub resolved: bool,
    /// Largest distance between two ends of a joint, m.
    pub anchor_separation: f64,
    /// Largest turn of a part in a step, revolutions.
    pub turn: f64,
    /// Movements that failed.
    pub failed: usize,
    /// The first failure's reason.
    pub failure: String,
    /// What it has instead of the base's values.
    pub settings: String,
    /// The label of the option of each factor of the design; empty where it has the base's value.
    pub labels: Vec<String>,
}

/// A claim by a configuration: a row of `study.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct ClaimRow {
    /// Number of the configuration.
    pub configuration: usize,
    /// Its name.
    pub name: String,
    /// Short name of the claim.
    pub claim: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// Lower end of the range that counts as reproduced.
    pub accepted_low: f64,
    /// Upper end of that range.
    pub accepted_high: f64,
    /// The value; of several, that which lies farthest towards the outside of the range.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// Where it was found.
    pub found: String,
    /// Whether it is in the range.
    pub verdict: Verdict,
    /// The value minus that of the first configuration, paired by simulation.
    pub change: Option<f64>,
    /// Lower end of the change's 95 % interval.
    pub change_low: Option<f64>,
    /// Upper end of the change's 95 % interval.
    pub change_high: Option<f64>,
}

/// The samples of a simulation at the condition of the headline: a row of `headline.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct HeadlineRow {
    /// Number of the configuration.
    pub configuration: usize,
    /// The simulation, from 1.
    pub simulation: usize,
    /// Eligible samples.
    pub eligible: usize,
    /// Those whose tree is right.
    pub right: usize,
}

/// What a study gave.
pub(super) struct Results {
    /// Its design.
    pub design: Design,
    /// Revision of the program that ran it.
    pub revision: String,
    /// Number of configurations of the design, of which these may be a part.
    pub planned: usize,
    /// Its configurations.
    pub configurations: Vec<ConfigurationRow>,
    /// By configuration, then in the order of the design's claims.
    pub claims: Vec<ClaimRow>,
    /// By configuration, condition and measure; only where the page has a section of factors.
    pub measures: Vec<MeasureRow>,
    /// By configuration and simulation; only where the page has a section of shares.
    pub headline: Vec<HeadlineRow>,
}

/// Fills [`Results`] with one outcome after the other.
pub(super) struct Gathering {
    results: Results,
    published: Vec<Claim>,
    /// The first configuration: its evidence by experiment, and its measures.
    first: Option<(BTreeMap<Experiment, Evidence>, Measured)>,
}

impl Gathering {
    /// Of a design, by this program.
    pub(super) fn new(design: Design) -> Self {
        let results = Results::empty(design, env!("BODYSCHEMA_REVISION").to_owned());
        Self { results, published: claims(), first: None }
    }

    /// Adds what a configuration gave; the first that is added is that from which changes are measured.
    pub(super) fn add(&mut self, configuration: &Configuration, outcome: &Outcome) {
        let evidence: BTreeMap<Experiment, Evidence> = [Experiment::Exp1, Experiment::Exp2]
            .map(|experiment| (experiment, outcome.evidence(experiment, &configuration.settings)))
            .into();
        let measured = Measured::new(configuration, outcome);
        let Self { results, published, first } = self;
        let base = first.as_ref();
        let changes = results.design.has(Section::Changes);
        for judged in &results.design.claims {
            let claim = judged.find(published).expect("the design was checked");
            let first = base.filter(|_| changes).map(|(evidence, _)| &evidence[&judged.experiment]);
            let row = claim_row(configuration, judged, claim, &evidence[&judged.experiment], first);
            // Why there is no value.
            let found = outcome.failures.first().map_or(row.found, |failure| failure.reason.clone());
            results.claims.push(ClaimRow { found, ..row });
        }
        if results.design.has(Section::Factors) {
            let first = base.map_or(&measured, |(_, measured)| measured);
            results.measures.extend(measured.rows(configuration.number, outcome, first));
        }
        if results.design.has(Section::Shares) {
            results.headline.extend(headline(configuration, outcome));
        }
        results.configurations.push(ConfigurationRow::of(configuration, outcome));
        first.get_or_insert((evidence, measured));
    }

    /// All that was added.
    pub(super) fn finish(self) -> Results {
        self.results
    }
}

fn claim_row(
    configuration: &Configuration,
    judged: &JudgedClaim,
    claim: &Claim,
    own: &Evidence,
    first: Option<&Evidence>,
) -> ClaimRow {
    let (found, place, verdict) = judge_claim(claim, own);
    let change = first.and_then(|first| change(claim, first, own, configuration.settings.experiment.seed));
    let (change, ends) = change.unzip();
    let (change_low, change_high) = ends.flatten().unzip();
    let (accepted_low, accepted_high) = claim.accept.expect("the design was checked");
    ClaimRow {
        configuration: configuration.number,
        name: configuration.name.clone(),
        claim: claim.id.clone(),
        experiment: judged.experiment,
        accepted_low,
        accepted_high,
        value: found.value,
        cells: (&found).into(),
        found: place,
        verdict,
        change,
        change_low,
        change_high,
    }
}

/// Right trees and eligible samples of each simulation at the condition of the headline; none where a chain keeps all its samples,
/// which are not independent.
fn headline(configuration: &Configuration, outcome: &Outcome) -> Vec<HeadlineRow> {
    let settings = &configuration.settings;
    if settings.schema.keep == Keep::All || !outcome.failures.is_empty() {
        return Vec::new();
    }
    let conditions = outcome.conditions(settings, |_| true);
    let (coordination, dimension) = (settings.motion.coordination, settings.experiment.dimension);
    let trees = conditions.trees(Condition { model: Model::DpgmmLj, coordination, dimension });
    let row = |(at, trees): (usize, Vec<f64>)| HeadlineRow {
        configuration: configuration.number,
        simulation: at + 1,
        eligible: trees.len(),
        right: trees.iter().filter(|right| **right == 1.0).count(),
    };
    trees.into_iter().enumerate().map(row).collect()
}

impl ConfigurationRow {
    fn of(configuration: &Configuration, outcome: &Outcome) -> Self {
        let Configuration { number, name, shared_stages: shared, labels, .. } = configuration;
        Self {
            number: *number,
            name: name.clone(),
            shared_stages: [shared.movement, shared.distances, shared.maps],
            resolved: outcome.is_resolved(),
            anchor_separation: outcome.resolution.anchor_separation,
            turn: outcome.resolution.turn,
            failed: outcome.failures.len(),
            failure: outcome.first_reason(),
            settings: configuration.in_a_line(),
            labels: labels.clone(),
        }
    }

    /// A row of the table, with a column for each factor of the design.
    fn cells(&self, design: &Design) -> Map<String, Value> {
        let [movement, distances, maps] = self.shared_stages;
        let fixed: [Value; COLUMNS.len()] = [
            self.number.into(),
            self.name.as_str().into(),
            movement.into(),
            distances.into(),
            maps.into(),
            self.resolved.into(),
            self.anchor_separation.into(),
            self.turn.into(),
            self.failed.into(),
            self.failure.as_str().into(),
            self.settings.as_str().into(),
        ];
        let factors = design
            .factors
            .iter()
            .map(|factor| factor.name.as_str())
            .zip(self.labels.iter().map(|label| label.as_str().into()));
        COLUMNS.into_iter().zip(fixed).chain(factors).map(|(name, value)| (name.to_owned(), value)).collect()
    }

    /// The same from the cells; `None` if they are not such a row.
    fn from_cells(mut cells: HashMap<String, String>, design: &Design) -> Option<Self> {
        let labels = design.factors.iter().map(|factor| cells.remove(&factor.name)).collect::<Option<_>>()?;
        let number = |name: &str| cells.get(name)?.parse::<f64>().ok();
        let [own, movement, distances, maps, failed] =
            ["configuration", "movement", "distances", "maps", "failed"]
                .map(|name| number(name).map(|count| count as usize));
        let (anchor_separation, turn) = (number("anchor_separation_m")?, number("turn")?);
        Some(Self {
            number: own?,
            shared_stages: [movement?, distances?, maps?],
            failed: failed?,
            anchor_separation,
            turn,
            resolved: cells.get("resolved")? == "true",
            name: cells.remove("name")?,
            failure: cells.remove("failure")?,
            settings: cells.remove("settings")?,
            labels,
        })
    }
}

impl Results {
    /// Writes the tables.
    ///
    /// # Errors
    /// If one cannot be written.
    pub(super) fn write(&self, folder: &mut ResultFolder) -> Result<(), FileError> {
        folder.write_rows(CONFIGURATIONS, self.configurations.iter().map(|row| row.cells(&self.design)))?;
        folder.write_rows(CLAIMS, &self.claims)?;
        if self.design.has(Section::Factors) {
            folder.write_rows(MEASURES, &self.measures)?;
        }
        if self.design.has(Section::Shares) {
            folder.write_rows(HEADLINE_SAMPLES, &self.headline)?;
        }
        Ok(())
    }

    /// Whether a folder has the tables of a study.
    pub(super) fn are_in(folder: &Path) -> bool {
        [CONFIGURATIONS, CLAIMS].iter().all(|name| folder.join(name).is_file())
    }

    /// Numbers of the configurations whose tables are in a folder.
    ///
    /// # Errors
    /// If the table cannot be read.
    pub(super) fn numbers_in(folder: &Path) -> Result<Vec<usize>, FileError> {
        let path = folder.join(CONFIGURATIONS);
        let rows: Vec<HashMap<String, String>> = read_rows(&path)?;
        let number = |row: &HashMap<String, String>| row.get("configuration")?.parse().ok();
        let numbers: Option<Vec<usize>> = rows.iter().map(number).collect();
        numbers.ok_or_else(|| FileError::new(&path, "is not a table of configurations".to_owned()))
    }

    /// Reads the tables that [`Results::write`] wrote.
    ///
    /// # Errors
    /// If one cannot be read or is not of this design.
    pub(super) fn read(folder: &Path, design: Design, revision: String) -> Result<Self, FileError> {
        let path = folder.join(CONFIGURATIONS);
        let rows: Vec<HashMap<String, String>> = read_rows(&path)?;
        let configurations: Option<Vec<_>> =
            rows.into_iter().map(|cells| ConfigurationRow::from_cells(cells, &design)).collect();
        let configurations = configurations
            .filter(|all| !all.is_empty())
            .ok_or_else(|| FileError::new(&path, "is not of the design beside it".to_owned()))?;
        let claims: Vec<ClaimRow> = read_rows(&folder.join(CLAIMS))?;
        let expected = configurations
            .iter()
            .flat_map(|one| design.claims.iter().map(move |claim| (one.number, &claim.id)));
        if !claims.iter().map(|row| (row.configuration, &row.claim)).eq(expected) {
            return Err(FileError::new(&folder.join(CLAIMS), "is not of the design beside it".to_owned()));
        }
        let measures =
            if design.has(Section::Factors) { read_rows(&folder.join(MEASURES))? } else { Vec::new() };
        let headline =
            if design.has(Section::Shares) { read_rows(&folder.join(HEADLINE_SAMPLES))? } else { Vec::new() };
        Ok(Self { configurations, claims, measures, headline, ..Self::empty(design, revision) })
    }

    /// Those of several parts together, by number; `None` without any, or if two parts have the same configuration.
    pub(super) fn joined(design: Design, mut parts: Vec<Self>, revision: String) -> Option<Self> {
        parts.sort_by_key(|part| part.configurations[0].number);
        let mut all = Self::empty(design, revision);
        for part in parts {
            all.configurations.extend(part.configurations);
            all.claims.extend(part.claims);
            all.measures.extend(part.measures);
            all.headline.extend(part.headline);
        }
        let rising = all.configurations.is_sorted_by(|one, next| one.number < next.number);
        (rising && !all.configurations.is_empty()).then_some(all)
    }

    fn empty(design: Design, revision: String) -> Self {
        let planned = plan(&design).map_or(0, |all| all.len());
        let (configurations, claims, measures, headline) = Default::default();
        Self { design, revision, planned, configurations, claims, measures, headline }
    }

    /// The claims of a configuration, by its place in the table, in the order of the design.
    pub(super) fn claims_of(&self, place: usize) -> &[ClaimRow] {
        let count = self.design.claims.len();
        &self.claims[place * count..(place + 1) * count]
    }
}
