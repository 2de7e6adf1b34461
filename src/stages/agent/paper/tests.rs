//! Test the body of the paper.

use super::*;

const SKIN: Skin = Skin { around: 12, along: 14, caps: 0 };

fn geometry(morphology: Morphology) -> Geometry {
    Geometry { morphology, part_length: 0.4, part_radius: 0.05, gap: 0.02, density: 1000.0 }
}

fn agent(morphology: Morphology) -> Agent {
    Agent::new(&geometry(morphology), &SKIN)
}

#[test]
fn the_paper_s_agent_has_five_parts_four_joints_and_840_sensors() {
    let agent = agent(Morphology::Chain);
    assert_eq!((agent.parts.len(), agent.joints.len(), agent.sites.len()), (5, 4, 840));
    for part in 0..5 {
        assert_eq!(agent.labels().iter().filter(|&&label| label == part).count(), 168);
    }
}

#[test]
fn each_morphology_has_its_tree() {
    use Morphology::*;
    for (morphology, tree) in [
        (Chain, [(1, 0), (2, 1), (3, 2), (4, 3)]),
        (Star, [(1, 0), (2, 0), (3, 0), (4, 0)]),
        (Tee, [(1, 0), (2, 0), (3, 0), (4, 3)]),
        (Y, [(1, 0), (2, 0), (3, 0), (4, 3)]),
    ] {
        assert_eq!(agent(morphology).truth().tree, tree, "{morphology:?}");
    }
}

#[test]
fn joints_sit_half_a_gap_from_both_ends_with_axes_across_the_child() {
    let reach = (0.4 + 0.02) / 2.0;
    for morphology in [Morphology::Chain, Morphology::Star, Morphology::Tee, Morphology::Y] {
        let agent = agent(morphology);
        for joint in &agent.joints {
            let child = &agent.parts[joint.child];
            let Freedom::Universal(axes) = joint.freedom else { panic!("{joint:?}") };
            let dot = |a: Vector3, b: Vector3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
            let offset = [0, 1, 2].map(|i| child.centre[i] - joint.anchor[i]);
            assert!((dot(offset, child.axis()) - reach).abs() < 1e-12, "{morphology:?}");
            assert!(dot(axes[0], axes[1]).abs() < 1e-12);
            assert!(axes.iter().all(|&axis| dot(axis, child.axis()).abs() < 1e-12));
        }
    }
}

#[test]
fn sensors_lie_on_the_surface_and_look_outward() {
    let skin = Skin { around: 12, along: 12, caps: 24 };
    let agent = Agent::new(&geometry(Morphology::Chain), &skin);
    assert_eq!(agent.sites.len(), 840);
    let (radius, half) = (0.05, 0.2);
    for Site { position: [x, y, z], normal, .. } in &agent.sites {
        if normal[2] == 0.0 {
            assert!((x.hypot(*y) - radius).abs() < 1e-12 && z.abs() < half);
            assert!((x * normal[0] + y * normal[1] - radius).abs() < 1e-12);
        } else {
            assert!(x.hypot(*y) < radius && (z * normal[2] - half).abs() < 1e-12);
        }
    }
}
