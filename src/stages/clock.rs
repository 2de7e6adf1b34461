//! Tell a column of times or of row numbers from one of pressures: by its name, or because it rises by even steps.
//!
//! A column of times is no sensor, but would count as one. What moves does not rise by the same step throughout.

use std::fmt::{self, Display, Formatter};

/// Fewest values that tell an even rise.
pub const MIN_VALUES: usize = 16;
/// Share of steps that are even at least: frames may be lost, and a counter may begin again.
const EVEN: f64 = 0.95;
/// How far an even step may be from the median one, as a share of it: clocks jitter.
const JITTER: f64 = 0.1;

/// A column of times, or of row numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// What tells it.
    pub mark: Mark,
    /// Time from one sample to the next, s, where it is known: the median step, as exactly as the times say it.
    pub interval: Option<f64>,
}

/// What tells that a column is no sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Its name.
    Name,
    /// It rises by even steps.
    EvenSteps,
    /// It rises by one from sample to sample.
    Counts,
}

impl Display for Mark {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Name => "is taken for the time by its name",
            Self::EvenSteps => "rises by even steps and is taken for the time",
            Self::Counts => "counts the rows",
        })
    }
}

impl Clock {
    /// Of a column with this name, if it has one; `None` if it may be a sensor.
    ///
    /// In: all values, NaN where there is none, and whether they were float32.
    pub fn of(name: Option<&str>, values: &[f64], is_single: bool) -> Option<Self> {
        let unit = name.and_then(unit_of);
        let step = median_step(values);
        if let Some(unit) = unit {
            let interval = step.map(|step| in_seconds(step, unit, values, is_single));
            return Some(Self { mark: Mark::Name, interval });
        }
        let step = step.filter(|step| values.len() >= MIN_VALUES && is_even(values, *step))?;
        let counts = step == 1.0 && values.iter().all(|value| value.is_nan() || value.fract() == 0.0);
        let interval = (!counts).then(|| in_seconds(step, Unit::Unknown, values, is_single));
        Some(Self { mark: if counts { Mark::Counts } else { Mark::EvenSteps }, interval })
    }
}

/// Whether a column of this name holds times, whatever its values.
pub fn is_time(name: &str) -> bool {
    unit_of(name).is_some()
}

/// Whether a column may rise by even steps, given its first values, so that [`Clock::of`] should see all.
pub fn may_rise(first: &[f64]) -> bool {
    let rising = first.windows(2).filter(|pair| pair[1] > pair[0]).count();
    first.len() < 2 || 2 * rising > first.len() - 1
}

/// The unit that a name of a column of times says.
#[derive(Clone, Copy)]
enum Unit {
    Seconds(f64),
    /// Seconds, or what a time since 1970 is in.
    Unknown,
}

impl Unit {
    /// Seconds of one unit.
    fn seconds(self, values: &[f64]) -> f64 {
        let size = values.iter().find(|value| value.is_finite()).map_or(0.0, |value| value.abs());
        match self {
            Self::Seconds(seconds) => seconds,
            // Today is 1.7e9 s after 1970.
            Self::Unknown if size > 1e17 => 1e-9,
            Self::Unknown if size > 1e14 => 1e-6,
            Self::Unknown if size > 1e11 => 1e-3,
            Self::Unknown => 1.0,
        }
    }
}

/// The unit of a column whose name is one of a time, such as `time`, `%time`, `Time [ms]` or `field.header.stamp`.
fn unit_of(name: &str) -> Option<Unit> {
    const TIMES: [&str; 12] = [
        "time",
        "times",
        "timestamp",
        "timestamps",
        "stamp",
        "stamps",
        "date",
        "datetime",
        "zeit",
        "uhrzeit",
        "elapsed",
        "clock",
    ];
    const UNITS: [(&str, f64); 14] = [
        ("s", 1.0),
        ("sec", 1.0),
        ("secs", 1.0),
        ("second", 1.0),
        ("seconds", 1.0),
        ("ms", 1e-3),
        ("msec", 1e-3),
        ("us", 1e-6),
        ("µs", 1e-6),
        ("μs", 1e-6),
        ("usec", 1e-6),
        ("ns", 1e-9),
        ("nsec", 1e-9),
        ("nanosec", 1e-9),
    ];
    let lower = name.to_lowercase();
    let words: Vec<&str> =
        lower.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let unit = |word: &str| UNITS.iter().find(|(known, _)| *known == word).map(|(_, seconds)| *seconds);
    let is_time = |word: &str| TIMES.contains(&word);
    match words[..] {
        // `sec` and `nanosec` of a ROS stamp, but no `s`, which may be a sensor.
        [.., last] if last.len() > 2 && unit(last).is_some() => unit(last).map(Unit::Seconds),
        [.., time, last] if is_time(time) || time == "t" => unit(last).map(Unit::Seconds),
        [.., last] if is_time(last) => Some(Unit::Unknown),
        _ => None,
    }
}

/// The median of the steps that rise.
fn median_step(values: &[f64]) -> Option<f64> {
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let mut rising: Vec<f64> = steps.filter(|step| *step > 0.0 && step.is_finite()).collect();
    let middle = rising.len() / 2;
    (!rising.is_empty()).then(|| *rising.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// A step in seconds: the number of fewest digits that differs from it by no more than the rounding errors of two times. Of times
/// 0.1 s apart, differences are 0.09999999999999432 and the like.
fn in_seconds(step: f64, unit: Unit, values: &[f64], is_single: bool) -> f64 {
    let (seconds, step) = (unit.seconds(values), step * unit.seconds(values));
    let largest =
        values.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, own| most.max(own.abs()));
    let error = seconds * largest * if is_single { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let mut shorter = (0..17).filter_map(|digits| format!("{step:.digits$e}").parse::<f64>().ok());
    shorter.find(|shorter| (shorter - step).abs() <= error).unwrap_or(step)
}

/// Whether nearly all steps are this one.
fn is_even(values: &[f64], step: f64) -> bool {
    let even = values.windows(2).filter(|pair| (pair[1] - pair[0] - step).abs() <= JITTER * step).count();
    even as f64 >= EVEN * (values.len() - 1) as f64
}

#[cfg(test)]
mod tests;
