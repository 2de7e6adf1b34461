//! Write estimated parts and joints as a robot that programs of ROS read: URDF.
//!
//! A link is a box around the sensors of a part, in the frame of its joint. A joint turns in every direction, since touch does not
//! tell about which axes parts turn: three hinges at one place, with two links of no shape between them.

use nalgebra::{Rotation3, Vector3};

use crate::stages::placement::{JointPlace, Placement};

/// What the first comment begins with.
pub const MARK: &str = "Estimated by bodyschema.";

/// The robot. `notes` become comments at its head.
pub fn urdf(placement: &Placement, notes: &[String]) -> String {
    let mut text = "<?xml version=\"1.0\"?>\n".to_owned();
    let head = format!("{MARK} A box holds the sensors of a part; masses are not known.");
    for note in std::iter::once(&head).chain(notes) {
        text += &format!("<!-- {note} -->\n");
    }
    // MuJoCo wants a mass of whatever moves; programs of ROS leave this out.
    text += "<robot name=\"estimated\">\n  <mujoco><compiler boundmass=\"1e-6\" boundinertia=\"1e-9\"/></mujoco>\n";
    for part in &placement.parts {
        let own = placement.joints.iter().find(|joint| joint.child == part.part);
        let centre = part.solid.centre - own.map_or_else(Vector3::zeros, |joint| joint.in_child);
        text += &format!("  <link name=\"part_{}\">\n", part.part);
        let [x, y, z] = part.solid.sides.into();
        for element in ["visual", "collision"] {
            text += &format!(
                "    <{element}>\n      {}\n      <geometry><box size=\"{x:.6} {y:.6} {z:.6}\"/></geometry>\n    </{element}>\n",
                origin(&centre, &part.solid.rotation)
            );
        }
        text += "  </link>\n";
    }
    placement.joints.iter().for_each(|joint| add_joint(&mut text, placement, joint));
    text + "</robot>\n"
}

fn add_joint(text: &mut String, placement: &Placement, joint: &JointPlace) {
    let JointPlace { child, parent, in_parent, rotation, .. } = joint;
    let carrier = placement.joints.iter().find(|other| other.child == *parent);
    let place = in_parent - carrier.map_or_else(Vector3::zeros, |other| other.in_child);
    let [first, last] = [parent, child].map(|part| format!("part_{part}"));
    let [one, two] = ["x", "y"].map(|axis| format!("joint_{child}_{parent}_after_{axis}"));
    let origins = [origin(&place, rotation), origin(&Vector3::zeros(), &Rotation3::identity())];
    for name in [&one, &two] {
        *text += &format!("  <link name=\"{name}\"/>\n");
    }
    for ((axis, at), [from, to]) in [("x", &origins[0]), ("y", &origins[1]), ("z", &origins[1])]
        .into_iter()
        .zip([[&first, &one], [&one, &two], [&two, &last]])
    {
        let direction = ["x", "y", "z"].map(|other| if other == axis { "1" } else { "0" }).join(" ");
        *text += &format!(
            "  <joint name=\"joint_{child}_{parent}_{axis}\" type=\"continuous\">\n    {at}\n    <parent link=\"{from}\"/>\n    \
             <child link=\"{to}\"/>\n    <axis xyz=\"{direction}\"/>\n  </joint>\n"
        );
    }
}

fn origin(place: &Vector3<f64>, rotation: &Rotation3<f64>) -> String {
    let (roll, pitch, yaw) = rotation.euler_angles();
    // Without the minus of a zero.
    let [x, y, z, roll, pitch, yaw] = [place.x, place.y, place.z, roll, pitch, yaw].map(|number| {
        let text = format!("{number:.6}");
        if text.trim_start_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { text }
    });
    format!("<origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/>")
}
