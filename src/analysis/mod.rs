//! Turn the posterior samples of an experiment into estimates with intervals, and these into verdicts on the paper's claims.

pub(crate) mod bootstrap;
pub(crate) mod cells;
pub(crate) mod claims;
pub(crate) mod conditions;
pub(crate) mod consensus;
pub(crate) mod diagnostics;
pub(crate) mod measure;
pub(crate) mod one_body;
pub(crate) mod paired;
pub(crate) mod posterior;
pub(crate) mod published;
pub(crate) mod shares;
pub(crate) mod single_bodies;
pub mod statistics;
pub(crate) mod variance;
