//! Say how often single bodies show a claim.

use serde::{Deserialize, Serialize};

use super::statistics::Estimate;

/// How often single bodies show a claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SingleBodies {
    /// Share of the bodies with a value in which the published value would have been seen.
    pub alone: Estimate,
    /// Share of them in which all other claims of the experiment hold, too.
    pub together: Estimate,
}

/// Whether one body shows a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OneBody {
    /// In at least half of the bodies.
    Usual,
    /// In some, but less than half of them.
    Possible,
    /// In none of them.
    Never,
}

impl SingleBodies {
    /// The verdict; `None` if no body has a value.
    pub(crate) fn verdict(&self) -> Option<OneBody> {
        self.alone.value.map(|share| match share {
            0.0 => OneBody::Never,
            share if share < 0.5 => OneBody::Possible,
            _ => OneBody::Usual,
        })
    }
}
