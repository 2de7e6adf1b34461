//! Rows of the tables of the paper's figures; `report/figures/README.md` explains their columns to users.

use serde::{Deserialize, Serialize};

use crate::analysis::cells::EstimateCells;
use crate::analysis::statistics::Estimate;

/// Which posterior samples of a condition an estimate is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Counting {
    /// As published: all samples; of trees, those with the right number of parts and ARI.
    AllDraws,
    /// An extension: of each simulation the sample of highest log posterior.
    BestDraw,
}

/// A point of figure 4: something of the agent, in its rest pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct AgentRow {
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
pub(crate) enum AgentPoint {
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
pub(crate) struct AngleRow {
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
pub(crate) struct MapRow {
    /// What it is.
    pub kind: MapPoint,
    /// Number of the sensor or joint, from 0.
    pub index: usize,
    /// The true part (a, b) or the cluster (c, d) of a sensor; empty for a joint.
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
pub(crate) enum MapPoint {
    /// A sensor.
    Sensor,
    /// An estimated joint q.
    Joint,
}

/// A bar of figure 7, with the mean of its histogram.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PartsRow {
    /// d.
    pub dimension: usize,
    /// Which posterior samples are counted.
    pub counting: Counting,
    /// Number of estimated parts.
    pub parts: usize,
    /// Posterior samples with that number.
    pub count: usize,
    /// Posterior samples in all.
    pub n: usize,
    /// Mean number of parts.
    pub mean: f64,
    /// Lower end of its 95 % interval.
    pub low: Option<f64>,
    /// Upper end of its 95 % interval.
    pub high: Option<f64>,
}

/// A box of figure 9, over the posterior samples of all simulations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct BoxRow {
    /// d.
    pub dimension: usize,
    /// Posterior samples.
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
pub(crate) struct CurveRow {
    /// The clustering or mixture.
    pub method: String,
    /// Number of clusters that it was told; empty if it found the number itself.
    pub clusters: Option<usize>,
    /// Which posterior samples are counted.
    pub counting: Counting,
    /// p.
    pub coordination: f64,
    /// d.
    pub dimension: usize,
    /// Mean ARI (8, 11a) or rate of right trees (10, 11b); empty without a sample.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
}

impl CurveRow {
    /// A point at (p, d).
    pub(crate) fn new(
        method: &str,
        clusters: Option<usize>,
        counting: Counting,
        (coordination, dimension): (f64, usize),
        estimate: Estimate,
    ) -> Self {
        let (method, value, cells) = (method.to_owned(), estimate.value, (&estimate).into());
        Self { method, clusters, counting, coordination, dimension, value, cells }
    }
}
