//! Every body of the folder `bodies` is one, and can be simulated; the study of them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use bodyschema::estimate::estimate;
use bodyschema::files::body::{NamedBody, read_body};
use bodyschema::numerics::partition::adjusted_rand_index;
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::simulate;
use rand_distr::{Distribution, StandardNormal};

fn bodies() -> Vec<(PathBuf, NamedBody)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("bodies");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), read_body(&path).unwrap())).collect()
}

#[test]
fn each_is_a_tree_whose_parts_all_have_a_skin() {
    let bodies = bodies();
    assert!(bodies.len() >= 12);
    for (path, NamedBody { agent, names }) in bodies {
        let truth = agent.truth();
        assert_eq!((truth.parts(), truth.tree.len() + 1), (names.len(), names.len()), "{path:?}");
        for (part, name) in names.iter().enumerate() {
            let own = truth.labels.iter().filter(|label| **label == part).count();
            assert!(own >= 24, "{path:?}: {name} has {own} sensors");
        }
    }
}

#[test]
fn a_body_is_simulated_and_its_parts_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("short.toml"), "[physics]\nduration = 20.0\n").unwrap();
    let simulate = |body: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
        command.current_dir(&folder).args([
            "simulate",
            "--settings",
            "short.toml",
            "--out",
            "moved",
            "--body",
        ]);
        command.arg(body).output().unwrap()
    };
    let human = Path::new(env!("CARGO_MANIFEST_DIR")).join("bodies/human.toml");
    let output = simulate(&human);
    assert!(output.status.success(), "{output:?}");
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.starts_with("200 samples of 634 sensors on 13 parts"), "{told}");
    let names = fs::read_to_string(at("moved/names.csv")).unwrap();
    assert!(names.starts_with("part,name\n0,pelvis\n1,chest\n"), "{names}");
    // Three universal joints, five balls and four hinges.
    let angles = fs::read_to_string(at("moved/joint-angles.csv")).unwrap();
    let header = angles.lines().next().unwrap();
    assert_eq!(header.split(',').count() - 1, 3 * 2 + 5 * 3 + 4, "{header}");
    assert!(header.contains("joint2_angle3_rad,joint3_angle1_rad"), "{header}");

    fs::write(at("wrong.toml"), "[[part]]\nname = \"trunk\"\nshape = \"sphere\"\nradius = 0.1\n").unwrap();
    let output = simulate(&at("wrong.toml"));
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(told.contains("part `trunk`: it lacks centre") && told.lines().count() == 1, "{told}");
}

#[test]
fn noise_costs_fewer_parts_if_it_counts_as_no_touch() {
    let mut settings = Settings::load_over(Some(Base::ESTIMATE), None).unwrap();
    (settings.motion.coordination, settings.motion.epoch) = (0.5, 1000);
    (settings.physics.duration, settings.physics.step) = (1000.0, 0.005);
    let Settings { motion, physics, sense: tactile_sense, quantise, .. } = &settings;
    for name in ["star", "chain-6"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("bodies/{name}.toml"));
        let NamedBody { agent, .. } = read_body(&path).unwrap();
        let rng = &mut stream(11, 1, "motion", 0);
        let trajectory = simulate(&agent, motion, physics, tactile_sense.interval, rng, &|| ()).unwrap();
        let mut tactile = sense(&agent, &trajectory, tactile_sense);
        for series in tactile.pressures.chunks_mut(tactile.samples) {
            let squares: f32 = series.iter().map(|pressure| pressure * pressure).sum();
            let deviation = 0.1 * (squares / series.len() as f32).sqrt();
            for pressure in series {
                let error: f32 = StandardNormal.sample(rng);
                *pressure = (*pressure + deviation * error).max(0.0);
            }
        }
        let agreement = |recording: &Recording| {
            let found = estimate(recording, quantise, &mut stream(1, 1, "co-motion", 0), &|| ()).unwrap();
            adjusted_rand_index(&found.parts.labels, &agent.labels())
        };
        let cleaned = Recording::new(tactile.clone());
        assert_eq!(cleaned.noisy, agent.labels().len(), "{name}");
        let as_felt = Recording { tactile, noisy: 0, ..cleaned.clone() };
        let (felt, cut) = (agreement(&as_felt), agreement(&cleaned));
        assert!(cut > 0.8 && cut > felt + 0.05, "{name}: {felt} with noise that is felt, {cut} without");
    }
}

