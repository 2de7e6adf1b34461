//! Write the data of the paper's figures as tidy tables, which [`plot`] draws.
//!
//! [`README`] documents every column, and is written beside the tables.

use std::collections::BTreeMap;

use serde::Serialize;

use super::figure_rows::{
    AgentPoint, AgentRow, AngleRow, BoxRow, Counting, CurveRow, MapPoint, MapRow, PartsRow,
};
use super::plot::{self, Picture};
use super::viewer::frames::Frames;
use crate::analysis::conditions::{BaselineEstimate, Conditions};
use crate::analysis::statistics::{Estimate, quantile};
use crate::files::FileError;
use crate::files::result_folder::ResultFolder;
use crate::pipeline::Condition;
use crate::stages::agent::Agent;
use crate::stages::body_map::BodyMap;
use crate::stages::schema::{Model, Sample};
use crate::stages::simulate::{Pose, Trajectory};

/// Explains the tables to whoever opens the folder.
pub(crate) const README: &str = include_str!("figures/README.md");

/// Writes the tables of figures into the folder of an experiment.
#[derive(Debug)]
pub(crate) struct Figures<'a> {
    folder: &'a mut ResultFolder,
}

impl<'a> Figures<'a> {
    /// Starts with the file that explains the others.
    ///
    /// # Errors
    /// If a file cannot be written; so for all that follow.
    pub(crate) fn new(folder: &'a mut ResultFolder) -> Result<Self, FileError> {
        folder.write_text("figures/README.md", README)?;
        Ok(Self { folder })
    }

    fn write<T: Serialize>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = T>,
    ) -> Result<(), FileError> {
        self.folder.write_rows(&format!("figures/{name}.csv"), rows)
    }

    /// Figure 4: the agent and its sensors in the poses of its parts.
    pub(crate) fn agent(&mut self, agent: &Agent, poses: &[Pose]) -> Result<(), FileError> {
        let row = |part, kind, [x_m, y_m, z_m]: [f64; 3]| {
            let [x_m, y_m, z_m] = [x_m, y_m, z_m].map(round);
            AgentRow { part, kind, x_m, y_m, z_m }
        };
        let ends = agent.parts.iter().zip(poses).enumerate().flat_map(|(at, (part, pose))| {
            let end = |side: f64| pose.place([0.0, 0.0, side * part.shape.half_length()]);
            [row(at, AgentPoint::ProximalEnd, end(-1.0)), row(at, AgentPoint::DistalEnd, end(1.0))]
        });
        let joints = agent.joints.iter().map(|joint| row(joint.child, AgentPoint::Joint, joint.anchor));
        let sensors = agent
            .sites
            .iter()
            .map(|site| row(site.part, AgentPoint::Sensor, poses[site.part].place(site.position)));
        self.write("fig04-agent", ends.chain(joints).chain(sensors))
    }

    /// Figure 5: joint angles about every 0.2 s, of a trajectory for each p with a sample every `interval` (s).
    pub(crate) fn angles(
        &mut self,
        trajectories: &[(f64, &Trajectory)],
        interval: f64,
    ) -> Result<(), FileError> {
        let every = Frames::every(Some(interval));
        let rows = trajectories.iter().flat_map(|&(coordination, trajectory)| {
            let states = trajectory.angles.chunks_exact(trajectory.joints).step_by(every);
            states.enumerate().flat_map(move |(sample, angles)| {
                angles.iter().enumerate().map(move |(joint, angles)| AngleRow {
                    coordination,
                    time_s: round(sample as f64 * (interval * every as f64)),
                    joint: joint + 1,
                    angle1_rad: round(angles[0]),
                    angle2_rad: round(angles[1]),
                })
            })
        });
        self.write("fig05-angles", rows)
    }

    /// Figure 6: a body map of two or three dimensions with the true parts, and with the clusters and joints
    /// of a posterior sample.
    pub(crate) fn map(&mut self, map: &BodyMap, parts: &[usize], sample: &Sample) -> Result<(), FileError> {
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
        let joints = sample.joints.iter().enumerate().map(|(at, x)| row(MapPoint::Joint, at, None, x));
        let (first, second) = if map.dims == 2 { ("a", "c") } else { ("b", "d") };
        self.write(&format!("fig06{first}-map-{}d", map.dims), sensors(parts))?;
        self.write(
            &format!("fig06{second}-clusters-{}d", map.dims),
            sensors(&sample.labels).into_iter().chain(joints),
        )
    }

    /// Figure 8a: mean ARI of the clusterings that are told the number of clusters.
    pub(crate) fn baselines(&mut self, estimates: &[BaselineEstimate]) -> Result<(), FileError> {
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
    pub(crate) fn by_dimension(
        &mut self,
        conditions: &Conditions,
        best: &Conditions,
    ) -> Result<(), FileError> {
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
    pub(crate) fn by_coordination(
        &mut self,
        conditions: &Conditions,
        best: &Conditions,
    ) -> Result<(), FileError> {
        let both = [(Counting::AllDraws, conditions), (Counting::BestDraw, best)];
        self.write("fig11a-ari", curves(&both, |_| true, |conditions, at| conditions.mean_ari(at)))?;
        self.write("fig11b-tree", curves(&both, |_| true, |conditions, at| conditions.tree_rate(&[at])))
    }

    /// The picture of every table in the folder, beside it.
    pub(crate) fn draw(self) -> Result<Vec<Picture>, FileError> {
        let pictures = plot::render(&self.folder.path().join("figures"))?;
        self.folder.remember(pictures.iter().map(|picture| format!("figures/{}.svg", picture.name)));
        Ok(pictures)
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
    let mean = value.expect("a condition that was run has samples");
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
