//! Evaluate the configurations of a grid, or those that were drawn, together: in what share of them each claim holds, which factors decide,
//! and how it would look if the published rate were true.

use std::collections::HashMap;

use serde::Serialize;

use super::design::{Design, Factor, Section};
use super::levels::Level;
use super::results::{ClaimRow, ConfigurationRow, Results};
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Claim, HEADLINE, claims};
use crate::analysis::shares::{Held, JointInference, Rate, joint_inference, share};
use crate::analysis::variance::{Source, Table};
use crate::numerics::rng::stream;
use crate::report::plot::specifications::{Choices, Curve, Point};

/// In what share of a group of configurations a claim holds: a row of `shares.csv`.
#[derive(Debug, Clone, Serialize)]
pub(super) struct ShareRow {
    /// The group.
    pub group: String,
    /// Short name of the claim, or `all together`.
    pub claim: String,
    /// Number of configurations.
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

/// The share of a claim's variance that a factor decides, or two together: a row of `variance.csv`.
#[derive(Debug, Clone, Serialize)]
pub(super) struct VarianceRow {
    /// Short name of the claim.
    pub claim: String,
    /// The factor, or the first of a pair.
    pub factor: String,
    /// The second of a pair.
    pub with: String,
    /// Number of configurations that have a value.
    pub n: usize,
    /// ω².
    pub share: Option<f64>,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of it.
    pub high: Option<f64>,
}

/// What all configurations say together.
pub(super) struct Evaluation<'a> {
    /// All results.
    pub results: &'a Results,
    /// Of each claim of the design, in its order.
    pub claims: Vec<Claim>,
    /// Of each group and claim.
    pub shares: Vec<ShareRow>,
    /// Of each claim, factor and pair.
    pub variance: Vec<VarianceRow>,
    /// Of the headline, where the design judges it.
    pub joint: Option<JointInference>,
}

/// A configuration and its claims, in the order of the design.
#[derive(Clone, Copy)]
struct Member<'a> {
    row: &'a ConfigurationRow,
    claims: &'a [ClaimRow],
}

/// Name of all claims together.
pub(super) const TOGETHER: &str = "all together";

impl<'a> Evaluation<'a> {
    /// Whether the page of a design shows any of it.
    pub(super) fn is_asked_for(design: &Design) -> bool {
        [Section::Shares, Section::Variance, Section::Curves].into_iter().any(|section| design.has(section))
    }

    /// Evaluates all configurations.
    pub(super) fn new(results: &'a Results) -> Self {
        let published = claims();
        let design = &results.design;
        let found =
            design.claims.iter().map(|judged| judged.find(&published).expect("it was checked").clone());
        let mut evaluation =
            Self { results, claims: found.collect(), shares: Vec::new(), variance: Vec::new(), joint: None };
        evaluation.shares = evaluation.all_shares();
        if design.has(Section::Variance) {
            evaluation.variance = evaluation.all_variance();
        }
        evaluation.joint = evaluation.joint_inference();
        evaluation
    }

