//! Write an estimate into the cells of a table.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::statistics::Estimate;

/// What a table says of a value beside the value itself; a row contains these columns by `#[serde(flatten)]`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct EstimateCells {
    /// Number of posterior samples, or of whatever else the value is over.
    pub n: usize,
    /// Lower end of the 95 % interval.
    #[serde(deserialize_with = "number_or_empty")]
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    #[serde(deserialize_with = "number_or_empty")]
    pub high: Option<f64>,
    /// Simulations that contribute to the value.
    pub simulations: usize,
    /// Lowest value of a single simulation, where there are several.
    #[serde(deserialize_with = "number_or_empty")]
    pub lowest: Option<f64>,
    /// Highest value of a single simulation, where there are several.
    #[serde(deserialize_with = "number_or_empty")]
    pub highest: Option<f64>,
}

impl From<&Estimate> for EstimateCells {
    fn from(estimate: &Estimate) -> Self {
        let (low, high) = estimate.interval.unzip();
        let (lowest, highest) = estimate.spread.unzip();
        Self { n: estimate.n, low, high, simulations: estimate.simulations, lowest, highest }
    }
}

/// Reads a cell that may be empty. The csv crate infers the type of a cell in a flattened struct, and does not take
/// an empty one for `None`.
pub(crate) fn number_or_empty<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    struct Cell;

    impl Visitor<'_> for Cell {
        type Value = Option<f64>;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            formatter.write_str("a number, or nothing")
        }

        fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
            Ok(Some(value))
        }

        fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
            Ok(Some(value as f64))
        }

        fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
            Ok(Some(value as f64))
        }

        fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
            if text.is_empty() {
                return Ok(None);
            }
            text.parse().map(Some).map_err(|_| E::custom(format!("`{text}` is not a number")))
        }
    }

    deserializer.deserialize_any(Cell)
}
