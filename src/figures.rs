//! An experiment → the data of the paper's figures, as tidy tables; [`crate::plot`] draws them.
//!
//! [`README`] documents every column, and is written beside the tables.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::agent::Agent;
use crate::body_map::BodyMap;
use crate::conditions::{BaselineEstimate, Condition, Conditions};
use crate::record::FileError;
use crate::record::tables::write_rows;
use crate::schema::{Model, Sample};
use crate::simulate::Trajectory;
use crate::simulate::world::Pose;
use crate::statistics::{Estimate, quantile};

/// Explains the tables to whoever opens the folder.
pub const README: &str = include_str!("figures/README.md");

/// Which draws of a condition an estimate is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counting {
    /// As published: all draws; of trees, those with the right number of parts and ARI.
    AllDraws,
    /// An extension: of each simulation the draw of highest log posterior.
    BestDraw,
}

/// A point of figure 4: something of the agent, in its rest pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgentRow {
    /// The part, from 0.
    pub part: usize,
    /// What it is.
    pub kind: AgentPoint,
    /// Position, m.
    pub x_m: f64,
    /// Position, m.
    pub y_m: f64,
    /// Position, m.
    pub z_m: f64,
}

/// What a point of figure 4 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AgentPoint {
    /// The proximal end of the cylinder's axis.
    ProximalEnd,
    /// The distal end of the cylinder's axis.
    DistalEnd,
    /// The joint that carries the part.
    Joint,
    /// A sensor on the part.
    Sensor,
}

/// A time of a joint of figure 5.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AngleRow {
    /// p.
    pub coordination: f64,
    /// Time, s.
    pub time_s: f64,
    /// The joint, from 1.
    pub joint: usize,
    /// Its first angle, rad in [−π, π].
    pub angle1_rad: f64,
    /// Its second angle, rad in [−π, π].
    pub angle2_rad: f64,
}

/// A point on a body map of figure 6.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapRow {
    /// What it is.
    pub kind: MapPoint,
    /// Number of the sensor or joint, from 0.
    pub index: usize,
    /// The true part (a, b) or the cluster (c, d) of a sensor; none of a joint.
    pub group: Option<usize>,
    /// Coordinate, bits.
    pub x1: f64,
    /// Coordinate, bits.
    pub x2: f64,
    /// Coordinate, bits, in three dimensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x3: Option<f64>,
}

/// What a point on a body map is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapPoint {
    /// A sensor.
    Sensor,
    /// An estimated joint q.
    Joint,
}

/// A bar of figure 7, with the mean of its histogram.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartsRow {
    /// d.
    pub dimension: usize,
    /// Which draws are counted.
    pub counting: Counting,
    /// Number of estimated parts.
    pub parts: usize,
    /// Draws with that number.
    pub count: usize,
    /// Draws in all.
    pub n: usize,
    /// Mean number of parts.
    pub mean: f64,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of its 95 % interval.
    pub high: Option<f64>,
}

/// A box of figure 9, over the draws of all simulations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoxRow {
    /// d.
    pub dimension: usize,
    /// Draws.
    pub n: usize,
    /// Lowest ARI.
    pub lowest: f64,
    /// Lowest ARI within 1.5 interquartile ranges of the box.
    pub whisker_low: f64,
    /// 25 % quantile.
    pub lower_quartile: f64,
    /// 50 % quantile.
    pub median: f64,
    /// 75 % quantile.
    pub upper_quartile: f64,
    /// Highest ARI within 1.5 interquartile ranges of the box.
    pub whisker_high: f64,
    /// Highest ARI.
    pub highest: f64,
}

/// A point of a curve of figures 8, 10 and 11.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveRow {
    /// The clustering or mixture.
    pub method: String,
    /// Number of clusters that it was told; none if it found the number itself.
    pub clusters: Option<usize>,
    /// Which draws are counted.
    pub counting: Counting,
    /// p.
    pub coordination: f64,
    /// d.
    pub dimension: usize,
    /// Mean ARI (8, 11a) or rate of right trees (10, 11b); none without a sample.
    pub value: Option<f64>,
    /// Samples.
    pub n: usize,
    /// Lower end of the 95 % interval.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
    /// Simulations with a sample.
    pub simulations: usize,
    /// Lowest value of a single simulation, where there are several.
    pub lowest: Option<f64>,
    /// Highest value of a single simulation, where there are several.
    pub highest: Option<f64>,
}

