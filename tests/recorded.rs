//! Recorded movements as a user meets them: a body of a skeleton, its movement felt, seen and estimated, and mistakes.

use bodyschema::files::body::read_body;
use bodyschema::files::npy::read_tactile;
use bodyschema::files::tables::read_truth;

use crate::support::folder::Folder;
use crate::support::repository::read;

/// A recording of our own: 2 s of hips, trunk, an arm of one piece with a watch and a finger, and legs of which one is rigid.
fn text() -> String {
    read("tests/data/movement/arms.bvh")
}

/// A folder with the recording, `walk.bvh`.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("walk.bvh", text());
    folder
}

#[test]
fn a_skeleton_becomes_a_body() {
    let folder = folder();
    let told = folder.succeed("body import walk.bvh --sensors-per-part 20 --out body.toml");
    assert!(
        told.starts_with("13 parts, in body.toml\njoints: 0 universal, 1 hinge, 6 ball, 5 fixed\n"),
        "{told}"
    );
    assert!(
        told.contains("note: the file names no unit") && told.contains("so centimetres were assumed"),
        "{told}"
    );
    assert!(told.contains("that do not turn are fixed to what carries them (1): Watch\n"), "{told}");
    assert!(
        told.contains("bones shorter than 0.05 m carry no skin, unless --min-length says so (1 of 13)\n"),
        "{told}"
    );
    let body = read_body(&folder.at("body.toml")).unwrap();
    let names = body.rigid_names();
    assert_eq!(names[..3], ["Hips + Hips/2 + Hips/3", "Spine + Spine/2", "Arm"]);
    assert_eq!((body.agent.sites.len(), body.agent.truth().parts()), (12 * 20, 7));
    // Of a unit that is given.
    folder.succeed("body import walk.bvh --scale 0.1 --min-length 2 --per-area 1 --out large.toml");
    let large = read_body(&folder.at("large.toml")).unwrap();
    assert!((large.agent.joints[2].anchor[1] - 2.0).abs() < 1e-9);
    // A skeleton's body can be simulated, too.
    folder.write("short.toml", "[physics]\nduration = 2.0\n");
    folder.succeed("simulate --body body.toml --settings short.toml --out random");
}

#[test]
fn a_movement_is_felt_seen_and_estimated() {
    let folder = folder();
    folder.succeed("body import walk.bvh --out body.toml");
    let told = folder.succeed("simulate --body body.toml --movement walk.bvh --out moved");
    assert!(told.starts_with("100 samples of 480 sensors on 6 parts, 0.02 s apart, in moved\n"), "{told}");
    assert!(told.contains("(1): Rigid on Hips\n"), "{told}");
    // Without a body file, the same body makes the same movement.
    let alone = folder.succeed("simulate --movement walk.bvh --out alone");
    assert!(alone.contains("so centimetres were assumed"), "{alone}");
    for name in [
        "tactile.npy",
        "labels.csv",
        "tree.csv",
        "names.csv",
        "joint-angles.csv",
        "poses.npy",
        "solids.csv",
        "sensors.csv",
    ] {
        assert_eq!(folder.bytes(format!("moved/{name}")), folder.bytes(format!("alone/{name}")), "{name}");
    }
    let tactile = read_tactile(&folder.at("moved/tactile.npy")).unwrap();
    assert_eq!((tactile.samples, tactile.sensors()), (100, 480));
    // Those on the back of what only goes forward feel nothing.
    let felt = tactile.series().filter(|series| series.iter().any(|pressure| *pressure > 0.0)).count();
    assert!(felt > 400, "{felt}");
    // The truth leaves out the finger, which has no skin.
    let truth = read_truth(&folder.at("moved/labels.csv"), &folder.at("moved/tree.csv"), 480).unwrap();
    assert_eq!((truth.parts(), truth.tree.len()), (6, 5));
    let names = folder.text("moved/names.csv");
    assert!(
        names.starts_with(
            "part,name\n0,Hips + Hips/2 + Hips/3 + Rigid\n1,Spine + Spine/2\n2,Arm\n3,Forearm + "
        ),
        "{names}"
    );
    let angles = folder.text("moved/joint-angles.csv");
    assert_eq!(angles.lines().count(), 102);
    assert!(angles.lines().nth(2).unwrap().starts_with("0.020000,"), "{angles}");

    let truth = "--labels moved/labels.csv --tree moved/tree.csv";
    let estimated = folder.run(&format!("estimate moved/tactile.npy {truth} --interval 0.02 --out found"));
    assert!(estimated.out.contains("against the truth: adjusted Rand index "), "{estimated:?}");
    let told = folder.succeed("view moved --estimate found");
    assert!(told.starts_with("480 sensors in "), "{told}");
}

#[test]
fn times_are_those_of_the_recording_unless_the_user_says_others() {
    let folder = folder();
    folder.write("tenths.toml", "[sense]\ninterval = 0.1\n");
    folder.write("thin.toml", "[sense]\nfluid_density = 505.0\n");
    let told = folder.succeed("simulate --movement walk.bvh --settings tenths.toml --out tenths");
    assert!(told.starts_with("20 samples of 480 sensors on 6 parts, 0.1 s apart"), "{told}");
    let told = folder.succeed("simulate --movement walk.bvh --settings thin.toml --duration 0.5 --out half");
    assert!(told.starts_with("25 samples of") && told.contains("0.02 s apart"), "{told}");
    assert!(told.contains("note: 0.5 s of 2 s are played (--duration)\n"), "{told}");
    // Half of the density is half of the pressure of the first samples.
    folder.succeed("simulate --movement walk.bvh --out all");
    let [half, all] = ["half", "all"].map(|name| read_tactile(&folder.at(name).join("tactile.npy")).unwrap());
    for (half, all) in half.series().zip(all.series()) {
        assert!(half.iter().zip(all).all(|(half, all)| (2.0 * half - all).abs() <= 1e-5 * all.abs()));
    }
    // Twice as many samples: every other one is a frame, and feels the same.
    folder.write("often.toml", "[sense]\ninterval = 0.01\n");
    folder.succeed("simulate --movement walk.bvh --settings often.toml --out often");
    let often = read_tactile(&folder.at("often").join("tactile.npy")).unwrap();
    assert_eq!(often.samples, 200);
    // But for what a part is accelerated by in a moment, a thousandth of a sample.
    let (mut error, mut speed) = (0.0, 0.0);
    for (often, all) in often.series().zip(all.series()) {
        for (pair, all) in often.chunks(2).zip(all) {
            error += (pair[1].sqrt() - all.sqrt()).powi(2);
            speed += all;
        }
    }
    assert!((error / speed).sqrt() < 1e-3, "{}", (error / speed).sqrt());
}

