//! Study how much each open setting changes each result, by varying it around the default.
//!
//! One setting at a time, and pairs where one may depend on the other. All values of all settings run on the same
//! simulations (the same random numbers), so that differences from the default are paired.

mod design;
mod page;
mod study;
mod survival;
mod table;

pub use self::design::Design;
pub use self::study::{is_study, redraw, study};
