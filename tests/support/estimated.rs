//! What `estimate` finds with its defaults.

use bodyschema::estimate::{Estimate, estimate};
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::parameters::Parameters;

/// The parts and joints of a recording of at least 12 sensors that tell something.
pub fn estimated(recording: &Recording) -> Estimate {
    let levels = Settings::load_over(Some(Base::ESTIMATE), None).unwrap().quantise;
    let rng = &mut stream(1, 1, "co-motion", 0);
    estimate(recording, &levels, &Parameters::default(), rng, &|| ()).unwrap()
}
