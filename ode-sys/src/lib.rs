//! Raw bindings to the system's Open Dynamics Engine, double precision: only the functions that a body
//! of cylinders and universal joints and its tests need. No logic lives here; see ODE's manual for each call.
//!
//! `src/bindings.rs` is bindgen's output for Debian's `libode-dev`, committed so that a build needs no
//! libclang; the feature `bindgen` regenerates it from the installed header.
#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals)]

#[cfg(not(feature = "bindgen"))]
mod bindings;
#[cfg(feature = "bindgen")]
mod bindings {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

pub use bindings::*;
