//! Study how often parts and tree of any body are found from touch alone, beside other methods on the same pressures.

mod components;
mod design;
mod joining;
mod movement;
mod page;
mod peers;
mod run;

pub(crate) use self::design::Design;
pub(crate) use self::run::{is_study, redraw, study};
