//! Show a body that moves, what its skin feels, its map and its tree, in a page that a browser draws without a network.

pub(crate) mod at_rest;
mod best_sample;
pub(crate) mod folder;
pub(crate) mod frames;
pub(crate) mod page;
pub(crate) mod scene;
pub(crate) mod sketch;
pub(crate) mod stored;
mod text;
