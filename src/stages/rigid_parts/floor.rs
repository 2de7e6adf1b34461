//! Find the floor below which sensors feel nothing, and the samples at which most is felt above it.
//!
//! Where noise was taken off, or a sensor has a dead band, a pressure of 0 says only that the root is below a floor. The least
//! pressure that a sensor ever has tells its floor. Of sensors without one, it is next to nothing.

use rayon::prelude::*;

use super::medians::median;
use super::roots::size;
use super::stratified::stratified;
use super::subspace::felt_samples;

/// Samples that are looked at at once. It changes no result.
const BLOCK: usize = 1024;

/// The root of the least size of each sensor that is other than 0; 0 if all are 0. `signed`: whether negative pressures are signal.
pub(super) fn floors(series: &[&[f32]], signed: bool) -> Vec<f64> {
    let least = |series: &&[f32]| {
        let sizes = series.iter().map(|pressure| size(*pressure, signed)).filter(|size| *size > 0.0);
        f64::from(sizes.reduce(f32::min).unwrap_or(0.0)).sqrt()
    };
    series.par_iter().map(least).collect()
}

/// The median floor of the sensors that feel anything, in units of these scales; 0 of none.
pub(super) fn typical_floor(floors: &[f64], scales: &[f64]) -> f64 {
    let both = floors.iter().zip(scales).filter(|(_, scale)| **scale > 0.0);
    median(both.map(|(floor, scale)| floor / scale).collect())
}

/// At most so many samples, spread over those at which the root mean square of all roots is above the floor. In: pressures, whether
/// negative ones are signal, and the floor of each sensor.
pub(super) fn telling_samples(series: &[&[f32]], signed: bool, floors: &[f64], most: usize) -> Vec<usize> {
    let samples = series.first().map_or(0, |series| series.len());
    let mean = |series: &&[f32]| {
        let known = series.iter().filter(|pressure| !pressure.is_nan());
        let (sum, count) = known
            .fold((0.0, 0), |(sum, count), pressure| (sum + f64::from(size(*pressure, signed)), count + 1));
        sum / f64::from(count.max(1))
    };
    let means: Vec<f64> = series.par_iter().map(mean).collect();
    let scales: Vec<f64> = means.iter().map(|mean| mean.sqrt()).collect();
    let least = typical_floor(floors, &scales).powi(2);
    let telling_from = |first: usize| {
        let count = BLOCK.min(samples - first);
        let (mut known, mut totals) = (vec![0u32; count], vec![0.0; count]);
        for (series, mean) in series.iter().zip(&means) {
            for ((pressure, known), total) in series[first..].iter().zip(&mut known).zip(&mut totals) {
                *known += u32::from(!pressure.is_nan());
                if *mean > 0.0 && !pressure.is_nan() {
                    *total += f64::from(size(*pressure, signed)) / mean;
                }
            }
        }
        let both = totals.into_iter().zip(known).enumerate();
        both.filter(|(_, (total, known))| *total > least * f64::from(*known)).map(move |(t, _)| first + t)
    };
    let firsts: Vec<usize> = (0..samples).step_by(BLOCK).collect();
    let telling: Vec<usize> = firsts.into_par_iter().flat_map_iter(telling_from).collect();
    // Sensors with few levels may feel nothing above their least.
    if telling.is_empty() {
        return felt_samples(series, signed, most);
    }
    stratified(telling.len(), most).map(|at| telling[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quiet_samples_are_left_out_only_where_there_is_a_floor() {
        let touch =
            |t: u16, least: f32| Some((f32::from(t) / 50.0).powi(2)).filter(|p| *p >= least).unwrap_or(0.0);
        let series = |least: f32| (1..=100).map(|t| touch(t, least)).collect::<Vec<f32>>();
        let found = |one: &[f32], other: &[f32]| {
            let own = floors(&[one, other], false);
            let count = telling_samples(&[one, other], false, &own, 1000).len();
            (own, count)
        };
        let smooth = series(0.0);
        assert!(found(&smooth, &smooth).0[0] < 0.021 && found(&smooth, &smooth).1 >= 99);
        // Sensors that feel from samples 50 and 75 on. Both roots are above the floors, in units of each, from sample 83 on.
        assert_eq!(found(&series(1.0), &series(2.25)), (vec![1.0, 1.5], 18));
        assert_eq!((typical_floor(&[], &[]), typical_floor(&[1.0], &[0.0])), (0.0, 0.0));
        assert_eq!(floors(&[&[0.0, 0.0], &[-4.0, 0.0]], true), [0.0, 2.0]);
        assert_eq!(floors(&[&[9.0, 0.0], &[-4.0, 0.0]], false), [3.0, 0.0]);
    }
}
