//! Estimate the parts and the tree of any body from the pressures on its sensors: the stages for one's own robot, composed.
//!
//! Sensors are clustered into [rigid parts](crate::stages::rigid_parts), which are joined by the speeds of their
//! [joints](crate::stages::joints).
//!
//! ```
//! use bodyschema::estimate::estimate;
//! use bodyschema::numerics::rng::stream;
//! use bodyschema::recording::Recording;
//! use bodyschema::settings::{Base, Settings};
//! use bodyschema::stages::parameters::Parameters;
//! # use bodyschema::stages::{agent::Agent, sense::sense, simulate::simulate};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let mut settings = Settings::paper();
//! # (settings.physics.duration, settings.motion.coordination) = (1500.0, 0.5);
//! # (settings.skin.around, settings.skin.along) = (8, 3);
//! # let agent = Agent::new(&settings.agent, &settings.skin);
//! # let rng = &mut stream(11, 1, "motion", 0);
//! # let moved = simulate(&agent, &settings.motion, &settings.physics, settings.sense.interval, rng, &|| ())?;
//! # let tactile = sense(&agent, &moved, &settings.sense);
//! // `tactile` may come from a file: bodyschema::files::touch::read_touch("tactile.npy".as_ref())?
//! let recording = Recording::new(tactile);
//! let levels = Settings::load_over(Some(Base::ESTIMATE), None)?.quantise;
//! let found = estimate(&recording, &levels, &Parameters::default(), &mut stream(1, 1, "co-motion", 0), &|| ())?;
//! for edge in &found.joints.tree {
//!     let support = 100.0 * found.joints.support(edge);
//!     println!("part {} is joined to part {} (bootstrap support {support:.0} %)", edge.child, edge.parent);
//! }
//! println!("sensor {} is on part {}", recording.sensors[0], found.parts.labels[0]);
//! # assert_eq!(found.joints.ranks.len(), 5);
//! # Ok(())
//! # }
//! ```

mod doubts;
mod novelty;
mod offset;
mod repeats;
mod strokes;

use std::fmt;

use rand::Rng;

pub use self::doubts::Doubt;
pub(crate) use self::doubts::SURE;
use self::doubts::doubts;
use self::offset::has_offset;
pub use self::repeats::{Repeats, repeats};
use self::strokes::few_at_a_time;
use crate::recording::Recording;
use crate::stages::distance::{Distances, information_metric};
use crate::stages::joints::{Joints, refine};
use crate::stages::parameters::Parameters;
use crate::stages::quantise::{Quantise, quantise};
use crate::stages::rigid_parts::{MIN_SENSORS, RigidParts, rigid_parts, stratified};
use crate::stages::sense::Tactile;

/// Most sensors among which parts are searched for, and whose distances are computed, spread over all.
const MAX_SENSORS: usize = 800;
/// Samples that distances are computed from, spread over all.
const MAX_SAMPLES: usize = 20_000;

/// Largest residual at which the motion of its part explains a sensor, as a share of the mean square of the sensor's roots: where few
/// sensors are noisy, and where most are.
const MAX_RESIDUAL: [f64; 2] = [0.05, 0.2];
/// Share of explained sensors from which on the fit is good. On calibration data it was at least 0.90 where rigid parts fit
/// (docs/estimate.md).
const GOOD: f64 = 0.9;
/// Share of explained sensors from which on the fit is doubtful. On calibration data it was at most 0.71 where sensors were read at different
/// times (docs/estimate.md).
const DOUBTFUL: f64 = 0.8;
/// Different values up to which a sensor has levels, such as on and off.
const LEVELS: usize = 8;
/// Samples below which a recording is short. About a third of such recordings, of movements of people and animals, have a wrong tree
/// although rigid motions explain what is felt (docs/own-data.md).
const SHORT: usize = 1000;

/// Novelty below which a movement repeats itself. Movements in one rhythm had 0.0002 at most, and recorded ones that are no loop at
/// least 0.003 (docs/estimate.md).
const LOOP: f64 = 1e-3;
/// Novelty below which a movement of few motions comes back to similar states, so that a fit is doubtful at best: bodies that swim in
/// changing gaits, of which many trees are wrong (docs/estimate.md). A recorded walk may have less, but consists of more motions.
const SIMILAR: f64 = 0.1;

/// Whether rigid parts explain what sensors felt. The first of these that applies:
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Parts and tree mean nothing. Rigid parts explain fewer than 80 % of the sensors, sensors do not read 0 at rest, the movement repeats
    /// itself in one rhythm, or few sensors feel something at a time (not tested where most sensors are noisy).
    DoesNotFit,
    /// Rigid parts explain at least 90 % of the sensors, over 1,000 samples or more, and the movement neither repeats itself nor comes back
    /// to similar states. There are two parts or more, of 16 sensors or more each.
    Good,
    /// All else.
    Doubtful,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Good => "good",
            Self::Doubtful => "doubtful",
            Self::DoesNotFit => "does not fit",
        })
    }
}

