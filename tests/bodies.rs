//! Every body of the folder `bodies` is one, and can be simulated; the study of them.

use std::fs;
use std::path::{Path, PathBuf};

use bodyschema::estimate::estimate;
use bodyschema::files::body::{NamedBody, read_body};
use bodyschema::numerics::partition::adjusted_rand_index;
use bodyschema::numerics::rng::stream;
use bodyschema::recording::Recording;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::parameters::Parameters;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::simulate;
use rand_distr::{Distribution, StandardNormal};

use crate::support::folder::Folder;
use crate::support::repository::{entries, repository};
use crate::support::said::Said;
use crate::support::small::small_chain;

fn bodies() -> Vec<(PathBuf, NamedBody)> {
    entries("bodies").into_iter().map(|path| (path.clone(), read_body(&path).unwrap())).collect()
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
    let folder = Folder::new();
    folder.write("short.toml", "physics.duration = 20.0");
    let simulate =
        |body: &Path| Said::by(folder.command("simulate --settings short.toml --out moved --body").arg(body));
    let said = simulate(&repository("bodies/human.toml"));
    assert_eq!(said.status, Some(0), "{said:?}");
    assert!(said.out.starts_with("200 samples of 634 sensors on 13 parts"), "{said:?}");
    let names = folder.text("moved/names.csv");
    assert!(names.starts_with("part,name\n0,pelvis\n1,chest\n"), "{names}");
    // Three universal joints, five balls and four hinges.
    let angles = folder.text("moved/joint-angles.csv");
    let header = angles.lines().next().unwrap();
    assert_eq!(header.split(',').count() - 1, 3 * 2 + 5 * 3 + 4, "{header}");
    assert!(header.contains("joint2_angle3_rad,joint3_angle1_rad"), "{header}");

    folder.write("wrong.toml", "[[part]]\nname = \"trunk\"\nshape = \"sphere\"\nradius = 0.1\n");
    simulate(&folder.at("wrong.toml")).is_refused("part `trunk`: it lacks centre");
}

#[test]
fn noise_costs_fewer_parts_if_it_counts_as_no_touch() {
    let mut settings = Settings::load_over(Some(Base::ESTIMATE), None).unwrap();
    (settings.motion.coordination, settings.motion.epoch) = (0.5, 1000);
    (settings.physics.duration, settings.physics.step) = (1000.0, 0.005);
    let Settings { motion, physics, sense: tactile_sense, quantise, .. } = &settings;
    let NamedBody { agent, .. } = read_body(&repository("bodies/chain-3.toml")).unwrap();
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
        let found =
            estimate(recording, quantise, &Parameters::default(), &mut stream(1, 1, "co-motion", 0), &|| ())
                .unwrap();
        adjusted_rand_index(&found.parts.labels, &agent.labels())
    };
    let cleaned = Recording::new(tactile.clone());
    assert_eq!(cleaned.noisy, agent.labels().len());
    let as_felt = Recording { tactile, noisy: 0, ..cleaned.clone() };
    let (felt, cut) = (agreement(&as_felt), agreement(&cleaned));
    // Without its cut, noise costs this body a quarter of its agreement and more.
    assert!(cut > 0.95 && cut > felt + 0.25, "{felt} with noise that is felt, {cut} without");
}

