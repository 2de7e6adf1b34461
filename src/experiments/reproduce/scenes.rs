//! Keep what the viewer of the report shows: of the first simulation at each p, how the body begins to move, what it feels, its map,
//! and the posterior sample of highest log posterior.

use std::path::Path;

use serde_json::Value;

use super::beginnings::Beginnings;
use super::run::Run;
use crate::files::FileError;
use crate::files::moved_body::MovedBody;
use crate::files::result_folder::ResultFolder;
use crate::report::viewer::frames::Frames;
use crate::report::viewer::scene::{Parts, Scene};
use crate::report::viewer::stored;
use crate::settings::Settings;
use crate::stages::agent::Agent;
use crate::stages::schema::Model;
use crate::stages::sense::sense;
use crate::stages::simulate::Trajectory;
use crate::tasks::batch::TaskOutput;
use crate::tasks::task::Task;

/// Writes a scene for each p, and returns their data, p rising.
///
/// # Errors
/// If a file cannot be written.
pub(super) fn write(
    run: &Run,
    tasks: &[Task],
    found: &[TaskOutput],
    beginnings: &Beginnings,
    folder: &mut ResultFolder,
) -> Result<Vec<Value>, FileError> {
    let first = || tasks.iter().zip(found).filter(|(task, _)| task.is_shown());
    let room = Frames::ROOM / first().count().max(1);
    let mut scenes = Vec::new();
    for (task, found) in first() {
        let p = task.settings.motion.coordination;
        let at = task.conditions.iter().position(|condition| {
            condition.model == Model::DpgmmLj && condition.dimension == run.largest_dimension()
        });
        let at = at.expect("the condition of the largest d is of every task");
        let scene = scene(task, found, beginnings.at(p), at, room).data();
        folder.write_text(&stored::name(p), &stored::text(&scene))?;
        scenes.push(scene);
    }
    Ok(scenes)
}

/// Files of an earlier run.
pub(super) fn made_anew(folder: &Path) -> Vec<String> {
    stored::names(folder)
}

/// What is shown of a simulation: how it begins, and its inference in the condition at this place of the task.
fn scene(task: &Task, found: &TaskOutput, beginning: &Trajectory, at: usize, room: usize) -> Scene {
    let Settings { agent, skin, motion, sense: tactile_sense, .. } = &task.settings;
    let agent = Agent::new(agent, skin);
    let interval = tactile_sense.interval;
    let felt = sense(&agent, beginning, tactile_sense);
    let body = MovedBody::of(&agent, beginning);
    let frames = Frames::of(&felt, body.shapes.len(), Frames::every(Some(interval)), room);
    let dimension = task.conditions[at].dimension;
    let maps = found.body.as_ref().and_then(|found| found.maps.as_ref());
    Scene {
        name: format!("p = {}", motion.coordination),
        frames,
        times: None,
        interval: Some(interval),
        sensors: felt.sensors(),
        touch: frames.of_touch(&felt),
        body: Some(body),
        is_still: false,
        surfaces: Vec::new(),
        map: maps.map(|maps| maps.in_dims(dimension)),
        truth: Some(Parts::of_truth(&agent.truth())),
        estimate: Some(Parts::of_sample(&found.best[at])),
    }
}
