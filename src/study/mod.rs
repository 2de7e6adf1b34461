//! Run a study: many configurations on shared simulations, judged by the paper's claims.
//!
//! A [`Design`] says which configurations there are: a named list, one change at a time from a base, a grid, or evenly drawn
//! combinations. [`plan`](plan::plan()) lists them, [`run`] runs what is left of them, or one shard, and [`gather`] writes the
//! tables and the page.

mod choices;
mod design;
mod draw;
mod evaluation;
mod extends;
mod gather;
mod levels;
mod measures;
mod outcome;
mod page;
mod plan;
mod ranking;
mod results;
mod work;

pub(crate) use self::design::Design;
pub(crate) use self::extends::DesignText;
pub(crate) use self::gather::{gather, is_finished, is_study, join, redraw};
pub(crate) use self::plan::{Selection, plan};
pub(crate) use self::work::run;
