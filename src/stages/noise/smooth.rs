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
    let sums = sums(series);
    let stretches = REACHES.map(Stretches::new);
    let limit = |line: &Line| size * (LIMIT[0] + LIMIT[1] * line.deviation);
    for (t, pressure) in series.iter_mut().enumerate() {
        let line = stretches.iter().find_map(|around| around.line(&sums, t, FITS * size * size));
        let line = line.unwrap_or(Line { value: f64::from(*pressure), left: 0.0, deviation: 1.0 });
        *pressure = if line.value.abs() < limit(&line) { 0.0 } else { line.value as f32 };
    }
}

/// Up to each time, the sums of pressures, of pressures times their time, and of their squares.
fn sums(series: &[f32]) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]];
    for (t, pressure) in series.iter().enumerate() {
        let (pressure, [a, b, c]) = (f64::from(*pressure), sums[t]);
        sums.push([a + pressure, b + pressure * t as f64, c + pressure * pressure]);
    }
    sums
}

/// A line at a time.
struct Line {
    value: f64,
    /// Squares that it leaves, for each degree of freedom.
    left: f64,
    /// Standard deviation of the value over that of the noise.
    deviation: f64,
}

/// The stretches of one reach: around a time, before it, and after it.
struct Stretches {
    reach: usize,
    around: Stretch,
    before: Stretch,
    after: Stretch,
}

impl Stretches {
    fn new(reach: usize) -> Self {
        let [around, before, after] = [(reach, reach), (reach, 0), (0, reach)].map(Stretch::new);
        Self { reach, around, before, after }
    }

    /// The line around a time that leaves little enough; else, of the one before it and the one after it, the better one that does.
    fn line(&self, sums: &[[f64; 3]], t: usize, most: f64) -> Option<Line> {
        if t < self.reach || t + self.reach + 1 >= sums.len() {
            return None;
        }
        let around = self.around.line(sums, t);
        if around.left <= most {
            return Some(around);
        }
        let (before, after) = (self.before.line(sums, t), self.after.line(sums, t));
        Some(if before.left < after.left { before } else { after }).filter(|line| line.left <= most)
    }
}

/// What lines through as many times before and after the time that counts have in common: products are quicker than quotients.
struct Stretch {
    /// Times before and after.
    sides: (usize, usize),
    /// From the time in the middle to the one that counts.
    off: f64,
    /// 1 over the number of times.
    share: f64,
    /// The sum of squares of times about their middle, and 1 over it.
    spread: [f64; 2],
    /// 1 over the degrees of freedom that a line leaves.
    freedom: f64,
    /// As of a [`Line`].
    deviation: f64,
}

impl Stretch {
    fn new(sides: (usize, usize)) -> Self {
        let count = (sides.0 + sides.1 + 1) as f64;
        let spread = count * (count * count - 1.0) / 12.0;
        let off = 0.5 * (sides.0 as f64 - sides.1 as f64);
        let deviation = (1.0 / count + off * off / spread).sqrt();
        let [share, freedom] = [1.0 / count, 1.0 / (count - 2.0)];
        Self { sides, off, share, spread: [spread, 1.0 / spread], freedom, deviation }
    }

    /// The line of least squares, at the time that counts.
    fn line(&self, sums: &[[f64; 3]], t: usize) -> Line {
        let (from, to) = (sums[t - self.sides.0], sums[t + self.sides.1 + 1]);
        let [a, b, c] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let mean = a * self.share;
        let slope = (b - a * (t as f64 - self.off)) * self.spread[1];
        let left = c - a * mean - slope * slope * self.spread[0];
        Line { value: mean + slope * self.off, left: left.max(0.0) * self.freedom, deviation: self.deviation }
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