#[test]
fn jumps_are_cut_off_and_said() {
    let folder = folder();
    // A rest pose before the movement, and one frame at another place late in it.
    let text = text();
    let (head, frames) = text.split_once("Frame Time: 0.02\n").unwrap();
    let mut frames: Vec<String> = frames.lines().map(str::to_owned).collect();
    frames.insert(0, ["0"; 25].join(" "));
    frames[90] = frames[90].split_once(' ').map(|(_, rest)| format!("900 {rest}")).unwrap();
    let head = head.replace("Frames: 101", "Frames: 102");
    folder.write("walk.bvh", format!("{head}Frame Time: 0.02\n{}\n", frames.join("\n")));
    let told = folder.succeed("simulate --movement walk.bvh --out cut");
    assert!(told.starts_with("88 samples of"), "{told}");
    assert!(
        told.contains("frames 2 to 90 of 102 are played, the longest stretch without a jump: there are 3 "),
        "{told}"
    );
    let told = folder.succeed("simulate --movement walk.bvh --keep-jumps --out all");
    assert!(told.starts_with("101 samples of") && !told.contains("jump"), "{told}");
}

#[test]
fn a_mistake_is_one_line_and_leaves_nothing() {
    let folder = folder();
    let text = text();
    let write = |name: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        folder.write(name, text.replace(from, to));
    };
    write("two.bvh", "MOTION", "ROOT Other\n{\nOFFSET 0 0 0\n}\nMOTION");
    write("nan.bvh", "100.7145", "NaN");
    write("few.bvh", "Frames: 101", "Frames: 4000000000000");
    write("still.bvh", "Frame Time: 0.02", "Frame Time: 0");
    write("longer.bvh", "OFFSET 0 -45 0", "OFFSET 0 -55 0");
    write("other.bvh", "JOINT Forearm", "JOINT Elbow");
    let (head, frames) = text.split_once("Frames: 101\nFrame Time: 0.02\n").unwrap();
    let one = format!("{head}Frames: 1\nFrame Time: 0.02\n{}\n", frames.lines().next().unwrap());
    folder.write("one.bvh", one);
    folder.write("noise.bvh", [0x89, b'P', b'N', b'G', 0, 1, 2, 255]);
    folder.write("robot.urdf", "<robot name='r'/>");
    folder.succeed("body import walk.bvh --out body.toml");
    for (arguments, expected) in [
        ("body import two.bvh --out b.toml", "two.bvh: line 66: a second ROOT"),
        ("body import nan.bvh --out b.toml", "nan.bvh: line 118: number 1 is `NaN`, but must be a number"),
        ("body import few.bvh --out b.toml", "4000000000000 frames are declared, but 101 follow"),
        ("body import still.bvh --out b.toml", "Frame Time is `0`, but must be"),
        ("body import noise.bvh --out b.toml", "noise.bvh: line 1: a BVH file begins with HIERARCHY"),
        ("body import absent.bvh --out b.toml", "absent.bvh: cannot be read"),
        ("body import walk.bvh --scale 0.00001 --out b.toml", "no bone is as long as 0.01 m"),
        ("body import walk.bvh --scale 1000 --out b.toml", "part `"),
        ("body import robot.urdf --scale 1 --out b.toml", "--scale is for recorded movements"),
        ("body import robot.urdf --min-length 1 --out b.toml", "--min-length is for recorded movements"),
        ("simulate --movement nan.bvh --out s", "nan.bvh: line 118: number 1 is `NaN`, but must be a number"),
        ("simulate --movement one.bvh --out s", "one.bvh: has one frame, but a movement needs two"),
        (
            "simulate --movement walk.bvh --duration 0.01 --out s",
            "walk.bvh: 0.01 s are played, but a sample needs 0.02 s",
        ),
        ("simulate --movement walk.bvh --body longer.bvh --out s", "longer.bvh: line 1"),
        (
            "simulate --movement longer.bvh --body body.toml --out s",
            "body.toml: cannot move as longer.bvh: the joint of its part `",
        ),
        (
            "simulate --movement other.bvh --body body.toml --out s",
            "its part `Forearm` is not named after a joint",
        ),
        (
            "simulate --movement walk.bvh --body body.toml --scale 1 --out s",
            "the skeletons or their units differ",
        ),
    ] {
        folder.refuse(arguments, expected);
        assert!(!folder.at("b.toml").exists() && !folder.at("s").exists(), "{arguments}");
    }
    // Options of recorded movements need one.
    for arguments in [
        "simulate --keep-jumps --out s",
        "simulate --scale 1 --out s",
        "body import walk.bvh --scale 0 --out b.toml",
    ] {
        assert_eq!(folder.run(arguments).status, Some(2), "{arguments}");
        assert!(!folder.at("b.toml").exists() && !folder.at("s").exists(), "{arguments}");
    }
}
