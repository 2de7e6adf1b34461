//! Share the work of stages 1 to 5 among tasks that need the same movement, pressures, distances or maps.

use serde::Serialize;

use crate::pipeline::{Mapped, Metric, Sensed, map_distances, measure_distances, sense_movement};
use crate::settings::Settings;
use crate::stages::simulate::Trajectory;

/// All that the result of each stage depends on.
pub(crate) struct Keys {
    /// Of the movement.
    pub movement: String,
    /// Of the pressures.
    pub pressures: String,
    /// Of the distances.
    pub distances: String,
    /// Of the body maps.
    pub maps: String,
}

impl Keys {
    /// Of one simulation, mapped in some numbers of dimensions.
    pub(crate) fn of(settings: &Settings, simulation: usize, dims: &[usize]) -> Self {
        let Settings { agent, skin, motion, physics, sense, quantise, map, experiment, .. } = settings;
        let movement = text(&(agent, motion, physics, sense.interval, simulation, experiment.seed));
        let pressures = text(&(&movement, skin, sense));
        let distances = text(&(&pressures, quantise));
        let maps = text(&(&distances, map, dims));
        Self { movement, pressures, distances, maps }
    }
}

fn text(key: &impl Serialize) -> String {
    serde_json::to_string(key).expect("settings are plain data")
}

/// The last result of a stage, and what it depended on.
struct LastResult<T>(Option<(String, T)>);

impl<T> Default for LastResult<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T> LastResult<T> {
    /// The last result if it has this key, or else a new one.
    fn get(&mut self, key: String, make: impl FnOnce() -> T) -> &T {
        if self.0.as_ref().is_none_or(|(last, _)| *last != key) {
            // Two of them at once would be too much memory.
            self.0 = None;
            self.0 = Some((key, make()));
        }
        &self.0.as_ref().expect("it was made").1
    }
}

/// The last results of the stages, for the tasks that come next: half a gigabyte at full size.
#[derive(Default)]
pub(crate) struct StageCache {
    movement: LastResult<Result<Trajectory, String>>,
    sensed: LastResult<Sensed>,
    metric: LastResult<Metric>,
    mapped: LastResult<Result<Mapped, String>>,
}

impl StageCache {
    /// Stages 1 to 5. Calls `simulate` if it needs another movement than the last.
    ///
    /// # Errors
    /// Why a stage failed.
    pub(crate) fn map(
        &mut self,
        settings: &Settings,
        simulation: usize,
        dims: &[usize],
        simulate: impl FnOnce() -> Result<Trajectory, String>,
    ) -> Result<Mapped, String> {
        let keys = Keys::of(settings, simulation, dims);
        let movement = self.movement.get(keys.movement, simulate);
        let trajectory = movement.as_ref().map_err(String::clone)?;
        let sensed = self.sensed.get(keys.pressures, || sense_movement(trajectory, settings));
        let metric = self.metric.get(keys.distances, || measure_distances(sensed, &settings.quantise));
        let mapped = self.mapped.get(keys.maps, || {
            map_distances(sensed, metric, settings, simulation, dims).map_err(|error| error.to_string())
        });
        mapped.clone()
    }
}
