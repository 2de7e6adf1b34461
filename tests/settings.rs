//! Thousands of random settings, valid and not: each ends in a result or in one line that names a setting, none in a
//! panic, an abort of the physics engine, or a wait. Seeds are fixed; `BODYSCHEMA_CASES=50000` tries more.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use bodyschema::numerics::rng::{Stream, stream};
use bodyschema::pipeline::StageError;
use bodyschema::settings::{PAPER, Settings, SettingsError};
use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::schema::InferenceError;
use bodyschema::stages::schema::{EdgeWeight, Prior, Sampler, Start};
use bodyschema::stages::schema::{Model, infer};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rayon::prelude::*;

use crate::support::bounded;

/// The values that a setting may have, as long as all others are the paper's.
enum Range {
    Real(f64, f64),
    /// A whole number; from 0 or 1 on.
    Whole(u64, u64),
    Word(&'static [&'static str]),
    /// true or false.
    Flag,
    /// A rising list of whole numbers up to a largest one.
    Numbers(u64),
    /// A rising list of probabilities.
    Probabilities,
}

use Range::{Flag, Numbers, Probabilities, Real, Whole, Word};

const SETTINGS: [(&str, Range); 70] = [
    ("agent.morphology", Word(&["chain", "star", "tee", "y"])),
    ("agent.part_length", Real(1e-3, 1e3)),
    ("agent.part_radius", Real(1e-3, 5.0)),
    ("agent.gap", Real(0.0, 1e3)),
    ("agent.density", Real(1e-6, 1e6)),
    ("skin.around", Whole(1, 571)),
    ("skin.along", Whole(1, 166)),
    ("skin.caps", Whole(0, 3832)),
    ("motion.coordination", Real(0.0, 1.0)),
    ("motion.epoch", Whole(1, i64::MAX as u64)),
    ("motion.targets", Word(&["each", "shared"])),
    ("motion.controller", Word(&["torque", "servo"])),
    ("motion.servo_gain", Real(1e-6, 1e6)),
    ("motion.servo_torque", Real(1e-6, 1e6)),
    ("motion.stiffness", Real(0.0, 1e6)),
    ("motion.damping", Real(0.0, 1e6)),
    ("motion.error", Word(&["raw", "shortest"])),
    ("motion.movement", Word(&["random", "rhythmic"])),
    ("motion.rhythm.frequency", Real(1e-4, 10.0)),
    ("motion.rhythm.frequency_spread", Real(0.0, 1.0)),
    ("motion.rhythm.frequency_time", Real(1e-6, 1e6)),
    ("motion.rhythm.gait_time", Real(0.0, 1e6)),
    ("motion.rhythm.least_amplitude", Real(0.0, 0.75)),
    ("motion.rhythm.largest_amplitude", Real(0.25, PI)),
    ("motion.rhythm.phase_lag", Real(-PI, PI)),
    ("motion.rhythm.phase_spread", Real(0.0, PI)),
    ("physics.step", Real(1e-5, 0.1)),
    ("physics.duration", Real(0.1, 238_095.2)),
    ("physics.turn_limit", Real(1e-3, 1e6)),
    ("physics.angular_momentum", Word(&["engine", "conserved"])),
    ("physics.fluid_density", Real(0.0, 1e6)),
    ("sense.interval", Real(0.01, 10_000.0)),
    ("sense.fluid_density", Real(1e-6, 1e6)),
    ("sense.threshold", Real(0.0, 1e6)),
    ("quantise.scheme", Word(&["per-sensor", "pooled", "equal-width"])),
    ("quantise.levels", Whole(2, 256)),
    ("map.of", Word(&["distances", "rows"])),
    ("map.method", Word(&["classical", "smacof", "smacof-random", "nonmetric"])),
    ("map.starts", Whole(1, 1000)),
    ("map.steps", Whole(1, 100_000)),
    ("map.tolerance", Real(0.0, 1e6)),
    ("schema.sampler", Word(&["equations", "authors-code", "split-merge"])),
    ("schema.components", Whole(1, 1000)),
    ("schema.concentration", Real(1e-6, 1e6)),
    ("schema.mean_weight", Real(1e-6, 1e6)),
    ("schema.extra_freedom", Real(-0.99, 1e6)),
    ("schema.prior", Word(&["fraley-raftery", "identity", "inverse-covariance"])),
    ("schema.scale", Real(1e-6, 1e6)),
    ("schema.edge_weight", Word(&["literal", "pairwise", "collapsed"])),
    ("schema.start", Word(&["uniform", "k-means", "single", "stick-breaking", "apart"])),
    ("schema.sweeps", Whole(1, 10_000_000)),
    ("schema.chains", Whole(1, 71_428)),
    ("schema.keep", Word(&["last", "all"])),
    ("schema.burn_in", Whole(0, i64::MAX as u64)),
    ("schema.authors.density_floor", Real(0.0, 1.0)),
    ("schema.authors.smallest_part", Whole(1, i64::MAX as u64)),
    ("schema.authors.root", Word(&["component-0", "first-active"])),
    ("schema.authors.stale_joints", Flag),
    ("schema.authors.densities", Word(&["plain", "logarithmic"])),
    ("schema.authors.joints_in_scatter", Flag),
    ("schema.authors.mean_covariance", Word(&["inverse-scale", "component"])),
    ("schema.authors.empty_components", Word(&["inverse", "prior"])),
    ("evaluate.eligible_ari", Real(0.0, 1.0)),
    ("baselines.clusters", Numbers(840)),
    ("baselines.restarts", Whole(1, 1000)),
    ("experiment.dimensions", Numbers(1000)),
    ("experiment.coordinations", Probabilities),
    ("experiment.dimension", Whole(1, 1000)),
    ("experiment.simulations", Whole(1, 3571)),
    ("experiment.seed", Whole(0, i64::MAX as u64)),
];