/// How well rigid parts explain a recording: said before any tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Whether rigid parts explain it.
    pub verdict: Verdict,
    /// The share of sensors that the motion of a part explains, 0 to 1. The ends of thin parts, which only joints assign, do not
    /// count as explained.
    pub explained: f64,
    /// Share of what is felt at a sample that the most similar other state leaves, 0 to 1, the median over samples: near 0 if the movement
    /// repeats itself, so that parts cannot be told apart.
    pub novelty: f64,
    /// What is likely to be the matter, in words, unless the verdict is good.
    pub cause: Option<&'static str>,
}

impl Fit {
    /// `explained`: the share of sensors that parts explain before joints assign the others; `doubts`: what parts and joints leave open;
    /// `comes_back`: whether the movement consists of few motions, and comes back to similar states.
    fn new(explained: f64, doubts: &[Doubt], recording: &Recording, novelty: f64, comes_back: bool) -> Self {
        let is_noisy = has_noise(recording);
        let is_one_part = doubts.iter().any(|doubt| matches!(doubt, Doubt::OnePart(_)));
        let has_small_part = doubts.iter().any(|doubt| matches!(doubt, Doubt::SmallParts { .. }));
        let has_offset = has_offset(&recording.tactile, recording.signed);
        let is_stroked = !is_noisy && few_at_a_time(&recording.tactile);
        let is_loop = novelty < LOOP;
        let keeps_step = is_loop && comes_back;
        let verdict = match explained {
            _ if has_offset || is_stroked || keeps_step => Verdict::DoesNotFit,
            share if share < DOUBTFUL => Verdict::DoesNotFit,
            share if share < GOOD || recording.tactile.samples < SHORT => Verdict::Doubtful,
            _ if comes_back || is_loop || is_one_part || has_small_part => Verdict::Doubtful,
            _ => Verdict::Good,
        };
        let cause = match verdict {
            Verdict::Good => None,
            _ if has_offset => Some(OFFSET),
            _ if keeps_step => Some(REPETITION),
            _ if explained >= GOOD && is_loop && !is_stroked => Some(LOOPED),
            _ if explained >= GOOD && comes_back && !is_stroked => Some(SIMILARITY),
            Verdict::Doubtful if explained >= GOOD && is_one_part => Some(ONE_PART),
            Verdict::Doubtful
                if explained >= GOOD && recording.tactile.samples >= SHORT && has_small_part =>
            {
                Some(SMALL_PART)
            }
            _ => Some(cause(&recording.tactile, is_noisy, is_stroked)),
        };
        Self { verdict, explained, novelty, cause }
    }

    /// Whether parts and tree mean anything: the verdict is good or doubtful.
    pub fn fits(&self) -> bool {
        self.verdict != Verdict::DoesNotFit
    }
}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = 100.0 * self.explained;
        write!(f, "fit: {}: rigid motions explain {share:.0} % of the sensors", self.verdict)?;
        self.cause.map_or(Ok(()), |cause| write!(f, "; likely cause: {cause}"))
    }
}

/// The estimated parts and joints of a body.
#[derive(Debug)]
pub struct Estimate {
    /// How well rigid parts explain the recording.
    pub fit: Fit,
    /// The part of each sensor of the recording; none is unassigned.
    pub parts: RigidParts,
    /// How the parts are joined.
    pub joints: Joints,
    /// The sensors whose distances were computed: places among the sensors that the recording keeps, rising.
    pub mapped: Vec<usize>,
    /// Their distances, in bits.
    pub distances: Distances,
    /// What all this leaves open; nothing where it does not fit, since it then means nothing.
    pub doubts: Vec<Doubt>,
}

/// A recording of too few sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{usable} of {all} sensors feel anything usable, but estimating parts needs at least {MIN_SENSORS}")]
pub struct TooFewSensors {
    /// Sensors of the recording.
    pub usable: usize,
    /// All sensors, with those that were dropped.
    pub all: usize,
}

/// Estimates the parts and the tree.
///
/// In: a [`Recording`], how its pressures are quantised for distances (`levels`), and the parameters. Out: the part of each of its sensors,
/// and the tree over the parts with the bootstrap support of each edge, given the parts. Calls `tick` after each of the three steps: distances,
/// parts, joints. The same recording and state of `rng` give the same bytes on one kind of processor, whatever the number of threads.
///
/// # Errors
/// If the recording has fewer sensors than [`MIN_SENSORS`].
pub fn estimate(
    recording: &Recording,
    levels: &Quantise,
    parameters: &Parameters,
    rng: &mut impl Rng,
    tick: &dyn Fn(),
) -> Result<Estimate, TooFewSensors> {
    if recording.sensors.len() < MIN_SENSORS {
        return Err(TooFewSensors { usable: recording.sensors.len(), all: recording.all_sensors() });
    }
    let Recording { tactile, signed, .. } = recording;
    let (sensors, distances) = distances(tactile, *signed, levels);
    tick();
    let parts = rigid_parts(tactile, *signed, &sensors, parameters);
    let novelty = novelty::novelty(tactile, *signed, &sensors);
    let comes_back = novelty < SIMILAR && novelty::has_few_motions(tactile, *signed, &sensors);
    let explained = explained(&parts, recording);
    tick();
    let (parts, joints) = refine(tactile, *signed, parts, parameters, rng);
    let mut doubts = doubts(&parts, &joints, parameters);
    let fit = Fit::new(explained, &doubts, recording, novelty, comes_back);
    if !fit.fits() {
        doubts.clear();
    }
    tick();
    Ok(Estimate { fit, parts, joints, mapped: sensors, distances, doubts })
}

