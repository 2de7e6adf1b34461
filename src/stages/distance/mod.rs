//! Stage 4, `distance`: the information metric between all pairs of sensors (equations 23 to 26).
//!
//! In: [`Symbols`](super::quantise::Symbols) of M sensors at T times. Out: [`Distances`], M × M, in bits.

mod bit_planes;
mod information_metric;
mod runs;
mod stretches;

pub use self::information_metric::{Distances, MAX_SENSORS, information_metric};
