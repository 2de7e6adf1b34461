//! Hash files and texts by SHA-256.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::FileError;

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// If the file cannot be read.
pub fn sha256(path: &Path) -> Result<String, FileError> {
    let bytes = fs::read(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))?;
    Ok(hexadecimal(&Sha256::digest(bytes)))
}

/// Bytes in hexadecimal.
fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of a text, in hexadecimal.
pub(crate) fn sha256_of_text(text: &str) -> String {
    hexadecimal(&Sha256::digest(text))
}
