use std::fs;
use std::path::Path;

use toml::{Table, Value};

use super::*;

/// The kinds of all uses of a seed.
fn kinds(list: &[Used], seed: u64) -> Vec<Kind> {
    list.iter().filter(|used| used.seeds().contains(&seed)).map(|used| used.kind).collect()
}

/// Uses that say nothing or are no range, and those of results on seeds that something was chosen on.
fn wrong(list: &[Used]) -> Vec<String> {
    let spoils = |used: &Used, other: Kind| match used.kind {
        Kind::Report => other == Kind::Calibration,
        Kind::Confirmation => other != Kind::Confirmation,
        _ => false,
    };
    let is_wrong = |used: &&Used| {
        let empty = [&used.purpose, &used.by, &used.at].iter().any(|text| text.is_empty());
        let range = used.last.is_none_or(|last| used.first < last && last - used.first < 1000);
        empty
            || !range
            || used.seeds().any(|seed| kinds(list, seed).into_iter().any(|other| spoils(used, other)))
    };
    list.iter().filter(is_wrong).map(Used::to_string).collect()
}

#[test]
fn results_and_the_confirmation_are_of_seeds_that_no_setting_was_chosen_on() {
    assert_eq!(wrong(&list()), [""; 0]);
    let of = |first, last, kind| Used {
        first,
        last,
        kind,
        purpose: "to test".to_owned(),
        by: "this".to_owned(),
        at: "now".to_owned(),
    };
    let chosen = || of(1, Some(9), Kind::Calibration);
    for found in [
        vec![chosen(), of(5, None, Kind::Report)],
        vec![of(5, None, Kind::Confirmation), of(5, None, Kind::Study)],
        vec![of(9, Some(5), Kind::Study)],
        vec![Used { at: String::new(), ..chosen() }],
    ] {
        assert_eq!(wrong(&found).len(), 1);
    }
}

/// The seeds of a design: those of the movements of a multiverse follow its own.
fn seeds(design: &Table, multiverse: bool) -> Option<RangeInclusive<u64>> {
    let within = |name: &str| design.get(name)?.get("seed");
    let seed = design.get("seed").or_else(|| within("experiment")).or_else(|| within("registered"))?;
    let movements = design.get("draws").and_then(|draws| draws.get("movements")).filter(|_| multiverse);
    let (seed, more) = (seed.as_integer()? as u64, movements.and_then(Value::as_integer).unwrap_or(0) as u64);
    Some(seed..=seed + more)
}

#[test]
fn every_seed_of_a_design_is_listed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reproduce");
    let (used, mut found) = (list(), Vec::new());
    for file in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        let Some(design) = name.strip_suffix(".toml") else { continue };
        let text: Table = fs::read_to_string(&file).unwrap().parse().unwrap();
        let Some(all) = seeds(&text, design.starts_with("multiverse")) else { continue };
        let unlisted = all.clone().find(|&seed| kinds(&used, seed).is_empty());
        assert_eq!(unlisted, None, "{name}: add its seed to reproduce/seeds.toml");
        let wanted = match design {
            "paper" => Some(Kind::Report),
            "confirm" => Some(Kind::Confirmation),
            _ => None,
        };
        assert!(wanted.is_none_or(|kind| kinds(&used, *all.start()).contains(&kind)), "{name}");
        found.push(name);
    }
    for name in ["paper.toml", "confirm.toml", "bodies.toml", "sensitivity.toml", "multiverse.toml"] {
        assert!(found.iter().any(|design| design == name), "{name} has a seed: {found:?}");
    }
}

#[test]
fn a_sentence_says_for_what_a_seed_was_used() {
    let at_8 = "Seed 8 was used before: to choose the fifth and today's default (calibration: \
                reproduce/fluid-wide.toml, revision e9468f1).";
    assert_eq!(used_before(8..=8).unwrap(), at_8);
    let of_default = used_before(1414..=1414).unwrap();
    assert!(
        of_default.starts_with("Seed 1414 was used before: for the published results of today's default")
    );
    let several = used_before(8..=9).unwrap();
    assert_eq!(several, at_8.replacen("Seed 8 was", "Some of seeds 8 to 9 were", 1));
    // Within a range, and beside its ends.
    assert!(used_before(6_000_064..=6_000_070).is_some() && used_before(9003..=9003).is_some());
    assert_eq!(used_before(6_000_065..=6_000_070), None);
    assert_eq!(used_before(424_242..=424_242), None);
}
