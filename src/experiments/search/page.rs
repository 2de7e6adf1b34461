//! Describe a search for people: the candidates of each round, and which claims held together.

use std::collections::BTreeSet;

use super::super::design::flat;
use super::design::Design;
use super::score::Tried;
use crate::analysis::claims::{Judged, Verdict};
use crate::report::markdown::{number, row, rule};

/// Candidates that are shown of each round but the last one.
const SHOWN: usize = 16;

/// Candidates that are shown of the last round.
const SHOWN_LAST: usize = 100;

impl Design {
    /// The page of a search, given what was tried in each round.
    pub fn page(&self, rounds: &[(usize, Vec<Tried>)]) -> String {
        let mut lines = vec![format!(
            "{} candidates, seed {}, revision {}. The score is the weighted share of reproduced claims, with partial credit for values \
             close to their accepted range; reproduce/search.toml has the claims and their weights.\n",
            rounds[0].1.len(),
            self.seed,
            env!("BODYSCHEMA_REVISION")
        )];
        for (at, tried) in rounds {
            let most = if at + 1 == self.round.len() { SHOWN_LAST } else { SHOWN };
            let shown = tried.len().min(most);
            let settings = flat(&self.round[*at].settings).join(", ");
            lines.push(format!("Round {}: {} candidates, {settings}\n", at + 1, tried.len()));
            lines.extend(self.table_of(&tried[..shown]));
            lines.push(String::new());
        }
        lines.push(
            "Bold: within the accepted range. Unresolved: the movement is too fast for the time step (joint anchors separate by \
             more than 1 cm, or a part rotates by more than a tenth of a revolution in a step); such a candidate never wins.\n"
                .to_owned(),
        );
        for (at, tried) in rounds {
            lines.extend(self.conflicts(at + 1, tried));
        }
        lines.join("\n") + "\n"
    }

    /// Names of the claims that are scored.
    fn claims(&self) -> Vec<&str> {
        self.score.iter().map(|term| term.claim.as_str()).collect()
    }

    /// The table of some candidates of one round.
    fn table_of(&self, tried: &[Tried]) -> Vec<String> {
        let claims = self.claims();
        let header = [&["candidate", "score"], &claims[..], &["settings"]].concat();
        let mut lines = vec![row(&header), rule(header.len())];
        for Tried { candidate, score, failures, resolution, terms } in tried {
            let failed = match failures.first() {
                None if resolution.is_resolved() => String::new(),
                None => format!(
                    "; unresolved: {:.0} mm, {:.2} revolutions",
                    1e3 * resolution.anchor_separation,
                    resolution.turn
                ),
                Some(first) => format!("; {} simulations failed: {}", failures.len(), first.reason),
            };
            let mut cells = vec![candidate.name.clone(), format!("{score:.3}")];
            cells.extend(terms.iter().map(|(judged, _)| value(judged)));
            cells.push(format!("{}{failed}", flat(&candidate.settings).join(", ")));
            lines.push(row(cells));
        }
        lines
    }

    /// How often each claim holds, alone and with each other, among the resolved candidates of a round, and the largest
    /// sets of claims that hold together.
    fn conflicts(&self, round: usize, tried: &[Tried]) -> Vec<String> {
        let held = Held::of(tried);
        let tested: Vec<usize> = (0..self.score.len()).filter(|&claim| held.tested(tried, claim)).collect();
        let names = self.claims();
        let mut lines = vec![
            format!(
                "Trade-offs: number of candidates that reproduce both claims, of {} resolved ones without a failure in round {round} \
                 (on the diagonal: that reproduce the claim)\n",
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
        let never: Vec<&str> =
            tested.iter().filter(|&&a| held.together(&[a]) == 0).map(|&a| names[a]).collect();
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
        lines.push(
            "\nLargest sets of claims that single candidates reproduce together, and the number of these candidates\n".to_owned(),
        );
        lines.extend([row(["claims", "candidates", "which"]), rule(3)]);
        for (set, count) in held.largest_sets() {
            let which = set.iter().map(|&claim| names[claim]).collect::<Vec<_>>().join(", ");
            lines.push(row([set.len().to_string(), count.to_string(), which]));
        }
        lines.push(String::new());
        lines
    }
}

/// A candidate's value of a claim.
fn value(judged: &Judged) -> String {
    let value = judged.reproduced.value.map_or("none".to_owned(), |value| number(Some(value)));
    if judged.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
}

/// Sets of claims that are shown.
const SETS: usize = 8;

/// Which claims hold for each resolved candidate that did not fail.
struct Held(Vec<Vec<bool>>);

impl Held {
    fn of(tried: &[Tried]) -> Self {
        let stable = tried.iter().filter(|tried| tried.is_resolved());
        let holds = |(judged, _): &(Judged, f64)| judged.verdict == Verdict::Reproduced;
        Self(stable.map(|tried| tried.terms.iter().map(holds).collect()).collect())
    }

    /// Candidates for which all of some claims hold.
    fn together(&self, claims: &[usize]) -> usize {
        self.0.iter().filter(|held| claims.iter().all(|&claim| held[claim])).count()
    }

    /// Whether a claim has a value for some candidate of the round.
    fn tested(&self, tried: &[Tried], claim: usize) -> bool {
        tried.iter().any(|tried| tried.terms[claim].0.reproduced.value.is_some())
    }

    /// The sets of claims that hold for some candidate and are part of no larger one, the largest first, with the number
    /// of candidates for which all of a set hold.
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
