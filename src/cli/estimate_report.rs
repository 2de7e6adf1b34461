//! Gather what the page of an estimate shows.

use std::collections::BTreeMap;

use super::tree::in_words;
use crate::analysis::estimate::Estimate;
use crate::analysis::statistics::quantile;
use crate::report::estimated::{Estimated, PartLine};
use crate::report::viewer::frames::Frames;
use crate::report::viewer::scene::{Parts, Scene, TreeEdge};
use crate::report::viewer::sketch::sketch;
use crate::stages::body_map::{BodyMap, MapOf};
use crate::stages::evaluate::score;
use crate::stages::schema::Draw;
use crate::stages::sense::Tactile;
use crate::stages::tree::{Edge, Truth};
use crate::stages::usable::Fault;

/// What of the input was used.
pub struct Read<'a> {
    /// Pressures of the sensors that were used.
    pub tactile: &'a Tactile,
    /// These sensors.
    pub sensors: &'a [usize],
    /// The others.
    pub dropped: &'a [(usize, Fault)],
    /// The samples that were used.
    pub samples: &'a [usize],
    /// How many were not.
    pub lost_samples: usize,
    /// Sensors with noise.
    pub noisy: usize,
}

impl Read<'_> {
    /// All sensors of the input.
    pub fn count(&self) -> usize {
        self.sensors.len() + self.dropped.len()
    }
}

/// What is known besides the estimate.
pub struct Shown<'a> {
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
    /// What the page shows.
    pub fn estimated(&self, found: &Estimate, read: &Read) -> Estimated {
        Estimated {
            name: self.name.clone(),
            answers: self.answers(found, read),
            parts: parts(found),
            scene: self.scene(found, read),
            facts: self.facts(read),
        }
    }

    fn answers(&self, found: &Estimate, read: &Read) -> Vec<String> {
        let tree = &found.tree;
        let sure = tree.tree.iter().filter(|edge| tree.confidence(edge) >= 0.95).count();
        let mut answers = vec![format!(
            "{} parts of {} sensors; {sure} of {} joints have a bootstrap support of at least 95 % (given the parts)",
            tree.parts.len(),
            read.sensors.len(),
            tree.tree.len()
        )];
        if let Some(truth) = self.truth {
            let own = read.sensors.iter().map(|&sensor| truth.labels[sensor]).collect();
            let truth = Truth { labels: own, tree: truth.tree.clone() };
            let score = score(&Draw::of(found.parts.labels.clone(), tree.tree.clone()), &truth, 1.0);
            answers.push(format!("Against the truth: {}", in_words(&score)));
        }
        answers
    }

    fn facts(&self, read: &Read) -> Vec<(&'static str, String)> {
        let dropped = match read.dropped.len() {
            0 => "none".to_owned(),
            many => format!("{many} of {} (dropped.csv says which and why)", read.count()),
        };
        vec![
            ("pressures", self.name.clone()),
            ("samples", read.tactile.samples.to_string()),
            ("samples left out", read.lost_samples.to_string()),
            ("sensors left out", dropped),
            ("noisy sensors, which are smoothed", read.noisy.to_string()),
            ("seed", self.seed.to_string()),
            ("revision", env!("BODYSCHEMA_REVISION").to_owned()),
        ]
    }

    fn map(&self, found: &Estimate, read: &Read) -> Option<BodyMap> {
        let mapped: Vec<usize> = found.mapped.iter().map(|&at| read.sensors[at]).collect();
        sketch(&found.distances, self.of, &mapped, read.count())
    }

    fn scene(&self, found: &Estimate, read: &Read) -> Scene {
        let count = read.count();
        let frames = Frames::of(read.tactile, 0, Frames::every(self.interval), Frames::ROOM);
        // A sensor that was left out felt nothing that counts.
        let mut touch = vec![0.0; frames.count * count];
        for (series, &sensor) in read.tactile.series().zip(read.sensors) {
            frames.samples().enumerate().for_each(|(at, sample)| touch[at * count + sensor] = series[sample]);
        }
        let mut of = vec![None; count];
        read.sensors.iter().zip(&found.parts.labels).for_each(|(&sensor, &part)| of[sensor] = Some(part));
        let edge = |edge: &Edge| TreeEdge {
            child: edge.child,
            parent: edge.parent,
            confidence: Some(found.tree.confidence(edge)),
        };
        let times = frames.samples().map(|sample| read.samples[sample]);
        Scene {
            name: String::new(),
            times: (read.lost_samples > 0).then(|| times.collect()),
            frames,
            interval: self.interval,
            sensors: count,
            touch,
            body: None,
            map: self.map(found, read),
            truth: self.truth.map(Parts::of_truth),
            estimate: Some(Parts { of, tree: found.tree.tree.iter().map(edge).collect() }),
        }
    }
}

fn parts(found: &Estimate) -> Vec<PartLine> {
    let mut left: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (&part, &share) in found.parts.labels.iter().zip(&found.parts.left) {
        left.entry(part).or_default().push(share);
    }
    let line = |(part, mut left): (usize, Vec<f64>)| {
        left.sort_by(f64::total_cmp);
        let components = found.tree.parts.iter().find(|(label, _)| *label == part).map_or(0, |(_, k)| *k);
        PartLine { part, sensors: left.len(), components, unexplained: quantile(&left, 0.5) }
    };
    left.into_iter().map(line).collect()
}
