//! Estimate parts and tree from all recordings of one movement, and compare with the truth.

use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use super::design::{Design, Recording, StudyBody, Way};
use super::{components, joining, peers};
use crate::estimate::estimate;
use crate::numerics::rng::stream;
use crate::recording::Recording as Cleaned;
use crate::settings::Settings;
use crate::stages::distance::information_metric;
use crate::stages::evaluate::{joins, parts, parts_match, score};
use crate::stages::joints::joint_tree;
use crate::stages::parameters::Parameters;
use crate::stages::quantise::quantise;
use crate::stages::sense::{Tactile, sense};
use crate::stages::simulate::simulate;
use crate::stages::tree::{Edge, Truth};

/// A movement of the study.
pub(super) struct Movement<'a> {
    /// What is studied.
    pub design: &'a Design,
    /// The body.
    pub body: &'a StudyBody,
    /// Its place in the design.
    pub of_body: usize,
    /// How it moves.
    pub way: Way<'a>,
    /// The settings.
    pub settings: &'a Settings,
    /// Its number, from 1.
    pub number: usize,
}

/// What was found in a recording: a row of recordings.csv.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Row {
    /// The body.
    pub body: String,
    /// The kind of movement, if the study has kinds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
    /// p.
    pub coordination: f64,
    /// The movement, from 1.
    pub movement: usize,
    /// T.
    pub samples: usize,
    /// Noise over the root mean square of each sensor.
    pub noise: f64,
    /// Whether the physics step resolves the movement.
    pub resolved: bool,
    /// The verdict on the fit; empty where there is no estimate, or the study is older.
    #[serde(default)]
    pub fit: String,
    /// Number of true parts.
    pub true_parts: usize,
    /// Number of estimated parts.
    pub parts: usize,
    /// Adjusted Rand index.
    pub ari: f64,
    /// Whether each estimated part is one true part by most of its sensors, and each true part one estimated.
    pub parts_right: bool,
    /// Whether the tree over the estimated parts is right.
    pub tree_right: bool,
    /// The same over the true parts.
    pub tree_of_true_parts_right: bool,
    /// The same of the nearest sensors of the estimated parts.
    pub nearest_right: bool,
    /// The same of the tree of most information between the estimated parts.
    pub chow_liu_right: bool,
    /// The same of the tree of most information between the principal components of the estimated parts.
    pub components_right: bool,
    /// The same of neighbour joining on the correlations of joint speeds.
    pub joining_right: bool,
    /// Number of parts of the DPGMM-LJ's most probable sample.
    pub dpgmm_lj_parts: Option<usize>,
    /// Whether its tree is right.
    pub dpgmm_lj_right: bool,
    /// Whether the tree of the DPGMM's most probable sample is right, by Prim's algorithm.
    pub dpgmm_prim_right: bool,
}

/// An edge of an estimated tree: a row of edges.csv.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct EdgeRow {
    /// The body.
    pub body: String,
    /// The kind of movement, if the study has kinds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
    /// p.
    pub coordination: f64,
    /// The movement, from 1.
    pub movement: usize,
    /// T.
    pub samples: usize,
    /// Noise.
    pub noise: f64,
    /// The share of resampled trees with the edge.
    pub support: f64,
    /// Whether it joins parts that are joined, each estimated part being that of most of its sensors.
    pub right: bool,
}

/// All that was found in the recordings of a movement.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Found {
    /// A row for each recording.
    pub rows: Vec<Row>,
    /// A row for each edge of each recording.
    pub edges: Vec<EdgeRow>,
}

