//! The section of trade-offs: which claims hold together.

use std::collections::BTreeSet;

use super::super::results::Results;
use crate::analysis::claims::Verdict;
use crate::report::markdown::{row, rule};

/// Sets of claims that are shown.
const SETS: usize = 8;

/// How often each claim holds, alone and with each other, and the largest sets of claims that hold together.
pub(super) fn section(results: &Results) -> Vec<String> {
    let held = Held::of(results);
    let names: Vec<&str> = results.design.claims.iter().map(|judged| judged.id.as_str()).collect();
    let has_value = |claim: usize| {
        (0..results.configurations.len()).any(|place| results.claims_of(place)[claim].value.is_some())
    };
    let tested: Vec<usize> = (0..names.len()).filter(|&claim| has_value(claim)).collect();
    let mut lines = vec![
        "\n## Trade-offs\n".to_owned(),
        format!(
            "Number of configurations that reproduce both claims, of {} resolved ones without a failure (on the diagonal: that reproduce \
             the claim).\n",
            held.0.len()
        ),
        row(std::iter::once("").chain(tested.iter().map(|&a| names[a]))).replacen("|  |", "| |", 1),
        rule(tested.len() + 1),
    ];
    for &a in &tested {
        let counts = tested.iter().map(|&b| held.together(&[a, b]).to_string());
        lines.push(row(std::iter::once(names[a].to_owned()).chain(counts)));
    }
    lines.push(format!("\n{} of them reproduce all of these claims.", held.together(&tested)));
    let never: Vec<&str> = tested.iter().filter(|&&a| held.together(&[a]) == 0).map(|&a| names[a]).collect();
    if !never.is_empty() {
        lines.push(format!("Never reproduced: {}.", never.join(", ")));
    }
    for (at, &a) in tested.iter().enumerate() {
        for &b in &tested[at + 1..] {
            let (one, other) = (held.together(&[a]), held.together(&[b]));
            if one > 0 && other > 0 && held.together(&[a, b]) == 0 {
                let (first, second) = (names[a], names[b]);
                lines.push(format!(
                    "Never reproduced together: {first} (alone {one}) and {second} (alone {other})."
                ));
            }
        }
    }
    lines.push("\nThe largest sets of claims that single configurations reproduce together:\n".to_owned());
    lines.extend([row(["claims", "configurations", "which"]), rule(3)]);
    for (set, count) in held.largest_sets() {
        let which = set.iter().map(|&claim| names[claim]).collect::<Vec<_>>().join(", ");
        lines.push(row([set.len().to_string(), count.to_string(), which]));
    }
    lines
}

/// Which claims hold for each resolved configuration.
struct Held(Vec<Vec<bool>>);

impl Held {
    fn of(results: &Results) -> Self {
        let resolved = results.configurations.iter().enumerate().filter(|(_, one)| one.resolved);
        let holds = |(place, _)| {
            results.claims_of(place).iter().map(|row| row.verdict == Verdict::Reproduced).collect()
        };
        Self(resolved.map(holds).collect())
    }

    /// Configurations for which all of some claims hold.
    fn together(&self, claims: &[usize]) -> usize {
        self.0.iter().filter(|held| claims.iter().all(|&claim| held[claim])).count()
    }

    /// The sets of claims that hold for some configuration and are part of no larger one, the largest first, with the number of
    /// configurations for which all of a set hold.
    fn largest_sets(&self) -> Vec<(Vec<usize>, usize)> {
        let set = |held: &Vec<bool>| (0..held.len()).filter(|&claim| held[claim]).collect::<Vec<_>>();
        let all: BTreeSet<Vec<usize>> = self.0.iter().map(set).collect();
        let within = |a: &[usize], b: &[usize]| a.len() < b.len() && a.iter().all(|claim| b.contains(claim));
        let maximal = all.iter().filter(|one| !all.iter().any(|other| within(one, other)));
        let mut sets: Vec<_> = maximal.map(|set| (set.clone(), self.together(set))).collect();
        sets.sort_by_key(|(set, count)| std::cmp::Reverse((set.len(), *count)));
        sets.truncate(SETS);
        sets
    }
}
