//! Stage 5, `map`: place the sensors in d dimensions by multidimensional scaling (section 4.1).
//!
//! In: [`Distances`](super::distance::Distances), M × M. Out: a [`BodyMap`], M × d, in the unit of the distances.
//! The paper says "MDS" and cites Kruskal; which variant it ran is open. [Classical](ClassicalScaling) scaling is the
//! default; metric and nonmetric scaling by [majorisation](smacof()) start from its map, or from
//! [random](descend) maps. Scaled are the distances themselves, or those [between their rows](scaled).

mod classical;
mod coordinates;
mod guttman;
mod maps;
mod monotone;
mod random_starts;
mod rows;
mod settings;
mod smacof;

pub use self::classical::{ClassicalScaling, MapError};
pub use self::coordinates::BodyMap;
pub use self::maps::BodyMaps;
pub use self::random_starts::{Descended, descend, random_map};
pub use self::rows::scaled;
pub use self::settings::{Map, MapMethod, MapOf};
pub use self::smacof::{Fit, Improvement, Majorisation, smacof};
