//! Fuzz the reader of recorded movements: what is made of a skeleton is a body, and what is played of it are poses.

#![no_main]

use bodyschema::files::body::{SkinEntry, read_body, write_body};
use bodyschema::files::bvh::read_bvh;
use bodyschema::files::import::{Options, body_of_skeleton};
use bodyschema::stages::sense::{Sense, sense};
use bodyschema::stages::simulate::recorded::{Attached, longest_stretch, play, samples, still_on};
use bodyschema_fuzz::{accepted, file, folder};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first byte says how long a unit is, and whether samples are frames.
    let Some((kind, rest)) = data.split_first() else { return };
    let Some(movement) = accepted(read_bvh(&file("walk.bvh", rest))) else { return };
    let skin = SkinEntry { sensors: Some(3), per_area: None };
    let scale = [None, Some(1.0), Some(0.01), Some(1e-4)][usize::from(kind % 4)];
    let made = body_of_skeleton(&movement, &Options { skin, scale, ..Options::default() });
    let imported = match made {
        Ok(imported) => imported,
        Err(message) => return assert!(message.lines().count() <= 1, "{message:?}"),
    };
    let path = folder().join("walk.toml");
    write_body(&path, "fuzzed", &imported.file).expect("it can be written");
    let body = read_body(&path).expect("what was made of a skeleton is a body");
    assert!(body.agent.truth().tree.len() < body.agent.truth().parts().max(1));
    let Ok(attached) = Attached::new(&body.agent, &body.names, &movement, scale) else {
        assert!(scale.is_none(), "a skeleton fits the body that was made of it");
        return;
    };
    let stretch = longest_stretch(&body.agent, &attached, &movement);
    let interval = movement.frame_time() * if kind & 4 == 0 { 1.0 } else { 0.3 };
    let samples = samples(&movement, &stretch.frames, interval);
    if samples == 0 {
        return;
    }
    let trajectory = play(&body.agent, &attached, &movement, &stretch.frames, interval, samples);
    assert_eq!(trajectory.samples(), samples);
    let finite = |number: f64| number.is_finite();
    assert!(trajectory.poses.iter().flat_map(|pose| pose.position).all(finite));
    assert!(trajectory.angles.iter().flatten().copied().all(finite));
    assert_eq!(still_on(&body.agent, &trajectory).len(), body.agent.joints.len());
    let tactile = sense(&body.agent, &trajectory, &Sense { interval, fluid_density: 1010.0, threshold: 0.0 });
    assert!(tactile.pressures.iter().all(|pressure| *pressure >= 0.0));
});
