use super::*;
use crate::settings::Settings;

#[test]
fn the_designs_of_the_repository_can_be_run_and_spare_the_seed_of_the_experiments() {
    let search = search::Design::parse(search::DESIGN, "search.toml").unwrap();
    search.check().unwrap();
    let study = sensitivity::Design::parse(sensitivity::DESIGN, "sensitivity.toml").unwrap();
    assert!(study.configurations().unwrap().len() > 60);
    assert!(is_held_out(Settings::paper().experiment.seed));
    assert!(!is_held_out(search.seed) && !is_held_out(study.seed) && search.seed != study.seed);
}

#[test]
fn every_setting_that_is_marked_as_ours_is_in_the_study() {
    let study = sensitivity::Design::parse(sensitivity::DESIGN, "sensitivity.toml").unwrap();
    let named: Vec<&String> = study.part.iter().flat_map(|part| &part.settings).collect();
    // How much is run, and what only says how a run is judged stable.
    let spared = [
        "schema.burn_in",
        "baselines.restarts",
        "experiment.simulations",
        "experiment.seed",
        "physics.turn_limit",
    ];
    let mut section = "";
    for line in crate::settings::PAPER.lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']');
        } else if let Some((name, rest)) = line.split_once(" = ")
            && rest.contains("# ours")
        {
            let key = format!("{section}.{name}");
            assert!(named.contains(&&key) || spared.contains(&key.as_str()), "{key}");
        }
    }
}

#[test]
fn parts_that_share_a_movement_are_together_and_no_others() {
    let configuration = |name: &str, change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::paper();
        settings.experiment.simulations = 2;
        settings.experiment.coordinations = vec![0.5, settings.motion.coordination];
        change(&mut settings);
        (name.to_owned(), settings)
    };
    let (names, all): (Vec<String>, Vec<Settings>) = [
        configuration("default", &|_| ()),
        configuration("levels", &|settings| settings.quantise.levels = 7),
        configuration("gap", &|settings| settings.agent.gap = 0.01),
        configuration("seed", &|settings| settings.experiment.seed += 1),
    ]
    .into_iter()
    .unzip();
    let movements = by_movement(&all);
    // Two simulations at two p of three bodies.
    assert_eq!(movements.len(), 2 * 2 * 3);
    for parts in &movements {
        let members: Vec<&str> = parts.iter().map(|part| names[part.configuration].as_str()).collect();
        assert!([vec!["default", "levels"], vec!["gap"], vec!["seed"]].contains(&members), "{members:?}");
        assert!(parts.iter().all(|part| {
            (part.coordination, part.simulation) == (parts[0].coordination, parts[0].simulation)
        }));
    }
}
