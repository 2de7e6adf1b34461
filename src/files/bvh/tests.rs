//! Test that BVH means what its readers make of it, and that every mistake is named with its line.

use super::*;
use crate::stages::simulate::recorded::Channel::{Position, Rotation};

/// A skeleton as exporters write it, in every way that is allowed.
const GOOD: &str = "HIERARCHY
ROOT Hips
{
\tOFFSET 0.0 1.5 -2e1
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT Left Arm
\t{
\t\tCHANNELS 3 yrotation XROTATION Zrotation
\t\tOFFSET 1 2 3
\t\tEnd Site
\t\t{
\t\t\tOFFSET 4 5 6
\t\t}
\t\tEND SITE { OFFSET 7 8 9 }
\t}
\tJOINT Head{
\t\tOFFSET 0 0 1
\t\tJOINT Head { OFFSET 0 0 2
\t\tCHANNELS 1 Zrotation }}
}

MOTION
Frames: 2
Frame Time:\t.0083333
1 2 3 4 5 6 7 8 9 10
-1 2 3 4 5 6 7 8 9 1e1

";

fn read(bytes: &[u8]) -> Result<RecordedMovement, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.bvh");
    std::fs::write(&path, bytes).unwrap();
    read_bvh(&path).map_err(|error| {
        let message = error.to_string();
        let (_, message) = message.split_once("walk.bvh: ").unwrap();
        assert!(!message.contains(char::is_control) && message.chars().count() < 350, "{message:?}");
        message.to_owned()
    })
}

