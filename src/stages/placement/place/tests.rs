use super::*;
use crate::numerics::rng::stream;
use crate::stages::agent::{Agent, Skin};
use crate::stages::sense::{Sense, sense};
use crate::stages::simulate::fixtures::{INTERVAL, Scene};
use crate::stages::simulate::{Controller, simulate};

/// The paper's body with so many sensors on the caps of each part, what it felt, and the edges of its tree.
fn moved(caps: usize) -> (Agent, Tactile, Vec<Edge>) {
    let mut scene = Scene::new();
    scene.geometry.gap = 0.1;
    (scene.motion.coordination, scene.motion.controller, scene.motion.servo_gain) =
        (0.5, Controller::Servo, 0.3);
    let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 3, caps });
    let rng = &mut stream(11, 1, "motion", 0);
    let moved = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
    let tactile = sense(&agent, &moved, &Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 });
    let tree = agent.joints.iter().enumerate();
    let tree = tree.map(|(at, joint)| Edge { child: at + 1, parent: joint.parent }).collect();
    (agent, tactile, tree)
}

/// A point in the frame of a part, from one at rest.
fn in_frame(agent: &Agent, part: usize, place: Vector3<f64>) -> Vector3<f64> {
    let own = &agent.parts[part];
    let from = place - Vector3::from(own.centre);
    Vector3::from_fn(|column, _| (0..3).map(|row| own.rotation[row][column] * from[row]).sum())
}

/// The sites at rest, in one frame.
fn at_rest(agent: &Agent) -> Vec<Site> {
    let turned = |part: usize, vector: [f64; 3]| {
        agent.parts[part].rotation.map(|row| (0..3).map(|at| row[at] * vector[at]).sum::<f64>())
    };
    let site = |site: &Site| {
        let (offset, centre) = (turned(site.part, site.position), agent.parts[site.part].centre);
        Site {
            part: 0,
            position: [0, 1, 2].map(|at| offset[at] + centre[at]),
            normal: turned(site.part, site.normal),
        }
    };
    agent.sites.iter().map(site).collect()
}

#[test]
fn joints_are_where_the_body_has_them() {
    let (agent, tactile, tree) = moved(8);
    let labels: Vec<usize> = agent.sites.iter().map(|site| site.part).collect();
    let rest = place(&tactile, false, &labels, &tree, &at_rest(&agent));
    let own = place(&tactile, false, &labels, &tree, &agent.sites);
    for part in rest.parts.iter().chain(&own.parts) {
        assert!(part.explained > 0.99 && part.left_out.is_empty(), "{part:?}");
    }
    for (at, joint) in agent.joints.iter().enumerate() {
        let truth = Vector3::from(joint.anchor);
        let (one, two) = (&rest.joints[at], &own.joints[at]);
        let errors = [
            one.in_parent - truth,
            two.in_parent - in_frame(&agent, joint.parent, truth),
            two.in_child - in_frame(&agent, joint.child, truth),
        ];
        for (error, found) in errors.iter().zip([one, two, two]) {
            let standard_error = found.standard_error.expect("touch tells the place");
            assert!(error.norm() < 0.005 && error.norm() < 4.0 * standard_error, "{error} {found:?}");
            assert!(standard_error < 0.005 && found.mismatch.unwrap() < 1e-3, "{found:?}");
        }
        assert_eq!((one.in_parent, one.rotation), (one.in_child, Rotation3::identity()));
        assert!((two.rotation.matrix().determinant() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn where_sensors_do_not_feel_a_motion_joints_are_between_the_parts() {
    // Without caps, a cylinder feels no motion along its axis, nor about it.
    let (agent, tactile, tree) = moved(0);
    let labels: Vec<usize> = agent.sites.iter().map(|site| site.part).collect();
    let found = place(&tactile, false, &labels, &tree, &at_rest(&agent));
    assert!(found.parts.iter().all(|part| part.rank == 4 && part.explained > 0.99));
    for (place, joint) in found.joints.iter().zip(&agent.joints) {
        assert!(place.standard_error.is_none() && place.mismatch.unwrap() > MAX_MISMATCH, "{place:?}");
        // The nearest sensors are on one side of the cylinders.
        assert!((place.in_parent - Vector3::from(joint.anchor)).norm() < 0.1, "{place:?}");
    }
}

#[test]
fn normals_that_point_inward_explain_little() {
    let (agent, tactile, tree) = moved(8);
    let labels: Vec<usize> = agent.sites.iter().map(|site| site.part).collect();
    let mut sites = at_rest(&agent);
    for site in sites
        .iter_mut()
        .zip(&labels)
        .filter(|(site, part)| **part == 2 && site.position[1] > 0.0)
        .map(|it| it.0)
    {
        site.normal = site.normal.map(|x| -x);
    }
    let found = place(&tactile, false, &labels, &tree, &sites);
    let explained: Vec<f64> = found.parts.iter().map(|part| part.explained).collect();
    assert!(explained[2] < 0.8 && explained[1] > 0.99, "{explained:?}");
}

#[test]
fn a_sensor_in_another_frame_is_left_out_and_a_body_at_rest_has_no_places() {
    let (agent, tactile, tree) = moved(8);
    let labels: Vec<usize> = agent.sites.iter().map(|site| site.part).collect();
    let mut sites = agent.sites.clone();
    sites[3].part = 4;
    let found = place(&tactile, false, &labels, &tree, &sites);
    assert_eq!((found.parts[0].frame, &found.parts[0].left_out[..]), (0, &[3][..]));
    let still = Tactile { samples: 100, pressures: vec![0.0; 100 * labels.len()] };
    let found = place(&still, false, &labels, &tree, &at_rest(&agent));
    assert!(
        found
            .joints
            .iter()
            .all(|joint| joint.mismatch.is_none() && joint.in_parent.iter().all(|x| x.is_finite()))
    );
}
