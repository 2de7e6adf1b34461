//! Smooth a series of pressures by local linear regression with adaptive windows, which keeps its steps.
//!
//! A movement is smooth for a while, and then another begins at once. So at each time a line is fitted in the widest window around
//! it, or before it, or after it, whose residuals are no larger than the noise (adaptive bandwidth: Lepski 1991), and its value
//! counts. A value within its remaining noise counts as no touch.

/// Half-widths of the windows in samples, the widest first.
pub(super) const HALF_WIDTHS: [usize; 3] = [10, 5, 2];
/// Largest residual variance of a fit, over the square of the median second difference, which is 1 to 2.7 times the variance of the
/// noise.
pub(super) const MAX_RESIDUAL: f64 = 1.5;
/// Median second differences below which a value is no touch: a constant, since noise that is cut at 0 has a mean, and a multiple of
/// the standard error of the value in units of the noise.
const TOUCH_LIMIT: [f64; 2] = [0.5, 3.5];

/// Replaces pressures by fitted values, and by 0 where these are within the noise. `size` is the median absolute second difference.
pub(super) fn smooth(series: &mut [f32], size: f32) {
    let size = f64::from(size);
    // Sums of squares of a large offset would lose the noise.
    let offset = series.first().map_or(0.0, |first| f64::from(*first));
    let sums = sums(series, offset);
    let windows = HALF_WIDTHS.map(Windows::new);
    for (t, pressure) in series.iter_mut().enumerate() {
        let line = windows.iter().find_map(|around| around.line(&sums, t, MAX_RESIDUAL * size * size));
        let line =
            line.unwrap_or(Line { value: f64::from(*pressure) - offset, residual: 0.0, deviation: 1.0 });
        *pressure = Line { value: offset + line.value, ..line }.touch(size);
    }
}

/// Up to each time, the sums of pressures, of pressures times their time, and of their squares. Pressures are beyond this offset.
fn sums(series: &[f32], offset: f64) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]];
    for (t, pressure) in series.iter().enumerate() {
        let (pressure, [a, b, c]) = (f64::from(*pressure) - offset, sums[t]);
        sums.push([a + pressure, b + pressure * t as f64, c + pressure * pressure]);
    }
    sums
}

/// A fitted line at one time.
pub(super) struct Line {
    pub value: f64,
    /// Residual variance: residual squares over degrees of freedom.
    pub residual: f64,
    /// Standard error of the value over the standard deviation of the noise.
    pub deviation: f64,
}

impl Line {
    /// Its value, 0 where it is within its remaining noise. `size` is the median absolute second difference.
    pub(super) fn touch(&self, size: f64) -> f32 {
        let limit = size * (TOUCH_LIMIT[0] + TOUCH_LIMIT[1] * self.deviation);
        if self.value.abs() < limit { 0.0 } else { self.value as f32 }
    }
}

/// The windows of one half-width: around a time, before it, and after it.
struct Windows {
    half_width: usize,
    around: Window,
    before: Window,
    after: Window,
}

impl Windows {
    fn new(half_width: usize) -> Self {
        let [around, before, after] =
            [(half_width, half_width), (half_width, 0), (0, half_width)].map(Window::new);
        Self { half_width, around, before, after }
    }

    /// The fit around a time if its residual variance is at most `most`; else the better one of those before and after it, if any is.
    fn line(&self, sums: &[[f64; 3]], t: usize, most: f64) -> Option<Line> {
        if t < self.half_width || t + self.half_width + 1 >= sums.len() {
            return None;
        }
        let around = self.around.line(sums, t);
        if around.residual <= most {
            return Some(around);
        }
        let (before, after) = (self.before.line(sums, t), self.after.line(sums, t));
        Some(if before.residual < after.residual { before } else { after })
            .filter(|line| line.residual <= most)
    }
}

/// A window with so many samples before and after the time of the fit, and the constants of its regression.
struct Window {
    /// Samples before and after.
    sides: (usize, usize),
    /// From the middle of the window to the time of the fit.
    offset: f64,
    /// 1 over the number of times.
    share: f64,
    /// The sum of squares of times about their middle, and 1 over it.
    spread: [f64; 2],
    /// 1 over the degrees of freedom that a line leaves.
    freedom: f64,
    /// As of a [`Line`].
    deviation: f64,
}

impl Window {
    fn new(sides: (usize, usize)) -> Self {
        let count = (sides.0 + sides.1 + 1) as f64;
        let spread = count * (count * count - 1.0) / 12.0;
        let offset = 0.5 * (sides.0 as f64 - sides.1 as f64);
        let deviation = (1.0 / count + offset * offset / spread).sqrt();
        let [share, freedom] = [1.0 / count, 1.0 / (count - 2.0)];
        Self { sides, offset, share, spread: [spread, 1.0 / spread], freedom, deviation }
    }

    /// The line of least squares, at the time that counts.
    fn line(&self, sums: &[[f64; 3]], t: usize) -> Line {
        let (from, to) = (sums[t - self.sides.0], sums[t + self.sides.1 + 1]);
        let [a, b, c] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        let mean = a * self.share;
        let slope = (b - a * (t as f64 - self.offset)) * self.spread[1];
        let squares = c - a * mean - slope * slope * self.spread[0];
        Line {
            value: mean + slope * self.offset,
            residual: squares.max(0.0) * self.freedom,
            deviation: self.deviation,
        }
    }
}

#[cfg(test)]
mod tests;
