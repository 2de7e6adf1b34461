//! A user's mistake is one line that says what, where and what to do, and status 2.

use bodyschema::files::npy;
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::distance::Distances;
use bodyschema::stages::sense::Tactile;

use crate::support::folder::Folder;
use crate::support::small::separated_clusters;

#[test]
fn a_mistake_is_one_line_that_says_what_and_where_and_status_2() {
    let folder = Folder::new();
    separated_clusters(&folder);
    let distances = |name: &str, sensors: usize, values: Vec<f64>| {
        npy::write_distances(&folder.at(name), &Distances { sensors, values }).unwrap();
    };
    distances("line.npy", 3, vec![0., 1., 2., 1., 0., 1., 2., 1., 0.]);
    distances("same.npy", 2, vec![0.0; 4]);
    distances("far.npy", 2, vec![0.0, 1e200, 1e200, 0.0]);
    let map = |name: &str, dims: usize, coordinates: Vec<f64>| {
        npy::write_body_map(&folder.at(name), &BodyMap { dims, coordinates }).unwrap();
    };
    map("wide.npy", 3, vec![1.0; 6]);
    map("flat.npy", 2, vec![1., 5., 2., 5., 4., 5.]);
    map("tiny.npy", 1, vec![1e-160, 2e-160, 4e-160]);
    map("nan.npy", 1, vec![1.0, f64::NAN]);
    map("broad.npy", 200_000, vec![1.0; 400_000]);
    map("deep.npy", 200, (0..300 * 200).map(|at| (at as f64 * 12.9898).sin()).collect());
    let tactile = Tactile { samples: 1, pressures: vec![1.0; 20_001] };
    npy::write_tactile(&folder.at("transposed.npy"), &tactile).unwrap();
    for (name, text) in [
        ("text.npy", "hello"),
        ("fraley.toml", "schema.prior = \"fraley-raftery\""),
        ("unknown.toml", "[motion]\nspeed = 1"),
        ("broken.toml", "[motion\n"),
        ("zero.toml", "schema.components = 0"),
        ("method.toml", "map.method = \"sammon\""),
        ("start.toml", "schema.start = \"random\""),
        (
            "wild.toml",
            "motion = { coordination = 0.0, controller = \"torque\", stiffness = 1e6 }\nphysics.duration = 60.0",
        ),
        ("heavy.toml", "agent.density = 1e300"),
        ("long.toml", "physics.duration = 1e7"),
        ("deep.toml", "experiment.dimensions = [2, 900]"),
        ("steps.toml", "physics.step = 1e-6\nsense.interval = 1000.0"),
        ("vast.toml", "skin = { around = 1000, along = 20 }"),
        ("endless.toml", "schema.sweeps = 1000000000000"),
        ("long-file.toml", &"#".repeat(2_000_000)),
        ("short.csv", "sensor,part\n0,0\n"),
        ("word.csv", "a,b\n1,2\n3,x\n"),
        ("commas.csv", "1,05,2,75\n3,25,4,00\n"),
        ("cut.csv", "1;2\n3;4\n5;6\n7\n"),
        ("times.csv", "time\n1\n2\n"),
        ("file", ""),
        ("no-figure/figures/README.md", ""),
        ("bad-figure/figures/fig07-parts.csv", "dimension,counting\n2,\"all\ndraws\"\n"),
        ("binary-figure/figures/fig07-parts.csv", "\0\0\0"),
        ("bad-claims/claims.csv", "id,figure\na,b\n"),
        ("bad-claims/manifest.json", "{}"),
        ("bad-manifest/claims.csv", "id\n"),
        ("bad-manifest/manifest.json", "{\"settings\": "),
        ("deep-manifest/claims.csv", "id\n"),
        ("deep-manifest/manifest.json", &"[".repeat(100_000)),
    ] {
        folder.write(name, text);
    }
    folder.write("binary.toml", [0xff, 0xfe, 0x00]);
    for run in ["bad-claims", "bad-manifest", "deep-manifest"] {
        let header =
            "dimension,n,lowest,whisker_low,lower_quartile,median,upper_quartile,whisker_high,highest";
        let table = format!("{header}\n2,9,0,0,0.5,0.5,0.6,1,1\n");
        folder.write(format!("{run}/figures/fig09-ari-box.csv"), table);
    }

    for (arguments, expected) in [
        ("distance absent.npy --out d.npy", "absent.npy: no such file"),
        ("distance text.npy --out d.npy", "text.npy: cannot be read as a .npy file"),
        ("distance nan.npy --out d.npy", "row 1, column 0: NaN"),
        ("distance nan.npy --symbols --out d.npy", "row 1, column 0: NaN"),
        ("distance line.npy --levels 1 --out d.npy", "`quantise.levels` is 1, but must be 2 to 256"),
        ("map wide.npy --dims 2 --out m.npy", "square matrix, but the shape is 2 x 3"),
        ("map line.npy --of distances --dims 4 --out m.npy", "at most 1"),
        ("map line.npy --of distances --dims 4 --method smacof --out m.npy", "at most 1"),
        ("map same.npy --dims 1 --method nonmetric --out m.npy", "all at distance 0"),
        ("map far.npy --of distances --dims 1 --method smacof --out m.npy", "the largest distance is 1e200"),
        ("map line.npy --dims 1 --settings method.toml --out m.npy", "unknown variant `sammon`"),
        ("map line.npy --dims 0 --out m.npy", "--dims is 0"),
        ("map line.npy --dims 1 --out file/m.npy", "file/m.npy: cannot be written"),
        (
            "infer flat.npy --settings fraley.toml --out s",
            "flat.npy: the 3 points span fewer than 2 dimensions",
        ),
        ("infer nan.npy --out s", "row 1, column 0: NaN"),
        ("infer clusters.npy --components 0 --out s", "`schema.components` is 0, but must be 1 to 1000"),
        ("infer clusters.npy --settings zero.toml --out s", "`schema.components` is 0"),
        ("infer clusters.npy --settings start.toml --out s", "unknown variant `random`"),
        ("infer clusters.npy --chains 0 --out s", "`schema.chains` is 0"),
        (
            "infer clusters.npy --labels short.csv --tree tree.csv --out s",
            "short.csv: sensor 1 of 100 has no part",
        ),
        (
            "infer clusters.npy --labels labels.csv --tree labels.csv --out s",
            "labels.csv: line 2: missing field `child`",
        ),
        ("simulate --settings absent.toml --out s", "absent.toml: cannot read the settings"),
        ("simulate --settings unknown.toml --out s", "unknown.toml: unknown setting `motion.speed`"),
        ("simulate --settings broken.toml --out s", "broken.toml: line 1"),
        ("simulate --settings wild.toml --out s", "lower motion.stiffness"),
        ("simulate --settings heavy.toml --out s", "`agent.density` is 1e300"),
        ("simulate --settings long.toml --out s", "at most 20 million samples"),
        (
            "simulate --settings steps.toml --out s",
            "`physics.duration` is 10000.0, but must be at least sense.interval",
        ),
        ("reproduce exp1 --settings vast.toml --out s", "`skin.around * skin.along + skin.caps` is 20000"),
        ("simulate --settings endless.toml --out s", "`schema.chains * schema.sweeps`"),
        ("simulate --settings long-file.toml --out s", "it is longer than 1048576 bytes"),
        ("simulate --settings binary.toml --out s", "binary.toml: cannot read the settings"),
        ("simulate --settings /dev/zero --out s", "/dev/zero: cannot read the settings"),
        ("simulate --settings . --out s", ".: cannot read the settings"),
        ("distance . --out d.npy", ".: cannot be read as a .npy file"),
        ("map line.npy --of distances --dims 18446744073709551615 --out m.npy", "at most 1"),
        ("map far.npy --of distances --dims 1 --out m.npy", "the largest distance is 1e200"),
        ("infer broad.npy --out s", "the 2 points span fewer than 200000 dimensions"),
        ("infer deep.npy --components 1000 --out s", "schema.components = 1000 in 200 dimensions"),
        (
            "infer clusters.npy --keep all --sweeps 100001 --burn-in 1 --chains 11 --out s",
            "at most 1000000 samples",
        ),
        ("plot absent", "absent/figures: has no table of a figure"),
        ("plot no-figure", "has no table of a figure"),
        ("plot bad-figure", "fig07-parts.csv: line 2: "),
        ("plot binary-figure", "fig07-parts.csv: has no rows"),
        ("plot bad-claims", "claims.csv: line 2: missing field"),
        ("plot bad-manifest", "bad-manifest/manifest.json: is not a manifest"),
        ("plot deep-manifest", "deep-manifest/manifest.json: is not a manifest"),
        ("simulate --out file/s", "file/s: cannot be written to"),
        ("estimate word.csv --out s", "word.csv: row 3, column 2 (`b`): `x` is not a number; empty the cell"),
        ("estimate commas.csv --out s", "row 1, column 2: `05` seems to be the decimals of the cell before"),
        (
            "estimate cut.csv --out s",
            "row 4 has 1 cells, but the first row of numbers has 2; repair or delete",
        ),
        (
            "estimate times.csv --out s",
            "has no column of a sensor; if its columns are no times, say --time none",
        ),
        (
            "estimate word.csv --parameter saving=1 --out s",
            "no parameter is called `saving`; there are: samples, completion_ridge, ",
        ),
        (
            "estimate word.csv --parameter min_saving=-1 --out s",
            "parameter `min_saving` is -1, but must be 0.003 to 30",
        ),
        ("estimate word.csv --time c --out s", "has no column `c`; --time takes a name, or a number"),
        ("tree transposed.npy --parts short.csv --out s", "is it transposed?"),
        ("distance transposed.npy --out d.npy", "is it transposed?"),
        ("distance transposed.npy --symbols --out d.npy", "is it transposed?"),
        ("map same.npy --dims 1 --out m.npy", "all at distance 0"),
        ("map line.npy --dims 1 --out /dev/null", "/dev/null: cannot be written: it is not a regular file"),
        ("infer tiny.npy --out s", "tiny.npy: the points spread over 1.5"),
        ("infer clusters.npy --chains 1000000000000 --out s", "`schema.chains`"),
        ("reproduce exp1 --settings deep.toml --out s", "but 840 sensors span fewer"),
        ("reproduce exp1 --jobs 0 --out s", "--jobs is 0"),
        ("reproduce exp1 --simulations 0 --out s", "`experiment.simulations` is 0"),
    ] {
        folder.refuse(arguments, expected);
    }
    // Arguments that do not fit are clap's to explain, with the same status.
    assert_eq!(folder.run("infer clusters.npy --labels labels.csv --out s").status, Some(2));
}
