//! Say whether the published tree accuracy survives another value of an open setting.

use super::super::measures::MeasureRow;

/// Whether the published tree accuracy survives a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Survival {
    /// The rate is within the range that counts as reproduced.
    Yes,
    /// The rate is not, but its interval reaches it.
    Perhaps,
    /// The whole interval lies above.
    Higher,
    /// The whole interval lies below.
    Lower,
    /// There is no eligible sample.
    Nothing,
}

impl Survival {
    const ALL: [Self; 5] = [Self::Yes, Self::Perhaps, Self::Higher, Self::Lower, Self::Nothing];

    /// Given the row of its tree accuracy and the range that counts as reproduced.
    pub(super) fn of(row: Option<&MeasureRow>, (low, high): (f64, f64)) -> Self {
        let Some((rate, row)) = row.and_then(|row| Some((row.value?, row))) else { return Self::Nothing };
        let (least, most) = row.cells.low.zip(row.cells.high).unwrap_or((rate, rate));
        match () {
            () if (low..=high).contains(&rate) => Self::Yes,
            () if least > high => Self::Higher,
            () if most < low => Self::Lower,
            () => Self::Perhaps,
        }
    }

    /// As written on the page.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::Perhaps => "perhaps",
            Self::Higher => "no, higher",
            Self::Lower => "no, lower",
            Self::Nothing => "no, no eligible sample",
        }
    }
}

/// How many of each kind.
pub(super) fn counts(survivals: &[Survival]) -> String {
    let count = |kind: Survival| survivals.iter().filter(|found| **found == kind).count();
    let kinds = Survival::ALL.into_iter().map(|kind| (kind, count(kind))).filter(|(_, count)| *count > 0);
    kinds.map(|(kind, count)| format!("{count} × {}", kind.name())).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests;
