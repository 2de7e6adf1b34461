//! The stages of the pipeline, in order. Each takes what the one before gives.
//!
//! | stage | module | in → out | paper |
//! |---|---|---|---|
//! | – | [`agent`] | geometry, skin → [`Agent`](agent::Agent): parts, joints, sensors, and their true tree | section 5.1, figure 4 |
//! | 1 | [`simulate`] | agent, motion → [`Trajectory`](simulate::Trajectory): T + 1 poses of each part (m), angles of each joint (rad) | section 5.1 |
//! | 2 | [`sense`] | trajectory → [`Tactile`](sense::Tactile): pressures, M × T, Pa | equation 27 |
//! | 3 | [`quantise`] | pressures → [`Symbols`](quantise::Symbols): M × T, 0 to N − 1 | section 4.1 |
//! | 4 | [`distance`] | symbols → [`Distances`](distance::Distances): M × M, bits | equations 23 to 26 |
//! | 5 | [`body_map`] | distances → [`BodyMap`](body_map::BodyMap): M × d, bits | section 4.1 |
//! | 6 | [`schema`] | body map → [`Sample`](schema::Sample)s: component of each sensor, tree | equations 1 to 22 |
//! | 7 | [`evaluate`] | posterior sample, truth → [`Score`](evaluate::Score): adjusted Rand index, whether the true tree is recovered | section 5.2 |
//!
//! Beside the paper, for one's own recordings:
//!
//! | module | in → out |
//! |---|---|
//! | [`clock`] | a column → whether it holds times, and their interval |
//! | [`usable`] | pressures → those of the sensors and samples that tell something |
//! | [`noise`] | pressures → smoothed, with 0 where there is no touch |
//! | [`parameters`] | what `rigid_parts` and `joints` are to be done with → [`Parameters`](parameters::Parameters) |
//! | [`rigid_parts`] | pressures → [`RigidParts`](rigid_parts::RigidParts): the part of each sensor, by motion subspaces |
//! | [`joints`] | pressures, parts → [`Joints`](joints::Joints): a tree over parts, by joint speeds and motions, and the support of its edges |
//! | [`placement`] | pressures, parts, tree, places of sensors → [`Placement`](placement::Placement): where the joints are |
//!
//! Beside stage 6, [`baselines`] cluster the same body map; [`mixture`] holds what both build on, [`tree`] the trees.
//! M is the number of sensors, T the number of samples, N the number of levels, d the number of dimensions.
//!
//! No stage reads or writes a file, or prints. Random numbers come from a generator or a seed that is an argument. Long stages call a `tick`
//! function as they go on.

pub mod agent;
pub mod baselines;
pub mod body_map;
pub mod clock;
pub mod distance;
pub mod evaluate;
pub mod joints;
pub mod mixture;
pub mod noise;
pub mod parameters;
pub mod placement;
pub mod quantise;
pub mod rigid_parts;
pub mod schema;
pub mod sense;
pub mod simulate;
pub mod tree;
pub mod usable;
