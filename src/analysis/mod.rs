//! Turn the posterior samples of an experiment into estimates with intervals, and these into verdicts on the paper's claims.

pub mod bootstrap;
pub mod cells;
pub mod claims;
pub mod conditions;
pub mod consensus;
pub mod diagnostics;
pub mod measure;
pub mod one_body;
pub mod paired;
pub mod posterior;
pub mod published;
pub mod shares;
pub mod single_bodies;
pub mod statistics;
pub mod variance;
