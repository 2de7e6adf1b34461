//! Render a picture of each figure, from its table alone.

mod agent;
mod angles;
mod axes;
mod bars;
mod canvas;
mod curves;
pub mod effects;
mod legend;
mod map;
mod pictures;
mod space;
pub mod specifications;
mod values;

pub use self::canvas::PlotError;
pub use self::pictures::{Picture, render};
