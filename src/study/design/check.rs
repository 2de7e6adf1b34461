//! Check that a design says what it must, and nothing that contradicts itself.

use std::collections::HashSet;

use super::super::choices::value_of;
use super::super::levels::{DrawCounts, Level};
use super::{BASE, COLUMNS, Choice, Design, Factor, JudgedClaim, Section, Vary};
use crate::analysis::published::{Claim, claims};
use crate::settings::Settings;

/// Most drawn configurations of a design, and most factors: what the sequence has that they are drawn by.
const MOST_DRAWN: usize = 1 << 16;
const MOST_FACTORS: usize = 1 << 8;

impl Design {
    /// Whether it can be planned.
    ///
    /// # Errors
    /// What is wrong, with the key and what is allowed.
    pub(crate) fn check(&self) -> Result<(), String> {
        self.check_kind()?;
        self.check_sections()?;
        self.check_names()?;
        self.check_factors()?;
        let claims = claims();
        self.claims.iter().try_for_each(|judged| judged.check(&claims))
    }

    /// Whether the configurations are given in one way.
    fn check_kind(&self) -> Result<(), String> {
        let named = !self.configurations.is_empty();
        let ways = [named, self.vary.is_some(), self.draws.is_some()].into_iter().filter(|way| *way).count();
        if ways != 1 {
            return Err("must have one of these: [[configuration]], `vary` (\"one-at-a-time\" or \"grid\"), or [draws]; \
                        the latter two with [[factor]]"
                .to_owned());
        }
        if named != self.factors.is_empty() {
            return Err("[[factor]] goes with `vary` or [draws], and not with [[configuration]]".to_owned());
        }
        let drawn = self.draws.map(DrawCounts::count);
        if drawn == Some(Some(0)) {
            return Err(
                "draws nothing: movements, distances, maps and inferences must be positive".to_owned()
            );
        }
        if let Some(draws) = self.draws
            && self.seed.checked_add(draws.movements as u64).is_none_or(|last| i64::try_from(last).is_err())
        {
            return Err(
                "has a `seed` that leaves no room for the seeds of its movements; use one far below 2^63"
                    .to_owned(),
            );
        }
        let combined =
            self.factors.iter().try_fold(1_usize, |all, factor| all.checked_mul(factor.options.len()));
        let count = if self.vary == Some(Vary::Grid) { Some(combined) } else { drawn };
        if count.is_some_and(|count| count.is_none_or(|count| count > MOST_DRAWN))
            || self.factors.len() > MOST_FACTORS
        {
            return Err(format!(
                "has more than {MOST_DRAWN} configurations, or more than {MOST_FACTORS} factors"
            ));
        }
        Ok(())
    }

    fn check_sections(&self) -> Result<(), String> {
        let one_at_a_time = self.vary == Some(Vary::OneAtATime);
        if self.has(Section::Factors) && !one_at_a_time {
            return Err("`factors` among the sections needs `vary = \"one-at-a-time\"`".to_owned());
        }
        let weights: Vec<f64> = self.claims.iter().filter_map(|judged| judged.weight).collect();
        if self.has(Section::Ranking) && weights.is_empty() {
            return Err("`ranking` among the sections needs a [[claim]] with `weight` and `slack`".to_owned());
        }
        if self.has(Section::Changes) && self.draws.is_some() {
            return Err("`changes` among the sections does not go with [draws]: drawn configurations have movements of their own".to_owned());
        }
        let over_all = [Section::Shares, Section::Variance, Section::Curves];
        if over_all.into_iter().any(|section| self.has(section)) && (one_at_a_time || self.factors.is_empty())
        {
            return Err(
                "`shares`, `variance` and `curves` among the sections need [draws] or `vary = \"grid\"`"
                    .to_owned(),
            );
        }
        Ok(())
    }

    /// Whether every name is of one thing alone.
    fn check_names(&self) -> Result<(), String> {
        let once = |names: Vec<&str>, what: &str| {
            let mut known = HashSet::new();
            match names.into_iter().find(|name| !known.insert(*name)) {
                Some(twice) => Err(format!("has two of `{twice}` among {what}; give each a name of its own")),
                None => Ok(()),
            }
        };
        let factors = self.factors.iter().map(|factor| factor.name.as_str());
        once(COLUMNS.into_iter().chain(factors).collect(), "factors and columns of configurations.csv")?;
        once(self.claims.iter().map(|judged| judged.id.as_str()).collect(), "claims")?;
        once(self.configurations.iter().map(|one| one.name.as_str()).collect(), "configurations")?;
        let grouping = self.factors.iter().filter(|factor| self.groups.contains(&factor.name));
        once(grouping.flat_map(Factor::labels).collect(), "options that make groups")?;
        self.factors
            .iter()
            .try_for_each(|factor| once(factor.labels().collect(), &format!("options of `{}`", factor.name)))
    }