/// Between two numbers, on a logarithmic scale; the ends more often.
fn between(low: f64, high: f64, rng: &mut Stream) -> f64 {
    match rng.random_range(0..10) {
        0 => low,
        1 => high,
        _ => {
            let least = low.max(high * 1e-12);
            (least.ln() + rng.random::<f64>() * (high / least).ln()).exp().clamp(low, high)
        }
    }
}

impl Range {
    /// A value within.
    fn within(&self, rng: &mut Stream) -> String {
        let rising = |most: u64, rng: &mut Stream| -> Vec<u64> {
            let several = (0..rng.random_range(1..6)).map(|_| between(1.0, most as f64, rng) as u64);
            several.collect::<BTreeSet<_>>().into_iter().collect()
        };
        match self {
            Real(low, high) => format!("{:?}", between(*low, *high, rng)),
            Whole(low, high) => (between(*low as f64, *high as f64, rng) as u64).min(*high).to_string(),
            Word(words) => format!("{:?}", words.choose(rng).unwrap()),
            Flag => rng.random_bool(0.5).to_string(),
            Numbers(most) => format!("{:?}", rising(*most, rng)),
            Probabilities => {
                let shares = rising(1_000_000, rng).into_iter().map(|share| share as f64 / 1e6);
                format!("{:?}", shares.collect::<Vec<_>>())
            }
        }
    }

    /// Values that are just outside, absurd, no number, negative or of a wrong type.
    fn outside(&self) -> Vec<String> {
        let mut values: Vec<String> =
            ["true", "{ }", "1979-05-27", "[[]]", "nan", "-nan", "inf", "-inf"].map(str::to_owned).into();
        if matches!(self, Flag) {
            values.retain(|value| value != "true");
        }
        match self {
            Flag => values.extend(["0", "1", "\"true\"", "[true]"].map(str::to_owned)),
            Real(low, high) => {
                let beyond = [
                    low - 1e-5 * low.abs().max(1e-9),
                    high * (1.0 + 1e-5),
                    1e300,
                    -1e300,
                    -1.0,
                    1e-320 * low,
                ];
                values
                    .extend(beyond.iter().filter(|x| !(*low..=*high).contains(*x)).map(|x| format!("{x:?}")));
                values.extend(["\"1.0\"", "[1.0]", "9223372036854775807"].map(str::to_owned));
            }
            Whole(low, high) => {
                values.extend([*low as i64 - 1, -1, i64::MIN].map(|x| x.to_string()));
                if *high < i64::MAX as u64 {
                    values.extend([high + 1, i64::MAX as u64].map(|x| x.to_string()));
                }
                values.extend(["\"1\"", "[1]", "1.0", "1e300"].map(str::to_owned));
            }
            Word(_) => {
                values.extend(["\"\"", "\"Chain\"", "\"a\\nb\"", "0", "[\"chain\"]"].map(str::to_owned))
            }
            Numbers(most) => {
                let long: Vec<u64> = (1..=61).collect();
                let beyond = format!("[{}]", most + 1);
                let rest = [
                    "[]",
                    "[0]",
                    "[-1]",
                    "[2, 2]",
                    "[3, 2]",
                    "[1.5]",
                    "[true]",
                    "2",
                    "\"2\"",
                    "[9223372036854775807]",
                ];
                values.extend(rest.map(str::to_owned).into_iter().chain([beyond, format!("{long:?}")]));
            }
            Probabilities => {
                let long: Vec<f64> = (0..61).map(|share| f64::from(share) / 100.0).collect();
                let rest = [
                    "[]",
                    "[-0.1]",
                    "[1.000001]",
                    "[nan]",
                    "[0.5, 0.5]",
                    "[0.9, 0.1]",
                    "[\"0\"]",
                    "0.5",
                    "[inf]",
                ];
                values.extend(rest.map(str::to_owned).into_iter().chain([format!("{long:?}")]));
            }
        }
        values
    }
}

