//! Turn the table of each figure into a picture beside it, from that table alone.

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
mod values;

pub use self::pictures::render;