#[test]
fn a_skeleton_and_its_frames_are_read() {
    let movement = read(GOOD.as_bytes()).unwrap();
    let joints = movement.joints();
    let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["Hips", "Left Arm", "Head", "Head (2)"]);
    assert_eq!(
        joints.iter().map(|joint| joint.parent).collect::<Vec<_>>(),
        [None, Some(0), Some(0), Some(2)]
    );
    assert_eq!((joints[0].offset, joints[1].offset), ([0.0, 1.5, -20.0], [1.0, 2.0, 3.0]));
    assert_eq!(joints[1].ends, [[4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    assert_eq!(
        joints[0].channels,
        [Position(0), Position(1), Position(2), Rotation(2), Rotation(0), Rotation(1)]
    );
    assert_eq!(joints[1].channels, [Rotation(1), Rotation(0), Rotation(2)]);
    assert_eq!((&joints[2].channels[..], &joints[3].channels[..]), (&[][..], &[Rotation(2)][..]));
    assert_eq!((movement.frames(), movement.frame_time()), (2, 0.0083333));
    assert_eq!(movement.local(0, 1).translation.vector.x, -1.0);
    assert!((movement.local(3, 1).rotation.angle() - 10_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn line_ends_marks_and_encodings_do_not_matter() {
    let good = read(GOOD.as_bytes()).unwrap();
    for text in [GOOD.replace('\n', "\r\n"), GOOD.replace('\n', "\r"), format!("\u{feff}{GOOD}")] {
        assert_eq!(read(text.as_bytes()).unwrap(), good);
    }
    // An umlaut in Latin-1, and one in UTF-8; letters that a terminal does not show; no name at all.
    let name = |name: &[u8]| {
        let (before, after) = GOOD.split_once("Left Arm").unwrap();
        read(&[before.as_bytes(), name, after.as_bytes()].concat()).unwrap().joints()[1].name.clone()
    };
    assert_eq!(name(b"H\xfcfte"), "Hüfte");
    assert_eq!(name("Hüfte".as_bytes()), "Hüfte");
    assert_eq!(name(b"a\x1b[31m\x00"), "a\u{fffd}[31m\u{fffd}");
    assert_eq!(name(b""), "unnamed");
    assert_eq!(name(&[b'x'; 5000]).len(), 200);
    assert_eq!(name(b"Head"), "Head");
}

#[test]
fn every_mistake_is_named_with_its_line() {
    for (from, to, expected) in [
        ("HIERARCHY", "HIERARCHIE", "line 1: a BVH file begins with HIERARCHY, not with `HIERARCHIE`"),
        ("HIERARCHY", "\u{7f}ELF\u{2}", "not with `\\u{7f}ELF\\u{2}`"),
        ("ROOT Hips\n{", "{", "line 2: `{` is not expected here"),
        ("ROOT Hips\n{", "ROOT Hips\n", "line 2: `Hips` lacks its `{`"),
        ("ROOT", "JOINT", "line 2: JOINT is not within a ROOT"),
        ("\tJOINT Left Arm", "ROOT Left Arm", "line 6: a second ROOT"),
        ("\t\tEND SITE", "}\nEND SITE", "line 17: JOINT is not within a ROOT or JOINT"),
        (
            "\t\t\tOFFSET 4 5 6",
            "End Site { OFFSET 1 1 1 }",
            "line 12: End Site is not within a ROOT or JOINT",
        ),
        ("OFFSET 1 2 3", "OFFSET 1 2", "line 9: OFFSET needs three numbers up to 1e9, but has nothing"),
        ("OFFSET 1 2 3", "OFFSET 1 2,5 3", "line 9: OFFSET needs three numbers up to 1e9, but has `2,5`"),
        ("OFFSET 1 2 3", "OFFSET 1 nan 3", "has `nan`"),
        ("OFFSET 1 2 3", "OFFSET 1 2e99 3", "has `2e99`"),
        ("OFFSET 1 2 3", "", "line 6: `Left Arm` lacks OFFSET"),
        ("OFFSET 1 2 3", "OFFSET 1 2 3 4", "line 9: `4` is not expected here"),
        ("OFFSET 1 2 3", "OFFSET 1 2 3\nOFFSET 1 2 3", "line 10: a second OFFSET"),
        ("\t\t\tOFFSET 4 5 6", "", "line 10: End Site lacks OFFSET"),
        ("CHANNELS 6", "CHANNELS", "line 5: CHANNELS does not begin with how many follow"),
        ("CHANNELS 6", "CHANNELS 99999999999999999999", "line 5: CHANNELS does not begin"),
        ("CHANNELS 6", "CHANNELS 7", "line 5: CHANNELS has `JOINT`; the channels are"),
        ("CHANNELS 6", "CHANNELS 5", "line 5: `Yrotation` is not expected here"),
        ("CHANNELS 6 X", "CHANNELS 6 W", "line 5: CHANNELS has `Wposition`; the channels are"),
        ("Zposition Z", "Yposition Z", "line 5: CHANNELS has `Yposition` twice"),
        ("CHANNELS 3", "CHANNELS 4 Xrotation", "line 8: CHANNELS has more than three rotations"),
        ("{ OFFSET 7 8 9 }", "{ OFFSET 7 8 9", "line 2: its `{` is never closed"),
        ("1 Zrotation }}", "1 Zrotation }}}}", "line 19: `}` closes nothing"),
        ("MOTION", "", "line 23: `Frames:` is not expected here"),
        ("Frames: 2\n", "", "line 23: `Frames:` must follow, but there is `Frame Time:"),
        ("Frames: 2", "Frames: two", "line 23: Frames is `two`, but must be a whole number"),
        ("Frames: 2", "Frames: -1", "line 23: Frames is `-1`"),
        ("Frames: 2", "Frames: 3", "line 23: 3 frames are declared, but 2 follow"),
        ("Frames: 2", "Frames: 18446744073709551615", "frames are declared, but 2 follow"),
        (
            "Frame Time:\t.0083333",
            "",
            "line 25: `Frame Time:` must follow, but there is `1 2 3 4 5 6 7 8 9 10`",
        ),
        (".0083333", "0", "line 24: Frame Time is `0`, but must be 0.000001 to 1000 (s)"),
        (".0083333", "NaN", "line 24: Frame Time is `NaN`"),
        (".0083333", "-0.1", "line 24: Frame Time is `-0.1`"),
        ("-1 2 3", "-1 2", "line 26: 9 numbers, but a frame has 10"),
        ("-1 2 3", "-1 2 3 3", "line 26: 11 numbers, but a frame has 10"),
        ("-1 2 3", "-1 2 inf", "line 26: number 3 is `inf`, but must be a number up to 1e9"),
        ("-1 2 3", "-1 -1.#IND 3", "line 26: number 2 is `-1.#IND`"),
    ] {
        assert!(GOOD.contains(from), "{from}");
        let message = read(GOOD.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(message.contains(expected), "{to:?}: {message:?} lacks {expected:?}");
    }
    let head = GOOD.split("MOTION").next().unwrap();
    for (bytes, expected) in [
        (&b""[..], "is empty"),
        (b"\n \n", "is empty"),
        (b"HIERARCHY\n", "has no ROOT"),
        (head.as_bytes(), "has no line MOTION"),
        (b"MOTION\nFrames: 1\n", "is empty; a BVH file begins with HIERARCHY"),
        (b"HIERARCHY ROOT a { OFFSET 0 0 0 }\nMOTION\n", "has no joint with CHANNELS"),
        (format!("{head}MOTION\nFrames: 0\nFrame Time: 1\n").as_bytes(), "line 23: no frame follows"),
        (format!("{head}MOTION").as_bytes(), "line 22: `Frames:` must follow, but there is ``"),
        (&[0xff, 0xfe, b'H', 0, b'I', 0], "a BVH file begins with HIERARCHY"),
    ] {
        let message = read(bytes).unwrap_err();
        assert!(message.contains(expected), "{message:?} lacks {expected:?}");
    }
}

#[test]
fn depth_and_numbers_have_bounds() {
    let nested = |count: usize| {
        let channels = "CHANNELS 1 Xrotation\n";
        let open = "JOINT a {\nOFFSET 0 1 0\n".repeat(count);
        let text = format!(
            "HIERARCHY\nROOT a {{\nOFFSET 0 0 0\n{channels}{open}{}}}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n",
            "}".repeat(count)
        );
        read(text.as_bytes())
    };
    // Names that all joints want are told apart in no time.
    let deep = nested(9_999).unwrap();
    assert_eq!(deep.joints()[9_999].name, "a (10000)");
    assert_eq!(deep.rest()[9_999].y, 9_999.0);
    assert!(nested(10_000).unwrap_err().contains("more than 10000 joints"));
    let error = read_bvh(Path::new("/dev/zero")).unwrap_err().to_string();
    assert!(error.contains("is longer than 536870912 bytes"), "{error}");
    let error = read_bvh(Path::new("absent.bvh")).unwrap_err().to_string();
    assert!(error.starts_with("absent.bvh: cannot be read: "), "{error}");
}
