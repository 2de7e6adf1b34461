//! Stage 2, `sense`: compute the pressure on each sensor from the movement of its part (equation 27).
//!
//! In: a [`Trajectory`]. Out: [`Tactile`] pressures, M × T, in Pa. It is a pure function and needs no physics engine.
//!
//! The paper's fluid has no viscosity: a sensor feels ρ (ṗ · n)² where it moves outward, along its normal
//! n, and nothing otherwise. The velocity ṗ is the backward difference of its position over Δt, the
//! normal is that of the later sample. A movement that has [`Instants`] is felt at each sample instead:
//! the difference is over a moment.

use rayon::prelude::*;

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, gain, moderate, positive};
use crate::numerics::simd::vectorised;
use crate::stages::agent::{Agent, Site};
use crate::stages::simulate::{Instants, Pose, Trajectory};

/// The tactile sense (equation 27).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sense {
    /// Δt, s: time between two samples, and of the backward difference.
    pub interval: f64,
    /// ρ, kg/m³.
    pub fluid_density: f64,
    /// The weakest pressure that is felt, Pa; what is below is no pressure. With 0, as in the paper, any movement is felt,
    /// however slow: also rounding.
    pub threshold: f64,
}

impl Sense {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        positive("sense.interval", self.interval)?;
        moderate("sense.fluid_density", self.fluid_density)?;
        gain("sense.threshold", self.threshold)
    }
}

/// Tactile pressures of M sensors at T times, Pa. Those of [`sense`] are finite and not negative; a recording may have negative ones,
/// and NaN where a value is missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Tactile {
    /// T, at least 1.
    pub samples: usize,
    /// M × T: the whole series of one sensor after that of another.
    pub pressures: Vec<f32>,
}

impl Tactile {
    /// M.
    pub fn sensors(&self) -> usize {
        self.pressures.len() / self.samples
    }

    /// The series of each sensor.
    pub fn series(&self) -> std::slice::ChunksExact<'_, f32> {
        self.pressures.chunks_exact(self.samples)
    }
}

/// The pressure on each sensor of `agent` over a trajectory (equation 27).
///
/// In: T + 1 poses of each part, T ≥ 1. Out: M × T pressures in Pa, at least 0.
///
/// With R the rotation of the part now and R', p' its rotation and centre one sample before, the outward
/// speed of a sensor at l with normal n, both in the frame of the part, is linear in twelve numbers that all sensors of the
/// part share: ṗ · n = nᵀ [Rᵀ (p − p')] / Δt + nᵀ [Rᵀ (R − R')] l / Δt. These are computed once for each part and
/// sample; each sensor then takes twelve multiplications.
pub fn sense(agent: &Agent, trajectory: &Trajectory, settings: &Sense) -> Tactile {
    /// Sensors that read a block of motion while it is in the cache.
    const GROUP: usize = 8;
    let samples = trajectory.samples();
    let mut pressures = vec![0.0; agent.sites.len() * samples];
    let mut rest = pressures.as_mut_slice();
    for sites in agent.sites.chunk_by(|a, b| a.part == b.part) {
        let motion = motion(trajectory, sites[0].part, settings.interval);
        let own = rest.split_off_mut(..sites.len() * samples).expect("a series for each site");
        own.par_chunks_mut(GROUP * samples).zip(sites.par_chunks(GROUP)).for_each(|(group, sites)| {
            vectorised(
                #[inline(always)]
                || pressures_in_lanes(group, sites, &motion, samples, settings),
            );
        });
    }
    Tactile { samples, pressures }
}

/// Samples that are computed side by side.
const BLOCK: usize = 64;

/// The twelve numbers that all sensors of a part share, for a block of samples: Rᵀ (p − p') / Δt, then the rows of
/// Rᵀ (R − R') / Δt.
type Motion = [[f64; BLOCK]; 12];

fn motion<'a>(trajectory: &'a Trajectory, part: usize, interval: f64) -> Vec<Motion> {
    let (before, time) = match &trajectory.instants {
        Some(Instants { before, moment }) => (before, *moment),
        None => (&trajectory.poses, interval),
    };
    let own = |poses: &'a [Pose]| poses[part..].iter().step_by(trajectory.parts).collect::<Vec<_>>();
    let (before, now) = (own(before), own(&trajectory.poses));
    let mut blocks = vec![[[0.0; BLOCK]; 12]; trajectory.samples().div_ceil(BLOCK)];
    let pairs = before.par_chunks(BLOCK).zip(now[1..].par_chunks(BLOCK));
    blocks.par_iter_mut().zip(pairs).for_each(|(block, (before, now))| {
        for (lane, (before, now)) in before.iter().zip(now).enumerate() {
            for (numbers, number) in block.iter_mut().zip(shared(before, now, time)) {
                numbers[lane] = number;
            }
        }
    });
    blocks
}

/// The twelve numbers of a part between two samples.
fn shared(before: &Pose, now: &Pose, interval: f64) -> [f64; 12] {
    let moved = now.turned_back([0, 1, 2].map(|k| now.position[k] - before.position[k]));
    let columns =
        [0, 1, 2].map(|j| now.turned_back([0, 1, 2].map(|k| now.rotation[k][j] - before.rotation[k][j])));
    let mut numbers = [0.0; 12];
    for i in 0..3 {
        numbers[i] = moved[i] / interval;
        for j in 0..3 {
            numbers[3 + 3 * i + j] = columns[j][i] / interval;
        }
    }
    numbers
}

/// The factor of each of the twelve numbers for a sensor.
fn coefficients(site: &Site) -> [f64; 12] {
    let mut coefficients = [0.0; 12];
    for i in 0..3 {
        coefficients[i] = site.normal[i];
        for j in 0..3 {
            coefficients[3 + 3 * i + j] = site.normal[i] * site.position[j];
        }
    }
    coefficients
}

/// Equation 27 for some sensors of one part, one series after another, Pa.
#[inline(always)]
fn pressures_in_lanes(
    pressures: &mut [f32],
    sites: &[Site],
    motion: &[Motion],
    samples: usize,
    settings: &Sense,
) {
    for (at, block) in motion.iter().enumerate() {
        let first = at * BLOCK;
        let lanes = BLOCK.min(samples - first);
        for (site, series) in sites.iter().zip(pressures.chunks_exact_mut(samples)) {
            let mut outward = [0.0; BLOCK];
            for (coefficient, numbers) in coefficients(site).iter().zip(block) {
                for lane in 0..BLOCK {
                    outward[lane] = coefficient.mul_add(numbers[lane], outward[lane]);
                }
            }
            let mut felt = [0.0; BLOCK];
            for lane in 0..BLOCK {
                let outward = if outward[lane] > 0.0 { outward[lane] } else { 0.0 };
                let pressure = settings.fluid_density * outward * outward;
                felt[lane] = if pressure >= settings.threshold { pressure as f32 } else { 0.0 };
            }
            series[first..first + lanes].copy_from_slice(&felt[..lanes]);
        }
    }
}

#[cfg(test)]
mod tests;
