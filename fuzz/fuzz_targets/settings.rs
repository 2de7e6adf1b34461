//! Fuzz the reader of settings; what is accepted goes through every stage, with smaller sizes.

#![no_main]

use bodyschema::settings::Settings;
use bodyschema_fuzz::{accepted, file};
use libfuzzer_sys::fuzz_target;

#[path = "../../tests/support/bounded.rs"]
mod bounded;

fuzz_target!(|data: &[u8]| {
    let path = file("settings.toml", data);
    if let Some(settings) = accepted(Settings::load(false, Some(&path))) {
        let settings = bounded::bounded(&settings);
        settings.validate().expect("smaller sizes are accepted, too");
        accepted(bounded::run_every_stage(&settings));
    }
});
