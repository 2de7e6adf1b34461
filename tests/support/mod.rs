//! The kit of the tests: the program in a folder of its own, small settings, files of the repository, and tools that a machine
//! may lack.
#![allow(dead_code, unreachable_pub, reason = "each test compiles the kit for itself and uses a part of it")]

pub mod browser;
pub mod folder;
pub mod repository;
pub mod said;
pub mod small;
pub mod tools;
