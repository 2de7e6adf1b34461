//! Test which body a skeleton becomes: capsules, joints, what is welded, and what is left out.

use super::*;
use crate::files::body::JointName;
use crate::files::front_end::FrontEnd;
use crate::stages::agent::Vector3;
use crate::stages::simulate::recorded::RecordedJoint;
use Channel::{Position, Rotation};

const SKIN: SkinEntry = SkinEntry { sensors: Some(7), per_area: None };
const BALL: [Channel; 3] = [Rotation(2), Rotation(0), Rotation(1)];
const FREE: [Channel; 6] = [Position(0), Position(1), Position(2), Rotation(2), Rotation(0), Rotation(1)];

fn joint(
    name: &str,
    parent: usize,
    offset: Vector3,
    channels: &[Channel],
    ends: &[Vector3],
) -> RecordedJoint {
    let parent = (name != "root").then_some(parent);
    RecordedJoint { name: name.to_owned(), parent, offset, channels: channels.to_vec(), ends: ends.to_vec() }
}

/// Two frames: all 0 but the place along x of the joints that `travel`, which is 0, then 0.5.
fn moved(joints: Vec<RecordedJoint>, travel: &[&str]) -> RecordedMovement {
    let frame = |at: f64| {
        joints.iter().flat_map(move |joint| {
            joint.channels.iter().map(move |channel| match *channel {
                Position(axis) if travel.contains(&joint.name.as_str()) => {
                    if axis == 0 {
                        at
                    } else {
                        0.0
                    }
                }
                Position(axis) => joint.offset[axis],
                Rotation(_) => 0.0,
            })
        })
    };
    let values = [0.0, 0.5].into_iter().flat_map(frame).collect();
    RecordedMovement::new(joints, 0.1, values)
}

fn options() -> Options {
    Options { skin: SKIN, ..Options::default() }
}

fn imported(joints: Vec<RecordedJoint>, travel: &[&str]) -> Result<Imported, Wrong> {
    body_of_skeleton(&moved(joints, travel), &Options { scale: Some(1.0), ..options() })
}

/// Name, parent and joint of each part.
fn tree(imported: &Imported) -> Vec<(&str, &str, Option<JointName>)> {
    imported
        .file
        .parts
        .iter()
        .map(|part| (part.name.as_str(), part.parent.as_deref().unwrap_or_default(), part.joint))
        .collect()
}

#[test]
fn bones_become_capsules_and_channels_joints() {
    let joints = vec![
        joint("root", 0, [9.0, 9.0, 9.0], &FREE, &[]),
        joint("spine", 0, [0.0, 0.4, 0.0], &BALL, &[[0.0, 0.2, 0.0]]),
        joint("leg", 0, [0.1, -0.1, 0.0], &[Rotation(0)], &[]),
        joint("foot", 2, [0.0, -0.5, 0.0], &[Rotation(2), Rotation(0)], &[[0.0, 0.0, 0.04]]),
    ];
    let imported = imported(joints, &[]).unwrap();
    assert_eq!(
        tree(&imported),
        [
            ("root", "", None),
            ("root/2", "root", Some(JointName::Fixed)),
            ("spine", "root", Some(JointName::Ball)),
            ("leg", "root", Some(JointName::Hinge)),
            ("foot", "leg", Some(JointName::Universal)),
        ]
    );
    let [root, fork, spine, leg, foot] = &imported.file.parts[..] else { panic!() };
    assert_eq!((root.from, root.to), (Some([0.0; 3]), Some([0.0, 0.4, 0.0])));
    assert_eq!((fork.to, spine.anchor), (Some([0.1, -0.1, 0.0]), Some([0.0, 0.4, 0.0])));
    assert_eq!((root.radius, spine.radius), (Some(0.06), Some(0.03)));
    assert_eq!((leg.to, leg.axes.as_deref()), (Some([0.1, -0.6, 0.0]), Some(&[[1.0, 0.0, 0.0]][..])));
    assert_eq!(foot.axes.as_deref(), Some(&[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]][..]));
    // A short bone carries no skin.
    assert_eq!((leg.skin, foot.skin.and_then(|skin| skin.sensors)), (None, Some(0)));
    assert_eq!(
        imported.notes,
        ["bones shorter than 0.05 m carry no skin, unless --min-length says so (1 of 5)"]
    );
    let body = imported.file.body().unwrap();
    assert_eq!((body.agent.sites.len(), body.agent.truth().parts()), (4 * 7, 3));
    assert_eq!(body.agent.truth().tree, [(1, 0), (2, 0)]);
}

