//! Make the body maps of one simulation, one for each number of dimensions, by the method of the settings (section
//! 4.1).

use super::classical::{ClassicalScaling, MapError};
use super::coordinates::BodyMap;
use super::settings::MapMethod;
use super::smacof::{Fit, Improvement, smacof};
use crate::stages::distance::Distances;

/// The body maps of one simulation.
#[derive(Debug, Clone, PartialEq)]
pub enum BodyMaps {
    /// One map, of which fewer dimensions are the first columns.
    Nested(BodyMap),
    /// A map for each d.
    Each(Vec<BodyMap>),
}

impl BodyMaps {
    /// Makes a map of each number of dimensions in `dims`, and says how far each is better than the classical map that
    /// it started from; for classical maps that list is empty.
    ///
    /// # Errors
    /// If the distances span fewer dimensions than the largest of `dims`. This holds for every method, since each starts
    /// from the classical map.
    ///
    /// # Panics
    /// If `dims` is empty, or its largest value is more than `scaling` was made for.
    pub fn new(
        distances: &Distances,
        scaling: &ClassicalScaling,
        method: MapMethod,
        dims: &[usize],
    ) -> Result<(Self, Vec<Improvement>), MapError> {
        let largest = dims.iter().copied().max().expect("dims must not be empty");
        let classical = scaling.coordinates(largest)?;
        let fit = match method {
            MapMethod::Classical => return Ok((Self::Nested(classical), Vec::new())),
            MapMethod::Smacof => Fit::Metric,
            MapMethod::Nonmetric => Fit::Nonmetric,
        };
        // One after the other: each takes several times the memory of the distances, and all threads.
        let (maps, improvements) = dims.iter().map(|&d| smacof(distances, classical.first(d), fit)).unzip();
        Ok((Self::Each(maps), improvements))
    }

    /// Uses maps that an earlier run made by `method`; `None` if `maps` is empty.
    pub fn of(method: MapMethod, mut maps: Vec<BodyMap>) -> Option<Self> {
        match method {
            MapMethod::Classical => maps.pop().map(Self::Nested),
            MapMethod::Smacof | MapMethod::Nonmetric => (!maps.is_empty()).then_some(Self::Each(maps)),
        }
    }

    /// The map of `dims` dimensions.
    ///
    /// # Panics
    /// If there is no such map.
    pub fn in_dims(&self, dims: usize) -> BodyMap {
        match self {
            Self::Nested(map) => map.first(dims),
            Self::Each(maps) => {
                maps.iter().find(|map| map.dims == dims).expect("a map was made for each d").clone()
            }
        }
    }

    /// Each map with the name of its file.
    pub fn files(&self) -> Vec<(String, &BodyMap)> {
        match self {
            Self::Nested(map) => vec![("body-map.npy".to_owned(), map)],
            Self::Each(maps) => maps.iter().map(|map| (format!("body-map-{}.npy", map.dims), map)).collect(),
        }
    }
}