impl Movement<'_> {
    /// The name of its checkpoint.
    pub(super) fn name(&self) -> String {
        let kind = self.way.name().map_or(String::new(), |kind| format!("-{kind}"));
        format!("{}{kind}-p{}-{}", self.body.name, self.way.coordination, self.number)
    }

    /// A number that no other movement of its way has, for its streams of random numbers: movements of all ways share them.
    fn simulation(&self) -> usize {
        (self.number - 1) * self.design.bodies.len() + self.of_body + 1
    }

    /// Simulates it, and estimates from each recording.
    ///
    /// # Errors
    /// If it is unstable; the message says at which body.
    pub(super) fn run(&self, tick: &dyn Fn()) -> Result<Found, String> {
        let Settings { motion, physics, sense: tactile, experiment, .. } = self.settings;
        let (agent, simulation) = (&self.body.body.agent, self.simulation());
        let mut rng = stream(experiment.seed, simulation, "motion", 0);
        let moved = simulate(agent, motion, physics, tactile.interval, &mut rng, &|| ())
            .map_err(|error| format!("{}: {error}", self.name()))?;
        tick();
        let felt = sense(agent, &moved, tactile);
        let truth = agent.truth();
        let (resolved, mut found) =
            (moved.resolution.is_resolved(), Found { rows: Vec::new(), edges: Vec::new() });
        drop(moved);
        for (at, recording) in self.design.recordings.iter().enumerate() {
            let mut rng = stream(experiment.seed, simulation, "noise", at);
            let seen = Seen { truth: &truth, recording, resolved, simulation };
            let (row, edges) = self.record(recorded(&felt, recording, &mut rng), &seen);
            found.rows.push(row);
            found.edges.extend(edges);
            tick();
        }
        Ok(found)
    }

    /// The row of a recording in which nothing is found.
    fn nothing(&self, seen: &Seen) -> Row {
        Row {
            body: self.body.name.clone(),
            kind: self.way.name().map(str::to_owned),
            coordination: self.way.coordination,
            movement: self.number,
            samples: seen.recording.samples,
            noise: seen.recording.noise,
            resolved: seen.resolved,
            fit: String::new(),
            true_parts: seen.truth.parts(),
            parts: 0,
            ari: 0.0,
            parts_right: false,
            tree_right: false,
            tree_of_true_parts_right: false,
            nearest_right: false,
            chow_liu_right: false,
            components_right: false,
            joining_right: false,
            dpgmm_lj_parts: None,
            dpgmm_lj_right: false,
            dpgmm_prim_right: false,
        }
    }

    /// What is found in a recording.
    fn record(&self, tactile: Tactile, seen: &Seen) -> (Row, Vec<EdgeRow>) {
        let Settings { quantise: levels, experiment, .. } = self.settings;
        let &Recording { samples, noise } = seen.recording;
        let nothing = self.nothing(seen);
        let recording = Cleaned::new(tactile);
        let mut rng = stream(experiment.seed, seen.simulation, "co-motion", 0);
        // A short recording may be of a body whose joints are all locked.
        let Ok(estimated) = estimate(&recording, levels, &Parameters::default(), &mut rng, &|| ()) else {
            return (nothing, Vec::new());
        };
        let truth = recording.truth(seen.truth);
        let tactile = &recording.tactile;
        let (labels, joints) = (&estimated.parts.labels, &estimated.joints);
        let given: Vec<Option<usize>> = truth.labels.iter().copied().map(Some).collect();
        let tree_of_true_parts = joint_tree(tactile, recording.signed, &given);
        let symbols = quantise(tactile, levels);
        let distances = information_metric(&symbols);
        let [nearest, chow_liu] = peers::trees(labels, &distances, &symbols);
        let mixtures = peers::mixtures(&distances, self.settings, seen.simulation);
        let scored = |labels: &[usize], tree: &[Edge]| score(labels, tree, &truth, 0.0);
        let mixture_right = |at: usize| {
            mixtures
                .as_ref()
                .is_some_and(|samples| scored(&samples[at].labels, &samples[at].tree).tree_correct)
        };
        let found = scored(labels, &joints.tree);
        let row = Row {
            fit: estimated.fit.verdict.to_string(),
            parts: joints.ranks.len(),
            ari: found.ari,
            parts_right: parts_match(labels, &truth),
            tree_right: found.tree_correct,
            tree_of_true_parts_right: scored(&truth.labels, &tree_of_true_parts).tree_correct,
            nearest_right: scored(labels, &nearest).tree_correct,
            chow_liu_right: scored(labels, &chow_liu).tree_correct,
            components_right: scored(labels, &components::tree(labels, tactile)).tree_correct,
            joining_right: scored(labels, &joining::tree(joints)).tree_correct,
            dpgmm_lj_parts: mixtures.as_ref().map(|samples| parts(&samples[0].labels)),
            dpgmm_lj_right: mixture_right(0),
            dpgmm_prim_right: mixture_right(1),
            ..nothing
        };
        let edge = |edge: &Edge| EdgeRow {
            body: row.body.clone(),
            kind: row.kind.clone(),
            coordination: row.coordination,
            movement: row.movement,
            samples,
            noise,
            support: joints.support(edge),
            right: joins(labels, edge, &truth),
        };
        let edges = joints.tree.iter().map(edge).collect();
        (row, edges)
    }
}

/// What is known of a recording besides its pressures.
struct Seen<'a> {
    truth: &'a Truth,
    recording: &'a Recording,
    resolved: bool,
    simulation: usize,
}

/// The first samples, with noise; a pressure that it makes negative is 0.
fn recorded(felt: &Tactile, recording: &Recording, rng: &mut impl rand::Rng) -> Tactile {
    let mut pressures = Vec::with_capacity(felt.sensors() * recording.samples);
    for series in felt.series() {
        let own = &series[..recording.samples];
        if recording.noise == 0.0 {
            pressures.extend_from_slice(own);
            continue;
        }
        let squares: f64 = own.iter().map(|pressure| f64::from(*pressure).powi(2)).sum();
        let deviation = recording.noise * (squares / own.len() as f64).sqrt();
        pressures.extend(own.iter().map(|pressure| {
            let error: f64 = StandardNormal.sample(rng);
            (f64::from(*pressure) + deviation * error).max(0.0) as f32
        }));
    }
    Tactile { samples: recording.samples, pressures }
}
