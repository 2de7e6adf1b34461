//! Describe a search for people: the candidates of each round, and which claims held together.

use super::super::design::flat;
use super::design::Design;
use super::score::Tried;
use crate::analysis::claims::{Judged, Verdict};
use crate::report::markdown::{number, row, rule};

/// Candidates that are shown of each round but the last one, which is shown whole.
const SHOWN: usize = 16;

impl Design {
    /// The page of a search, given what was tried in each round.
    pub fn page(&self, rounds: &[Vec<Tried>]) -> String {
        let mut lines = vec![format!(
            "{} candidates, seed {}, revision {}. Score: weighted share of claims, in part for those nearly satisfied; \
             the claims and their weights stand in reproduce/search.toml.\n",
            rounds[0].len(),
            self.seed,
            env!("BODYSCHEMA_REVISION")
        )];
        for (at, tried) in rounds.iter().enumerate() {
            let shown = if at + 1 == rounds.len() { tried.len() } else { tried.len().min(SHOWN) };
            let settings = flat(&self.round[at].settings).join(", ");
            lines.push(format!("Round {}: {} candidates, {settings}\n", at + 1, tried.len()));
            lines.extend(self.table_of(&tried[..shown]));
            lines.push(String::new());
        }
        lines.push("Bold: within the accepted range.\n".to_owned());
        lines.extend(self.conflicts(&rounds[0]));
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
        for Tried { candidate, score, failures, terms } in tried {
            let failed = match failures.first() {
                None => String::new(),
                Some(first) => format!("; {} parts failed: {}", failures.len(), first.reason),
            };
            let mut cells = vec![candidate.name.clone(), format!("{score:.3}")];
            cells.extend(terms.iter().map(|(judged, _)| value(judged)));
            cells.push(format!("{}{failed}", flat(&candidate.settings).join(", ")));
            lines.push(row(cells));
        }
        lines
    }

    /// How often each claim holds, alone and with each other, among the candidates of the first round, which tries all
    /// of them alike.
    fn conflicts(&self, tried: &[Tried]) -> Vec<String> {
        let (names, held) = (self.claims(), Held::of(tried));
        let mut lines = vec![
            format!(
                "How often two claims hold together, of {} candidates without a failure in round 1 (the diagonal: alone)\n",
                held.0.len()
            ),
            row(std::iter::once("").chain(names.iter().copied())).replacen("|  |", "| |", 1),
            rule(names.len() + 1),
        ];
        for (a, name) in names.iter().enumerate() {
            let counts = (0..names.len()).map(|b| held.together(&[a, b]).to_string());
            lines.push(row(std::iter::once((*name).to_owned()).chain(counts)));
        }
        let all: Vec<usize> = (0..names.len()).collect();
        lines.push(format!("\nAll claims together hold for {} of them.", held.together(&all)));
        let never: Vec<&str> = all.iter().filter(|&&a| held.together(&[a]) == 0).map(|&a| names[a]).collect();
        if !never.is_empty() {
            lines.push(format!("Never satisfied: {}.", never.join(", ")));
        }
        for a in 0..names.len() {
            for b in a + 1..names.len() {
                let (one, other) = (held.together(&[a]), held.together(&[b]));
                if one > 0 && other > 0 && held.together(&[a, b]) == 0 {
                    let (first, second) = (names[a], names[b]);
                    lines
                        .push(format!("Never together: {first} (alone {one}) and {second} (alone {other})."));
                }
            }
        }
        lines
    }
}

/// A candidate's value of a claim.
fn value(judged: &Judged) -> String {
    let value = judged.reproduced.value.map_or("none".to_owned(), |value| number(Some(value)));
    if judged.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
}

/// Which claims hold for each candidate that did not fail.
struct Held(Vec<Vec<bool>>);

impl Held {
    fn of(tried: &[Tried]) -> Self {
        let stable = tried.iter().filter(|tried| tried.failures.is_empty());
        let holds = |(judged, _): &(Judged, f64)| judged.verdict == Verdict::Reproduced;
        Self(stable.map(|tried| tried.terms.iter().map(holds).collect()).collect())
    }

    /// Candidates for which all of some claims hold.
    fn together(&self, claims: &[usize]) -> usize {
        self.0.iter().filter(|held| claims.iter().all(|&claim| held[claim])).count()
    }
}
