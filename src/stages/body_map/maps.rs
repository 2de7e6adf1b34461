//! Make the body maps of one simulation, one for each number of dimensions, by the method of the settings (section
//! 4.1).

use rayon::prelude::*;

use super::classical::{ClassicalScaling, MapError};
use super::coordinates::BodyMap;
use super::random_starts::{Descended, descend, random_map};
use super::settings::{Map, MapMethod};
use super::smacof::{Fit, Improvement, Majorisation, smacof};
use crate::numerics::rng::Stream;
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
    /// Makes a map of each number of dimensions in `dims`, and says how far each is better than the map that it started
    /// from; for classical maps that list is empty. `random(d, start)` is the stream of a random start.
    ///
    /// # Errors
    /// If the distances span fewer dimensions than the largest of `dims`. This holds for every method, so that none makes
    /// up dimensions that are not there.
    ///
    /// # Panics
    /// If `dims` is empty, or its largest value is more than `scaling` was made for.
    pub fn new(
        distances: &Distances,
        scaling: &ClassicalScaling,
        settings: &Map,
        dims: &[usize],
        random: &(dyn Fn(usize, usize) -> Stream + Sync),
    ) -> Result<(Self, Vec<Improvement>), MapError> {
        let largest = dims.iter().copied().max().expect("dims must not be empty");
        let classical = scaling.coordinates(largest)?;
        // One after the other: each takes several times the memory of the distances, and all threads.
        let each = |map: &dyn Fn(usize) -> (BodyMap, Improvement)| {
            let (maps, improvements) = dims.iter().map(|&d| map(d)).unzip();
            Ok((Self::Each(maps), improvements))
        };
        match settings.method {
            MapMethod::Classical => Ok((Self::Nested(classical), Vec::new())),
            MapMethod::Smacof => each(&|d| smacof(distances, classical.first(d), Fit::Metric)),
            MapMethod::Nonmetric => each(&|d| smacof(distances, classical.first(d), Fit::Nonmetric)),
            MapMethod::SmacofRandom => {
                each(&|d| best_of_random(distances, d, settings, &|start| random(d, start)))
            }
        }
    }

    /// Uses maps that an earlier run made by `method`; `None` if `maps` is empty.
    pub fn of(method: MapMethod, mut maps: Vec<BodyMap>) -> Option<Self> {
        match method {
            MapMethod::Classical => maps.pop().map(Self::Nested),
            MapMethod::Smacof | MapMethod::SmacofRandom | MapMethod::Nonmetric => {
                (!maps.is_empty()).then_some(Self::Each(maps))
            }
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

/// The map of least raw stress from random starts, the first of equal ones. It is "improved" from that start.
fn best_of_random(
    distances: &Distances,
    dims: usize,
    settings: &Map,
    random: &(dyn Fn(usize) -> Stream + Sync),
) -> (BodyMap, Improvement) {
    let start = |start: usize| random_map(distances.sensors, dims, &mut random(start));
    let end = |at: usize| descend(distances, &start(at), settings.steps, settings.tolerance);
    let all: Vec<Descended> = (0..settings.starts).into_par_iter().map(end).collect();
    let least = (0..all.len()).reduce(|a, b| if all[b].stress < all[a].stress { b } else { a });
    let least = least.expect("there is a start");
    let stress = |map: BodyMap| Majorisation::new(distances, map, Fit::Metric).stress();
    let start = stress(start(least));
    let Descended { map, steps, .. } = all.into_iter().nth(least).expect("it is one of them");
    let improvement = Improvement { dimension: dims, start, stress: stress(map.clone()), steps };
    (map, improvement)
}
