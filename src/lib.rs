//! A replication of Mimura, Hagiwara, Taniguchi and Inamura, "Bayesian Body Schema Estimation using Tactile
//! Information obtained through Coordinated Random Movements" (Advanced Robotics, 2017).
//!
//! A body of five cylinders moves at random in a fluid. From the pressure on its 840 sensors alone, the pipeline finds
//! out how many parts the body has, which sensor sits on which part, and how the parts are joined. [`stages`] lists
//! what happens, in order; [`pipeline`] composes it and is the file to read first. All [`settings`] have their
//! defaults in `reproduce/paper.toml`; [`files`] reads and writes what NumPy and a spreadsheet open.
//!
//! The program builds on that: `src/tasks` runs simulations and keeps what is finished, `src/experiments` reproduces the paper and
//! benchmarks `estimate`, `src/study` runs many configurations, `src/analysis` judges claims, `src/report` writes pages and pictures,
//! and `src/cli` has a file for each subcommand.
//!
//! A body also moves as a BVH file has recorded it ([`movement`]); `src/files/import` makes bodies of BVH, URDF and MJCF. For one's own
//! robot, a [`recording`] is cleaned, and [`estimate`](mod@estimate) finds its parts, its tree and the bootstrap support of each joint.
//!
//! From a movement to a tree:
//!
//! ```
//! use bodyschema::numerics::rng::stream;
//! use bodyschema::settings::Settings;
//! use bodyschema::stages::agent::Agent;
//! use bodyschema::stages::body_map::ClassicalScaling;
//! use bodyschema::stages::distance::information_metric;
//! use bodyschema::stages::evaluate::{parts, score};
//! use bodyschema::stages::quantise::quantise;
//! use bodyschema::stages::schema::{Model, best, infer};
//! use bodyschema::stages::sense::sense;
//! use bodyschema::stages::simulate::simulate;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut settings = Settings::paper();
//! settings.physics.duration = 2000.0; // s, instead of 10,000 s
//! settings.schema.chains = 8;
//! let Settings { motion, physics, schema, .. } = &settings;
//! let (seed, simulation) = (1, 1);
//!
//! let agent = Agent::new(&settings.agent, &settings.skin);
//! let mut rng = stream(seed, simulation, "motion", 0);
//! let trajectory = simulate(&agent, motion, physics, settings.sense.interval, &mut rng, &|| ())?;
//! let tactile = sense(&agent, &trajectory, &settings.sense); // pressures, Pa
//! let symbols = quantise(&tactile, &settings.quantise);
//! let distances = information_metric(&symbols); // bits
//! let map = ClassicalScaling::new(&distances, 9)?.coordinates(9)?; // 840 points in 9 dimensions
//! let samples = infer(&map, Model::DpgmmLj, schema, seed, simulation, &|| ())?;
//!
//! let best = best(&samples); // the posterior sample of highest log p(x, z)
//! for edge in &best.tree {
//!     println!("component {} is joined to component {}", edge.child, edge.parent);
//! }
//! println!("{} parts, {:?}", parts(&best.labels), score(&best.labels, &best.tree, &agent.truth(), 1.0));
//! # assert!((2..=10).contains(&parts(&best.labels)) && best.tree.len() + 1 == parts(&best.labels));
//! # Ok(())
//! # }
//! ```

mod analysis;
pub mod estimate;
mod experiments;
pub mod files;
pub mod movement;
pub mod numerics;
pub mod pipeline;
pub mod recording;
mod report;
pub mod settings;
pub mod stages;
mod study;
mod tasks;

#[doc(hidden)]
pub mod cli;

/// What the tests, the fuzz targets and the examples of this repository use beside the library's own surface.
#[doc(hidden)]
pub mod internals {
    pub use crate::analysis::consensus::consensus;
    pub use crate::analysis::posterior::Posterior;
    pub use crate::analysis::published::figures;
    pub use crate::analysis::statistics;
    pub use crate::files::verify;
    pub use crate::numerics::log_sum::log_sum;
    pub use crate::report::page::Page;
    pub use crate::report::{markdown, plot};

    /// The revision of the repository that the program was built from.
    pub const REVISION: &str = env!("BODYSCHEMA_REVISION");

    /// Steps of a sweep, each of which is compared with an independent implementation.
    pub mod sampler {
        pub use crate::stages::mixture::assignments::draw_labels;
        pub use crate::stages::schema::components::Components;
        pub use crate::stages::schema::joints::{cost, draw_between};
        pub use crate::stages::schema::latent_tree::{Joint, LatentTree, Update, tree};
        pub use crate::stages::schema::split_merge::graph;
        pub use crate::stages::schema::weighted_trees::WeightedGraph;
    }
}
