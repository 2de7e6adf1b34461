//! Test that a body has the mass, the centre of mass and the inertia that its description names.

use std::fs;

use crate::files::body::{BodyFile, DENSITY, InertiaEntry, PartEntry};
use crate::files::import::options::{Imported, Options};
use crate::files::import::read::import;
use crate::stages::agent::{Part, Vector3};

fn imported(name: &str, text: &str, strict: bool) -> Result<Imported, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    import(&path, &Options { strict, ..Options::default() }).map_err(|error| error.to_string())
}

/// Mass of a part, kg, and its inertia.
fn named(file: &BodyFile, part: usize) -> (f64, InertiaEntry) {
    let entry = &file.parts[part];
    let made = file.body().unwrap().agent.parts[part].clone();
    (entry.density.unwrap_or(DENSITY) * made.shape.volume(), entry.inertia.unwrap())
}

#[track_caller]
fn near(found: Vector3, expected: Vector3) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} is not {expected:?}");
}

#[test]
fn the_inertia_of_a_link_is_in_the_common_frame() {
    // The link is turned by a quarter about x, and its inertia by another one about z.
    let half = std::f64::consts::FRAC_PI_2;
    let urdf = format!(
        "<robot><link name='a'><collision><geometry><sphere radius='1'/></geometry></collision></link>
         <link name='b'><inertial><origin xyz='0 0 1' rpy='0 0 {half}'/><mass value='2'/>
           <inertia ixx='3' iyy='4' izz='5' ixy='0.1' ixz='0.2' iyz='0.3'/></inertial>
           <collision><geometry><box size='1 1 1'/></geometry></collision></link>
         <joint name='j' type='continuous'><origin xyz='5 0 0' rpy='{half} 0 0'/><parent link='a'/><child link='b'/></joint></robot>"
    );
    // In MJCF the same, in degrees; its order is xx, yy, zz, xy, xz, yz, too.
    let mjcf = "<mujoco><worldbody><body name='a'><geom size='1'/><body name='b' pos='5 0 0' euler='90 0 0'><joint axis='1 0 0'/>
        <inertial pos='0 0 1' euler='0 0 90' mass='2' fullinertia='3 4 5 0.1 0.2 0.3'/><geom type='box' size='.5 .5 .5'/>
        </body></body></worldbody></mujoco>";
    for (name, text) in [("r.urdf", &*urdf), ("r.xml", mjcf)] {
        let Imported { file, notes, .. } = imported(name, text, true).unwrap();
        assert!(notes.is_empty() && file.parts[0].inertia.is_none(), "{notes:?}");
        let (mass, inertia) = named(&file, 1);
        assert!((mass - 2.0).abs() < 1e-9);
        near(inertia.centre.unwrap(), [5.0, -1.0, 0.0]);
        // By the turns, its x is z of the world, its y is -x, and its z is -y.
        near(inertia.moments, [4.0, 5.0, 3.0]);
        near(inertia.products.unwrap(), [0.3, -0.1, -0.2]);
    }
}

/// What the parts weigh together, kg.
fn weight(text: &str) -> f64 {
    let Imported { file, .. } = imported("r.urdf", text, true).unwrap();
    let made = file.body().unwrap().agent.parts;
    let mass = |(entry, made): (&PartEntry, &Part)| entry.density.unwrap_or(DENSITY) * made.shape.volume();
    file.parts.iter().zip(&made).map(mass).sum()
}

#[test]
fn a_urdf_link_without_a_mass_has_none_where_what_is_fixed_to_it_has_one() {
    let shape = "<collision><geometry><box size='.5 .3 .2'/></geometry></collision>";
    let link = |name: &str, mass: &str, shape: &str| {
        let inertial =
            if mass.is_empty() { "".into() } else { format!("<inertial><mass value='{mass}'/></inertial>") };
        format!("<link name='{name}'>{inertial}{shape}</link>")
    };
    let robot = |first: &str, second: &str, kind: &str| {
        let ends = "<parent link='a'/><child link='b'/>";
        format!("<robot name='r'>{first}{second}<joint name='j' type='{kind}'>{ends}</joint></robot>")
    };
    let (bare, small) = ("", shape.replace(".5", ".05"));
    for (first, second, kind, expected) in [
        // The mass of the shape is named by a link of its own, as of many published robots; 30 kg of water would come to it.
        (link("a", "", shape), link("b", "20", bare), "fixed", 20.0),
        (link("a", "20", bare), link("b", "", shape), "fixed", 20.0),
        (link("a", "20", bare), link("b", "0", shape), "fixed", 20.0),
        (link("a", "5", shape), link("b", "", &small), "fixed", 5.0),
        (link("a", "5", shape), link("b", "", &small), "continuous", 5.0 + 3.0),
        (link("a", "", shape), link("b", "", &small), "fixed", 30.0 + 3.0),
        // What turns on it says nothing of its own mass.
        (link("a", "", shape), link("b", "1", bare), "continuous", 30.0 + 1.0),
    ] {
        let text = robot(&first, &second, kind);
        assert!(
            (weight(&text) - expected).abs() < 1e-4 * expected,
            "{} is not {expected}: {text}",
            weight(&text)
        );
    }
}

