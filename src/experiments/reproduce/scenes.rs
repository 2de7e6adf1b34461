//! Keep what the viewer of the report shows: of the first simulation at each p, how the body begins to move, what it feels, its map,
//! and the draw of highest log posterior.

use std::path::Path;

use super::super::batch::Found;
use super::super::error::ExperimentError;
use super::super::task::Task;
use super::run::Run;
use crate::files::moved_body::MovedBody;
use crate::files::result_folder::ResultFolder;
use crate::numerics::rng::stream;
use crate::report::viewer::frames::Frames;
use crate::report::viewer::scene::{Parts, Scene};
use crate::report::viewer::stored;
use crate::settings::Settings;
use crate::stages::agent::Agent;
use crate::stages::schema::Model;
use crate::stages::sense::sense;
use crate::stages::simulate::simulate;

/// Some twenty epochs, s: at high p, the first of them may pass without a movement.
const SHOWN: f64 = 100.0;

/// Writes a scene for each p.
///
/// # Errors
/// If a movement is unstable or a file cannot be written.
pub fn write(
    run: &Run,
    tasks: &[Task],
    found: &[Found],
    folder: &mut ResultFolder,
) -> Result<(), ExperimentError> {
    let first = || tasks.iter().zip(found).filter(|(task, _)| task.simulation == 1);
    let room = Frames::ROOM / first().count().max(1);
    for (task, found) in first() {
        let p = task.settings.motion.coordination;
        let at = task.conditions.iter().position(|condition| {
            condition.model == Model::DpgmmLj && condition.dimension == run.largest_dimension()
        });
        let at = at.expect("the condition of the largest d is of every task");
        let scene = Scene { name: format!("p = {p}"), ..scene(task, found, at, room)? };
        folder.write_text(&stored::name(p), &stored::text(&scene))?;
    }
    Ok(())
}

/// Files of an earlier run.
pub fn made_anew(folder: &Path) -> Vec<String> {
    stored::names(folder)
}

fn scene(task: &Task, found: &Found, at: usize, room: usize) -> Result<Scene, ExperimentError> {
    let Settings { agent, skin, motion, physics, sense: tactile_sense, experiment, .. } = &task.settings;
    let agent = Agent::new(agent, skin);
    let interval = tactile_sense.interval;
    let mut physics = physics.clone();
    physics.duration = physics.duration.min(SHOWN.max(interval));
    let mut rng = stream(experiment.seed, task.simulation, "motion", 0);
    let trajectory = simulate(&agent, motion, &physics, interval, &mut rng, &|| ())
        .map_err(|error| ExperimentError::Stage(error.to_string()))?;
    let felt = sense(&agent, &trajectory, tactile_sense);
    let body = MovedBody::of(&agent, &trajectory);
    let frames = Frames::of(&felt, body.shapes.len(), Frames::every(Some(interval)), room);
    let dimension = task.conditions[at].dimension;
    let maps = found.body.as_ref().and_then(|found| found.maps.as_ref());
    Ok(Scene {
        name: String::new(),
        frames,
        times: None,
        interval: Some(interval),
        sensors: felt.sensors(),
        touch: frames.of_touch(&felt),
        body: Some(body),
        map: maps.map(|maps| maps.in_dims(dimension)),
        truth: Some(Parts::of_truth(&agent.truth())),
        estimate: Some(Parts::of_draw(&found.best[at])),
    })
}
