//! All tests of the program and of the repository, linked once: a program for each of these files would take minutes longer to build,
//! and would leave one core waiting for each one's longest test.

mod article;
mod authors;
mod bodies;
mod body_import;
mod citation;
mod claims;
mod codecheck;
mod command_line;
mod docs;
mod layers;
mod mistakes;
mod multiverse;
mod package;
mod person;
mod placement;
mod properties;
mod prose;
mod recorded;
mod recovery;
mod reference;
mod report;
mod resume;
mod rhythm;
mod ro_crate;
mod settings;
mod study;
mod support;
mod system_calls;
mod verify;
mod viewer;
