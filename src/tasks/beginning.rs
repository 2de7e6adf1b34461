//! Keep how a simulation begins, which figures 4 and 5 and the viewer show.

use super::error::ExperimentError;
use crate::pipeline::simulate_movement;
use crate::settings::Settings;
use crate::stages::simulate::Trajectory;

/// Some twenty epochs, s: at high p, the first of them may pass without a movement.
const SHOWN: f64 = 100.0;

/// The same settings, with no more simulated time than is shown.
fn shortened(settings: &Settings) -> Settings {
    let mut short = settings.clone();
    short.physics.duration = short.physics.duration.min(SHOWN.max(short.sense.interval));
    short
}

/// The first states of a trajectory that has these settings. What it says of the resolution is that of the whole.
pub(crate) fn beginning(whole: &Trajectory, settings: &Settings) -> Trajectory {
    let states = shortened(settings).physics.samples(settings.sense.interval) + 1;
    Trajectory {
        poses: whole.poses[..states * whole.parts].to_vec(),
        angles: whole.angles[..states * whole.joints].to_vec(),
        // Experiments feel over Δt, as the paper does.
        instants: None,
        ..*whole
    }
}

/// The same states where there is no trajectory to take them from.
///
/// # Errors
/// If the simulation is unstable.
pub(crate) fn simulate_beginning(
    settings: &Settings,
    simulation: usize,
) -> Result<Trajectory, ExperimentError> {
    simulate_movement(&shortened(settings), simulation, &|| ())
        .map_err(|error| ExperimentError::Stage(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beginning_is_the_same_whether_it_is_kept_or_simulated() {
        let mut settings = Settings::paper();
        settings.motion.coordination = 0.5;
        for (duration, interval, states) in [(120.0, 0.1, 1001), (110.0, 0.15, 667), (30.0, 0.1, 301)] {
            (settings.physics.duration, settings.sense.interval) = (duration, interval);
            let whole = simulate_movement(&settings, 1, &|| ()).unwrap();
            let (kept, simulated) = (beginning(&whole, &settings), simulate_beginning(&settings, 1).unwrap());
            assert_eq!(kept.poses.len(), states * kept.parts);
            assert_eq!((kept.poses, kept.angles), (simulated.poses, simulated.angles));
            let moved = |angles: &[[f64; 3]]| angles.iter().flatten().any(|angle| angle.abs() > 0.1);
            assert!(moved(&whole.angles), "nothing moved");
        }
    }
}