/// Links on a line along x, each fixed to the one before by a metre.
fn fixed(links: &[&str]) -> String {
    let link = |(at, inside): (usize, &&str)| format!("<link name='{at}'>{inside}</link>");
    let joint = |at: usize| {
        format!(
            "<joint name='{at}' type='fixed'><origin xyz='1 0 0'/><parent link='{}'/><child link='{at}'/></joint>",
            at - 1
        )
    };
    let all: String = links.iter().enumerate().map(link).chain((1..links.len()).map(joint)).collect();
    format!("<robot>{all}</robot>")
}

fn inertial(mass: f64, moment: f64) -> String {
    format!(
        "<inertial><mass value='{mass}'/><inertia ixx='{moment}' iyy='{moment}' izz='{moment}'/></inertial>"
    )
}

/// The same, turned, which changes nothing of its inertia but the last digits.
const TURNED: &str =
    "<collision><origin rpy='.3 .4 .5'/><geometry><box size='.1 .1 .1'/></geometry></collision>";
const CUBE: &str = "<collision><geometry><box size='.1 .1 .1'/></geometry></collision>";

#[test]
fn links_that_are_fixed_have_the_inertia_of_all_by_the_parallel_axis_theorem() {
    // The third link has no shape, and the fourth no inertia: it is an even cube of 1 kg, with 1/600 kg m².
    let links = [
        format!("{}{CUBE}", inertial(1.0, 0.1)),
        format!("{}{CUBE}", inertial(3.0, 0.2)),
        inertial(1.0, 0.3),
        format!("<inertial><mass value='1'/></inertial>{TURNED}"),
    ];
    let text = fixed(&links.each_ref().map(|link| &**link));
    let Imported { file, notes, .. } = imported("r.urdf", &text, true).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let all: Vec<(f64, InertiaEntry)> = (0..3).map(|part| named(&file, part)).collect();
    let mass: f64 = all.iter().map(|(mass, _)| mass).sum();
    assert!((mass - 6.0).abs() < 1e-9, "{mass}");
    let centre = (3.0 + 2.0 + 3.0) / 6.0;
    let apart: f64 =
        [1.0, 3.0, 1.0, 1.0].iter().zip(0..).map(|(mass, at)| mass * (f64::from(at) - centre).powi(2)).sum();
    let own = 0.6 + 1.0 / 600.0;
    let moments = [0, 1, 2].map(|axis| all.iter().map(|(_, inertia)| inertia.moments[axis]).sum::<f64>());
    near(moments, [own, own + apart, own + apart]);
    for (mass, inertia) in all {
        near(inertia.centre.unwrap(), [centre, 0.0, 0.0]);
        // Each has a share by its mass.
        near(inertia.moments, moments.map(|moment| moment * mass / 6.0));
    }
}

#[test]
fn what_no_body_can_have_is_replaced_with_a_note_and_refused_if_asked() {
    for inertia in [
        "ixx='1' iyy='1' izz='3'",
        "ixx='1' iyy='1' izz='0'",
        "ixx='1' iyy='1' izz='-1'",
        "ixx='1' iyy='1' izz='1' ixy='2'",
    ] {
        let text = fixed(&[&format!("<inertial><mass value='2'/><inertia {inertia}/></inertial>{CUBE}")]);
        let Imported { file, notes, .. } = imported("r.urdf", &text, false).unwrap();
        assert_eq!((file.parts[0].inertia, file.parts[0].density), (None, Some(2000.0)), "{inertia}");
        assert_eq!(notes, ["inertias that no rigid body has are replaced by those of the shapes (1): 0"]);
        let refused = imported("r.urdf", &text, true).unwrap_err();
        assert!(refused.contains("link `0` has an inertia that no rigid body has; correct"), "{refused}");
    }
    // One of 0 says nothing.
    let text = fixed(&[&format!("{}{CUBE}", inertial(2.0, 0.0))]);
    assert_eq!(imported("r.urdf", &text, true).unwrap().file.parts[0].inertia, None);
}

#[test]
fn the_inertia_grows_with_the_mass_of_all_bodies() {
    let mjcf = "<mujoco><compiler settotalmass='6'/><worldbody><body name='a'><inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/>
        <geom size='1'/></body></worldbody></mujoco>";
    let Imported { file, .. } = imported("r.xml", mjcf, true).unwrap();
    near(named(&file, 0).1.moments, [3.0; 3]);
    let of_geoms = mjcf.replace("settotalmass='6'", "inertiafromgeom='true'");
    assert_eq!(imported("r.xml", &of_geoms, true).unwrap().file.parts[0].inertia, None);
}
