//! Cluster a body map by the three methods that the paper compares its mixtures with (figure 8a).
//!
//! In: a [`BodyMap`](super::body_map::BodyMap), M × d, and the number of clusters. Out: a label for each sensor.

mod cluster;
mod gmm;
mod ward;

pub use self::cluster::{Baselines, ClusteringMethod, cluster};
pub use self::gmm::{MixtureFit, gmm, ridge};
pub use self::ward::ward;
