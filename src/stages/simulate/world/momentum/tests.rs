//! Test momentum and its drift.

use super::*;

fn part(position: Vector3, linear: Vector3, angular: Vector3) -> Moving {
    let tensor = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.02]];
    // A quarter of a turn about x.
    let rotation = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
    Moving { inertia: Inertia::new(2.0, tensor), pose: Pose { position, rotation }, linear, angular }
}

fn off(found: (Vector3, Vector3), expected: (Vector3, Vector3)) -> f64 {
    let difference = |a: Vector3, b: Vector3| (Column::from(a) - Column::from(b)).norm();
    difference(found.0, expected.0) + difference(found.1, expected.1)
}

#[test]
fn a_body_that_turns_as_one_comes_to_rest_and_goes_on_along_its_way() {
    // About (1, 0, 0), at 0.5 rad/s about z, and 3 m/s along x.
    let parts = [-1.0, 3.0].map(|x| part([x, 0.0, 0.0], [3.0, 0.5 * (x - 1.0), 0.0], [0.0, 0.0, 0.5]));
    for found in with_angular_momentum([0.0; 3], &parts) {
        assert!(off(found, ([3.0, 0.0, 0.0], [0.0; 3])) < 1e-12, "{found:?}");
    }
}

/// Of a rigid motion any inertia takes off all; here only the right one does.
#[test]
fn one_part_that_turns_alone_has_the_momentum_of_its_inertia() {
    let spin = [0.0, 0.3, 0.4];
    let parts = [part([-1.0, 0.0, 0.0], [0.0; 3], spin), part([1.0, 0.0, 0.0], [0.0; 3], [0.0; 3])];
    // The part's long axis, of 0.02 kg m², lies along −y: so it has 0.02 of y and 0.1 of z. Both parts and their places,
    // 2 kg at 1 m each, have 0.2 about x, 0.04 + 4 about y and 0.2 + 4 about z.
    let rotation = [0.0, 0.02 * 0.3 / 4.04, 0.1 * 0.4 / 4.2];
    for (found, (part, way)) in
        with_angular_momentum([0.0; 3], &parts).into_iter().zip(parts.iter().zip([-1.0, 1.0]))
    {
        let angular = [0, 1, 2].map(|i| part.angular[i] - rotation[i]);
        // Less rotation × place.
        let linear = [0.0, -rotation[2] * way, rotation[1] * way];
        assert!(off(found, (linear, angular)) < 1e-12, "{found:?}");
    }
}

#[test]
fn a_body_at_rest_gets_the_momentum_that_is_wanted() {
    let parts = [-1.0, 1.0].map(|x| part([x, 0.0, 0.0], [0.0; 3], [0.0; 3]));
    // Moments as above: 4.04 about y.
    for (found, way) in with_angular_momentum([0.0, 0.808, 0.0], &parts).into_iter().zip([-1.0, 1.0]) {
        assert!(off(found, ([0.0, 0.0, -0.2 * way], [0.0, 0.2, 0.0])) < 1e-12, "{found:?}");
    }
}

#[test]
fn parts_that_turn_against_each_other_are_left_alone() {
    let parts = [-1.0, 1.0].map(|x| part([x, 0.0, 0.0], [0.0; 3], [0.0, 0.0, x]));
    for (found, part) in with_angular_momentum([0.0; 3], &parts).into_iter().zip(&parts) {
        assert!(off(found, (part.linear, part.angular)) < 1e-12, "{found:?}");
    }
}
