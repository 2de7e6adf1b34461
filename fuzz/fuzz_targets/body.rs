//! Fuzz the readers of robots and of bodies: what is made of a robot is read again, and a body that is accepted has sensors.

#![no_main]

use bodyschema::files::body::{SkinEntry, read_body, write_body};
use bodyschema::files::import::{Options, import};
use bodyschema_fuzz::{accepted, file, folder};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first byte says what the others are.
    let Some((kind, rest)) = data.split_first() else { return };
    if kind % 2 == 1 {
        if let Some(body) = accepted(read_body(&file("body.toml", rest))) {
            assert!((1..=body.names.len()).contains(&body.agent.truth().parts()));
        }
        return;
    }
    let skin = SkinEntry { sensors: Some(3), per_area: None };
    let options = Options { skin, ..Options::default() };
    if let Some(robot) = accepted(import(&file("robot.xml", rest), &options)) {
        let made = folder().join("robot.toml");
        write_body(&made, "fuzzed", &robot.file).expect("it can be written");
        read_body(&made).expect("what was made of a robot is a body");
    }
});
