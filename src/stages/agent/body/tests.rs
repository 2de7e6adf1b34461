use super::*;

#[test]
fn parts_that_are_fixed_to_each_other_are_one_in_truth() {
    let part = Part {
        shape: Shape::Sphere { radius: 0.1 },
        centre: [0.0; 3],
        rotation: across([0.0, 0.0, 1.0]),
        density: 1000.0,
        inertia: None,
    };
    let joint = |parent, child, freedom| Joint { parent, child, anchor: [0.0; 3], freedom };
    let site = |part| Site { part, position: [0.1, 0.0, 0.0], normal: [1.0, 0.0, 0.0] };
    let agent = Agent {
        parts: vec![part; 5],
        joints: vec![
            joint(0, 1, Freedom::Ball),
            joint(1, 2, Freedom::Fixed),
            joint(2, 3, Freedom::Ball),
            joint(0, 4, Freedom::Fixed),
        ],
        sites: (0..5).map(site).collect(),
    };
    assert_eq!(agent.labels(), [0, 1, 1, 2, 0]);
    assert_eq!(agent.truth().tree, [(1, 0), (2, 1)]);
}

#[test]
fn a_part_without_sensors_is_none_in_truth() {
    // A root that carries 1 and 2, of which 1 carries 3 and 2 carries 4, and 5 on 4.
    let tree = |felt: &[usize]| {
        let part = Part {
            shape: Shape::Sphere { radius: 0.1 },
            centre: [0.0; 3],
            rotation: across([0.0, 0.0, 1.0]),
            density: 1000.0,
            inertia: None,
        };
        let joint = |(at, parent): (usize, &usize)| Joint {
            parent: *parent,
            child: at + 1,
            anchor: [0.0; 3],
            freedom: Freedom::Ball,
        };
        let site = |&part: &usize| Site { part, position: [0.1, 0.0, 0.0], normal: [1.0, 0.0, 0.0] };
        let agent = Agent {
            parts: vec![part; 6],
            joints: [0, 0, 1, 2, 4].iter().enumerate().map(joint).collect(),
            sites: felt.iter().map(site).collect(),
        };
        agent.truth().tree
    };
    assert_eq!(tree(&[0, 1, 2, 3, 4, 5]), [(1, 0), (2, 0), (3, 1), (4, 2), (5, 4)]);
    assert_eq!(tree(&[0, 3, 4]), [(3, 0), (4, 0)]);
    assert_eq!(tree(&[0, 1, 5]), [(1, 0), (5, 0)]);
    assert_eq!(tree(&[3, 4, 5]), [(4, 3), (5, 4)]);
    assert_eq!(tree(&[2, 3, 5]), [(3, 2), (5, 2)]);
    assert_eq!(tree(&[5]), []);
}

#[test]
fn a_part_is_turned_without_being_mirrored() {
    for axis in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.6, 0.0, -0.8], [0.48, 0.6, 0.64]] {
        let rows = across(axis);
        let dot = |a: Vector3, b: Vector3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        for i in 0..3 {
            for j in 0..3 {
                assert!((dot(rows[i], rows[j]) - f64::from(u8::from(i == j))).abs() < 1e-12);
            }
        }
        let [a, b, c] = rows;
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        assert!((dot(cross, c) - 1.0).abs() < 1e-12, "{axis:?}");
        assert!((dot(rows.map(|row| row[2]), axis) - 1.0).abs() < 1e-12);
    }
}