/// The share of sensors that the motion of a part explains, before joints assign the others.
fn explained(parts: &RigidParts, recording: &Recording) -> f64 {
    let most = MAX_RESIDUAL[usize::from(has_noise(recording))];
    let own = parts.labels.iter().zip(&parts.residuals);
    let count =
        own.filter(|(label, residual)| !parts.unassigned.contains(label) && **residual <= most).count();
    count as f64 / parts.labels.len() as f64
}

/// Whether most sensors are noisy.
fn has_noise(recording: &Recording) -> bool {
    2 * recording.noisy > recording.sensors.len()
}

/// What is the matter if sensors do not read 0 at rest.
const OFFSET: &str = "sensors do not read 0 at rest, so that their reading there must be subtracted, or a speed has lost its sign";

/// What is the matter if few sensors feel something at a time.
const STROKES: &str = "few sensors feel something at a time, as where something strokes the skin, or where parts move one after the other, not together";

/// What is the matter if all joints keep step in one rhythm.
const REPETITION: &str = "the movement repeats itself, so that parts that keep step cannot be told apart";

/// What is the matter if a movement of many motions repeats itself.
const LOOPED: &str = "the movement repeats itself, so that it tells no more than its first round";

/// What is likely to be the matter if rigid parts explain a movement that comes back to similar states.
const SIMILARITY: &str = "the movement comes back to similar states, as in a rhythm, and parts that keep step are hard to tell apart";

/// What is likely to be the matter if there is one part.
const ONE_PART: &str = "no two parts move against each other, so that no joint shows";

/// What is likely to be the matter if a part has few sensors.
const SMALL_PART: &str = "a part has fewer than 16 sensors, and may be a piece of another one";

/// What is likely to be the matter if rigid parts do not explain a recording.
fn cause(tactile: &Tactile, is_noisy: bool, is_stroked: bool) -> &'static str {
    let has_levels = |series: &[f32]| {
        let mut values: Vec<u32> = Vec::new();
        series.iter().filter(|pressure| !pressure.is_nan()).all(|pressure| {
            let bits = pressure.to_bits();
            values.contains(&bits) || {
                values.push(bits);
                values.len() <= LEVELS
            }
        })
    };
    let with_levels = tactile.series().filter(|series| has_levels(series)).count();
    if 2 * with_levels > tactile.sensors() {
        "most sensors have a few levels only, such as contact pads, which do not feel speeds"
    } else if is_stroked {
        STROKES
    } else if tactile.samples < SHORT {
        "the recording is short"
    } else if is_noisy {
        "most sensors are noisy"
    } else {
        "sensors that feel contact, soft parts, offsets, or sensors that are not read at the same time"
    }
}

/// The information metric, in bits, between at most 800 sensors over at most 20,000 samples. Out: these sensors, rising, and their m × m
/// distances. A missing value counts as the one before. `signed`: whether negative pressures are signal.
pub fn distances(tactile: &Tactile, signed: bool, levels: &Quantise) -> (Vec<usize>, Distances) {
    let sensors = searched(tactile);
    let distances = information_metric(&quantise(&excerpt(tactile, signed, &sensors), levels));
    (sensors, distances)
}

/// The sensors that parts are searched for among, rising and spread over all.
fn searched(tactile: &Tactile) -> Vec<usize> {
    stratified(tactile.sensors(), MAX_SENSORS).collect()
}

/// Pressures of some sensors at some samples, made positive in the same order: each sensor's minus its smallest negative one. Where
/// one is missing, the one before: the distances only make a picture.
fn excerpt(tactile: &Tactile, signed: bool, sensors: &[usize]) -> Tactile {
    let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
    let series: Vec<&[f32]> = tactile.series().collect();
    let own = |&sensor: &usize| {
        let mut last = 0.0;
        let held = |pressure: f32| {
            last = if pressure.is_nan() { last } else { pressure };
            last
        };
        let own: Vec<f32> = samples.iter().map(|&t| series[sensor][t]).map(held).collect();
        let least = if signed { own.iter().copied().fold(0.0, f32::min) } else { 0.0 };
        own.into_iter().map(move |pressure| pressure - least)
    };
    Tactile { samples: samples.len(), pressures: sensors.iter().flat_map(own).collect() }
}

#[cfg(test)]
mod tests;
