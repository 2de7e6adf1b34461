use super::*;
use crate::numerics::rng::stream;
use crate::stages::agent::{Agent, Morphology, Skin};
use crate::stages::sense::{Sense, sense};
use crate::stages::simulate::fixtures::{INTERVAL, Scene};
use crate::stages::simulate::simulate;

fn felt(morphology: Morphology, coordination: f64) -> (Agent, Tactile) {
    let mut scene = Scene::new();
    scene.geometry.morphology = morphology;
    (scene.geometry.part_length, scene.geometry.part_radius, scene.geometry.gap) = (0.5, 0.03, 0.1);
    (scene.motion.stiffness, scene.motion.damping) = (0.47, 0.05);
    (scene.motion.coordination, scene.physics.duration) = (coordination, 1000.0);
    let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 3, caps: 0 });
    let rng = &mut stream(3, 1, "motion", 0);
    let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
    let tactile =
        sense(&agent, &trajectory, &Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 });
    (agent, tactile)
}

fn known(agent: &Agent) -> Vec<Option<usize>> {
    agent.labels().into_iter().map(Some).collect()
}

fn undirected(mut edges: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    edges.iter_mut().for_each(|edge| *edge = (edge.0.min(edge.1), edge.0.max(edge.1)));
    edges.sort_unstable();
    edges
}

fn edges(found: &Joints) -> Vec<(usize, usize)> {
    undirected(found.tree.iter().map(|edge| (edge.child, edge.parent)).collect())
}

#[test]
fn the_tree_is_recovered_with_joints_that_are_locked_and_that_never_are() {
    for (morphology, coordination) in
        [(Morphology::Chain, 0.0), (Morphology::Chain, 0.9), (Morphology::Tee, 0.5)]
    {
        let (agent, tactile) = felt(morphology, coordination);
        let found = joints(
            &tactile,
            false,
            &known(&agent),
            None,
            &Parameters::default(),
            &mut stream(1, 1, "co-motion", 0),
        );
        assert_eq!(
            edges(&found),
            undirected(agent.truth().tree),
            "{morphology:?}, p = {coordination}: {found:?}"
        );
        let sum: f64 = found.pairs.iter().map(|pair| pair.support).sum();
        assert!((sum - 4.0).abs() < 1e-9, "every resampled tree has four edges");
        assert!(found.tree.iter().all(|edge| found.support(edge) > 0.5));
        assert_eq!(joint_tree(&tactile, false, &known(&agent)), found.tree);
        assert!(found.ranks.values().all(|rank| (3..=5).contains(rank)));
    }
}

#[test]
fn only_simultaneous_motion_tells_the_tree() {
    let (agent, mut tactile) = felt(Morphology::Chain, 0.5);
    let correlation = |tactile: &Tactile| {
        let found = joints(
            tactile,
            false,
            &known(&agent),
            None,
            &Parameters::default(),
            &mut stream(1, 1, "co-motion", 0),
        );
        found.pairs.iter().find(|pair| (pair.part, pair.other) == (0, 1)).unwrap().correlation
    };
    let before = correlation(&tactile);
    let own = tactile.samples * agent.labels().iter().filter(|part| **part == 0).count();
    // The first part feels everything half of the recording later.
    tactile.pressures[..own].chunks_mut(tactile.samples).for_each(|series| series.rotate_right(5000));
    assert!(correlation(&tactile) < before - 0.1, "{} {before}", correlation(&tactile));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let (agent, tactile) = felt(Morphology::Chain, 0.5);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            joints(
                &tactile,
                false,
                &known(&agent),
                None,
                &Parameters::default(),
                &mut stream(1, 1, "co-motion", 0),
            )
        })
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_is_in_the_place_of_an_edge_is_counted_where_it_is_lacking() {
    let tree_of = |pairs: &[(usize, usize)]| -> Vec<Edge> {
        pairs.iter().map(|&(parent, child)| Edge { child, parent }).collect()
    };
    // 0 – 1 – 2 – 3. In half of the others 0 – 2 is in the place of 0 – 1, and in one 1 – 3 in that of 1 – 2.
    let tree = tree_of(&[(0, 1), (1, 2), (2, 3)]);
    let without_first = tree_of(&[(0, 2), (2, 1), (3, 2)]);
    let without_second = tree_of(&[(0, 1), (1, 3), (2, 3)]);
    let others = [
        without_first.clone(),
        without_first.clone(),
        without_first,
        tree.clone(),
        tree.clone(),
        without_second,
    ];
    assert_eq!(most_often_instead(&tree, 0, &others), Some((0, 2, 3)));
    // 0 – 2 joins the two sides of 1 – 2, too, but beside it.
    assert_eq!(most_often_instead(&tree, 1, &others), Some((1, 3, 1)));
    assert_eq!(most_often_instead(&tree, 2, &others), None);
}
