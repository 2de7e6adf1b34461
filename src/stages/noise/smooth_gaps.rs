//! Smooth a series that has gaps, as one without: by the widest local line that its noise allows, of the values that there are.
//!
//! What is missing stays missing.

use super::smooth::{HALF_WIDTHS, Line, MAX_RESIDUAL};

/// Fewest values of a line: one more than fit any line.
const MIN_VALUES: usize = 3;

/// As [`smooth`](super::smooth::smooth), where NaN is missing.
pub(super) fn smooth_gaps(series: &mut [f32], size: f32) {
    let size = f64::from(size);
    let most = MAX_RESIDUAL * size * size;
    let before = series.to_vec();
    for (t, pressure) in series.iter_mut().enumerate().filter(|(_, pressure)| !pressure.is_nan()) {
        let line = HALF_WIDTHS.iter().find_map(|half| best(&before, t, *half, most));
        let line = line.unwrap_or(Line { value: f64::from(*pressure), residual: 0.0, deviation: 1.0 });
        *pressure = line.touch(size);
    }
}

/// The fit around a time if its residual variance is at most `most`; else the better one of those before and after it, if any is.
fn best(series: &[f32], t: usize, half: usize, most: f64) -> Option<Line> {
    if t < half || t + half >= series.len() {
        return None;
    }
    let fit = |before: usize, after: usize| line(&series[t - before..=t + after], before);
    let fits = |line: &Line| line.residual <= most;
    let one_sided = || {
        let both = [fit(half, 0), fit(0, half)].into_iter().flatten();
        both.reduce(|best, other| if other.residual <= best.residual { other } else { best })
    };
    fit(half, half).filter(fits).or_else(|| one_sided().filter(fits))
}

/// The line of least squares through the values of a window, at one of its places. At least half of the values must be there.
fn line(window: &[f32], at: usize) -> Option<Line> {
    let known = || window.iter().enumerate().filter(|(_, value)| !value.is_nan());
    let place = |t: usize| t as f64 - at as f64;
    let count = known().count();
    if count < MIN_VALUES || 2 * count < window.len() {
        return None;
    }
    let share = 1.0 / count as f64;
    let middle = share * known().map(|(t, _)| place(t)).sum::<f64>();
    let mean = share * known().map(|(_, value)| f64::from(*value)).sum::<f64>();
    let [mut spread, mut product, mut squares] = [0.0; 3];
    for (t, value) in known() {
        let (own, error) = (place(t) - middle, f64::from(*value) - mean);
        spread += own * own;
        product += own * error;
        squares += error * error;
    }
    let slope = product / spread;
    Some(Line {
        value: mean - slope * middle,
        residual: (squares - slope * product).max(0.0) / (count as f64 - 2.0),
        deviation: (share + middle * middle / spread).sqrt(),
    })
}

#[cfg(test)]
mod tests;