    fn check_factors(&self) -> Result<(), String> {
        if let Some(empty) = self.factors.iter().find(|factor| factor.options.is_empty()) {
            return Err(format!("has a factor `{}` without an option; give it one or remove it", empty.name));
        }
        let unnamed = |factor: &&Factor| factor.options.iter().any(|option| option.label.is_empty());
        if let Some(factor) = self.factors.iter().find(unnamed) {
            return Err(format!(
                "has an option of `{}` without settings, gains and label; give it one of them",
                factor.name
            ));
        }
        let known = |name: &String| self.factors.iter().any(|factor| factor.name == *name);
        if let Some(unknown) = self.groups.iter().find(|name| !known(name)) {
            return Err(format!("groups by `{unknown}`, which is not a factor"));
        }
        if let Some(factor) =
            self.factors.iter().find(|factor| self.draws.is_some() && factor.level.is_none())
        {
            return Err(format!(
                "has a factor `{}` without `level`; with [draws] it must be movement, distances, map, inference or evaluation",
                factor.name
            ));
        }
        self.check_draws()?;
        if self.vary == Some(Vary::OneAtATime) {
            let paper = Settings::paper();
            self.factors.iter().try_for_each(|factor| factor.check_alone(&paper))?;
        }
        self.check_gains()
    }

    /// Whether options can be drawn, and what is left out is there.
    fn check_draws(&self) -> Result<(), String> {
        if let Some(keep) = self.draws.and_then(|draws| draws.keep).filter(|keep| !(0.0..1.0).contains(keep))
        {
            return Err(format!("has `draws.keep` = {keep}; use a probability from 0 to below 1"));
        }
        for factor in &self.factors {
            for option in &factor.options {
                if option.weight == Some(0) {
                    return Err(format!(
                        "has `{}` with weight 0; use at least 1, or remove it",
                        option.label
                    ));
                }
                let judges = factor.level != Some(Level::Evaluation)
                    || option.keys().iter().all(|key| key.starts_with("evaluate."));
                if !judges {
                    return Err(format!(
                        "has `{}` at the level evaluation, where only settings of `evaluate` can be",
                        option.label
                    ));
                }
            }
        }
        let paper = Settings::paper();
        let named = self.left_out.iter().flat_map(|one| &one.what);
        let key = |what: &&String| value_of(&paper, what.split(" = ").next().unwrap_or_default()).is_none();
        match named.into_iter().find(key) {
            Some(unknown) => Err(format!("leaves out `{unknown}`, which is not a setting")),
            None => Ok(()),
        }
    }

    /// Whether gains come from one place alone.
    fn check_gains(&self) -> Result<(), String> {
        let with_gains = |factor: &&Factor| factor.options.iter().any(|option| option.gains.is_some());
        if self.factors.iter().filter(with_gains).count() > 1 {
            return Err("has gains in two factors; put them into one".to_owned());
        }
        let both = |option: &&Choice| option.gains.is_some() && option.settings.contains_key("motion");
        match self.factors.iter().flat_map(|factor| &factor.options).find(both) {
            Some(option) => Err(format!(
                "has gains and settings of motion in `{}`; give one of them (gains are those of a torque)",
                option.label
            )),
            None => Ok(()),
        }
    }
}

impl JudgedClaim {
    /// Whether there is such a claim, and it has both or none of weight and slack.
    ///
    /// # Errors
    /// What is wrong.
    pub(crate) fn check(&self, claims: &[Claim]) -> Result<(), String> {
        let (id, experiment) = (&self.id, self.experiment.name());
        if self.find(claims).is_none() {
            let rule = "is not a claim of that experiment with an accepted range for values of its samples";
            return Err(format!("names `{id}` of {experiment}, which {rule}; see reproduce/published.toml"));
        }
        match (self.weight, self.slack) {
            (None, None) => Ok(()),
            (Some(weight), Some(slack)) if weight > 0.0 && slack > 0.0 && (weight + slack).is_finite() => {
                Ok(())
            }
            _ => Err(format!("`weight` and `slack` of `{id}` must both be there and positive, or neither")),
        }
    }
}

impl Factor {
    /// Whether it can be varied alone: its name can be that of a picture's file, and its settings exist.
    fn check_alone(&self, paper: &Settings) -> Result<(), String> {
        let name = &self.name;
        let plain = |letter: u8| letter.is_ascii_alphanumeric() || letter == b'-';
        if name.is_empty() || name == BASE || !name.bytes().all(plain) {
            return Err(format!(
                "`{name}` cannot name a factor here: use letters, digits and -, and not `{BASE}`"
            ));
        }
        match self.settings.iter().find(|key| value_of(paper, key).is_none()) {
            Some(key) => Err(format!("the factor `{name}` names `{key}`, which is not a setting")),
            None => Ok(()),
        }
    }
}
