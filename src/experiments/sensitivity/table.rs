//! Measure what each value of an open setting gives, in a row for each condition and measure.

use serde::{Deserialize, Serialize};

use super::super::configurations::Outcome;
use crate::analysis::cells::EstimateCells;
use crate::analysis::conditions::Conditions;
use crate::analysis::statistics::Estimate;
use crate::pipeline::{Condition, Record};
use crate::settings::Settings;
use crate::stages::schema::Model;

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
    pub const ALL: [Self; 5] = [Self::Parts, Self::Ari, Self::Eligible, Self::Tree, Self::BestTree];

    /// Whether it is a rate of ones among ones and zeros.
    pub fn is_rate(self) -> bool {
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
    /// The factor; [`DEFAULT`](super::design::DEFAULT) for the default.
    #[serde(rename = "part")]
    pub factor: String,
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
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
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

/// A configuration's draws by condition.
#[derive(Clone)]
pub struct Counted {
    all: Conditions,
    best: Conditions,
}

impl Counted {
    /// Of what a configuration gave.
    pub fn new(settings: &Settings, outcome: &Outcome) -> Self {
        let all = outcome.conditions(settings, |_| true);
        Self { best: all.best(), all }
    }

    /// Values of a measure of a condition, by simulation.
    fn groups(&self, measure: Measure, condition: Condition) -> Vec<Vec<f64>> {
        let of = if measure == Measure::BestTree { &self.best } else { &self.all };
        of.by_simulation(condition, |record| measure.of(record))
    }

    /// A row for each condition of the default and each measure. A configuration that fails has no conditions itself.
    pub fn rows(&self, [factor, value]: &[String; 2], outcome: &Outcome, default: &Self) -> Vec<Row> {
        let mut rows = Vec::new();
        for condition in default.all.all() {
            let failures = outcome.failures.iter();
            let failures: Vec<_> =
                failures.filter(|failure| failure.coordination == condition.coordination).collect();
            for measure in Measure::ALL {
                let found = self.estimate(measure, condition);
                let moved = if value.is_empty() {
                    Estimate::default()
                } else {
                    self.moved(measure, condition, default)
                };
                let (difference_low, difference_high) = moved.interval.unzip();
                rows.push(Row {
                    factor: factor.clone(),
                    value: value.clone(),
                    coordination: condition.coordination,
                    dimension: condition.dimension,
                    model: condition.model,
                    measure,
                    estimate: found.value,
                    cells: (&found).into(),
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

    fn estimate(&self, measure: Measure, condition: Condition) -> Estimate {
        let groups = self.groups(measure, condition);
        match measure {
            Measure::Ari => self.all.mean_ari(condition),
            _ if measure.is_rate() => self.all.rate(&groups),
            _ => self.all.mean(&groups),
        }
    }

    /// How far a measure is from the default's.
    fn moved(&self, measure: Measure, condition: Condition, default: &Self) -> Estimate {
        let (groups, defaults) = (self.groups(measure, condition), default.groups(measure, condition));
        self.all.difference(&defaults, &groups, measure.is_rate())
    }
}
