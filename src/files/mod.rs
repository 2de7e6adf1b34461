//! Read and write files that NumPy and a spreadsheet open, and the folders of finished runs.

mod array;
pub mod body;
pub mod bvh;
pub(crate) mod checkpoint;
mod error;
mod front_end;
pub mod graph;
mod hash;
pub mod import;
pub(crate) mod manifest;
pub(crate) mod moved_body;
pub mod npy;
pub(crate) mod provenance;
pub(crate) mod result_folder;
pub(crate) mod ro_crate;
pub mod sensor_sites;
pub mod tables;
pub mod touch;
pub mod urdf;
#[doc(hidden)]
pub mod verify;
mod whole;

pub use self::error::{FileError, one_line};
pub use self::front_end::FrontEnd;
pub use self::hash::sha256;
pub(crate) use self::hash::sha256_of_text;
pub(crate) use self::whole::{is_same_file, remove_if_there, write_same_text};
pub use self::whole::{prepare_folder, read_text, write_text, write_whole};
