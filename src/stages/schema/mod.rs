//! Stage 6, `infer`: posterior samples of the body schema by the DPGMM-LJ or the DPGMM (section 3).
//!
//! In: a [`BodyMap`](super::body_map::BodyMap), M × d, and the settings [`Schema`]. Out: [`Sample`]s, each with the
//! component of every sensor and the tree over the components.

pub(crate) mod components;
mod departures;
mod error;
mod gibbs;
mod infer;
pub(crate) mod joints;
pub(crate) mod latent_tree;
mod prior;
mod sample;
mod settings;
pub(crate) mod split_merge;
pub(crate) mod weighted_trees;

pub use self::departures::{Densities, Departures, EmptyComponents, MeanCovariance, Root};
pub use self::error::{InferenceError, matrices_fit};
pub use self::gibbs::Chain;
pub use self::infer::{infer, tree_over};
pub use self::joints::collapsed_cost;
pub use self::prior::prior;
pub use self::sample::{Sample, best, one_part};
pub use self::settings::{EdgeWeight, Keep, Model, Prior, Sampler, Schema, Start};
pub use self::split_merge::TreePosterior;
