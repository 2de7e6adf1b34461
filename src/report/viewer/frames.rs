//! Choose the times of a movement that a page shows: as many as it may hold, from where something is felt.

use std::ops::Range;

use crate::stages::sense::Tactile;

/// Times that are shown: `count` samples from `first` on, each `every` samples after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frames {
    /// The first sample.
    pub first: usize,
    /// Samples from one to the next.
    pub every: usize,
    /// How many.
    pub count: usize,
}

impl Frames {
    /// Most frames of one movement.
    const MOST: usize = 600;

    /// Samples from one frame to the next, for about 0.2 s between them; 1 where the time between samples is not known.
    pub fn every(interval: Option<f64>) -> usize {
        interval.map_or(1, |interval| (0.2 / interval).round().clamp(1.0, 1e6) as usize)
    }

    /// Frames of some pressures, from the first sample at which a sensor feels anything else than at first. `bytes` is the room for them, a
    /// byte for each sensor and frame.
    pub fn of(touch: &Tactile, every: usize, bytes: usize) -> Self {
        let changes = |series: &[f32]| series.iter().position(|pressure| *pressure != series[0]);
        let first = touch.series().filter_map(changes).min().unwrap_or(0);
        let room = (bytes / touch.sensors()).clamp(2, Self::MOST);
        // A short recording is shown whole.
        let first = if touch.samples <= room * every { 0 } else { first };
        Self { first, every, count: room.min((touch.samples - first).div_ceil(every)) }
    }

    /// The pressures that are shown, of all sensors at one time after the other.
    pub fn of_touch(self, touch: &Tactile) -> Vec<f32> {
        self.samples().flat_map(|sample| touch.series().map(move |series| series[sample])).collect()
    }

    /// The samples that are shown.
    pub fn samples(self) -> impl Iterator<Item = usize> + Clone {
        let all: Range<usize> = 0..self.count;
        all.map(move |at| self.first + at * self.every)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_begin_where_something_is_felt_and_fit_their_room() {
        let mut series = vec![0.0; 1000];
        series[700] = 1.0;
        let touch = Tactile { samples: 1000, pressures: [vec![0.0; 1000], series].concat() };
        assert_eq!(Frames::of(&touch, 2, 100), Frames { first: 700, every: 2, count: 50 });
        assert_eq!(Frames::of(&touch, 2, 900), Frames { first: 700, every: 2, count: 150 });
        assert_eq!(Frames::of(&touch, 2, 1000), Frames { first: 0, every: 2, count: 500 });
        assert_eq!(Frames::of(&touch, 2, 100).samples().last(), Some(798));
        // A body that feels nothing, and one of a single time.
        let still = Tactile { samples: 1, pressures: vec![0.0] };
        assert_eq!(Frames::of(&still, 1, 1), Frames { first: 0, every: 1, count: 1 });
    }
}
