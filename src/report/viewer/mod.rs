//! Show a body that moves, what its skin feels, its map and its tree, in a page that a browser draws without a network.

mod best_sample;
pub mod folder;
pub mod frames;
pub mod page;
pub mod scene;
pub mod sketch;
pub mod stored;
mod text;
