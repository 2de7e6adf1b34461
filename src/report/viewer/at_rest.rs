//! Show a body that has not moved: its solids, the sensors on them, and its tree.

use super::frames::Frames;
use super::scene::{Parts, Scene};
use crate::files::body::NamedBody;
use crate::files::import::Surface;
use crate::files::moved_body::MovedBody;
use crate::stages::simulate::{Pose, Trajectory};

/// The body in its rest pose, with the surfaces of those of its parts that stand for meshes. Nothing is felt.
pub(crate) fn at_rest(body: &NamedBody, surfaces: Vec<Surface>) -> Scene {
    let agent = &body.agent;
    let poses = agent.parts.iter().map(|part| Pose { position: part.centre, rotation: part.rotation });
    // A movement begins with the pose before its first sample.
    let poses: Vec<Pose> = poses.clone().chain(poses).collect();
    let still = Trajectory { parts: agent.parts.len(), poses, ..Trajectory::default() };
    Scene {
        name: String::new(),
        frames: Frames { first: 0, every: 1, count: 1 },
        times: None,
        interval: None,
        is_still: true,
        sensors: agent.sites.len(),
        touch: vec![0.0; agent.sites.len()],
        body: Some(MovedBody::of(agent, &still)),
        surfaces,
        map: None,
        truth: Some(Parts { names: body.rigid_names(), ..Parts::of_truth(&agent.truth()) }),
        estimate: None,
    }
}
