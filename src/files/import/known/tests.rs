//! Test that misspelt attributes are told with their line, and that none is that MuJoCo and ROS have.

use super::*;
use crate::files::import::document::parsed;

fn of_mjcf(inside: &str, strict: bool) -> Result<Option<String>, Wrong> {
    let text = format!("<mujoco>\n{inside}</mujoco>");
    unknown(mjcf_elements(parsed(&text).unwrap().root_element()), &MJCF, strict)
}

fn of_urdf(inside: &str, strict: bool) -> Result<Option<String>, Wrong> {
    let text = format!("<robot nam='r'>\n{inside}</robot>");
    unknown(urdf_elements(parsed(&text).unwrap().root_element()), &URDF, strict)
}

#[test]
fn misspelt_attributes_are_told_and_refused_if_asked() {
    let geoms = "<worldbody><body nmae='a'>\n<geom siez='1'/>\n<geom siez='1' size='1'/></body></worldbody>";
    assert_eq!(
        of_mjcf(geoms, false).unwrap().unwrap(),
        "attributes that are not known are ignored (2): `nmae` of body (line 2), `siez` of geom (line 3 and 1 more)"
    );
    let refused = of_mjcf(geoms, true).unwrap_err();
    assert_eq!(refused, "line 2: body has an attribute `nmae`, which is not known; correct or remove it");
    for (inside, expected) in [
        ("<default><geom siz='1'/></default>", "`siz` of geom"),
        ("<compiler anlge='radian'/>", "`anlge` of compiler"),
        ("<asset><mesh fil='1'/></asset>", "`fil` of mesh"),
    ] {
        assert!(of_mjcf(inside, false).unwrap().unwrap().contains(expected), "{inside}");
    }
    let joint = "<joint name='j' typ='fixed'><origin xzy='0 0 1'/></joint>";
    let told = of_urdf(joint, false).unwrap().unwrap();
    assert!(told.ends_with("(2): `typ` of joint (line 2), `xzy` of origin (line 2)"), "{told}");
    assert!(of_urdf("<link name='a'><inertial><mass vlaue='1'/></inertial></link>", true).is_err());
}

#[test]
fn what_others_have_and_what_is_no_part_of_a_body_is_not_told() {
    for inside in [
        "<worldbody><body name='a' gravcomp='1'><joint actuatorfrcrange='0 1' frictionloss='1'/><geom solmix='1' user='1'/>
           <composite type='cable'><joint kind='main'/><geom any='1'/></composite></body></worldbody>",
        "<default><joint armature='1'/><motor any='1'/><equality active='false'/></default>",
        "<tendon><spatial><geom geom='g' sidesite='s'/></spatial></tendon><sensor><body any='1'/></sensor>",
        "<asset><mesh name='m' file='m.obj' inertia='shell'/><texture any='1'/></asset>",
    ] {
        assert_eq!(of_mjcf(inside, true).unwrap(), None, "{inside}");
    }
    for inside in [
        "<link name='a'><collision group='1'><origin rpy='0 0 0'/><geometry><mesh filename='m' scale='1 1 1'/></geometry></collision></link>",
        "<joint name='j' type='fixed'><limit any='1'/><mimic joint='k' offset='1'/></joint>",
        "<gazebo reference='a'><link any='1'><mass kg='1'/></link></gazebo><transmission><joint any='1'/></transmission>",
        "<link xmlns:own='http://example.org' name='a' own:colour='red'/>",
    ] {
        assert_eq!(of_urdf(inside, true).unwrap(), None, "{inside}");
    }
}