#[test]
fn the_study_of_bodies_repeats_itself_and_names_mistakes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let chain =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("bodies/chain-3.toml")).unwrap();
    fs::write(at("chain-3.toml"), &chain).unwrap();
    let design = |coordinations: &str| {
        format!(
            "seed = 4\nmovements = 2\nchains = 2\ncoordinations = {coordinations}\nbodies = [\"chain-3.toml\"]\n\
             [[recording]]\nsamples = 1000\nnoise = 0.0\n[[recording]]\nsamples = 500\nnoise = 0.1\n"
        )
    };
    let study = |name: &str, out: &str, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
        command
            .current_dir(&folder)
            .args(["bodies", "--design", name, "--out", out])
            .args(more)
            .output()
            .unwrap()
    };
    fs::write(at("bodies.toml"), design("[0.0, 0.5]")).unwrap();
    let output = study("bodies.toml", "whole", &[]);
    assert!(output.status.success(), "{output:?}");
    let page = fs::read_to_string(at("whole/bodies.md")).unwrap();
    assert!(page.contains("| chain-3 | 3 | ") && page.contains("| 0.5 | 500 | 0.1 | 2 |"), "{page}");
    assert_eq!(fs::read_to_string(at("whole/recordings.csv")).unwrap().lines().count(), 9);
    // One movement now, and the other one later.
    assert!(study("bodies.toml", "again", &["--movements", "1"]).status.success());
    let page = fs::read_to_string(at("again/bodies.md")).unwrap();
    assert!(page.contains("of each at each p: 1;") && page.contains("| 0.5 | 500 | 0.1 | 1 |"), "{page}");
    assert!(fs::read_to_string(at("again/design.toml")).unwrap().contains("movements = 1\n"));
    let output = study("bodies.toml", "again", &[]);
    assert!(output.status.success(), "{output:?}");
    assert!(
        String::from_utf8(output.stderr).unwrap().contains("continuing from what an earlier run finished")
    );
    // Page and picture are made from the tables alone.
    fs::remove_dir_all(at("again/figures")).unwrap();
    fs::remove_file(at("again/bodies.md")).unwrap();
    let plot = Command::new(env!("CARGO_BIN_EXE_bodyschema")).arg("plot").arg(at("again")).output().unwrap();
    assert!(plot.status.success(), "{plot:?}");
    for file in ["recordings.csv", "edges.csv", "bodies.md", "figures/bodies.svg", "manifest.json"] {
        assert_eq!(
            fs::read(at("whole").join(file)).unwrap(),
            fs::read(at("again").join(file)).unwrap(),
            "{file}"
        );
    }
    // What was kept of another body is not used, whatever its file.
    fs::write(at("chain-3.toml"), chain.replace("radius = ", "density = 900\nradius = ")).unwrap();
    let output = study("bodies.toml", "again", &["--movements", "1"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && told.contains("of other settings"), "{told}");
    // Joints that are always locked: nothing is felt, and nothing found.
    fs::write(at("locked.toml"), design("[1.0]")).unwrap();
    let output = study("locked.toml", "locked", &["--movements", "1"]);
    assert!(output.status.success(), "{output:?}");
    let rows = fs::read_to_string(at("locked/recordings.csv")).unwrap();
    let row = rows.lines().nth(1).unwrap();
    assert!(row.starts_with("chain-3,1.0,1,1000,0.0,true,3,0,0.0,false,false,"), "{rows}");
    // Two kinds of movement, of which one is the first study's.
    let rhythmic = "[[movement]]\nname = \"rhythmic\"\nsettings = { motion = { movement = \"rhythmic\" } }\n";
    let kinds = |more: &str| format!("{}[[movement]]\nname = \"random\"\n{more}", design("[0.0, 0.5]"));
    fs::write(at("chain-3.toml"), &chain).unwrap();
    fs::write(at("kinds.toml"), kinds(rhythmic)).unwrap();
    let output = study("kinds.toml", "kinds", &[]);
    assert!(output.status.success(), "{output:?}");
    let rows = fs::read_to_string(at("kinds/recordings.csv")).unwrap();
    let random = rows.replace("body,kind,", "body,").replace("chain-3,random,", "chain-3,");
    let random: Vec<&str> = random.lines().filter(|row| !row.contains("rhythmic")).collect();
    assert_eq!(random.join("\n") + "\n", fs::read_to_string(at("whole/recordings.csv")).unwrap());
    assert_eq!(rows.matches("chain-3,rhythmic,").count(), 8, "{rows}");
    let page = fs::read_to_string(at("kinds/bodies.md")).unwrap();
    assert!(
        page.contains("| rhythmic | 0.5 | 500 | 0.1 | 2 |") && page.contains("| rhythmic, p = 0.5 |"),
        "{page}"
    );
    assert!(page.contains("that moves?") && !page.contains("at random"), "{page}");
    for (wrong, expected) in [
        (kinds("[[movement]]\nname = \"random\"\n"), "a name of its own"),
        (kinds("[[movement]]\nname = \"a/b\"\n"), "letters, digits and hyphens"),
        (kinds(&rhythmic.replace("\"rhythmic\" }", "\"circular\" }")), "unknown variant `circular`"),
        (design("[]"), "must not be empty"),
        (design("[0.5]").replace("noise = 0.1", "noise = -1"), "noise from 0 to 10"),
        (design("[0.5]").replace("chain-3", "chain-33"), "chain-33.toml: cannot be read"),
        (
            design("[0.5]").replace("bodies = [", "bodies = [\"old/chain-3.toml\", "),
            "two body files are named chain-3",
        ),
        (design("[1.5]"), "motion.coordination"),
    ] {
        fs::write(at("wrong.toml"), wrong).unwrap();
        let output = study("wrong.toml", "wrong", &[]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && told.contains(expected), "{expected}: {told}");
    }
}
