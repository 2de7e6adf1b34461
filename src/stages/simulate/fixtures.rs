//! Build a small body and its movement for the tests of this stage.

use super::settings::{AngleError, AngularMomentum, Controller, Motion, Movement, Physics, Targets};
use crate::stages::agent::{Agent, Geometry, Morphology, Skin};

/// Everything that a simulation needs.
pub(crate) struct Scene {
    pub geometry: Geometry,
    pub motion: Motion,
    pub physics: Physics,
}

/// Time between two samples, s.
pub(crate) const INTERVAL: f64 = 0.1;

impl Scene {
    /// Five short thick parts in a row, moved by strong gains.
    pub(crate) fn new() -> Self {
        Self {
            geometry: Geometry {
                morphology: Morphology::Chain,
                part_length: 0.3,
                part_radius: 0.05,
                gap: 0.0,
                density: 1000.0,
            },
            motion: Motion {
                coordination: 0.9,
                epoch: 500,
                targets: Targets::Each,
                controller: Controller::Torque,
                stiffness: 1.1,
                damping: 0.5,
                servo_gain: 10.0,
                servo_torque: 100.0,
                error: AngleError::Shortest,
                movement: Movement::Random,
                rhythm: None,
            },
            physics: Physics {
                step: 0.01,
                duration: 200.0,
                turn_limit: 1e6,
                angular_momentum: AngularMomentum::Engine,
                fluid_density: 0.0,
            },
        }
    }

    /// The body, with few sensors.
    pub(crate) fn agent(&self) -> Agent {
        Agent::new(&self.geometry, &Skin { around: 4, along: 1, caps: 0 })
    }
}
