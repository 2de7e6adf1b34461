//! Small settings and data.

use bodyschema::files::npy;
use bodyschema::stages::body_map::BodyMap;
use toml::{Table, Value};

use super::folder::Folder;
use super::repository::read;

/// A body of five parts of 24 sensors, which still shows them after 1000 s, for experiments of a second or two.
const SMALL: &str = "
[skin]
around = 8
along = 3
[physics]
duration = 1000.0
[schema]
chains = 6
sweeps = 60
[experiment]
dimensions = [2, 4]
simulations = 1
seed = 5
";

/// The small settings with others laid over them, such as `schema.chains = 2`.
pub fn small(over: &str) -> String {
    let [mut settings, over] = [SMALL, over].map(|text| text.parse::<Table>().unwrap());
    for (section, values) in over {
        let own = settings.entry(section).or_insert_with(|| Value::Table(Table::new()));
        own.as_table_mut().unwrap().extend(values.as_table().unwrap().clone());
    }
    settings.to_string()
}

/// The text of a bundled body file with half of its sensors, 20 on each part. It is estimated in less than half of the time.
pub fn small_body(file: &str) -> String {
    let body = read(file);
    let small = body.replace("sensors = 40", "sensors = 20");
    assert!(small != body, "{file} has 40 sensors on each part");
    small
}

/// The same of a chain of three parts.
pub fn small_chain() -> String {
    small_body("bodies/chain-3.toml")
}

/// Five Gaussian clusters in a row, far apart, so that any working sampler finds them: `clusters.npy`, `labels.csv`, `tree.csv`.
pub fn separated_clusters(folder: &Folder) {
    let wave = |at: usize| (at as f64 * 12.9898).sin() * 0.3;
    let coordinates = (0..100).flat_map(|i| [10.0 * (i / 20) as f64 + wave(i), wave(7 * i + 3)]).collect();
    npy::write_body_map(&folder.at("clusters.npy"), &BodyMap { dims: 2, coordinates }).unwrap();
    let labels: String = (0..100).map(|i| format!("{i},{}\n", i / 20)).collect();
    folder.write("labels.csv", format!("sensor,part\n{labels}"));
    folder.write("tree.csv", "child,parent\n1,0\n2,1\n3,2\n4,3\n");
}
