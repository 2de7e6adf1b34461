//! Say for what a seed was used before: `reproduce/seeds.toml` lists the seeds of the searches, of results and of studies.

use std::fmt;
use std::ops::RangeInclusive;

use serde::Deserialize;

/// `reproduce/seeds.toml`.
const SEEDS: &str = include_str!("../../reproduce/seeds.toml");

/// The list.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    seeds: Vec<Used>,
}

/// A use of a seed, or of all seeds of a range.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Used {
    first: u64,
    /// `first` without one.
    last: Option<u64>,
    kind: Kind,
    /// For what, as the end of the sentence "was used before: …".
    purpose: String,
    /// The design, script or page.
    by: String,
    /// The revision at which it ran.
    at: String,
}

/// What a seed's simulations can still show.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    /// Settings were chosen on it.
    Calibration,
    /// Results of a default; no setting was chosen on it before.
    Report,
    /// The registered run.
    Confirmation,
    /// Results of a study; nothing was chosen.
    Study,
    /// Movements of a multiverse.
    Multiverse,
    /// The accuracy of `estimate`.
    Benchmark,
    /// A page or a check runs it.
    Example,
}

impl Used {
    fn seeds(&self) -> RangeInclusive<u64> {
        self.first..=self.last.unwrap_or(self.first)
    }
}

impl fmt::Display for Used {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { kind, purpose, by, at, .. } = self;
        let kind = match kind {
            Kind::Calibration => "calibration",
            Kind::Report => "held out until then",
            Kind::Confirmation => "registered",
            Kind::Study => "study",
            Kind::Multiverse => "multiverse",
            Kind::Benchmark => "benchmark",
            Kind::Example => "example",
        };
        write!(f, "{purpose} ({kind}: {by}, {at})")
    }
}

/// For what master seeds were used before, in a sentence; `None` if none of them was.
pub(crate) fn used_before(seeds: RangeInclusive<u64>) -> Option<String> {
    let (first, last) = (seeds.start(), seeds.end());
    let meet = |used: &Used| used.seeds().start() <= last && first <= used.seeds().end();
    let uses: Vec<String> = list().iter().filter(|used| meet(used)).map(Used::to_string).collect();
    let which = if first == last {
        format!("Seed {first} was")
    } else {
        format!("Some of seeds {first} to {last} were")
    };
    (!uses.is_empty()).then(|| format!("{which} used before: {}.", uses.join("; ")))
}

fn list() -> Vec<Used> {
    let List { seeds } =
        toml::from_str(SEEDS).expect("reproduce/seeds.toml is a list of seeds; a test checks it");
    seeds
}

#[cfg(test)]
mod tests;