/// Settings as TOML has them.
fn toml(values: &[(&str, String)]) -> String {
    values.iter().fold(String::new(), |mut text, (key, value)| {
        writeln!(text, "{key} = {value}").unwrap();
        text
    })
}

fn load(file: &Path, text: &str) -> Result<Settings, SettingsError> {
    std::fs::write(file, text).unwrap();
    Settings::load(false, Some(file))
}

#[test]
fn every_setting_of_the_paper_is_tried() {
    let paper: toml::Table = PAPER.parse().unwrap();
    fn keys((name, value): (&String, &toml::Value)) -> Vec<String> {
        let Some(section) = value.as_table() else { return vec![name.clone()] };
        section.iter().flat_map(keys).map(|key| format!("{name}.{key}")).collect()
    }
    let expected: BTreeSet<String> = paper.iter().flat_map(keys).collect();
    assert_eq!(SETTINGS.iter().map(|(key, _)| (*key).to_owned()).collect::<BTreeSet<_>>(), expected);
}

#[test]
fn a_value_outside_its_range_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.toml");
    let mut refused = 0;
    for (key, range) in &SETTINGS {
        for value in range.outside() {
            let text = toml(&[(key, value)]);
            let message = load(&file, &text).expect_err(&text).to_string();
            assert!(message.contains(key), "{text} gave {message:?}");
            assert!(message.len() < 500 && !message.contains('\n'), "{text} gave {message:?}");
            refused += 1;
        }
    }
    assert!(refused > 400, "{refused} were tried");
}

#[test]
fn mixtures_of_extreme_priors_on_nearly_flat_maps_end_in_samples_or_in_an_error() {
    let (mut drawn, mut lost) = (0, 0);
    for case in 0..900 {
        let rng = &mut stream(1, 1, "flat maps", case);
        let mut schema = Settings::paper().schema;
        (schema.chains, schema.sweeps, schema.components) = (1, 10, *[2, 10, 300].choose(rng).unwrap());
        schema.edge_weight =
            *[EdgeWeight::Literal, EdgeWeight::Pairwise, EdgeWeight::Collapsed].choose(rng).unwrap();
        schema.start =
            *[Start::Uniform, Start::KMeans, Start::Single, Start::StickBreaking, Start::Overdispersed]
                .choose(rng)
                .unwrap();
        schema.sampler =
            *[Sampler::Equations, Sampler::AuthorsCode, Sampler::SplitMerge].choose(rng).unwrap();
        schema.prior =
            *[Prior::FraleyRaftery, Prior::Identity, Prior::InverseCovariance].choose(rng).unwrap();
        schema.concentration = between(1e-6, 1e6, rng);
        schema.mean_weight = between(1e-6, 1e6, rng);
        schema.extra_freedom = between(1e-2, 1e6, rng) - 1.0;
        schema.scale = between(1e-6, 1e6, rng);
        // Points that coincide in far clusters, whose coordinates nearly determine each other.
        let (clusters, thin) = (rng.random_range(1..5), between(1e-7, 1.0, rng));
        let spread = between(1e-9, 1.0, rng);
        let point = |i: usize| {
            let x = 100.0 * (i % clusters) as f64 + spread * rng.random::<f64>();
            [x, x + thin * rng.random::<f64>(), 0.5 * x + thin * rng.random::<f64>()]
        };
        let map = BodyMap { dims: 3, coordinates: (0..60).flat_map(point).collect() };
        for model in Model::ALL {
            match infer(&map, model, &schema, 1, 1, &|| ()) {
                Ok(samples) => {
                    assert!(
                        samples.iter().all(|sample| sample.log_posterior.is_some_and(f64::is_finite)),
                        "{case}"
                    );
                    drawn += 1;
                }
                Err(error) => {
                    assert!(
                        matches!(error, InferenceError::Flat { .. } | InferenceError::Rounding),
                        "{case}: {error}"
                    );
                    lost += usize::from(error == InferenceError::Rounding);
                }
            }
        }
    }
    println!("{drawn} drawn, {lost} lost in rounding");
    assert!(drawn > 100 && lost > 10, "{drawn} drawn, {lost} lost in rounding");
}

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused,
    Unstable,
    NoMap,
    NoMixture,
    Done,
}