    fn all(&self) -> Vec<Member<'a>> {
        let results = self.results;
        let member = |(place, row)| Member { row, claims: results.claims_of(place) };
        results.configurations.iter().enumerate().map(member).collect()
    }

    /// Names and sizes of the groups that shares are of: all, the resolved ones, and those with each option of the factors that the
    /// design groups by.
    pub(super) fn groups(&self) -> Vec<(String, usize)> {
        self.grouped().into_iter().map(|(name, members)| (name, members.len())).collect()
    }

    fn grouped(&self) -> Vec<(String, Vec<Member<'a>>)> {
        let all = self.all();
        let some =
            |keep: &dyn Fn(&Member) -> bool| all.iter().copied().filter(|one| keep(one)).collect::<Vec<_>>();
        let mut groups =
            vec![("all".to_owned(), some(&|_| true)), ("resolved".to_owned(), some(&|one| one.row.resolved))];
        let design = &self.results.design;
        for (at, factor) in design.factors.iter().enumerate() {
            if !design.groups.contains(&factor.name) {
                continue;
            }
            for option in &factor.options {
                let own = some(&|one| one.row.labels[at] == option.label && one.row.resolved);
                groups.push((format!("resolved, {}", option.label), own));
            }
        }
        groups
    }

    fn all_shares(&self) -> Vec<ShareRow> {
        let design = &self.results.design;
        let mut rows = Vec::new();
        for (group, members) in self.grouped() {
            let row = |claim: &str, verdicts: &dyn Fn(&Member) -> Option<bool>| {
                let found: Vec<Option<bool>> = members.iter().map(verdicts).collect();
                let held = members.iter().zip(&found).map(|(one, holds)| Held {
                    movement: one.row.shared_stages[0],
                    holds: *holds == Some(true),
                });
                let held: Vec<Held> = held.collect();
                let share = share(&held, &mut stream(design.seed, 0, "shares", 0));
                // Movements that were not drawn are no sample of movements.
                let interval = share.interval.filter(|_| design.draws.is_some());
                let (low, high) = interval.unzip();
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
            for (at, judged) in design.claims.iter().enumerate() {
                rows.push(row(&judged.id, &|one| one.holds(at)));
            }
            rows.push(row(TOGETHER, &|one| {
                (0..one.claims.len()).try_fold(true, |all, at| one.holds(at).map(|one| all && one))
            }));
        }
        rows
    }

    fn all_variance(&self) -> Vec<VarianceRow> {
        let factors = self.varied();
        let mut rows = Vec::new();
        for (at, judged) in self.results.design.claims.iter().enumerate() {
            let with = self.with_value(at);
            let unit = |(_, factor): &(usize, &Factor)| -> Vec<usize> {
                let unit = |(place, one): (usize, &Member)| match factor.level {
                    Some(Level::Movement) => one.row.shared_stages[0],
                    Some(Level::Distances) => one.row.shared_stages[1],
                    Some(Level::Map) => one.row.shared_stages[2],
                    Some(Level::Inference | Level::Evaluation) | None => place,
                };
                with.iter().enumerate().map(unit).collect()
            };
            let table = Table {
                values: with.iter().filter_map(|one| one.claims[at].value).collect(),
                clusters: with.iter().map(|one| one.row.shared_stages[0]).collect(),
                units: factors.iter().map(unit).collect(),
                levels: factors
                    .iter()
                    .map(|&(place, factor)| with.iter().map(|one| one.option(place, factor)).collect())
                    .collect(),
            };
            for (source, share) in table.shares() {
                let name = |factor: usize| factors[factor].1.name.clone();
                let (factor, other) = match source {
                    Source::Factor(one) => (name(one), String::new()),
                    Source::Pair(one, other) => (name(one), name(other)),
                };
                let (low, high) = share.interval.unzip();
                let (claim, n) = (judged.id.clone(), share.n);
                rows.push(VarianceRow { claim, factor, with: other, n, share: share.value, low, high });
            }
        }
        rows
    }

    /// The factors that have a choice, with their places in the design.
    fn varied(&self) -> Vec<(usize, &'a Factor)> {
        self.results
            .design
            .factors
            .iter()
            .enumerate()
            .filter(|(_, factor)| factor.options.len() > 1)
            .collect()
    }

    /// The configurations that have a value of a claim.
    fn with_value(&self, claim: usize) -> Vec<Member<'a>> {
        self.all().into_iter().filter(|one| one.claims[claim].value.is_some()).collect()
    }

    fn joint_inference(&self) -> Option<JointInference> {
        let design = &self.results.design;
        let at = design.claims.iter().position(|judged| judged.id == HEADLINE)?;
        let claim = &self.claims[at];
        let mut simulations: HashMap<usize, Vec<(usize, usize)>> = HashMap::new();
        for row in &self.results.headline {
            simulations.entry(row.configuration).or_default().push((row.right, row.eligible));
        }
        let rate = |one: &ConfigurationRow| Rate {
            movement: one.shared_stages[0],
            bodies: simulations.remove(&one.number).unwrap_or_default(),
        };
        let rates: Vec<Rate> =
            self.results.configurations.iter().map(rate).filter(|rate| rate.samples() > 0).collect();
        joint_inference(&rates, claim.published?, claim.accept?, &mut stream(design.seed, 0, "joint", 0))
    }

    /// The specification curve of a claim.
    pub(super) fn curve(&self, at: usize) -> Curve {
        let claim = &self.claims[at];
        let mut with = self.with_value(at);
        with.sort_by(|a, b| {
            let value = |one: &Member| one.claims[at].value.unwrap_or_default();
            value(a).total_cmp(&value(b)).then(a.row.number.cmp(&b.row.number))
        });
        let point = |one: &Member| Point {
            value: one.claims[at].value.unwrap_or_default(),
            interval: one.claims[at].cells.low.zip(one.claims[at].cells.high),
        };
        let choices = |&(place, factor): &(usize, &Factor)| Choices {
            factor: factor.name.clone(),
            options: factor.options.iter().map(|option| option.label.clone()).collect(),
            chosen: with.iter().map(|one| one.option(place, factor)).collect(),
        };
        Curve {
            title: self.results.design.claims[at].name(),
            unit: claim.measure.unit(),
            published: claim.published,
            accepted: claim.accept.expect("it was checked"),
            points: with.iter().map(point).collect(),
            choices: self.varied().iter().map(choices).collect(),
        }
    }
}

impl Member<'_> {
    /// The option of a factor that it has, by its place.
    fn option(&self, place: usize, factor: &Factor) -> usize {
        let label = &self.row.labels[place];
        factor.options.iter().position(|option| option.label == *label).unwrap_or_default()
    }

    /// Whether a claim holds in it; `None` without a value.
    fn holds(&self, at: usize) -> Option<bool> {
        match self.claims[at].verdict {
            Verdict::Reproduced => Some(true),
            Verdict::NotReproduced => Some(false),
            Verdict::NotTestable => None,
        }
    }
}
