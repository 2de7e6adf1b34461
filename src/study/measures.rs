//! Measure parts and tree of each condition, and how far they are from the first configuration's.

use serde::{Deserialize, Serialize};

use super::outcome::Outcome;
use super::plan::Configuration;
use crate::analysis::cells::EstimateCells;
use crate::analysis::conditions::Conditions;
use crate::analysis::statistics::Estimate;
use crate::pipeline::{Condition, Record};
use crate::stages::schema::Model;

/// What is measured of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Measure {
    /// Mean number of estimated parts.
    Parts,
    /// Mean adjusted Rand index.
    Ari,
    /// Share of samples that are eligible: right number of parts and ARI.
    Eligible,
    /// Share of eligible samples whose tree is right.
    Tree,
    /// Share of simulations in which the tree of the sample of highest log posterior is right (an extension).
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

/// A measure of a condition by a configuration: a row of `measures.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct MeasureRow {
    /// Number of the configuration.
    pub configuration: usize,
    /// p.
    pub coordination: f64,
    /// d.
    pub dimension: usize,
    /// The mixture.
    pub model: Model,
    /// What is measured.
    pub measure: Measure,
    /// The mean or rate.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// The mean or rate minus the first configuration's.
    pub change: Option<f64>,
    /// Lower end of the change's 95 % interval.
    pub change_low: Option<f64>,
    /// Upper end of the change's 95 % interval.
    pub change_high: Option<f64>,
    /// Simulations of this p that failed, as by unstable movement.
    pub failed: usize,
    /// The first failure's reason.
    pub failure: String,
}

/// A configuration's samples by condition.
pub(super) struct Measured {
    all: Conditions,
    best: Conditions,
}

impl Measured {
    /// Of what a configuration gave.
    pub(super) fn new(configuration: &Configuration, outcome: &Outcome) -> Self {
        let all = outcome.conditions(&configuration.settings, |_| true);
        Self { best: all.best(), all }
    }

    /// A row for each condition of the first configuration and each measure. A configuration that fails has no conditions
    /// itself.
    pub(super) fn rows(&self, number: usize, outcome: &Outcome, first: &Self) -> Vec<MeasureRow> {
        let mut rows = Vec::new();
        for condition in first.all.all() {
            let failures = outcome.failures.iter();
            let failures: Vec<_> =
                failures.filter(|failure| failure.coordination == condition.coordination).collect();
            for measure in Measure::ALL {
                let found = self.estimate(measure, condition);
                let change =
                    if number == 1 { Estimate::default() } else { self.change(measure, condition, first) };
                let (change_low, change_high) = change.interval.unzip();
                rows.push(MeasureRow {
                    configuration: number,
                    coordination: condition.coordination,
                    dimension: condition.dimension,
                    model: condition.model,
                    measure,
                    value: found.value,
                    cells: (&found).into(),
                    change: change.value,
                    change_low,
                    change_high,
                    failed: failures.len(),
                    failure: failures.first().map_or(String::new(), |failure| failure.reason.clone()),
                });
            }
        }
        rows
    }

    /// Values of a measure of a condition, by simulation.
    fn groups(&self, measure: Measure, condition: Condition) -> Vec<Vec<f64>> {
        let of = if measure == Measure::BestTree { &self.best } else { &self.all };
        of.by_simulation(condition, |record| measure.of(record))
    }

    fn estimate(&self, measure: Measure, condition: Condition) -> Estimate {
        let groups = self.groups(measure, condition);
        match measure {
            Measure::Ari => self.all.mean_ari(condition),
            _ if measure.is_rate() => self.all.rate(&groups),
            _ => self.all.mean(&groups),
        }
    }

    /// How far a measure is from the first configuration's.
    fn change(&self, measure: Measure, condition: Condition, first: &Self) -> Estimate {
        let (groups, firsts) = (self.groups(measure, condition), first.groups(measure, condition));
        self.all.difference(&firsts, &groups, measure.is_rate())
    }
}
