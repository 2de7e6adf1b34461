//! Take noise off a series of pressures, and keep its steps.
//!
//! A movement is smooth for a while, and then another begins at once. So at each time a line goes through the longest stretch around
//! it, or before it, or after it, that a line explains up to the noise (as Lepski 1991 chooses the width of a window), and its value
//! counts. What is within the noise that such a value still has counts as no touch.

/// Times on each side of a stretch, the longest first.
const REACHES: [usize; 3] = [10, 5, 2];
/// Of the square of the middle second difference, what a line may leave for each degree of freedom: its square is 1 to 2.7 times the
/// variance of the noise.
const FITS: f64 = 1.5;
/// Middle second differences below which a value is no touch: without a share of the noise, for what is cut at 0 has a mean, and for
/// each standard deviation that is left of 1.
const LIMIT: [f64; 2] = [0.5, 3.5];

/// Puts lines in the place of pressures, and 0 where they are within the noise. `size` is the middle of the sizes of second differences.
pub fn smooth(series: &mut [f32], size: f32) {
    let size = f64::from(size);
    let lines = Lines::new(series);
    let reaches = REACHES.into_iter().filter(|reach| 2 * reach < series.len());
    let found = |t: usize| {
        let line = reaches.clone().find_map(|reach| lines.through(t, reach, FITS * size * size));
        let line = line.unwrap_or(Line { value: f64::from(series[t]), left: 0.0, gain: 1.0 });
        let limit = size * (LIMIT[0] + LIMIT[1] * line.gain.sqrt());
        if line.value.abs() < limit { 0.0 } else { line.value as f32 }
    };
    let found: Vec<f32> = (0..series.len()).map(found).collect();
    series.copy_from_slice(&found);
}

/// A line at a time.
struct Line {
    value: f64,
    /// Squares that it leaves, for each degree of freedom.
    left: f64,
    /// Variance of the value over that of the noise.
    gain: f64,
}

/// Lines through stretches of a series.
struct Lines {
    /// Up to each time, the sums of pressures, of pressures times their time, and of their squares.
    sums: Vec<[f64; 3]>,
}

impl Lines {
    fn new(series: &[f32]) -> Self {
        let mut sums = vec![[0.0; 3]];
        for (t, pressure) in series.iter().enumerate() {
            let (pressure, [a, b, c]) = (f64::from(*pressure), sums[t]);
            sums.push([a + pressure, b + pressure * t as f64, c + pressure * pressure]);
        }
        Self { sums }
    }

    /// The line around a time that leaves little enough; else, of the one before it and the one after it, the better one that does.
    fn through(&self, t: usize, reach: usize, most: f64) -> Option<Line> {
        let end = t + reach + 1;
        if t < reach || end >= self.sums.len() {
            return None;
        }
        let around = self.line(t - reach, end, t);
        if around.left <= most {
            return Some(around);
        }
        let (before, after) = (self.line(t - reach, t + 1, t), self.line(t, end, t));
        Some(if before.left < after.left { before } else { after }).filter(|line| line.left <= most)
    }

    /// The line of least squares through the times of a stretch, at one of them.
    fn line(&self, from: usize, to: usize, t: usize) -> Line {
        let count = (to - from) as f64;
        let [a, b, c] = [0, 1, 2].map(|at| self.sums[to][at] - self.sums[from][at]);
        let centre = 0.5 * (from + to - 1) as f64;
        let spread = count * (count * count - 1.0) / 12.0;
        let slope = (b - a * centre) / spread;
        let off = t as f64 - centre;
        Line {
            value: a / count + slope * off,
            left: (c - a * a / count - slope * slope * spread).max(0.0) / (count - 2.0),
            gain: 1.0 / count + off * off / spread,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn noise_goes_and_steps_stay() {
        let rng = &mut stream(1, 1, "noise", 0);
        // Begins at once each 50 samples, and fades; every second time nothing is felt.
        let moves = |t: usize| (t / 50).is_multiple_of(2);
        let touch = |t: usize| if moves(t) { 20.0 * (-((t % 50) as f64) / 17.0).exp() } else { 0.0 };
        let truth: Vec<f64> = (0..5000).map(touch).collect();
        let mut error = || -> f64 { StandardNormal.sample(rng) };
        let noisy: Vec<f32> = truth.iter().map(|pressure| (pressure + error()).max(0.0) as f32).collect();
        let mut found = noisy.clone();
        smooth(&mut found, 1.1);
        let off = |found: &[f32], some: &dyn Fn(usize) -> bool| {
            let squares =
                (0..truth.len()).filter(|t| some(*t)).map(|t| (f64::from(found[t]) - truth[t]).powi(2));
            (squares.sum::<f64>() / (0..truth.len()).filter(|t| some(*t)).count() as f64).sqrt()
        };
        let early = |t: usize| moves(t) && t % 50 < 30;
        assert!(off(&found, &early) < 0.6 * off(&noisy, &early), "{}", off(&found, &early));
        assert!(off(&found, &|t| t % 100 == 0) < 1.5, "a step is not blurred");
        let rests = (0..truth.len()).filter(|t| !moves(*t));
        let felt = rests.clone().filter(|t| found[*t] > 0.0).count();
        assert!(felt * 100 < rests.count(), "{felt}");
    }

    #[test]
    fn a_series_too_short_for_a_line_keeps_what_is_above_the_noise() {
        let mut few = [10.0, 1.0, 0.0, 9.0];
        smooth(&mut few, 1.0);
        assert_eq!(few, [10.0, 0.0, 0.0, 9.0]);
    }
}
