//! Open a file, a pipe or standard input, and tell from its first bytes what it holds.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use crate::files::error::FileError;

/// Bytes that are looked at before the rest: enough for some rows of a wide table.
pub(super) const HEAD: usize = 1 << 16;

/// What a file holds, by its first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// An array of NumPy.
    Npy,
    /// An archive of them.
    Npz,
    /// A table, or anything else.
    Text,
}

/// Where pressures are read from.
pub(super) struct Source {
    /// As messages name it.
    pub name: PathBuf,
    /// The path of a file; none of a pipe, which can be read once.
    file: Option<PathBuf>,
    head: Vec<u8>,
    rest: Box<dyn Read + Send>,
}

impl Source {
    /// Of a path, where `-` is standard input.
    pub(super) fn open(path: &Path) -> Result<Self, FileError> {
        let is_standard_input = path == Path::new("-");
        let name = if is_standard_input { PathBuf::from("standard input") } else { path.to_owned() };
        let broken = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => FileError::new(&name, "no such file"),
            _ => FileError::new(&name, format!("cannot be read: {error}")),
        };
        let (file, mut rest): (_, Box<dyn Read + Send>) = if is_standard_input {
            (None, Box::new(io::stdin()))
        } else {
            let opened = File::open(path).map_err(broken)?;
            let kind = opened.metadata().map_err(broken)?;
            if kind.is_dir() {
                return Err(FileError::new(&name, "is a folder; give a file of pressures"));
            }
            (kind.is_file().then(|| path.to_owned()), Box::new(opened))
        };
        let mut head = Vec::new();
        rest.by_ref().take(HEAD as u64).read_to_end(&mut head).map_err(broken)?;
        if head.is_empty() {
            return Err(FileError::new(&name, "is empty"));
        }
        Ok(Self { name, file, head, rest })
    }

    /// What it holds.
    pub(super) fn kind(&self) -> Kind {
        let has_extension = |wanted: &str| {
            self.name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
        };
        if self.head.starts_with(b"\x93NUMPY") || has_extension("npy") {
            Kind::Npy
        } else if self.head.starts_with(b"PK") || has_extension("npz") {
            Kind::Npz
        } else {
            Kind::Text
        }
    }

    /// The first bytes, at most [`HEAD`].
    pub(super) fn head(&self) -> &[u8] {
        &self.head
    }

    /// All bytes in turn.
    pub(super) fn reader(self) -> impl Read + Send {
        Cursor::new(self.head).chain(self.rest)
    }

    /// Bytes that can be read more than once: those of a pipe go into memory.
    pub(super) fn bytes(self) -> Result<Bytes, FileError> {
        if let Some(path) = self.file {
            return Ok(Bytes::File(path));
        }
        let (name, mut all) = (self.name, self.head);
        let mut rest = self.rest;
        rest.read_to_end(&mut all)
            .map_err(|error| FileError::new(&name, format!("cannot be read: {error}")))?;
        Ok(Bytes::Memory(name, all))
    }
}

/// Reads any byte next.
pub(super) trait ReadSeek: Read + io::Seek + Send {}
impl<T: Read + io::Seek + Send> ReadSeek for T {}

/// Bytes of a file, or of a pipe that was read to its end.
pub(super) enum Bytes {
    /// Of the file at a path.
    File(PathBuf),
    /// Of a pipe of this name.
    Memory(PathBuf, Vec<u8>),
}

impl Bytes {
    /// As messages name it.
    pub(super) fn name(&self) -> &Path {
        match self {
            Self::File(path) | Self::Memory(path, _) => path,
        }
    }

    /// All of them from the first on, and how many they are.
    pub(super) fn open(&self) -> Result<(Box<dyn ReadSeek + '_>, u64), FileError> {
        match self {
            Self::File(path) => {
                let broken = |error: io::Error| FileError::new(path, format!("cannot be read: {error}"));
                let file = File::open(path).map_err(broken)?;
                let length = file.metadata().map_err(broken)?.len();
                Ok((Box::new(file), length))
            }
            Self::Memory(_, bytes) => Ok((Box::new(Cursor::new(bytes)), bytes.len() as u64)),
        }
    }
}
