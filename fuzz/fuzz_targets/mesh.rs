//! Fuzz the readers of meshes: a robot that has one is a body with sensors, or the mesh is refused in a line.

#![no_main]

use bodyschema::files::body::SkinEntry;
use bodyschema::files::import::{Options, import};
use bodyschema_fuzz::{accepted, file};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // The first byte says which format the others have.
    let Some((kind, rest)) = data.split_first() else { return };
    let name = ["m.stl", "m.obj", "m.dae", "m.msh", "m.gltf", "m.glb"][usize::from(kind % 6)];
    file(name, rest);
    let robot = format!(
        "<robot><link name='a'><visual><geometry><mesh filename='{name}'/></geometry></visual></link></robot>"
    );
    let options = Options { skin: SkinEntry { sensors: Some(5), per_area: None }, ..Options::default() };
    if let Some(robot) = accepted(import(&file("robot.urdf", robot.as_bytes()), &options)) {
        let body = robot.file.body().expect("what was made of a robot is a body");
        let finite = |numbers: [f64; 3]| numbers.iter().all(|number| number.is_finite());
        assert!(body.agent.sites.iter().all(|site| finite(site.position) && finite(site.normal)));
    }
});
