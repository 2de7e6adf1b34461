//! Measure the split–merge sampler: how fast its chains mix beside the paper's, whether they find the parts of bodies that it
//! was not calibrated on, and whether its probabilities of edges are calibrated. Run by `reproduce/mixing.sh`; the argument is
//! the folder to write to.

#[allow(dead_code, reason = "the truth is of no use here")]
#[path = "../../tests/support/synthetic.rs"]
mod synthetic;

mod bodies;
mod edges;
mod picture;
mod traces;

use std::error::Error;
use std::path::Path;

use bodyschema::files::write_text;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::schema::Schema;

/// The settings of `infer --sampler split-merge`.
fn split_merge() -> Schema {
    Settings::load_over(Some(Base::SPLIT_MERGE), None).expect("the repository's settings").schema
}

/// The default when this was first asked, so that what comes of it hangs on no later one.
fn no_fluid() -> Settings {
    let text = include_str!("../../reproduce/no-fluid.toml");
    Settings::paper().with(text, "reproduce/no-fluid.toml").expect("the repository's settings")
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: mixing FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder.join("figures"))?;
    let page = [
        "# How the split–merge sampler mixes\n".to_owned(),
        format!(
            "All simulations here are of an older configuration, [no-fluid.toml](reproduce/no-fluid.toml), with one-way fluid \
             coupling, four levels for each sensor, and maps of the distances. They say nothing about today's default. Measured \
             by `reproduce/mixing.sh` at revision {}.\n",
            bodyschema::internals::REVISION
        ),
        "How fast does `bodyschema infer --sampler split-merge` mix, does it find the parts, and are its probabilities \
         calibrated? [method.md](docs/method.md#the-splitmerge-sampler) explains it, and has the answer in short. All tables \
         are the same on machines of one kind, but for seconds. These are of one core of the machine that wrote this page.\n"
            .to_owned(),
        bodies::study(folder)?,
        traces::study(folder)?,
        edges::study(folder)?,
    ];
    write_text(&folder.join("mixing.md"), &page.join("\n"))?;
    Ok(())
}
