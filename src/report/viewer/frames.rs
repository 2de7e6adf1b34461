//! Choose the times of a movement that a page shows: as many as it may hold, from where something is felt.

use std::ops::Range;

use crate::stages::sense::Tactile;

/// Times that are shown: `count` samples from `first` on, each `every` samples after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Frames {
    /// The first sample.
    pub first: usize,
    /// Samples from one to the next.
    pub every: usize,
    /// How many.
    pub count: usize,
}

impl Frames {
    /// Room for the frames of a page, bytes.
    pub(crate) const ROOM: usize = 1_000_000;

    /// Most frames of one movement.
    const MOST: usize = 600;

    /// Samples from one frame to the next, for about 0.2 s between them; 1 where the time between samples is not known.
    pub(crate) fn every(interval: Option<f64>) -> usize {
        interval.map_or(1, |interval| (0.2 / interval).round().clamp(1.0, 1e6) as usize)
    }

    /// Frames of some pressures and of so many solids, from the first sample at which a sensor feels anything else than at first. `bytes`
    /// is the room for them: a frame takes a byte for each sensor, and the place and turn of each solid.
    pub(crate) fn of(touch: &Tactile, solids: usize, every: usize, bytes: usize) -> Self {
        const SOLID: usize = 14;
        let changes = |series: &[f32]| {
            let known = || series.iter().enumerate().filter(|(_, pressure)| pressure.is_finite());
            let (_, first) = known().next()?;
            known().find(|(_, pressure)| *pressure != first).map(|(at, _)| at)
        };
        let first = touch.series().filter_map(changes).min().unwrap_or(0);
        let room = (bytes / (touch.sensors() + SOLID * solids)).clamp(2, Self::MOST);
        // A short recording is shown whole.
        let first = if touch.samples <= room * every { 0 } else { first };
        Self { first, every, count: room.min((touch.samples - first).div_ceil(every)) }
    }

    /// The pressures that are shown, of all sensors at one time after the other.
    pub(crate) fn of_touch(self, touch: &Tactile) -> Vec<f32> {
        self.samples().flat_map(|sample| touch.series().map(move |series| series[sample])).collect()
    }

    /// The samples that are shown.
    pub(crate) fn samples(self) -> impl Iterator<Item = usize> + Clone {
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
        assert_eq!(Frames::of(&touch, 0, 2, 100), Frames { first: 700, every: 2, count: 50 });
        assert_eq!(Frames::of(&touch, 0, 2, 900), Frames { first: 700, every: 2, count: 150 });
        assert_eq!(Frames::of(&touch, 0, 2, 1000), Frames { first: 0, every: 2, count: 500 });
        assert_eq!(Frames::of(&touch, 0, 2, 100).samples().last(), Some(798));
        // Solids take room, too, and a value that is no number is no touch.
        assert_eq!(Frames::of(&touch, 1, 2, 160).count, 10);
        let mut lost = touch.clone();
        (lost.pressures[0], lost.pressures[1001]) = (f32::NAN, f32::NAN);
        assert_eq!(Frames::of(&lost, 0, 2, 100).first, 700);
        // A body that feels nothing, and one of a single time.
        let still = Tactile { samples: 1, pressures: vec![0.0] };
        assert_eq!(Frames::of(&still, 0, 1, 1), Frames { first: 0, every: 1, count: 1 });
    }
}
