//! Merge settings of several options, and write them in a line.

use std::f64::consts::PI;

use serde::Deserialize;
use toml::{Table, Value};

use crate::settings::{PAPER, Settings};

/// Lays `over` on `base`, section by section.
pub(super) fn merge(base: &mut Table, over: &Table) {
    for (name, value) in over {
        match (base.get_mut(name), value) {
            (Some(Value::Table(base)), Value::Table(over)) => merge(base, over),
            _ => {
                base.insert(name.clone(), value.clone());
            }
        }
    }
}

/// `section.key = value` for every setting of a table.
pub(super) fn flat(table: &Table) -> Vec<String> {
    let mut all = Vec::new();
    for (name, value) in table {
        match value {
            Value::Table(inner) => all.extend(flat(inner).into_iter().map(|line| format!("{name}.{line}"))),
            value => all.push(format!("{name} = {}", value.to_string().replace('"', ""))),
        }
    }
    all
}

/// The settings of a table in a line, without their sections.
pub(super) fn short(table: &Table) -> String {
    let short = |line: String| line.split_once('.').map_or(line.clone(), |(_, short)| short.to_owned());
    flat(table).into_iter().map(short).collect::<Vec<_>>().join(", ")
}

/// The value of a setting `section.key`, as settings files write it.
pub(super) fn value_of(settings: &Settings, key: &str) -> Option<String> {
    let own = serde_json::to_value(settings).expect("settings are plain data");
    // Settings of a random movement do not write the rhythm, which has defaults, too.
    let defaults: Table = PAPER.parse().expect("reproduce/paper.toml is TOML");
    let defaults = serde_json::to_value(defaults).expect("settings are plain data");
    let within = |all| key.split('.').try_fold(all, |table: &serde_json::Value, name| table.get(name));
    Some(within(&own).or_else(|| within(&defaults))?.to_string().replace('"', ""))
}

/// The gains of a torque, by what they do to the body that they are for.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gains {
    /// Natural frequency of a part that swings about its end, rad/s: √(stiffness / (m L² / 3)).
    pub frequency: f64,
    /// Damping times the step over the axial inertia of a part, m r² / 2; beyond 1 a spin is overshot in one step.
    pub spin_damping: f64,
}

impl Gains {
    /// `[motion]` for a body, in three digits.
    pub(crate) fn settings(self, settings: &Settings) -> Table {
        let Settings { agent, physics, .. } = settings;
        let mass = agent.density * PI * agent.part_radius.powi(2) * agent.part_length;
        let stiffness = self.frequency.powi(2) * mass * agent.part_length.powi(2) / 3.0;
        let damping = self.spin_damping * mass * agent.part_radius.powi(2) / 2.0 / physics.step;
        let digits = |value: f64| format!("{value:.2e}").parse().expect("it is a number");
        let number = |value: f64| Value::Float(digits(value));
        let motion = Table::from_iter([
            ("controller".to_owned(), Value::String("torque".to_owned())),
            ("stiffness".to_owned(), number(stiffness)),
            ("damping".to_owned(), number(damping)),
        ]);
        Table::from_iter([("motion".to_owned(), Value::Table(motion))])
    }

    /// What they are, in words.
    pub(crate) fn in_words(self) -> String {
        let Self { frequency, spin_damping } = self;
        format!("natural frequency {frequency} rad/s, damping × step = {spin_damping} × axial inertia")
    }
}
