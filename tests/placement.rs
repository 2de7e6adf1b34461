//! Estimated parts and joints as a robot description: `estimate --sensors` writes it, and `body import` reads it back.

use std::fmt::Write;

use bodyschema::files::body::read_body;

use crate::support::folder::Folder;
use crate::support::repository::repository;
use crate::support::small::{small_body, small_chain};

const STAR: &str = "bodies/star.toml";

/// A folder in which a body has moved for 300 s; `rest.csv` has the sites of its sensors at rest.
fn moved(body: &str) -> Folder {
    let folder = Folder::new();
    folder.write("body.toml", body);
    folder.write("short.toml", "[physics]\nduration = 300.0\n[motion]\ncoordination = 0.5\n");
    folder.succeed("simulate --body body.toml --settings short.toml --seed 3 --out moved");
    let agent = read_body(&folder.at("body.toml")).unwrap().agent;
    let mut rest = "x,y,z,nx,ny,nz\n".to_owned();
    for site in &agent.sites {
        let part = &agent.parts[site.part];
        let turned =
            |vector: [f64; 3]| part.rotation.map(|row| (0..3).map(|at| row[at] * vector[at]).sum::<f64>());
        let ([x, y, z], [i, j, k]) = (turned(site.position), turned(site.normal));
        let [a, b, c] = part.centre;
        writeln!(rest, "{},{},{},{i},{j},{k}", x + a, y + b, z + c).unwrap();
    }
    folder.write("rest.csv", rest);
    folder
}

/// The numbers of places.csv by their column, for each joint.
fn places(folder: &Folder) -> Vec<impl Fn(&str) -> f64> {
    let text = folder.text("found/places.csv");
    let mut rows = text.lines().map(|row| row.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = rows.next().unwrap();
    rows.map(|row| {
        let names = names.clone();
        move |name: &str| row[names.iter().position(|own| own == name).unwrap()].parse().unwrap()
    })
    .collect()
}

#[test]
fn joints_are_placed_by_sensors_at_rest_and_the_description_is_read_back() {
    let folder = moved(&small_body(STAR));
    let said = folder.succeed("estimate moved/tactile.npy --sensors rest.csv --out found");
    assert!(said.contains("body.urdf: 5 boxes; the place of 4 of 4 joints is known from touch"), "{said}");
    let anchors: Vec<[f64; 3]> =
        read_body(&repository(STAR)).unwrap().agent.joints.iter().map(|joint| joint.anchor).collect();
    for place in places(&folder) {
        let found = ["x", "y", "z"].map(|axis| place(&format!("parent_{axis}_m")));
        let off = |anchor: &[f64; 3]| (0..3).map(|at| (anchor[at] - found[at]).powi(2)).sum::<f64>().sqrt();
        let nearest = anchors.iter().map(off).fold(f64::INFINITY, f64::min);
        // Errors are not only random ones: the three standard errors of Gaussian ones are exceeded.
        assert!(nearest < 0.03 && nearest < 4.0 * place("standard_error_m"), "{found:?}: {nearest}");
    }
    let said = folder.run("body import found/body.urdf --out back.toml");
    assert!(said.status == Some(0) && said.out.contains("4 ball"), "{said:?}");
    let [back, star] = [folder.at("back.toml"), repository(STAR)].map(|file| read_body(&file).unwrap().agent);
    let lengths = |agent: &bodyschema::stages::agent::Agent| agent.joints.len();
    assert_eq!(lengths(&back), lengths(&star));
}

#[test]
fn a_description_of_others_stays_and_an_own_one_goes_with_the_sites() {
    let folder = moved(&small_chain());
    folder.succeed("estimate moved/tactile.npy --sensors rest.csv --out found");
    assert!(folder.at("found/body.urdf").exists() && folder.at("found/places.csv").exists());

    // Files of others with these names stay, and are not overwritten.
    folder.write("own/body.urdf", "<robot/>");
    folder.succeed("estimate moved/tactile.npy --out own");
    folder.refuse(
        "estimate moved/tactile.npy --sensors rest.csv --out own",
        "own/body.urdf: is not one that `estimate` wrote",
    );
    assert_eq!(folder.text("own/body.urdf"), "<robot/>");

    // Without sites, those of before are gone.
    folder.succeed("estimate moved/tactile.npy --out found");
    assert!(!folder.at("found/body.urdf").exists() && !folder.at("found/places.csv").exists());
}

#[test]
fn sensors_in_the_frames_of_their_own_solids_place_joints_in_both_frames() {
    let folder = moved(&small_body(STAR));
    folder.succeed("estimate moved/tactile.npy --sensors moved/sensors.csv --out found");
    for place in places(&folder) {
        // The z axis of a limb's frame runs along it, and its joint is 0.05 m before its end.
        assert!((place("child_z_m").abs() - 0.3).abs() < 0.03 && place("child_x_m").abs() < 0.03);
        assert!(place("mismatch") < 0.01);
    }
}

#[test]
fn mistakes_in_the_sites_of_sensors_are_named_before_anything_is_written() {
    let folder = moved(&small_chain());
    let rest = folder.text("rest.csv");
    let (head, rows) = rest.split_once('\n').unwrap();
    let fewer = rest.trim_end().rsplit_once('\n').unwrap().0;
    for (sites, expected) in [
        (fewer.to_owned(), "fewer.csv: has 59 sensors, but the recording has 60"),
        (
            format!("{head}\n0,0,0,0,0,0\n{rows}"),
            "fewer.csv: line 2: the normal of sensor 0 has no direction",
        ),
        (rest.replace("nx", "up"), "missing field `normal_x`"),
    ] {
        folder.write("fewer.csv", sites);
        let said = folder.run("estimate moved/tactile.npy --sensors fewer.csv --out found");
        assert!(
            said.status == Some(2) && said.err.contains(expected) && said.err.lines().count() == 1,
            "{said:?}"
        );
        assert!(!folder.at("found").exists());
    }
    // Sites in another order than the sensors cannot explain what is felt.
    let rows: Vec<&str> = rows.lines().collect();
    let mixed: Vec<&str> = (0..rows.len()).map(|at| rows[7 * at % rows.len()]).collect();
    folder.write("mixed.csv", format!("{head}\n{}\n", mixed.join("\n")));
    let said = folder.succeed("estimate moved/tactile.npy --sensors mixed.csv --out found");
    assert!(said.contains("are rows in the order of the sensors"), "{said}");
}
