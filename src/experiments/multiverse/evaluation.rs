//! Evaluate a multiverse: in what share of it each claim holds, what decides, and how it would look if the published rate
//! were true.

use serde::Serialize;

use super::super::draws::Level;
use super::design::{Design, Factor};
use super::specification::Specification;
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Claim, HEADLINE, claims};
use crate::analysis::shares::{Held, JointInference, Rate, joint_inference, share};
use crate::analysis::variance::{Source, Table};
use crate::numerics::rng::stream;
use crate::report::plot::specifications::{Choices, Curve, Point};

/// A row of shares.csv: in what share of a group of specifications a claim holds.
#[derive(Debug, Clone, Serialize)]
pub struct ShareRow {
    /// The group.
    pub group: String,
    /// Short name of the claim, or `all together`.
    pub claim: String,
    /// Number of specifications.
    pub n: usize,
    /// Those that have a value: of all claims together, a value of each.
    pub with_value: usize,
    /// Those in which it holds.
    pub holds: usize,
    /// Their share of `n`.
    pub share: Option<f64>,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of it.
    pub high: Option<f64>,
}

/// A row of variance.csv: the share of a claim's variance that a choice decides, or two together.
#[derive(Debug, Clone, Serialize)]
pub struct VarianceRow {
    /// Short name of the claim.
    pub claim: String,
    /// The factor, or the first of a pair.
    pub factor: String,
    /// The second of a pair.
    pub with: String,
    /// Number of specifications that have a value.
    pub n: usize,
    /// ω².
    pub share: Option<f64>,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of it.
    pub high: Option<f64>,
}

/// What a multiverse says.
pub struct Evaluation<'a> {
    /// Its design.
    pub design: &'a Design,
    /// All specifications.
    pub all: &'a [Specification],
    /// Of each claim of the design, in its order.
    pub claims: Vec<Claim>,
    /// Of each group and claim.
    pub shares: Vec<ShareRow>,
    /// Of each claim, factor and pair.
    pub variance: Vec<VarianceRow>,
    /// Of the headline, where the design judges it.
    pub joint: Option<JointInference>,
}

/// Name of all claims together.
pub const TOGETHER: &str = "all together";

impl<'a> Evaluation<'a> {
    /// Evaluates all specifications.
    pub fn new(design: &'a Design, all: &'a [Specification]) -> Self {
        let published = claims();
        let found =
            design.claims.iter().map(|compared| compared.find(&published).expect("it was checked").clone());
        let mut evaluation = Self {
            design,
            all,
            claims: found.collect(),
            shares: Vec::new(),
            variance: Vec::new(),
            joint: None,
        };
        evaluation.shares = evaluation.all_shares();
        evaluation.variance = evaluation.all_variance();
        evaluation.joint = evaluation.joint_inference();
        evaluation
    }

    /// Named groups of specifications: all, the resolved ones, and those with each option of the factors that the design
    /// groups by.
    pub fn groups(&self) -> Vec<(String, Vec<&'a Specification>)> {
        let some = |keep: &dyn Fn(&&Specification) -> bool| self.all.iter().filter(keep).collect::<Vec<_>>();
        let mut groups = vec![
            ("all".to_owned(), some(&|_| true)),
            ("resolved".to_owned(), some(&|one| one.summary.resolved)),
        ];
        for factor in self.design.factors.iter().filter(|factor| self.design.groups.contains(&factor.name)) {
            for option in &factor.options {
                let own = some(&|one| one.label(&factor.name) == option.label && one.summary.resolved);
                groups.push((format!("resolved, {}", option.label), own));
            }
        }
        groups
    }

    fn all_shares(&self) -> Vec<ShareRow> {
        let mut rows = Vec::new();
        for (group, members) in self.groups() {
            let row = |claim: &str, verdicts: &dyn Fn(&Specification) -> Option<bool>| {
                let found: Vec<Option<bool>> = members.iter().map(|one| verdicts(one)).collect();
                let held = members
                    .iter()
                    .zip(&found)
                    .map(|(one, holds)| Held { movement: one.summary.movement, holds: *holds == Some(true) });
                let held: Vec<Held> = held.collect();
                let share = share(&held, &mut stream(self.design.seed, 0, "shares", 0));
                let (low, high) = share.interval.unzip();
                ShareRow {
                    group: group.clone(),
                    claim: claim.to_owned(),
                    n: held.len(),
                    with_value: found.iter().flatten().count(),
                    holds: held.iter().filter(|one| one.holds).count(),
                    share: share.value,
                    low,
                    high,
                }
            };
            for (at, compared) in self.design.claims.iter().enumerate() {
                rows.push(row(&compared.id, &|one| holds(one, at)));
            }
            rows.push(row(TOGETHER, &|one| {
                (0..one.rows.len()).try_fold(true, |all, at| holds(one, at).map(|one| all && one))
            }));
        }
        rows
    }

