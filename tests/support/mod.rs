//! The kit of the tests: the program in a folder of its own, small settings, drawn bodies, the names in the sources, files of the
//! repository, and tools that a machine may lack.
#![allow(unreachable_pub, reason = "examples and benchmarks compile files of it for themselves")]

pub mod bounded;
pub mod browser;
pub mod estimated;
pub mod folder;
pub mod names;
pub mod repository;
pub mod said;
pub mod small;
pub mod synthetic;
pub mod tools;
