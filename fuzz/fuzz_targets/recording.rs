//! Fuzz the estimate of parts and tree: any pressures of a few sensors at a few samples.

#![no_main]

use bodyschema::estimate::estimate;
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::rigid_parts::MIN_SENSORS;
use bodyschema::stages::sense::Tactile;
use bodyschema_fuzz::accepted;
use libfuzzer_sys::fuzz_target;

/// Most sensors beyond the fewest that an estimate needs.
const MORE: u8 = 21;

fuzz_target!(|data: &[u8]| {
    let Some((&count, bytes)) = data.split_first() else { return };
    let sensors = MIN_SENSORS + usize::from(count % MORE);
    let mut pressures: Vec<f32> = bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect();
    let samples = pressures.len() / sensors;
    if samples == 0 {
        return;
    }
    pressures.truncate(sensors * samples);
    let recording = Recording::new(Tactile { samples, pressures });
    let levels = Settings::load_over(Some(Base::ESTIMATE), None).expect("settings of the project").quantise;
    let Some(found) = accepted(estimate(&recording, &levels, &mut stream(1, 1, "fuzz", 0), &|| ())) else {
        return;
    };
    assert_eq!(found.parts.labels.len(), recording.sensors.len());
    assert!(found.parts.residuals.iter().all(|residual| residual.is_finite()));
    assert_eq!(found.joints.tree.len() + 1, found.joints.ranks.len());
});