impl CurveRow {
    fn new(
        method: &str,
        clusters: Option<usize>,
        counting: Counting,
        (coordination, dimension): (f64, usize),
        estimate: Estimate,
    ) -> Self {
        let (low, high) = estimate.interval.unzip();
        let (lowest, highest) = estimate.spread.unzip();
        let Estimate { value, n, simulations, .. } = estimate;
        Self {
            method: method.to_owned(),
            clusters,
            counting,
            coordination,
            dimension,
            value,
            n,
            low,
            high,
            simulations,
            lowest,
            highest,
        }
    }
}

/// A folder that figure data are written to, and the names of what it holds by now.
#[derive(Debug)]
pub struct Figures<'a> {
    folder: &'a Path,
    /// Files written, in order.
    pub names: Vec<String>,
}

impl<'a> Figures<'a> {
    /// Starts with the file that explains the others.
    ///
    /// # Errors
    /// If a file cannot be written; so for all that follow.
    pub fn new(folder: &'a Path) -> Result<Self, FileError> {
        crate::record::write_text(&folder.join("README.md"), README)?;
        Ok(Self { folder, names: vec!["README.md".to_owned()] })
    }

    fn write<T: Serialize>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = T>,
    ) -> Result<(), FileError> {
        let name = format!("{name}.csv");
        write_rows(&self.folder.join(&name), rows)?;
        self.names.push(name);
        Ok(())
    }

    /// Figure 4: the agent and its sensors in the poses of its parts, whose length is `part_length`.
    pub fn agent(&mut self, agent: &Agent, poses: &[Pose], part_length: f64) -> Result<(), FileError> {
        let row = |part, kind, [x_m, y_m, z_m]: [f64; 3]| {
            let [x_m, y_m, z_m] = [x_m, y_m, z_m].map(round);
            AgentRow { part, kind, x_m, y_m, z_m }
        };
        let end = |pose: &Pose, side: f64| pose.place([0.0, 0.0, side * part_length / 2.0]);
        let ends = poses.iter().enumerate().flat_map(|(part, pose)| {
            [
                row(part, AgentPoint::ProximalEnd, end(pose, -1.0)),
                row(part, AgentPoint::DistalEnd, end(pose, 1.0)),
            ]
        });
        let joints = agent.joints.iter().map(|joint| row(joint.child, AgentPoint::Joint, joint.anchor));
        let sensors = agent
            .sites
            .iter()
            .map(|site| row(site.part, AgentPoint::Sensor, poses[site.part].place(site.position)));
        self.write("fig04-agent", ends.chain(joints).chain(sensors))
    }

    /// Figure 5: joint angles over time, of a trajectory for each p with a sample every `interval`.
    pub fn angles(&mut self, trajectories: &[(f64, Trajectory)], interval: f64) -> Result<(), FileError> {
        let rows = trajectories.iter().flat_map(|(coordination, trajectory)| {
            trajectory.angles.chunks_exact(trajectory.joints).enumerate().flat_map(move |(sample, angles)| {
                angles.iter().enumerate().map(move |(joint, angles)| AngleRow {
                    coordination: *coordination,
                    time_s: round(sample as f64 * interval),
                    joint: joint + 1,
                    angle1_rad: round(angles[0]),
                    angle2_rad: round(angles[1]),
                })
            })
        });
        self.write("fig05-angles", rows)
    }

    /// Figure 6: a body map of two or three dimensions with the true parts, and with the clusters and joints
    /// of a draw.
    pub fn map(&mut self, map: &BodyMap, parts: &[usize], draw: &Sample) -> Result<(), FileError> {
        let row = |kind, index, group, x: &[f64]| MapRow {
            kind,
            index,
            group,
            x1: x[0],
            x2: x[1],
            x3: x.get(2).copied(),
        };
        let sensors = |groups: &[usize]| -> Vec<MapRow> {
            let places = map.coordinates.chunks_exact(map.dims).enumerate();
            places.map(|(at, x)| row(MapPoint::Sensor, at, Some(groups[at]), x)).collect()
        };
        let joints = draw.joints.iter().enumerate().map(|(at, x)| row(MapPoint::Joint, at, None, x));
        let (first, second) = if map.dims == 2 { ("a", "c") } else { ("b", "d") };
        self.write(&format!("fig06{first}-map-{}d", map.dims), sensors(parts))?;
        self.write(
            &format!("fig06{second}-clusters-{}d", map.dims),
            sensors(&draw.labels).into_iter().chain(joints),
        )
    }

    /// Figure 8a: mean ARI of the clusterings that are told the number of clusters.
    pub fn baselines(&mut self, estimates: &[BaselineEstimate]) -> Result<(), FileError> {
        let rows =
            estimates.iter().map(|&BaselineEstimate { method, clusters, coordination, dimension, ari }| {
                CurveRow::new(
                    method.name(),
                    Some(clusters),
                    Counting::AllDraws,
                    (coordination, dimension),
                    ari,
                )
            });
        self.write("fig08a-ari-baselines", rows)
    }

    /// Figures 7, 8b, 9 and 10: number of parts, ARI and tree for each d.
    pub fn by_dimension(&mut self, conditions: &Conditions, best: &Conditions) -> Result<(), FileError> {
        let both = [(Counting::AllDraws, conditions), (Counting::BestDraw, best)];
        let of = |model| move |condition: &Condition| condition.model == model;

        let mut parts = Vec::new();
        for condition in conditions.all().into_iter().filter(of(Model::DpgmmLj)) {
            for (counting, conditions) in both {
                parts.extend(histogram(condition, counting, conditions));
            }
        }
        self.write("fig07-parts", parts)?;

        let ari = curves(&both, |_| true, |conditions, at| conditions.mean_ari(at));
        self.write("fig08b-ari", ari)?;
        let boxes = conditions.all().into_iter().filter(of(Model::DpgmmLj)).map(|at| ari_box(at, conditions));
        self.write("fig09-ari-box", boxes)?;
        for (name, model) in [("fig10a-tree-baseline", Model::Dpgmm), ("fig10b-tree", Model::DpgmmLj)] {
            self.write(name, curves(&both, of(model), |conditions, at| conditions.tree_rate(&[at])))?;
        }
        Ok(())
    }

    /// Figure 11: ARI and tree for each p.
    pub fn by_coordination(&mut self, conditions: &Conditions, best: &Conditions) -> Result<(), FileError> {
        let both = [(Counting::AllDraws, conditions), (Counting::BestDraw, best)];
        self.write("fig11a-ari", curves(&both, |_| true, |conditions, at| conditions.mean_ari(at)))?;
        self.write("fig11b-tree", curves(&both, |_| true, |conditions, at| conditions.tree_rate(&[at])))
    }
}

