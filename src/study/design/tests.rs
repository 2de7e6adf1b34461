//! Every bundled design can be run, and no open setting is forgotten.

use super::super::plan::plan;
use super::*;
use crate::analysis::published::claims;
use crate::settings::PAPER;

fn bundled(name: &str) -> Design {
    let source = DesignText::read(std::path::Path::new(name), None).unwrap();
    Design::parse(&source).unwrap()
}

#[test]
fn every_bundled_design_can_be_run() {
    for (name, _) in BUNDLED.iter().filter(|(name, _)| *name != "scored") {
        let configurations = plan(&bundled(name)).unwrap();
        let least = match *name {
            "sensitivity" => 60,
            "multiverse" => 1000,
            _ => 2,
        };
        assert!(configurations.len() >= least, "{name}: {}", configurations.len());
    }
    assert!(scored().iter().all(|judged| judged.weight.is_some() && judged.check(&claims()).is_ok()));
}

#[test]
fn every_setting_that_is_marked_as_ours_is_in_the_study_of_sensitivity() {
    let study = bundled("sensitivity");
    let named: Vec<&String> = study.factors.iter().flat_map(|factor| &factor.settings).collect();
    // How much is run, what only says how a run is judged stable, and what studies of their own are about.
    let spared = [
        "schema.burn_in",
        "baselines.restarts",
        "experiment.simulations",
        "experiment.seed",
        "physics.turn_limit",
        "physics.angular_momentum",
        "physics.fluid_density",
        "sense.threshold",
    ];
    let mut section = "";
    for line in PAPER.lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']');
        } else if let Some((name, rest)) = line.split_once(" = ")
            && rest.contains("# ours")
        {
            let key = format!("{section}.{name}");
            let spared = spared.contains(&key.as_str()) || section == "schema.authors";
            assert!(named.contains(&&key) || spared, "{key}");
        }
    }
}