    fn all_variance(&self) -> Vec<VarianceRow> {
        let factors = self.varied();
        let mut rows = Vec::new();
        for (at, compared) in self.design.claims.iter().enumerate() {
            let with: Vec<&Specification> =
                self.all.iter().filter(|one| one.rows[at].value.is_some()).collect();
            let unit = |factor: &&Factor| -> Vec<usize> {
                let unit = |(place, one): (usize, &&Specification)| match factor.decides {
                    Level::Movement => one.summary.movement,
                    Level::Distances => one.summary.distances,
                    Level::Map => one.summary.maps,
                    Level::Inference => place,
                };
                with.iter().enumerate().map(unit).collect()
            };
            let table = Table {
                values: with.iter().filter_map(|one| one.rows[at].value).collect(),
                clusters: with.iter().map(|one| one.summary.movement).collect(),
                units: factors.iter().map(unit).collect(),
                levels: factors
                    .iter()
                    .map(|factor| with.iter().map(|one| option_of(factor, one)).collect())
                    .collect(),
            };
            for (source, share) in table.shares() {
                let (factor, other) = match source {
                    Source::Factor(one) => (factors[one].name.clone(), String::new()),
                    Source::Pair(one, other) => (factors[one].name.clone(), factors[other].name.clone()),
                };
                let (low, high) = share.interval.unzip();
                let (claim, n) = (compared.id.clone(), share.n);
                rows.push(VarianceRow { claim, factor, with: other, n, share: share.value, low, high });
            }
        }
        rows
    }

    /// The factors that have a choice.
    fn varied(&self) -> Vec<&'a Factor> {
        self.design.factors.iter().filter(|factor| factor.options.len() > 1).collect()
    }

    fn joint_inference(&self) -> Option<JointInference> {
        let at = self.design.claims.iter().position(|compared| compared.id == HEADLINE)?;
        let claim = &self.claims[at];
        let rate = |one: &Specification| Rate {
            movement: one.summary.movement,
            bodies: one.summary.headline.iter().map(|&[right, eligible]| (right, eligible)).collect(),
        };
        let rates: Vec<Rate> = self.all.iter().map(rate).filter(|rate| rate.draws() > 0).collect();
        joint_inference(&rates, claim.published?, claim.accept?, &mut stream(self.design.seed, 0, "joint", 0))
    }

    /// The specification curve of a claim.
    pub fn curve(&self, at: usize) -> Curve {
        let claim = &self.claims[at];
        let mut with: Vec<&Specification> =
            self.all.iter().filter(|one| one.rows[at].value.is_some()).collect();
        with.sort_by(|a, b| {
            let value = |one: &Specification| one.rows[at].value.unwrap_or_default();
            value(a).total_cmp(&value(b)).then(a.summary.number.cmp(&b.summary.number))
        });
        let point = |one: &&Specification| Point {
            value: one.rows[at].value.unwrap_or_default(),
            interval: one.rows[at].cells.low.zip(one.rows[at].cells.high),
        };
        let choices = |factor: &&Factor| Choices {
            factor: factor.name.clone(),
            options: factor.options.iter().map(|option| option.label.clone()).collect(),
            chosen: with.iter().map(|one| option_of(factor, one)).collect(),
        };
        Curve {
            title: self.design.claims[at].label.replace('\n', " "),
            unit: claim.measure.unit(),
            published: claim.published,
            accepted: claim.accept.expect("it was checked"),
            points: with.iter().map(point).collect(),
            choices: self.varied().iter().map(choices).collect(),
        }
    }
}

/// The option of a factor that a specification has, by its place.
fn option_of(factor: &Factor, one: &Specification) -> usize {
    let label = one.label(&factor.name);
    factor.options.iter().position(|option| option.label == label).unwrap_or_default()
}

/// Whether a claim holds in a specification; `None` without a value.
fn holds(one: &Specification, at: usize) -> Option<bool> {
    match one.rows[at].verdict {
        Verdict::Reproduced => Some(true),
        Verdict::NotReproduced => Some(false),
        Verdict::NotTestable => None,
    }
}