#[test]
fn what_has_no_bone_goes_to_what_carries_it() {
    // As in conversions of the CMU database: hips without a bone of their own; a wrist that turns at the end of the arm twice.
    let joints = vec![
        joint("root", 0, [0.0; 3], &FREE, &[]),
        joint("left", 0, [0.0; 3], &BALL, &[]),
        joint("thigh", 1, [0.2, 0.0, 0.0], &BALL, &[[0.0, -0.5, 0.0]]),
        joint("right", 0, [0.0; 3], &BALL, &[[-0.2, 0.0, 0.0]]),
        joint("back", 0, [0.0; 3], &BALL, &[]),
        joint("arm", 4, [0.0, 0.3, 0.0], &BALL, &[]),
        joint("wrist", 5, [0.3, 0.0, 0.0], &[Rotation(0)], &[]),
        joint("hand", 6, [0.0, 0.0, 0.001], &[Rotation(1)], &[[0.1, 0.0, 0.0], [0.1, 0.1, 0.0]]),
        joint("tip", 7, [0.0; 3], &BALL, &[]),
        joint("watch", 5, [0.1, 0.0, 0.0], &[], &[[0.0, 0.0, 0.06]]),
    ];
    let imported = imported(joints, &[]).unwrap();
    assert_eq!(
        tree(&imported),
        [
            ("left", "", None),
            ("thigh", "left", Some(JointName::Ball)),
            ("right", "left", Some(JointName::Ball)),
            ("back", "left", Some(JointName::Ball)),
            ("arm", "back", Some(JointName::Ball)),
            ("arm/2", "arm", Some(JointName::Fixed)),
            ("watch", "arm", Some(JointName::Fixed)),
            ("hand", "arm", Some(JointName::Ball)),
            ("hand/2", "hand", Some(JointName::Fixed)),
        ]
    );
    assert_eq!(imported.file.parts[7].anchor, Some([0.3, 0.3, 0.001]));
    assert_eq!(
        imported.notes,
        [
            "joints that do not turn are fixed to what carries them (1): watch",
            "joints without a bone of 0.01 m are no parts; what they carry is joined to what carries them (2): root, wrist",
            "joints that end the skeleton without a bone of 0.01 m are left out (1): tip",
            "`left` is the first part, and parts that meet it there are joined to it (2): right, back",
        ]
    );
}

#[test]
fn what_travels_has_no_bone_to_it_and_two_travellers_are_two_bodies() {
    // A root on the floor, on which the hips travel.
    let hips = |name: &str| joint(name, 0, [0.0, 0.9, 0.0], &FREE, &[[0.0, 0.3, 0.0]]);
    let one = imported(vec![joint("root", 0, [0.0; 3], &FREE, &[]), hips("hips")], &["hips"]).unwrap();
    assert_eq!(tree(&one), [("hips", "", None)]);
    // The body begins at its first part.
    assert_eq!(one.file.parts[0].from, Some([0.0; 3]));
    assert!(
        one.notes.iter().any(|note| note.ends_with("no bone leads to them (1): hips")),
        "{:?}",
        one.notes
    );
    let two = imported(vec![joint("root", 0, [0.0; 3], &FREE, &[]), hips("a"), hips("b")], &["a", "b"]);
    assert!(two.unwrap_err().contains("`a` and `b` are two bodies"));
    // What travels on a part is joined to it all the same.
    let held = vec![
        joint("root", 0, [0.0; 3], &FREE, &[[0.0, 0.3, 0.0]]),
        joint("sword", 0, [0.0; 3], &FREE, &[[0.0, 0.5, 0.0]]),
    ];
    assert_eq!(tree(&imported(held, &["sword"]).unwrap())[1], ("sword", "root", Some(JointName::Ball)));
}

#[test]
fn the_unit_is_guessed_and_said_and_what_is_no_body_is_refused() {
    let arm = |length: f64| {
        vec![
            joint("root", 0, [0.0; 3], &FREE, &[[length / 2.0, 0.0, 0.0]]),
            joint("arm", 0, [0.0, length / 2.0, 0.0], &BALL, &[[length, 0.0, 0.0]]),
        ]
    };
    let guess = |length: f64, options: &Options| body_of_skeleton(&moved(arm(length), &[]), options);
    let of = |scale, min_length| Options { scale, min_length, ..options() };
    for (length, expected, reach) in
        [(1.0, "metres were assumed", 1.0), (100.0, "centimetres", 1.0), (45.0, "inches were", 45.0 * 0.0254)]
    {
        let imported = guess(length, &options()).unwrap();
        assert!(
            imported.notes[0].contains(expected) && imported.notes[0].contains("--scale"),
            "{:?}",
            imported.notes
        );
        let to = imported.file.parts[2].to.unwrap();
        assert!((to[0] - reach).abs() < 1e-9, "{to:?}");
    }
    let python = Options { front_end: FrontEnd::Python, ..of(Some(1e-3), None) };
    for (length, options, expected) in [
        (1.0, of(Some(1e-3), None), "no bone is as long as 0.01 m; check the offsets, or give --scale"),
        (1.0, python, "no bone is as long as 0.01 m; check the offsets, or give scale"),
        (0.0, options(), "no bone is as long as 0.01 m"),
        (
            1.0,
            of(None, Some(3.0)),
            "no bone is as long as 3 m, from which on bones carry skin; lower --min-length",
        ),
        (1.0, of(None, Some(0.0)), "--min-length is 0, but must be"),
        (1.0, of(Some(f64::NAN), None), "--scale is NaN"),
        (1.0, of(Some(1e5), None), "part `root`"),
    ] {
        let message = guess(length, &options).unwrap_err();
        assert!(message.contains(expected), "{message:?} lacks {expected:?}");
    }
}
