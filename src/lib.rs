//! A replication of Mimura et al. (2017): from a simulated body to its schema, stage by stage.

pub mod agent;
pub mod body_map;
pub mod claims;
pub mod distance;
pub mod evaluate;
pub mod figures;
pub mod pipeline;
pub mod quantise;
pub mod record;
pub mod reproduce;
pub mod schema;
pub mod sense;
pub mod settings;
pub mod simulate;
pub mod statistics;
pub mod streams;

#[cfg(test)]
mod testing;
