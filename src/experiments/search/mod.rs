//! Search for settings under which most of the paper's claims hold together.
//!
//! Candidates are named starting points and random draws from a space of options (Bergstra & Bengio, "Random
//! search for hyper-parameter optimization", 2012). They are tried in rounds, of which each keeps the best and
//! tries them harder (successive halving: Jamieson & Talwalkar, 2016). The score was written down, in
//! `reproduce/search.toml`, before the first run.

mod design;
mod page;
mod run;
mod score;

pub use self::design::{Continuation, Design};
pub use self::run::search;