#[test]
fn the_study_of_bodies_repeats_itself_and_names_mistakes() {
    let folder = Folder::new();
    let chain = small_chain();
    folder.write("chain-3.toml", &chain);
    let design = |coordinations: &str| {
        format!(
            "seed = 4\nmovements = 2\nchains = 2\ncoordinations = {coordinations}\nbodies = [\"chain-3.toml\"]\n\
             [[recording]]\nsamples = 1000\nnoise = 0.0\n[[recording]]\nsamples = 500\nnoise = 0.1\n"
        )
    };
    // What a study says, which is a line of what it goes on from.
    let study = |arguments: &str| folder.done(&format!("bodies --design {arguments}")).err;
    folder.write("bodies.toml", design("[0.0, 0.5]"));
    study("bodies.toml --out whole");
    let page = folder.text("whole/bodies.md");
    assert!(page.contains("| chain-3 | 3 | ") && page.contains("| 0.5 | 500 | 0.1 | 2 |"), "{page}");
    assert!(
        page.contains("| 1000 | 0 | 4, of which 100 % (")
            && page.contains("| T | noise | good | doubtful | does not fit |"),
        "{page}"
    );
    assert_eq!(folder.rows("whole/recordings.csv").len(), 8);
    // One movement now, and the other one later.
    study("bodies.toml --out again --movements 1");
    let page = folder.text("again/bodies.md");
    assert!(page.contains("of each at each p: 1;") && page.contains("| 0.5 | 500 | 0.1 | 1 |"), "{page}");
    assert!(folder.text("again/design.toml").contains("movements = 1\n"));
    // Of the four movements, the third shard of three has the third: p = 0, the second time. It changes no table.
    study("bodies.toml --out again --shard 3/3");
    assert_eq!(folder.text("again/bodies.md"), page);
    let kept = folder.files("again/checkpoints");
    assert_eq!(
        kept.keys().collect::<Vec<_>>(),
        ["chain-3-p0-1.json", "chain-3-p0-2.json", "chain-3-p0.5-1.json"]
    );
    let told = study("bodies.toml --out again");
    assert!(told.contains("continuing from what an earlier run finished"), "{told}");
    // Page and picture are made from the tables alone.
    fs::remove_dir_all(folder.at("again/figures")).unwrap();
    fs::remove_file(folder.at("again/bodies.md")).unwrap();
    folder.succeed("plot again");
    for file in ["recordings.csv", "edges.csv", "bodies.md", "figures/bodies.svg", "manifest.json"] {
        assert!(folder.text(format!("whole/{file}")) == folder.text(format!("again/{file}")), "{file}");
    }
    // What was kept of another body is not used, whatever its file.
    folder.write("chain-3.toml", chain.replace("radius = ", "density = 900\nradius = "));
    let told = study("bodies.toml --out again --movements 1");
    assert!(told.contains("of other settings"), "{told}");
    // Joints that are always locked: nothing is felt, and nothing found.
    folder.write("locked.toml", design("[1.0]"));
    study("locked.toml --out locked --movements 1");
    let rows = folder.text("locked/recordings.csv");
    let row = rows.lines().nth(1).unwrap();
    assert!(row.starts_with("chain-3,1.0,1,1000,0.0,true,,3,0,0.0,false,false,"), "{rows}");
    // Two kinds of movement, of which one is the first study's, whose first movement it repeats.
    let rhythmic = "[[movement]]\nname = \"rhythmic\"\nsettings = { motion = { movement = \"rhythmic\" } }\n";
    let kinds = |more: &str| format!("{}[[movement]]\nname = \"random\"\n{more}", design("[0.5]"));
    folder.write("chain-3.toml", &chain);
    folder.write("kinds.toml", kinds(rhythmic));
    study("kinds.toml --out kinds --movements 1");
    let rows = folder.text("kinds/recordings.csv");
    let random = rows.replace("body,kind,", "body,").replace("chain-3,random,", "chain-3,");
    let random: Vec<&str> = random.lines().filter(|row| !row.contains("rhythmic")).collect();
    let whole = folder.text("whole/recordings.csv");
    let first: Vec<&str> =
        whole.lines().filter(|row| row.starts_with("body,") || row.starts_with("chain-3,0.5,1,")).collect();
    assert_eq!((random.len(), random), (3, first));
    assert_eq!(rows.matches("chain-3,rhythmic,").count(), 2, "{rows}");
    let page = folder.text("kinds/bodies.md");
    assert!(
        page.contains("| rhythmic | 0.5 | 500 | 0.1 | 1 |") && page.contains("| rhythmic, p = 0.5 |"),
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
        folder.write("wrong.toml", wrong);
        folder.refuse("bodies --design wrong.toml --out wrong", expected);
    }
}