/// A millionth is far below what a picture or a reader of angles and times can see.
fn round(value: f64) -> f64 {
    // Adding 0 turns −0 into 0.
    (value * 1e6).round() / 1e6 + 0.0
}

fn histogram(condition: Condition, counting: Counting, conditions: &Conditions) -> Vec<PartsRow> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for record in conditions.records(condition) {
        *counts.entry(record.parts).or_default() += 1;
    }
    let Estimate { value, n, interval, .. } = conditions.mean_parts(condition);
    let (low, high) = interval.unzip();
    let mean = value.expect("a condition that was run has draws");
    let dimension = condition.dimension;
    counts
        .into_iter()
        .map(|(parts, count)| PartsRow { dimension, counting, parts, count, n, mean, low, high })
        .collect()
}

fn ari_box(condition: Condition, conditions: &Conditions) -> BoxRow {
    let mut aris = conditions.aris(condition);
    aris.sort_by(f64::total_cmp);
    let [lower_quartile, median, upper_quartile] = [0.25, 0.5, 0.75].map(|share| quantile(&aris, share));
    let reach = 1.5 * (upper_quartile - lower_quartile);
    let (first, last) = (aris[0], aris[aris.len() - 1]);
    let within = |ari: &&f64| (lower_quartile - reach..=upper_quartile + reach).contains(*ari);
    BoxRow {
        dimension: condition.dimension,
        n: aris.len(),
        lowest: first,
        whisker_low: *aris.iter().find(within).unwrap_or(&first),
        lower_quartile,
        median,
        upper_quartile,
        whisker_high: *aris.iter().rev().find(within).unwrap_or(&last),
        highest: last,
    }
}

fn curves(
    both: &[(Counting, &Conditions)],
    shown: impl Fn(&Condition) -> bool,
    estimate: impl Fn(&Conditions, Condition) -> Estimate,
) -> Vec<CurveRow> {
    let mut rows = Vec::new();
    for (counting, conditions) in both {
        for at in conditions.all().into_iter().filter(&shown) {
            let place = (at.coordination, at.dimension);
            rows.push(CurveRow::new(at.model.name(), None, *counting, place, estimate(conditions, at)));
        }
    }
    rows
}
