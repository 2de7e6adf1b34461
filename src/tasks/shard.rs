//! A shard I/N of the work of a study: every N-th piece of a list, for one of several machines.

use std::str::FromStr;

/// Every `of`-th piece of the work, beginning with the `index`-th, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    /// All of it.
    pub(crate) const WHOLE: Self = Self { index: 1, of: 1 };

    /// Whether it has the piece of work at this place of a list, from 0.
    pub(crate) fn has(self, place: usize) -> bool {
        place % self.of == self.index - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `I/N`.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (index, of) = text.split_once('/').unwrap_or_default();
        match (index.parse(), of.parse()) {
            (Ok(index), Ok(of)) if (1..=of).contains(&index) => Ok(Self { index, of }),
            _ => Err("a shard is I/N, with I from 1 to N, such as 3/8".to_owned()),
        }
    }
}
