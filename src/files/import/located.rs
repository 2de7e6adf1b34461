//! Find the files that a description names, such as meshes and included files.

use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};

use super::document::Wrong;

/// Folders above that of the description in which its files may be: packages of ROS are beside each other there.
const UP: usize = 4;

/// Where the files of a description are.
#[derive(Clone)]
pub(super) struct Located {
    folder: PathBuf,
    /// All files must be in here.
    top: PathBuf,
}

impl Located {
    /// Those of the description in this file.
    pub(super) fn beside(description: &Path) -> Self {
        let folder = description.parent().unwrap_or(Path::new("")).join(".");
        let folder = folder.canonicalize().unwrap_or(folder);
        let top = folder.ancestors().take(UP + 1).last().unwrap_or(&folder).to_owned();
        Self { folder, top }
    }

    /// Those of a file that the description names: as far up as its own.
    pub(super) fn of(&self, file: &Path) -> Self {
        Self { folder: file.parent().unwrap_or(&self.folder).to_owned(), top: self.top.clone() }
    }

    /// The file of this name in `within`, relative to the description; none if it is not there. Of names such as
    /// `package://NAME/REST`, the package is looked for in the folders above. The name may be in Latin-1 on the disk, as old archives have it.
    ///
    /// # Errors
    /// If it is outside the folders that a description may name.
    pub(super) fn find(&self, within: &str, name: &str) -> Result<Option<PathBuf>, Wrong> {
        let name = name.replace('\\', "/");
        let (scheme, rest) = name.split_once("://").unwrap_or(("", &name));
        let place: &dyn Fn(&Path) -> Option<PathBuf> = match scheme {
            "package" | "model" => &|rest| self.in_package(rest),
            "file" => &|rest| Some(rest.to_owned()),
            "" => &|rest| Some(self.folder.join(within).join(rest)),
            _ => {
                return Err(format!(
                    "is at `{name}`, but {scheme}:// is not read; give the path of a file or package://"
                ));
            }
        };
        let there = |rest: PathBuf| place(&rest)?.canonicalize().ok().filter(|path| path.is_file());
        let Some(path) = [Some(rest.into()), in_latin_1(rest)].into_iter().flatten().find_map(there) else {
            return Ok(None);
        };
        if !path.starts_with(&self.top) {
            return Err(format!(
                "is at `{name}`, more than {UP} folders above; copy it beside the description"
            ));
        }
        Ok(Some(path))
    }

    /// A file by the name of its package and its path in that.
    fn in_package(&self, name: &Path) -> Option<PathBuf> {
        let mut names = name.iter();
        let (package, rest) = (names.next()?, names.as_path());
        let above = || self.folder.ancestors().take_while(|folder| folder.starts_with(&self.top));
        let inside = above().filter(|folder| folder.ends_with(package)).map(|folder| folder.join(rest));
        let beside = above().map(|folder| folder.join(name));
        // A package may be unpacked into a folder of another name.
        let renamed = above().map(|folder| folder.join(rest));
        inside.chain(beside).chain(renamed).find(|path| path.is_file())
    }
}

/// A path whose names are in Latin-1; none if it has other letters.
fn in_latin_1(path: &str) -> Option<PathBuf> {
    let bytes = path.chars().map(|letter| u8::try_from(letter).ok()).collect::<Option<Vec<u8>>>()?;
    Some(OsString::from_vec(bytes).into())
}

#[cfg(test)]
mod tests;
