//! Gather what the page of an estimate shows.

use std::collections::BTreeMap;

use super::tree::in_words;
use crate::analysis::statistics::quantile;
use crate::estimate::{Estimate, Repeats, SURE, Verdict};
use crate::recording::Recording;
use crate::report::estimated::{Estimated, JointLine, PartLine};
use crate::report::viewer::frames::Frames;
use crate::report::viewer::scene::{Parts, Scene, TreeEdge};
use crate::report::viewer::sketch::sketch;
use crate::stages::body_map::{BodyMap, MapOf};
use crate::stages::evaluate::score;
use crate::stages::tree::{Edge, Truth};

/// What is known besides the estimate.
pub(super) struct Shown<'a> {
    /// The file of the pressures.
    pub name: String,
    /// Time between two samples, s.
    pub interval: Option<f64>,
    /// True parts and tree.
    pub truth: Option<&'a Truth>,
    /// What its map is of.
    pub of: MapOf,
    /// Master seed.
    pub seed: u64,
}

impl Shown<'_> {
    /// What the page shows, with how often it was found again if there were repeats.
    pub(super) fn estimated(
        &self,
        found: &Estimate,
        again: Option<&Repeats>,
        recording: &Recording,
    ) -> Estimated {
        Estimated {
            name: self.name.clone(),
            answers: self.answers(found, recording),
            doubts: found.doubts.iter().map(ToString::to_string).collect(),
            parts: parts(found, again),
            joints: joints(found, again),
            scene: self.scene(found, recording),
            facts: self.facts(recording),
        }
    }

    fn answers(&self, found: &Estimate, recording: &Recording) -> Vec<String> {
        let joints = &found.joints;
        let sure = joints.tree.iter().filter(|edge| joints.support(edge) >= SURE).count();
        let fit = match found.fit.verdict {
            Verdict::DoesNotFit => format!("{}; parts and tree mean nothing", found.fit),
            _ => found.fit.to_string(),
        };
        let parts = format!(
            "{} parts of {} sensors; {sure} of {} joints have a bootstrap support of at least 95 % (given the parts)",
            joints.ranks.len(),
            recording.sensors.len(),
            joints.tree.len()
        );
        let mut answers = vec![fit, parts];
        if let Some(truth) = self.truth {
            let score = score(&found.parts.labels, &joints.tree, &recording.truth(truth), 1.0);
            answers.push(format!("Against the truth: {}", in_words(&score)));
        }
        answers
    }

    fn facts(&self, recording: &Recording) -> Vec<(&'static str, String)> {
        let missing = &recording.missing;
        let dropped = match recording.dropped.len() {
            0 => "none".to_owned(),
            many => format!("{many} of {} (dropped.csv says which and why)", recording.all_sensors()),
        };
        vec![
            ("pressures", self.name.clone()),
            ("samples", recording.tactile.samples.to_string()),
            ("samples left out", recording.lost_samples.to_string()),
            ("sensors left out", dropped),
            ("values missing of the others", missing.values.to_string()),
            ("infinite values", missing.infinite.to_string()),
            ("saturated values", missing.saturated.to_string()),
            ("noisy sensors, which are smoothed", recording.noisy.to_string()),
            ("seed", self.seed.to_string()),
            ("revision", env!("BODYSCHEMA_REVISION").to_owned()),
        ]
    }

    fn map(&self, found: &Estimate, recording: &Recording) -> Option<BodyMap> {
        let mapped: Vec<usize> = found.mapped.iter().map(|&at| recording.sensors[at]).collect();
        sketch(&found.distances, self.of, &mapped, recording.all_sensors())
    }

    fn scene(&self, found: &Estimate, recording: &Recording) -> Scene {
        let count = recording.all_sensors();
        let frames = Frames::of(&recording.tactile, 0, Frames::every(self.interval), Frames::ROOM);
        // A sensor that was left out has no touch.
        let mut touch = vec![0.0; frames.count * count];
        for (series, &sensor) in recording.tactile.series().zip(&recording.sensors) {
            frames.samples().enumerate().for_each(|(at, sample)| touch[at * count + sensor] = series[sample]);
        }
        let mut of = vec![None; count];
        recording
            .sensors
            .iter()
            .zip(&found.parts.labels)
            .for_each(|(&sensor, &part)| of[sensor] = Some(part));
        let edge = |edge: &Edge| TreeEdge {
            child: edge.child,
            parent: edge.parent,
            support: Some(found.joints.support(edge)),
        };
        let times = frames.samples().map(|sample| recording.samples[sample]);
        Scene {
            name: String::new(),
            times: (recording.lost_samples > 0).then(|| times.collect()),
            frames,
            interval: self.interval,
            sensors: count,
            touch,
            body: None,
            is_still: false,
            surfaces: Vec::new(),
            map: self.map(found, recording),
            truth: self.truth.map(Parts::of_truth),
            estimate: Some(Parts {
                of,
                tree: found.joints.tree.iter().map(edge).collect(),
                names: Vec::new(),
            }),
        }
    }
}

fn parts(found: &Estimate, again: Option<&Repeats>) -> Vec<PartLine> {
    let mut residuals: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (&part, &residual) in found.parts.labels.iter().zip(&found.parts.residuals) {
        residuals.entry(part).or_default().push(residual);
    }
    let line = |(part, mut own): (usize, Vec<f64>)| {
        own.sort_by(f64::total_cmp);
        let rank = found.joints.ranks.get(&part).copied().unwrap_or(0);
        let repeated = again.and_then(|again| again.parts.get(&part).copied());
        PartLine { part, sensors: own.len(), rank, residual: quantile(&own, 0.5), repeated }
    };
    residuals.into_iter().map(line).collect()
}

fn joints(found: &Estimate, again: Option<&Repeats>) -> Vec<JointLine> {
    let line = |(at, edge): (usize, &Edge)| JointLine {
        parts: [edge.child, edge.parent],
        support: found.joints.support(edge),
        repeated: again.map(|again| again.tree[at]),
    };
    found.joints.tree.iter().enumerate().map(line).collect()
}
