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
    for key in ours() {
        let spared = spared.contains(&key.as_str()) || key.starts_with("schema.authors");
        assert!(named.contains(&&key) || spared, "{key}");
    }
}

/// The settings that are marked as ours in `reproduce/paper.toml`.
fn ours() -> Vec<String> {
    let (mut section, mut all) = ("", Vec::new());
    for line in PAPER.lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']');
        } else if let Some((name, rest)) = line.split_once(" = ")
            && rest.contains("# ours")
        {
            all.push(format!("{section}.{name}"));
        }
    }
    all
}

/// What is missing for a design to have the default among its points.
fn lacks_default(design: &Design) -> Vec<&str> {
    let lacks = |factor: &&Factor| factor.of_base(design).is_none();
    design.factors.iter().filter(lacks).map(|factor| factor.name.as_str()).collect()
}

#[test]
fn the_default_is_a_point_of_the_multiverse() {
    let design = bundled("multiverse");
    assert_eq!(lacks_default(&design), [""; 0]);
    // All base options together are the default but for how much is run.
    let mut all = Table::new();
    for factor in &design.factors {
        let option = &factor.options[factor.of_base(&design).unwrap()];
        super::super::choices::merge(&mut all, &option.settings);
    }
    let mut own = Settings::overlaid([&design.settings, &all], "").unwrap();
    let paper = Settings::paper();
    assert_eq!((own.schema.chains, own.map.starts, own.experiment.simulations), (6, 2, 4));
    (own.schema.chains, own.map.starts) = (paper.schema.chains, paper.map.starts);
    own.experiment = paper.experiment.clone();
    assert_eq!(own, paper);
    // A design without one of its values lacks it.
    let mut other = design.clone();
    let levels = other.factors.iter_mut().find(|factor| factor.name == "number of levels").unwrap();
    levels.options.remove(0);
    assert_eq!(lacks_default(&other), ["number of levels"]);
}

/// Settings marked as ours that a design neither varies nor leaves out with a reason. A factor is about what the default's option sets,
/// and the gains beside it; what a reading overrides is about that reading alone.
fn forgotten(design: &Design) -> Vec<String> {
    let about = |factor: &Factor| -> Vec<String> {
        let base = factor.of_base(design).map(|base| factor.options[base].keys());
        let gains = factor.options.iter().filter(|option| option.gains.is_some()).flat_map(Choice::keys);
        base.into_iter().flatten().chain(gains).collect()
    };
    let varied = design.factors.iter().filter(|factor| factor.options.len() > 1).flat_map(about);
    let left_out = design.left_out.iter().filter(|one| !one.why.is_empty()).flat_map(|one| one.what.clone());
    let known: Vec<String> = varied.chain(left_out).collect();
    let is_known = |key: &String| known.iter().any(|one| one == key || key.starts_with(&format!("{one}.")));
    ours().into_iter().filter(|key| !is_known(key)).collect()
}

#[test]
fn every_setting_that_is_ours_is_a_factor_of_the_multiverse_or_has_a_reason_not_to_be() {
    let design = bundled("multiverse");
    assert_eq!(forgotten(&design), [""; 0]);
    let mut other = design.clone();
    other.factors.retain(|factor| factor.name != "concentration");
    other.left_out.retain(|one| !one.what.contains(&"agent.density".to_owned()));
    assert_eq!(forgotten(&other), ["agent.density", "schema.concentration"]);
    // Every option and every factor has a reason.
    let options = || design.factors.iter().flat_map(|factor| &factor.options);
    assert!(options().all(|option| !option.why.is_empty()), "a reason for each option");
    assert!(design.factors.iter().all(|factor| !factor.paper.is_empty()));
}

#[test]
fn its_draws_are_as_many_as_they_say_and_the_code_is_taken_whole() {
    let factor =
        |design: &Design, name: &str| design.factors.iter().position(|factor| factor.name == name).unwrap();
    for (name, count) in [("multiverse", 2048), ("multiverse-near", 232), ("multiverse-held-out", 320)] {
        let design = bundled(name);
        let all = plan(&design).unwrap();
        assert_eq!(all.len(), count, "{name}");
        // Every replication is judged both ways.
        let exact = all.iter().filter(|one| one.settings.evaluate.eligible_ari == 1.0).count();
        assert_eq!(exact, count / 2);
        // What the code overrides has no label.
        let (reading, start) = (factor(&design, "reading"), factor(&design, "start of a chain"));
        for one in &all {
            assert_eq!(one.labels[reading] != "equations", one.labels[start].is_empty(), "{one:?}");
        }
    }
    // Of each body map of the large one, three are read by the equations and one by the code.
    let design = bundled("multiverse");
    let all = plan(&design).unwrap();
    let by_code = all.iter().filter(|one| one.labels[factor(&design, "reading")] != "equations").count();
    assert_eq!(by_code, 512);
    let classical = all.iter().filter(|one| one.labels[factor(&design, "scaling")] == "classical").count();
    assert_eq!(classical, 1024);
    // Around the default, seven of ten choices and more are its own.
    let near = bundled("multiverse-near");
    let base: Vec<&str> = near
        .factors
        .iter()
        .map(|factor| factor.options[factor.of_base(&near).unwrap()].label.as_str())
        .collect();
    let all = plan(&near).unwrap();
    let own = all.iter().flat_map(|one| one.labels.iter().zip(&base));
    let kept = own.filter(|(label, base)| label.is_empty() || label == *base).count();
    let kept = kept as f64 / (all.len() * base.len()) as f64;
    assert!((0.75..0.9).contains(&kept), "{kept}");
}