/// Random settings: some missing, the others within, and in every second case a few of them outside.
fn random_settings(rng: &mut Stream) -> String {
    let (given, outside) = (rng.random_range(0.05..0.95), [0.0, 0.02].choose(rng).unwrap());
    let mut values = Vec::new();
    for (key, range) in &SETTINGS {
        if rng.random_bool(given) {
            let value = match rng.random_bool(*outside) {
                true => range.outside().choose(rng).unwrap().clone(),
                false => range.within(rng),
            };
            values.push((*key, value));
        }
    }
    // Most steps go a whole number of times into none of the intervals drawn, and few times are long enough.
    if rng.random_bool(0.9) {
        values.retain(|(key, _)| !["physics.step", "sense.interval", "physics.duration"].contains(key));
        let step = between(1e-6, 1e6, rng);
        let interval = step * between(1.0, 1e3, rng).floor();
        let duration = interval * between(1.0, 1e4, rng);
        values.extend([
            ("physics.step", format!("{step:?}")),
            ("sense.interval", format!("{interval:?}")),
            ("physics.duration", format!("{duration:?}")),
        ]);
    }
    // A light body that is driven hard is unstable; half of them are driven as the paper's.
    if rng.random_bool(0.5) {
        values.retain(|(key, _)| !["motion.stiffness", "motion.damping"].contains(key));
    }
    // Most steps are too long for a rhythm, whose settings do not count without one.
    if rng.random_bool(0.75) {
        values.retain(|(key, _)| *key != "motion.movement" && !key.starts_with("motion.rhythm."));
    }
    toml(&values)
}

fn run(file: &Path, text: &str) -> (End, String) {
    let settings = match load(file, text) {
        Ok(settings) => bounded::bounded(&settings),
        Err(error) => return (End::Refused, error.to_string()),
    };
    settings.validate().unwrap_or_else(|error| panic!("smaller sizes are refused: {error}"));
    match bounded::run_every_stage(&settings) {
        Ok(()) => (End::Done, String::new()),
        Err(error @ StageError::Simulate(_)) => (End::Unstable, error.to_string()),
        Err(error @ StageError::Map(_)) => (End::NoMap, error.to_string()),
        Err(error @ StageError::Infer(_)) => (End::NoMixture, error.to_string()),
    }
}

#[test]
fn random_settings_end_in_a_result_or_in_a_line_that_names_a_setting() {
    let cases =
        std::env::var("BODYSCHEMA_CASES").map_or(4000, |cases| cases.parse().expect("a number of cases"));
    let folder = tempfile::tempdir().unwrap();
    let ends: Vec<(End, Duration)> = (0..cases)
        .into_par_iter()
        .map(|case: usize| {
            let text = random_settings(&mut stream(1, 1, "random settings", case));
            let file = folder.path().join(format!("{case}.toml"));
            let begun = Instant::now();
            let (end, message) = catch_unwind(AssertUnwindSafe(|| run(&file, &text)))
                .unwrap_or_else(|_| panic!("case {case} panicked with\n{text}"));
            std::fs::remove_file(&file).unwrap();
            let names_one = SETTINGS.iter().any(|(key, _)| {
                let (_, name) = key.split_once('.').unwrap();
                message.contains(key) || [End::NoMap, End::NoMixture].contains(&end) && message.contains(name)
            });
            assert!(end == End::Done || names_one, "case {case}: {message:?} names no setting\n{text}");
            assert!(!message.contains('\n') && message.len() < 500, "case {case}: {message:?}");
            (end, begun.elapsed())
        })
        .collect();
    let count = |end| ends.iter().filter(|(other, _)| *other == end).count();
    let slowest = ends.iter().map(|(_, time)| *time).max().unwrap();
    let counts =
        [End::Refused, End::Unstable, End::NoMap, End::NoMixture, End::Done].map(|end| (end, count(end)));
    println!("{cases} cases: {counts:?}; the slowest took {slowest:?}");
    // Enough of each to say that it was tried; a servo is seldom unstable, and that rounding leaves a mixture nothing is too
    // rare.
    for ((end, count), percent) in counts.into_iter().zip([10, 4, 1, 0, 10]) {
        assert!(100 * count >= percent * cases, "{end:?}: {count} of {cases}");
    }
    // A thread that waits for others may look slow.
    assert!(slowest < Duration::from_secs(60), "{slowest:?}");
}
