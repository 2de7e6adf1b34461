//! A replication of Mimura, Hagiwara, Taniguchi & Inamura, "Bayesian Body Schema Estimation using Tactile
//! Information obtained through Coordinated Random Movements" (Advanced Robotics, 2017).
//!
//! An [`agent`] of five cylinders moves at random in Open Dynamics Engine ([`simulate`]). The pressure of
//! the fluid on its sensors ([`sense`]) is turned into symbols ([`quantise`]); how much the symbols of two
//! sensors tell of each other is their [`distance`], and the distances place all sensors on a [`body_map`], which
//! [`smacof`] may improve; an experiment has several [`body_maps`].
//! A mixture with latent joints finds parts and their tree on it, the body [`schema`]; [`baselines`] cluster it
//! in other ways, and the truth says how well ([`evaluate`]). [`pipeline`] composes these stages;
//! [`reproduce`] runs an experiment of them and sums it up for its [`conditions`], from which [`figures`] and
//! [`claims`] are made. [`plot`] draws the figures and [`report`] shows all of it. All [`settings`] stand in
//! `reproduce/paper.toml`, and a [`study`] says where they come from and what others would do; [`record`] reads and
//! writes every file, and [`verify`] compares finished results.

pub mod agent;
pub mod baselines;
pub mod body_map;
pub mod body_maps;
pub mod claims;
pub mod conditions;
pub mod distance;
mod eigen;
pub mod evaluate;
pub mod figures;
pub mod pipeline;
pub mod plot;
pub mod progress;
pub mod quantise;
pub mod record;
pub mod report;
pub mod reproduce;
pub mod schema;
pub mod sense;
pub mod settings;
pub mod simulate;
pub mod smacof;
pub mod statistics;
pub mod streams;
pub mod study;
mod vectorised;
pub mod verify;

#[cfg(test)]
mod testing;
