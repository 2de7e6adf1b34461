//! Gaussian mixtures on a body map: points, components, their prior, and the assignment of points to components.
//!
//! Both the [baselines](super::baselines) and the [body schema](super::schema) build on it.

pub(crate) mod assignments;
mod augmented;
mod gaussian;
mod k_means;
mod normal_inverse_wishart;
mod points;

pub(crate) use self::augmented::Augmented;
pub use self::gaussian::{Gaussian, Rounding, standard_normal};
pub(crate) use self::k_means::lloyd;
pub use self::k_means::{Partition, k_means};
pub use self::normal_inverse_wishart::{MeanCovariance, NormalInverseWishart, Predictive};
pub use self::points::{Points, SufficientStatistics};
